//! Files written whole or not at all.

use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::{Error, Result};

/// Writes every file, or none.
///
/// Each file goes to a temporary one in its own folder first (created when
/// missing); only when all of them are complete and on disk are they renamed into
/// place, one after the other. So a full disk, a missing permission or a crash
/// while writing leaves the files that were there as they were, and a reader
/// never sees half a file. What cannot be promised: when a *rename* fails after
/// others have succeeded, which takes a folder changed by another program in
/// between, those others are new already.
///
/// # Errors
///
/// The first file that cannot be written, by name ([`Error::is_io`]); no
/// temporary file stays behind.
///
/// # Examples
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let plan = folder.path().join("out/plan.txt");
/// urban_layout::io::write::write_all_or_nothing(&[(plan.clone(), b"whole".to_vec())])?;
/// assert_eq!(std::fs::read(plan)?, b"whole");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_all_or_nothing(files: &[(PathBuf, Vec<u8>)]) -> Result<()> {
    let mut complete = Vec::with_capacity(files.len());
    for (path, bytes) in files {
        let failed = |source| Error::writing(path, source);
        // A rename onto a folder fails late and with a poor message.
        if path.is_dir() {
            return Err(failed(std::io::Error::other("a folder has that name")));
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        std::fs::create_dir_all(folder).map_err(failed)?;
        let mut file = new_file(folder).map_err(failed)?;
        file.write_all(bytes).map_err(failed)?;
        file.as_file().sync_all().map_err(failed)?;
        complete.push((path, file));
    }
    for (path, file) in complete {
        file.persist(path)
            .map_err(|error| Error::writing(path, error.error))?;
    }
    Ok(())
}

/// A temporary file in the folder, with the permissions an ordinary new file
/// would have (a temporary file is private to its owner otherwise).
fn new_file(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".urban-layout-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The process's umask takes its bits away from these.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
        builder.tempfile_in(folder)
    }
    #[cfg(not(unix))]
    builder.tempfile_in(folder)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn folders_are_made_and_files_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a/b/c.txt");
        for text in ["first", "second, longer"] {
            write_all_or_nothing(&[(path.clone(), text.into())]).unwrap();
            assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(names(path.parent().unwrap()), ["c.txt"]);
    }

    #[test]
    fn when_one_file_fails_the_others_stay_as_they_were() {
        let folder = tempfile::tempdir().unwrap();
        let good = folder.path().join("good.txt");
        let blocked = folder.path().join("folder");
        std::fs::create_dir(&blocked).unwrap();
        std::fs::write(&good, "old").unwrap();
        let error =
            write_all_or_nothing(&[(good.clone(), b"new".to_vec()), (blocked, b"x".to_vec())])
                .unwrap_err();
        assert!(error.is_io());
        assert!(error.to_string().contains("folder"), "{error}");
        assert_eq!(std::fs::read_to_string(&good).unwrap(), "old");
        assert_eq!(names(folder.path()), ["folder", "good.txt"]);
    }

    #[test]
    fn a_file_below_a_file_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "old").unwrap();
        let error = write_all_or_nothing(&[(file.join("below"), b"x".to_vec())]).unwrap_err();
        assert!(error.is_io());
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_new_file_may_be_read_by_others() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("ours"), folder.path().join("plain"));
        write_all_or_nothing(&[(ours.clone(), b"x".to_vec())]).unwrap();
        std::fs::write(&plain, "x").unwrap();
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }
}
