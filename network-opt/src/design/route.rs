//! Routes that a network should offer between two places.

/// A pair of places and the paths that would do between them (the paper's
/// equations 7 and 8).
///
/// ```
/// use network_opt::design::Route;
///
/// // Along edges 0 and 1, or along edge 2.
/// let needed = Route::from(vec![vec![0, 1], vec![2]]);
/// let wished = Route { cost: Some(5.0), ..needed.clone() };
/// assert_eq!((needed.cost, wished.paths.len()), (None, 2));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Route {
    /// What it is for.
    pub kind: RouteKind,
    /// The paths, by their edges. A path is there if all its edges are active;
    /// the route, if one of its paths is. Without paths it never is.
    pub paths: Vec<Vec<usize>>,
    /// What it costs if the route is not there; `None` if it has to be.
    pub cost: Option<f64>,
}

impl Route {
    /// Whether one of its paths is active throughout.
    ///
    /// # Panics
    ///
    /// If a path has an edge that `active` has no entry of.
    #[must_use]
    pub fn is_there(&self, active: &[bool]) -> bool {
        let mut paths = self.paths.iter();
        paths.any(|path| path.iter().all(|&e| active[e]))
    }
}

impl From<Vec<Vec<usize>>> for Route {
    /// One that has to be there.
    fn from(paths: Vec<Vec<usize>>) -> Self {
        Self {
            paths,
            ..Self::default()
        }
    }
}

/// What a route is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum RouteKind {
    /// Someone asked for it.
    #[default]
    Asked,
    /// Traffic from one place inside to another: the paper's point-to-point
    /// constraint.
    Inside,
    /// Traffic from one place on the boundary to another.
    Across,
}

impl RouteKind {
    /// The kind in words.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Asked => "asked for",
            Self::Inside => "inside",
            Self::Across => "across",
        }
    }
}
