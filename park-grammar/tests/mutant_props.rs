//! Broken grammars: whatever is changed in a grammar, deriving it comes to an end,
//! with a park that tiles its outline or an error, and never a panic.

mod common;

use std::time::Duration;

use park_grammar::geo_types::{polygon, Polygon};
use park_grammar::{grammars, DeriveOptions, Grammar, ParkError};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

/// As others, with less patience to make what fails small.
fn config(few: u32, many: u32) -> ProptestConfig {
    ProptestConfig {
        max_shrink_iters: 200,
        ..common::config(few, many)
    }
}

/// Grammars beside those of the library: what these leave out.
const OTHERS: [&str; 4] = [
    "grammar 1\nRegion -> Grid(3 {[1, 4]a[-20, 20]}, 2 {5}, Apart, fit = blend, of = [axis, oriented]) { A } { Gravel } { Paving } { B }\nA -> Peel(OUTER, 20 %, CornersOrthogonal) { ShrubBed | Lawn }\nB -> Case { sides > 3 and area < 50 m: Sand | else: Scatter(4, Poisson) { Tree | 2: Bush } }\n",
    "grammar 1\nparam Side = WEST or Angle([0, 90])\nfun Lines(s) = Parametrise([0, 0.5], [], [0.2, 1], 1, s, inset = 1)\nRegion -> Distribute(Side: 1, 4, Exact) { Lamp } Sweep(Lines(ALL), 0.4, 1) { Hedge } Place(CORNER[0..2], facing = centre) { Bench }\n",
    "grammar 1\nRegion -> VoronoiRegions(C[2], smooth = chaikin, amplitude = 0.5, Weighted) { A } { Gravel } { Circle(1) Sand }\nC -> ScatterCircles(4 {[2, 3]}, gap = 1)\nA -> Sweep(PATH: 0.2) { Hedge } Sweep(Cardinal(WEST, Dominant, Split), 1) { Wall }\n",
    "grammar 1\nRegion -> CastRays([CENTRE, (0.2, 0.3)], Corners(OUTER), join = tree, rays = all) { A } { Gravel } { Romb(2) Paving }\nA -> Case { Length(EDGE[1]) > 5: Peel(EDGE[-1] or History(\"CastRays\", PATH), 1) { A | Meadow } | else: Rectangle(2, 3) Water }\n",
];

/// What may stand in the place of a word.
const WORDS: [&str; 44] = [
    "0",
    "1",
    "-1",
    "1e300",
    "0.0001",
    "99999",
    "3 m",
    "50 %",
    "[0, 1]",
    "[]",
    "{2, 3}",
    "(0.5, 0.5)",
    "OUTER",
    "ALL",
    "CENTRE",
    "EDGE",
    "EDGE[0]",
    "CORNER[-1]",
    "Region",
    "Lawn",
    "Tree",
    "Grid",
    "Peel",
    "CastRays",
    "VoronoiRegions",
    "Scatter",
    "Distribute",
    "Sweep",
    "Place",
    "Circle",
    "FitRectangle",
    "area",
    "room",
    "and",
    "or",
    "minus",
    "else",
    "fit",
    "in",
    "Exact",
    "Poisson",
    "{",
    "}",
    ",",
];

/// One change of a text.
#[derive(Clone, Debug)]
enum Change {
    Replace(Index, usize),
    Insert(Index, usize),
    Remove(Index),
    Double(Index),
    Swap(Index, Index),
}

fn change() -> impl Strategy<Value = Change> {
    let word = 0..WORDS.len();
    prop_oneof![
        4 => (any::<Index>(), word.clone()).prop_map(|(at, k)| Change::Replace(at, k)),
        2 => (any::<Index>(), word).prop_map(|(at, k)| Change::Insert(at, k)),
        1 => any::<Index>().prop_map(Change::Remove),
        1 => any::<Index>().prop_map(Change::Double),
        2 => (any::<Index>(), any::<Index>()).prop_map(|(a, b)| Change::Swap(a, b)),
    ]
}

/// Words, numbers and marks of a text.
fn tokens(text: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut before = ' ';
    for line in text.lines() {
        let line = line.split("//").next().unwrap_or(line);
        for c in line.chars().chain(['\n']) {
            let word = |c: char| c.is_alphanumeric() || "_.\"->".contains(c);
            match found.last_mut().filter(|_| word(c) && word(before)) {
                Some(last) => last.push(c),
                None => found.push(c.to_string()),
            }
            before = c;
        }
    }
    found
}

fn changed(text: &str, changes: &[Change]) -> String {
    let mut all = tokens(text);
    for change in changes {
        let n = all.len();
        match change {
            Change::Replace(at, word) => all[at.index(n)] = WORDS[*word].to_owned(),
            Change::Insert(at, word) => all.insert(at.index(n), format!(" {} ", WORDS[*word])),
            Change::Remove(at) => drop(all.remove(at.index(n))),
            Change::Double(at) => {
                let k = at.index(n);
                all.insert(k, all[k].clone());
            }
            Change::Swap(a, b) => all.swap(a.index(n), b.index(n)),
        }
    }
    all.concat()
}

fn outlines() -> [Polygon<f64>; 3] {
    [
        polygon![(x: 0., y: 0.), (x: 24., y: 0.), (x: 24., y: 16.), (x: 0., y: 16.)],
        polygon![(x: 0., y: 0.), (x: 30., y: 4.), (x: 12., y: 25.)],
        polygon![
            (x: 0., y: 0.), (x: 34., y: 2.), (x: 30., y: 12.), (x: 14., y: 11.), (x: 12., y: 28.),
            (x: 1., y: 24.)
        ],
    ]
}

proptest! {
    #![proptest_config(config(150, 100_000))]

    #[test]
    fn changed_grammars_come_to_an_end(
        which in any::<Index>(),
        park in 0..3_usize,
        changes in vec(change(), 1..4),
        seed in 0..100_u64,
    ) {
        let all: Vec<&str> = grammars::ALL.iter().map(|g| g.text).chain(OTHERS).collect();
        let text = changed(all[which.index(all.len())], &changes);
        let Ok(grammar) = Grammar::new(&text) else {
            return Ok(());
        };
        let options = DeriveOptions {
            seed,
            depth: 12,
            operations: 2_000,
            time: Some(Duration::from_millis(500)),
            ..DeriveOptions::default()
        };
        let outline = &outlines()[park];
        match grammar.derive(outline, &options) {
            Ok(scene) => {
                let audit = scene.audit(outline);
                prop_assert!(audit.tiling_error() < 1e-7, "{text}\n{:?}", audit.violations);
            }
            Err(error) => {
                let known = matches!(
                    error,
                    ParkError::Rule(_) | ParkError::Limit { .. }
                );
                prop_assert!(known, "{text}\n{error}");
            }
        }
    }
}
