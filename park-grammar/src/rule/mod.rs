//! The operations: one file a rule.

mod arguments;
mod circles;
pub(crate) mod contract;
pub(crate) mod control;
mod darts;
mod distribute;
mod fit;
mod fit_rectangle;
mod grid;
pub(crate) mod holes;
mod parts;
mod peel;
pub(crate) mod place;
pub(crate) mod points;
pub(crate) mod primitive;
mod rays;
mod rings;
mod runs;
mod scatter;
mod sites;
mod smooth;
pub(crate) mod smoothing;
mod split_along;
mod sweep;
mod target;
#[cfg(test)]
mod trial;
mod voronoi;

use crate::derive::{Node, Places, Run, Scope};
use crate::error::Failure;
use crate::library;
use crate::scene::Ground;
use crate::shape::Region;
use crate::syntax::ast::Operation;

pub(crate) use arguments::{mode, Arguments};
pub(crate) use primitive::Primitive;

/// What a partition rule is asked.
pub(crate) struct Ask<'a, 's> {
    /// The operation as it is written.
    pub(crate) operation: &'a Operation,
    /// What its arguments are evaluated in; its region is the one to be divided.
    pub(crate) scope: Scope<'s>,
    /// Width of paths, metres, unless the arguments say otherwise; 0 where the
    /// grammar wants none.
    pub(crate) path_width: f64,
    /// The shape of centres, if the grammar gives one.
    pub(crate) centre: Option<Primitive>,
    /// Whether the grammar says what becomes of centres, whatever their shape.
    pub(crate) centred: bool,
}

/// One of the outputs of a partition, in the order of the blocks.
#[derive(Clone, Debug)]
pub(crate) struct Output {
    pub(crate) ground: Ground,
    /// What its regions are made of where the grammar does not say.
    pub(crate) material: &'static str,
    pub(crate) regions: Vec<Region>,
}

/// Regions that tile the one they were cut from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Partition {
    pub(crate) outputs: Vec<Output>,
}

impl Output {
    pub(crate) fn lawns(regions: Vec<Region>) -> Self {
        Self {
            ground: Ground::Region,
            material: "Lawn",
            regions,
        }
    }

    pub(crate) fn paths(regions: Vec<Region>) -> Self {
        Self {
            ground: Ground::Path,
            material: "Gravel",
            regions,
        }
    }
}

type Divide = fn(&mut Ask<'_, '_>) -> Result<Partition, Failure>;
type Act = fn(&mut Run<'_>, &mut Node, &Operation, &Places) -> Result<(), Failure>;

/// What an operation does.
#[derive(Clone, Copy)]
pub(crate) enum Deed {
    /// Divides the region into the outputs of its blocks.
    Divide(Divide),
    /// The same, where the third output is no centre.
    Part(Divide),
    /// Puts things on the region, or sets what it is.
    Act(Act),
    /// Cuts a shape out of the region, and goes on with that.
    Shape,
    /// Goes on with one of its branches: `Choose`, `Case`.
    Branch,
    /// Gives places, as an argument or a rule of its own.
    Points,
}

/// An operation that every grammar knows.
pub(crate) struct Operator {
    pub(crate) name: &'static str,
    pub(crate) deed: Deed,
}

const fn operator(name: &'static str, deed: Deed) -> Operator {
    Operator { name, deed }
}

/// All of them.
pub(crate) const OPERATORS: &[Operator] = &[
    operator("Choose", Deed::Branch),
    operator("Case", Deed::Branch),
    operator("Circle", Deed::Shape),
    operator("Romb", Deed::Shape),
    operator("Square", Deed::Shape),
    operator("Rectangle", Deed::Shape),
    operator("Polygon", Deed::Shape),
    operator("Grid", Deed::Divide(grid::grid)),
    operator("FitRectangle", Deed::Divide(fit_rectangle::fit_rectangle)),
    operator("CastRays", Deed::Divide(rays::rays)),
    operator("Peel", Deed::Part(peel::peel)),
    operator("Contract", Deed::Part(contract::contract)),
    operator("Rings", Deed::Part(rings::rings)),
    operator("Smooth", Deed::Part(smooth::smooth)),
    operator("SplitAlong", Deed::Part(split_along::split_along)),
    operator("SplitHoles", Deed::Part(holes::split_holes)),
    operator("VoronoiRegions", Deed::Divide(voronoi::voronoi)),
    operator("VoronoiSmoothed", Deed::Divide(voronoi::voronoi)),
    operator("Place", Deed::Act(place::place)),
    operator("Scatter", Deed::Act(scatter::scatter)),
    operator("Distribute", Deed::Act(distribute::distribute)),
    operator("DistributeSmooth", Deed::Act(sweep::sweep)),
    operator("Sweep", Deed::Act(sweep::sweep)),
    operator("ScatterCircles", Deed::Points),
    operator("Corners", Deed::Points),
    operator("Along", Deed::Points),
    operator("Parametrise", Deed::Points),
];

/// Words that mean something as an argument of some operation; how they are
/// written tells flags, modes and places apart: see [`arguments`].
pub(crate) const WORDS: &[&str] = &[
    // Flags of operations.
    "Exact",
    "Apart",
    "Poisson",
    "Middles",
    "Through",
    "Mitre",
    // Flags of selectors.
    "Line",
    "Compass",
    "Leave",
    "Rest",
    "Corners",
    "Angle",
    "Sector",
    "Grow",
    "Dominant",
    "Northern",
    "Split",
    // Modes: ways to fit.
    "own",
    "oriented",
    "bounding",
    "axis",
    "inscribed",
    "optimised",
    "indexed",
    "meeting",
    "blend",
    // Modes: symmetry.
    "centre",
    "left",
    "right",
    "local",
    "mirror",
    "pair",
    "extended",
    // Peel and others.
    "CornersOrthogonal",
    "SplitHoles",
    "POLE",
    "inset",
    "scale",
    "straight",
    "smooth",
    "arc",
    "sinus",
    // Smoothing of borders.
    "none",
    "average",
    "chaikin",
    "round",
    // VoronoiRegions.
    "Weighted",
    "Around",
    // CastRays.
    "nearest",
    "unconnected",
    "all",
    "loop",
    "open",
    "pairs",
    "opposites",
    "delaunay",
    "tree",
    "drop",
    "end",
    // Modes: which way things face.
    "in",
    "out",
    "along",
    "random",
    // Places, and what edges are to the rules that made them.
    "AREA",
    "CENTRE",
    "POLE",
    "BASE",
    "FLANK",
    "SEGMENT",
    "SEAM",
    "ANY",
];

/// The word that this one is but for the case of its letters.
pub(crate) fn in_other_case(word: &str) -> Option<&'static str> {
    let all = WORDS.iter().chain(&crate::select::NAMES).copied();
    let same = |known: &&str| *known != word && known.eq_ignore_ascii_case(word);
    all.filter(same).max_by_key(|known| {
        // A place or selector is asked for more often than a mode.
        known.chars().filter(|c| c.is_uppercase()).count()
    })
}

/// What was divided, unless nothing but paths would be left.
fn with_room(found: Option<Partition>, operation: &Operation) -> Result<Partition, Failure> {
    found.ok_or_else(|| {
        let error = "the paths leave no room for regions";
        Failure::unfit(operation.span, error)
    })
}

/// The argument `width`, where the grammar wants paths at all.
fn path_width(
    arguments: &mut Arguments<'_>,
    scope: &mut Scope<'_>,
    default: f64,
) -> Result<f64, Failure> {
    match arguments.named("width") {
        Some(expr) => {
            let width = scope.metres(expr)?;
            if width < 0.0 {
                return Err(Failure::fault(expr.span, "a width is 0 or more"));
            }
            // Empty braces say that there are none, however wide.
            Ok(if default > 0.0 { width } else { 0.0 })
        }
        None => Ok(default),
    }
}

pub(crate) fn operator_named(name: &str) -> Option<&'static Operator> {
    OPERATORS.iter().find(|o| o.name == name)
}

/// All names that every grammar knows.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    let operators = OPERATORS.iter().map(|o| o.name);
    let materials = library::MATERIALS.iter().map(|m| m.name);
    operators
        .chain(materials)
        .chain(library::THINGS.iter().map(|t| t.name))
        .chain(library::BARRIERS.iter().map(|b| b.name))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The guide has every word of the language, on one of its two pages.
    #[test]
    fn every_word_stands_in_the_guide() {
        let guide = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src");
        let pages = ["park-language.md", "park-rules.md"];
        let read = |page: &&str| std::fs::read_to_string(guide.join(page)).ok();
        let text: String = pages.iter().filter_map(read).collect();
        if text.is_empty() {
            // The guide is not a part of the package.
            return;
        }
        let said: std::collections::BTreeSet<&str> = text
            .split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .collect();
        let known = names()
            .chain(WORDS.iter().copied())
            .chain(crate::select::NAMES)
            .chain(crate::select::CALLS)
            .chain(crate::derive::ATTRIBUTES);
        let missing: Vec<&str> = known.filter(|word| !said.contains(word)).collect();
        assert!(missing.is_empty(), "the guide leaves out {missing:?}");
    }

    /// Flags are capitalised words, modes are in lower case, places in capitals.
    #[test]
    fn words_tell_what_they_are() {
        for word in WORDS {
            let capitals = word.chars().filter(|c| c.is_uppercase()).count();
            let letters = word.chars().filter(|c| c.is_alphabetic()).count();
            let first = word.starts_with(char::is_uppercase);
            let flag = first && capitals < letters && !word.contains('_');
            assert!(flag || capitals == 0 || capitals == letters, "{word}");
        }
    }
}
