//! The one error of the crate: opaque, with predicates and a stable code.

use std::path::{Path, PathBuf};

use crate::site::SiteError;

/// What every fallible function of this crate returns.
pub type Result<T> = std::result::Result<T, Error>;

/// Why nothing could be made of a site, or written.
///
/// The error is opaque, so that a new cause is no breaking change: ask the
/// predicates what sort it is, [`Error::code`] which cause it is exactly, and
/// print it to tell the user. Its text is one line that names the feature, ring
/// and vertex where there is one, counted from 0 as in the file's arrays (ring 0
/// is the exterior), and says what to do.
///
/// # Examples
///
/// ```
/// use urban_layout::site::{Site, Units};
///
/// let bow_tie = r#"{"type": "Polygon", "coordinates":
///     [[[0, 0], [300, 200], [300, 0], [0, 200], [0, 0]]]}"#;
/// let error = Site::from_geojson(bow_tie, Units::Metres).unwrap_err();
/// assert!(error.is_input());
/// assert_eq!(error.code(), "self-crossing-ring");
/// assert_eq!(error.exit_code(), 1);
/// ```
pub struct Error(Box<ErrorKind>);

/// The sorts of error; causes of bad input are in [`SiteError`].
#[derive(Debug, thiserror::Error)]
pub(crate) enum ErrorKind {
    /// A site that cannot be used.
    #[error("{0}")]
    Site(SiteError),
    /// Another input that cannot be used, such as a layout to check.
    #[error("{0}")]
    Input(String),
    /// A call or command line that asks for what cannot be.
    #[error("{0}")]
    Usage(String),
    /// No result meets the constraints.
    #[error("{0}")]
    Unsatisfied(String),
    /// The caller's progress hook asked to stop, or time ran out.
    #[error("cancelled before a result was found; nothing was written")]
    Cancelled,
    /// A file could not be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        action: &'static str,
        path: PathBuf,
        source: std::io::Error,
    },
    /// An algorithm of another crate gave up where no fallback could go on.
    #[error("{stage}: {source}")]
    Stage {
        stage: &'static str,
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}

impl Error {
    /// A call that asks for what cannot be: an option out of its range, a name
    /// that nothing bears.
    #[must_use]
    pub fn usage(message: impl Into<String>) -> Self {
        ErrorKind::Usage(message.into()).into()
    }

    /// An input other than a site that cannot be used, such as a layout file.
    #[must_use]
    pub fn input(message: impl Into<String>) -> Self {
        ErrorKind::Input(message.into()).into()
    }

    /// No result meets the constraints; the message says which and where.
    #[must_use]
    pub fn unsatisfied(message: impl Into<String>) -> Self {
        ErrorKind::Unsatisfied(message.into()).into()
    }

    /// The work was asked to stop.
    #[must_use]
    pub fn cancelled() -> Self {
        ErrorKind::Cancelled.into()
    }

    /// A file that could not be read.
    #[must_use]
    pub fn reading(path: impl AsRef<Path>, source: std::io::Error) -> Self {
        ErrorKind::Io {
            action: "read",
            path: path.as_ref().to_owned(),
            source,
        }
        .into()
    }

    /// A file or folder that could not be written.
    #[must_use]
    pub fn writing(path: impl AsRef<Path>, source: std::io::Error) -> Self {
        ErrorKind::Io {
            action: "write",
            path: path.as_ref().to_owned(),
            source,
        }
        .into()
    }

    /// A stage of the work (`"field"`, `"mesh"`, ...) that failed with an error
    /// of its own, which stays reachable as the source.
    #[must_use]
    pub fn stage(
        stage: &'static str,
        source: impl Into<Box<dyn std::error::Error + Send + Sync>>,
    ) -> Self {
        ErrorKind::Stage {
            stage,
            source: source.into(),
        }
        .into()
    }

    /// The input is at fault: a site, or a layout to check.
    #[must_use]
    pub fn is_input(&self) -> bool {
        matches!(*self.0, ErrorKind::Site(_) | ErrorKind::Input(_))
    }

    /// The call or command line is at fault.
    #[must_use]
    pub fn is_usage(&self) -> bool {
        matches!(*self.0, ErrorKind::Usage(_))
    }

    /// The input is sound, but no result was found that meets the constraints.
    #[must_use]
    pub fn is_unsatisfied(&self) -> bool {
        matches!(*self.0, ErrorKind::Unsatisfied(_) | ErrorKind::Stage { .. })
    }

    /// The work was stopped from outside, by its caller or its deadline.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        matches!(*self.0, ErrorKind::Cancelled)
    }

    /// A file could not be read or written.
    #[must_use]
    pub fn is_io(&self) -> bool {
        matches!(*self.0, ErrorKind::Io { .. })
    }

    /// The exit status of the command: 1 the input (or a file) is wrong, 2 usage,
    /// 3 no result meets the constraints, 4 cancelled.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match *self.0 {
            ErrorKind::Site(_) | ErrorKind::Input(_) | ErrorKind::Io { .. } => 1,
            ErrorKind::Usage(_) => 2,
            ErrorKind::Unsatisfied(_) | ErrorKind::Stage { .. } => 3,
            ErrorKind::Cancelled => 4,
        }
    }

    /// A short name of the exact cause that stays the same from release to
    /// release, for programs: `self-crossing-ring`, `not-degrees`, ...
    #[must_use]
    pub fn code(&self) -> &'static str {
        match &*self.0 {
            ErrorKind::Site(cause) => cause.code(),
            ErrorKind::Input(_) => "bad-input",
            ErrorKind::Usage(_) => "usage",
            ErrorKind::Unsatisfied(_) => "unsatisfied",
            ErrorKind::Cancelled => "cancelled",
            ErrorKind::Io { .. } => "io",
            ErrorKind::Stage { .. } => "stage",
        }
    }

    /// The feature of the site's file that is at fault, counted from 0.
    #[must_use]
    pub fn feature(&self) -> Option<usize> {
        match &*self.0 {
            ErrorKind::Site(cause) => cause.place().map(|place| place.feature),
            _ => None,
        }
    }

    /// The ring at fault, counted from 0; ring 0 is the exterior.
    #[must_use]
    pub fn ring(&self) -> Option<usize> {
        match &*self.0 {
            ErrorKind::Site(cause) => cause.place().and_then(|place| place.ring),
            _ => None,
        }
    }

    /// The vertex at fault, counted from 0 within its ring or line.
    #[must_use]
    pub fn vertex(&self) -> Option<usize> {
        match &*self.0 {
            ErrorKind::Site(cause) => cause.place().and_then(|place| place.vertex),
            _ => None,
        }
    }
}

impl From<ErrorKind> for Error {
    fn from(kind: ErrorKind) -> Self {
        Self(Box::new(kind))
    }
}

impl From<SiteError> for Error {
    fn from(cause: SiteError) -> Self {
        ErrorKind::Site(cause).into()
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

// As in the standard library's `io::Error`, so that `unwrap` in a user's
// program prints something that can be read.
impl std::fmt::Debug for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Debug::fmt(&self.0, f)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.0 {
            ErrorKind::Io { source, .. } => Some(source),
            ErrorKind::Stage { source, .. } => Some(source.as_ref()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_sort_has_its_predicate_and_exit_code() {
        let missing = || std::io::Error::from(std::io::ErrorKind::NotFound);
        let table = [
            (Error::input("x"), 1, [true, false, false, false, false]),
            (Error::usage("x"), 2, [false, true, false, false, false]),
            (
                Error::unsatisfied("x"),
                3,
                [false, false, true, false, false],
            ),
            (
                Error::stage("field", "x"),
                3,
                [false, false, true, false, false],
            ),
            (Error::cancelled(), 4, [false, false, false, true, false]),
            (
                Error::reading("a", missing()),
                1,
                [false, false, false, false, true],
            ),
            (
                Error::writing("a", missing()),
                1,
                [false, false, false, false, true],
            ),
        ];
        for (error, code, is) in table {
            let found = [
                error.is_input(),
                error.is_usage(),
                error.is_unsatisfied(),
                error.is_cancelled(),
                error.is_io(),
            ];
            assert_eq!((error.exit_code(), found), (code, is), "{error}");
            assert!(!error.to_string().contains('\n'));
        }
    }

    #[test]
    fn a_file_error_names_the_file_and_keeps_its_source() {
        let source = std::io::Error::from(std::io::ErrorKind::NotFound);
        let error = Error::reading("some/site.geojson", source);
        assert!(error
            .to_string()
            .starts_with("cannot read some/site.geojson: "));
        assert!(std::error::Error::source(&error).is_some());
    }
}
