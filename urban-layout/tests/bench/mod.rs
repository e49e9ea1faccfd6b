//! A folder of one's own to run the command in, sites to run it on, and what it
//! leaves there.

#![allow(dead_code, reason = "each test file uses its own part")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A field of 3.6 hectares: a plan of it takes a moment.
pub(crate) const FIELD: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site", "name": "Field"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [240, 0], [240, 150], [0, 150], [0, 0]]]}}]}"#;

/// A ring that crosses itself.
pub(crate) const BOW_TIE: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [240, 150], [240, 0], [0, 150], [0, 0]]]}}]}"#;

/// A site of three straight sides: no H-field follows them.
pub(crate) const TRIANGLE: &str = r#"{"type": "FeatureCollection", "coordinate_units": "metres", "features": [
{"type": "Feature", "properties": {"kind": "site"}, "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [420, 20], [150, 330], [0, 0]]]}}]}"#;

/// A folder of one's own with a site in it.
pub(crate) struct Bench {
    folder: TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let bench = Self { folder };
        std::fs::write(bench.path("site.geojson"), FIELD).expect("written");
        bench
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs the command in the folder.
    pub(crate) fn run(&self, words: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_urban-layout"))
            .current_dir(self.folder.path())
            .args(words)
            .output()
            .expect("the command starts")
    }

    /// Runs the command, expecting an exit status; gives its standard output.
    #[track_caller]
    pub(crate) fn expect(&self, status: i32, words: &[&str]) -> String {
        let output = self.run(words);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{words:?}: {said}");
        String::from_utf8(output.stdout).expect("UTF-8")
    }

    /// The one line on standard error of a run that ends with this status.
    #[track_caller]
    pub(crate) fn complaint(&self, status: i32, words: &[&str]) -> String {
        let output = self.run(words);
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(status), "{words:?}: {said}");
        assert!(output.stdout.is_empty(), "nothing goes to stdout");
        assert_eq!(said.lines().count(), 1, "one line: {said}");
        said
    }
}

/// Every file below a folder with its bytes, sorted.
pub(crate) fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut out = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let bytes = std::fs::read(&path).expect("readable");
                out.push((path, bytes));
            }
        }
    }
    out.sort();
    out
}

pub(crate) fn names(folder: &Path) -> Vec<String> {
    let name = |(path, _): &(PathBuf, Vec<u8>)| {
        let below = path.strip_prefix(folder).expect("below the folder");
        below.to_string_lossy().replace('\\', "/")
    };
    files(folder).iter().map(name).collect()
}

pub(crate) fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}
