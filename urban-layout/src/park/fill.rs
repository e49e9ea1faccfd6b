//! Designs for the parks of a plan: what [`ParkFill`](crate::splitter::ParkFill)
//! and templates leave open gets paths, trees and benches.

use std::f64::consts::PI;

use geo_types::Polygon;
use park_grammar::{grammars, DeriveOptions, Grammar, Scene};

use super::sewn;
use crate::layout::plane::{distance, rings};
use crate::layout::{Layout, ParkDesign, Tile, TileKind};
use crate::options::PlanOptions;
use crate::planner::parallel;
use crate::planner::seed::mix;
use crate::site::boolean::area;

/// How the parks that a plan makes are designed.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ParkChoice {
    /// By grammars of the library, chosen by size and shape.
    #[default]
    Fitting,
    /// All by one grammar, where that suits.
    Grammar(Box<Grammar>),
    /// They stay open land.
    Plain,
}

/// Land that is too small or too narrow to be walked in: trees on grass.
const VERGE: &str = "grammar 1
Region -> Lawn Scatter(density = 0.7, margin = 0.5) { 2: SmallTree | Bush } Scatter(density = 0.3, margin = 0.8) { Tree }
";

/// Smaller and narrower parks are verges, square metres and metres.
const SMALL: f64 = 350.0;
const NARROW: f64 = 9.0;

/// Land that is narrower on average, metres, stays grass.
const HEM: f64 = 2.5;

/// Designs all parks of a layout that were not given with the site, each by a
/// stream of its own, so that others may change without it.
///
/// A design that its grammar cannot make of the land, or that would break a law of
/// parks, gives way to the next simpler one; what suits nothing stays open land.
pub(crate) fn design(layout: &mut Layout, options: &PlanOptions) {
    if options.parks == ParkChoice::Plain {
        return;
    }
    let parks: Vec<&Tile> = layout
        .tiles
        .iter()
        .filter(|tile| tile.kind == TileKind::Park && !tile.given)
        .collect();
    let designs = parallel::map(&parks, options.threads, |tile| {
        one(tile, layout.seed, &options.parks)
    });
    layout.parks = designs.into_iter().flatten().collect();
}

fn one(tile: &Tile, seed: u64, choice: &ParkChoice) -> Option<ParkDesign> {
    let stream = tile.lineage.as_ref().map_or(seed, |lineage| lineage.seed);
    let seed = mix(stream ^ mix(tile.id));
    let made = |name: &str, grammar: &Grammar| {
        let scene = lawful(grammar, &tile.polygon, seed)?;
        Some(ParkDesign {
            tile: tile.id,
            grammar: name.to_owned(),
            scene,
        })
    };
    if let ParkChoice::Grammar(grammar) = choice {
        return made(&super::name_of(grammar), grammar);
    }
    fitting(&tile.polygon, seed)
        .into_iter()
        .find_map(|name| match grammars::named(name) {
            Some(known) => made(name, &known.grammar().ok()?),
            None => made(name, &Grammar::new(VERGE).ok()?),
        })
}

/// The park on an outline, if the grammar makes one that keeps all laws.
fn lawful(grammar: &Grammar, outline: &Polygon<f64>, seed: u64) -> Option<Scene> {
    let options = DeriveOptions {
        seed,
        // By the clock a plan would depend on the machine.
        time: None,
        operations: 200_000,
        ..DeriveOptions::default()
    };
    let mut scene = grammar.derive(outline, &options).ok()?;
    sewn(&mut scene, outline);
    scene.audit(outline).is_lawful().then_some(scene)
}

/// Grammars that suit a park, the best first.
fn fitting(outline: &Polygon<f64>, seed: u64) -> Vec<&'static str> {
    let land = area(outline);
    let round: f64 = rings(outline)
        .flat_map(|ring| ring.0.windows(2))
        .map(|w| distance(w[0], w[1]))
        .sum();
    // Of a long strip, its width; of a square, its side.
    let width = {
        let half = 0.25 * round;
        half - (half * half - land).max(0.0).sqrt()
    };
    // 1 for a circle, 0.785 for a square, 0.5 for an oblong of four squares.
    let compact = 4.0 * PI * land / (round * round);
    if width < HEM {
        return Vec::new();
    }
    let mut found = match (land < SMALL || width < NARROW, compact > 0.58) {
        (true, _) => Vec::new(),
        (false, true) if land < 2500.0 => drawn(&["pocket_park", "simple_square"], seed),
        (false, true) if land < 15_000.0 => drawn(
            &[
                "simple_square",
                "circular_paths",
                "formal_garden",
                "pocket_park",
            ],
            seed,
        ),
        (false, true) => drawn(&["woodland", "simple_square", "nested_grids"], seed),
        (false, false) if land < 2500.0 => drawn(&["woodland", "pocket_park"], seed),
        (false, false) => drawn(&["woodland", "free_form", "beam_park"], seed),
    };
    found.push("verge");
    found
}

/// The names from one that chance chose on, around to the one before it.
fn drawn(names: &[&'static str], seed: u64) -> Vec<&'static str> {
    let first = (mix(seed ^ 0x5eed) % names.len() as u64) as usize;
    let mut all = names.to_vec();
    all.rotate_left(first);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use geo_types::polygon;

    fn oblong(x: f64, y: f64) -> Polygon<f64> {
        polygon![(x: 0., y: 0.), (x: x, y: 0.), (x: x, y: y), (x: 0., y: y)]
    }

    #[test]
    fn grammars_suit_size_and_shape() {
        assert!(fitting(&oblong(80.0, 2.0), 1).is_empty());
        assert_eq!(fitting(&oblong(80.0, 6.0), 1), ["verge"]);
        assert_eq!(fitting(&oblong(12.0, 12.0), 1), ["verge"]);
        assert!(fitting(&oblong(40.0, 35.0), 1).contains(&"pocket_park"));
        assert!(fitting(&oblong(250.0, 30.0), 1).contains(&"woodland"));
        let all = fitting(&oblong(90.0, 80.0), 1);
        assert_eq!((all.len(), all.last()), (5, Some(&"verge")));
        let firsts: Vec<&str> = (0..40)
            .map(|k| fitting(&oblong(90.0, 80.0), k)[0])
            .collect();
        for name in &all[..4] {
            assert!(firsts.contains(name), "{name} is never the first");
            assert!(grammars::named(name).is_some());
        }
    }

    #[test]
    fn a_verge_is_lawful() {
        let grammar = Grammar::new(VERGE).expect("reads");
        let scene = lawful(&grammar, &oblong(40.0, 6.0), 3).expect("a design");
        assert!(!scene.objects.is_empty());
    }
}
