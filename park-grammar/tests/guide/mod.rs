//! The examples of the guide's pages about parks: fenced blocks of `park`, each
//! with the name of its picture.
//!
//! A block begins with ` ```park NAME OUTLINE `; without an outline it is on the
//! oblong. The line `grammar 1` may be left out. ` ```park NAME OUTLINE fault `
//! is one that cannot be derived, and the next block of `text` says why.

use std::path::PathBuf;

use park_grammar::geo_types::{coord, Polygon};
use park_grammar::{DeriveOptions, Grammar, ParkError, Scene};

/// The pages with examples.
pub(crate) const PAGES: [&str; 2] = ["park-language.md", "park-rules.md"];

/// A block of a page.
#[derive(Clone, Debug)]
pub(crate) struct Sample {
    pub(crate) page: &'static str,
    pub(crate) line: usize,
    pub(crate) name: String,
    pub(crate) outline: String,
    pub(crate) text: String,
    /// What is said of it if it cannot be derived.
    pub(crate) fault: Option<String>,
}

/// Where the guide's sources lie; they are not a part of the package.
pub(crate) fn folder() -> Option<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../docs/src");
    folder.is_dir().then_some(folder)
}

/// All examples of a page.
pub(crate) fn samples(page: &'static str, markdown: &str) -> Vec<Sample> {
    let mut found: Vec<Sample> = Vec::new();
    let mut lines = markdown.lines().enumerate();
    while let Some((line, text)) = lines.next() {
        let Some(info) = text.strip_prefix("```").filter(|info| !info.is_empty()) else {
            continue;
        };
        let body: Vec<&str> = lines
            .by_ref()
            .map(|(_, text)| text)
            .take_while(|text| *text != "```")
            .collect();
        let body = body.join("\n");
        let words: Vec<&str> = info.split_whitespace().collect();
        match words.as_slice() {
            ["park", name, rest @ ..] => found.push(Sample {
                page,
                line: line + 1,
                name: (*name).to_owned(),
                outline: rest.first().map_or("oblong", |o| o).to_owned(),
                text: body,
                fault: rest.contains(&"fault").then(String::new),
            }),
            ["text"] => {
                let last = found.last_mut().and_then(|sample| sample.fault.as_mut());
                if let Some(fault) = last.filter(|fault| fault.is_empty()) {
                    *fault = body;
                }
            }
            _ => {}
        }
    }
    found
}

/// The outlines that examples are on, metres.
pub(crate) fn outline(name: &str) -> Option<Polygon<f64>> {
    Some(match name {
        "oblong" => polygon(&[(0., 0.), (48., 0.), (48., 32.), (0., 32.)]),
        "square" => polygon(&[(0., 0.), (36., 0.), (36., 36.), (0., 36.)]),
        "small" => polygon(&[(0., 0.), (24., 0.), (24., 16.), (0., 16.)]),
        "large" => polygon(&[(0., 0.), (90., 0.), (90., 60.), (0., 60.)]),
        "turned" => polygon(&[(8., 0.), (46., 14.), (38., 36.), (0., 22.)]),
        "slant" => polygon(&[(0., 0.), (44., 4.), (50., 34.), (6., 28.)]),
        "triangle" => polygon(&[(0., 0.), (48., 4.), (18., 34.)]),
        "five" => polygon(&[(4., 0.), (40., 2.), (50., 20.), (26., 36.), (0., 24.)]),
        "cut" => polygon(&[(0., 0.), (48., 0.), (48., 20.), (36., 32.), (0., 32.)]),
        "bend" => polygon(&[
            (0., 0.),
            (48., 0.),
            (48., 16.),
            (22., 18.),
            (18., 36.),
            (0., 36.),
        ]),
        "bay" => polygon(&[
            (0., 2.),
            (30., 0.),
            (50., 8.),
            (48., 34.),
            (34., 36.),
            (31., 20.),
            (22., 18.),
            (18., 34.),
            (3., 32.),
        ]),
        "niche" => polygon(&[
            (0., 0.),
            (48., 0.),
            (48., 32.),
            (0., 32.),
            (0., 21.),
            (6., 21.),
            (6., 12.),
            (0., 12.),
        ]),
        "island" => {
            let park = polygon(&[(0., 0.), (48., 0.), (48., 32.), (0., 32.)]);
            let house = polygon(&[(18., 11.), (30., 11.), (30., 21.), (18., 21.)]);
            Polygon::new(park.exterior().clone(), vec![house.exterior().clone()])
        }
        _ => return None,
    })
}

fn polygon(points: &[(f64, f64)]) -> Polygon<f64> {
    let ring = points.iter().map(|&(x, y)| coord! { x: x, y: y });
    Polygon::new(ring.collect(), Vec::new())
}

impl Sample {
    /// What it derives.
    pub(crate) fn derive(&self) -> Result<Scene, ParkError> {
        let mut text = self.text.clone();
        if !text.trim_start().starts_with("grammar 1") {
            text = format!("grammar 1\n{text}");
        }
        let load = |name: &str| match name {
            "stone.obj" => Ok(STONE.to_owned()),
            "planting.park" => Ok(PLANTING.to_owned()),
            _ => Err("there is no such file".to_owned()),
        };
        let park = outline(&self.outline).ok_or_else(|| ParkError::File {
            what: format!("there is no outline {}", self.outline),
        })?;
        let grammar = Grammar::with_includes("example.park", &text, &load)?;
        grammar.derive(&park, &DeriveOptions::default())
    }
}

/// A boulder.
const STONE: &str = "v 1 0 0.4\nv 0.2 0 1\nv -1 0 0.3\nv -0.4 0 -1\nv 0.7 0 -0.7\nv 0 1 0\n\
                     f 1 6 2\nf 2 6 3\nf 3 6 4\nf 4 6 5\nf 5 6 1\n";

/// What the example of includes includes.
const PLANTING: &str = "grammar 1\nPlanted -> Meadow Scatter(6, margin = 1) { Tree | Bush }\n";
