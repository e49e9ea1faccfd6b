//! The real sites of this repository, with typed loaders, and what the tests that
//! need several crates share.
//!
//! Five sites of Kotka, Finland, lie in `data/sites` (OpenStreetMap, ODbL 1.0; see
//! `data/LICENSE.md`). [`SITES`] lists them; the tests beside this crate make plans
//! of them and ask for the project's laws.
//!
//! The pages of the guide that hold Rust code are tested from here as well, so that
//! what a reader copies compiles and runs.

mod compare;
mod metres;

use std::path::PathBuf;

use urban_layout::{generate, Plan, PlanOptions, Quiet, Site};

pub use compare::{new_streets, share_elsewhere};
pub use metres::in_metres;

/// A site that is shipped with the repository.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shipped {
    /// Its name: that of its file, without `.geojson`.
    pub name: &'static str,
    /// Whether it is plain suburban land, without anything given on it but what
    /// a field has: the stricter limits of quality hold there.
    pub plain: bool,
}

/// All sites that are shipped, the smallest first.
pub const SITES: [Shipped; 5] = [
    Shipped {
        name: "kotka_north",
        plain: false,
    },
    Shipped {
        name: "kotka_northwest",
        plain: true,
    },
    Shipped {
        name: "kotka_fields",
        plain: true,
    },
    Shipped {
        name: "kotka_east",
        plain: false,
    },
    Shipped {
        name: "kotka_district",
        plain: false,
    },
];

impl Shipped {
    /// The site of that name.
    ///
    /// # Panics
    ///
    /// If no site is called so.
    #[must_use]
    pub fn named(name: &str) -> Self {
        match SITES.into_iter().find(|site| site.name == name) {
            Some(site) => site,
            None => panic!("no shipped site is called {name}"),
        }
    }

    /// Its file.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        PathBuf::from(env!("CARGO_MANIFEST_DIR"))
            .join("data/sites")
            .join(format!("{}.geojson", self.name))
    }

    /// The text of its file.
    ///
    /// # Panics
    ///
    /// If the file cannot be read.
    #[must_use]
    pub fn text(&self) -> String {
        let path = self.path();
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }

    /// The site as the planner takes it.
    ///
    /// # Panics
    ///
    /// If the file is no site, with the reason.
    #[must_use]
    pub fn site(&self) -> Site {
        Site::read(self.path()).unwrap_or_else(|e| panic!("{}: {e}", self.name))
    }

    /// A plan of it.
    ///
    /// # Panics
    ///
    /// If there is none, with the reason.
    #[must_use]
    pub fn plan(&self, options: &PlanOptions) -> Plan {
        generate(&self.site(), options, &mut Quiet).unwrap_or_else(|e| panic!("{}: {e}", self.name))
    }
}

/// Whether the long versions of the tests were asked for
/// (`URBAN_LAYOUT_LONG=1`).
#[must_use]
pub fn long() -> bool {
    std::env::var_os("URBAN_LAYOUT_LONG").is_some_and(|value| value == "1")
}

/// The Rust code of the guide and of the front page.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
#[doc = include_str!("../../docs/src/library.md")]
#[doc = include_str!("../../docs/src/extending.md")]
mod guide {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_folder_is_listed() {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data/sites");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .expect("the sites are there")
            .map(|entry| entry.expect("readable").file_name().into_string())
            .map(|name| name.expect("plain names"))
            .collect();
        files.sort();
        let mut listed = SITES.map(|site| format!("{}.geojson", site.name));
        listed.sort();
        assert_eq!(files, listed);
    }

    #[test]
    fn every_site_is_read_without_loss() {
        for shipped in SITES {
            let site = shipped.site();
            assert_eq!(site.name.as_deref(), Some(shipped.name));
            let km2 = site.area() / 1e6;
            assert!((0.15..1.5).contains(&km2), "{} {km2} km2", shipped.name);
        }
    }
}
