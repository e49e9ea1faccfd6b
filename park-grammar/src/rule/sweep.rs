//! `Sweep(OUTER: 0.5, 0.8, 1.2) { Hedge }`, also called `DistributeSmooth`:
//! volumes along lines.
//!
//! The first argument is a selection, with the offset after its colon; what
//! `Parametrise` gives; places that a line goes through; or `AREA`, the whole
//! region. The second, or `width`, and the third, or `height`, are those of the
//! barrier unless said. Along a selection the strip lies on the inner side of its
//! offset, along a line half on each side. Strips go round outer corners in an
//! arc, with `Mitre` in a point of at most four widths. They are clipped to the
//! region and leave out what was cut from it or stands on it. Of several
//! branches each line has the next.

use super::target::Target;
use super::Arguments;
use crate::derive::{clear, Node, Places, Run};
use crate::error::Failure;
use crate::library;
use crate::plane::{circle, difference, intersection, strip, stroke, union, Area, Corner};
use crate::scene::Volume;
use crate::syntax::ast::{Branch, Operation};

/// Smaller parts of a strip, square metres, are left out.
const LEAST: f64 = 1e-6;

/// What is drawn along a line.
struct Profile {
    name: String,
    width: f64,
    height: f64,
}

pub(crate) fn sweep(
    run: &mut Run<'_>,
    node: &mut Node,
    operation: &Operation,
    places: &Places,
) -> Result<(), Failure> {
    let mut profiles = Vec::new();
    for branch in operation.blocks.iter().flat_map(|b| &b.branches) {
        profiles.push(profile(run, branch, places)?);
    }
    if profiles.is_empty() {
        let failure = Failure::fault(operation.span, "there is nothing to draw along the line");
        return Err(failure.hint("write what in braces: Sweep(OUTER) { Hedge }"));
    }
    let mut scope = run.scope(node, places);
    let mut arguments = Arguments::new(operation);
    let (target, offset) = Target::read(&mut arguments, &mut scope)?;
    let mitre = arguments.flag(&mut scope, "Mitre")?;
    let mut sizes = [None; 2];
    for (size, name) in sizes.iter_mut().zip(["width", "height"]) {
        *size = match arguments.next() {
            Some(argument) => Some(scope.metres(&argument.value)?),
            None => arguments.metres(&mut scope, name)?,
        };
        if size.is_some_and(|metres| metres <= 0.0) {
            return Err(Failure::fault(
                operation.span,
                format!("the {name} must be positive"),
            ));
        }
    }
    arguments.done()?;
    let [width, height] = sizes;
    let corner = if mitre { Corner::Mitre } else { Corner::Round };

    let offset = offset.unwrap_or(0.0);
    let lines = match target {
        Target::Area => vec![None],
        Target::Line(line) => vec![Some((line, None))],
        Target::Boundary { selection, inset } => {
            let lines = selection.lines(&node.region).into_iter();
            lines
                .map(|line| Some((line, Some(inset + offset))))
                .collect()
        }
    };
    let before = run.tally();
    let watch = run.watch(node);
    for (line, profile) in lines.into_iter().zip(profiles.iter().cycle()) {
        watch.look()?;
        let width = width.unwrap_or(profile.width);
        let band = match line {
            None => vec![node.region.area.clone()],
            Some((line, None)) => union(&stroke(&line, width, false)),
            Some((line, Some(inset))) => {
                let near = strip(&line, inset, corner);
                let far = union(&strip(&line, inset + width, corner));
                difference(&far, &near)
            }
        };
        let inside = intersection(&band, std::slice::from_ref(&node.region.area));
        watch.look()?;
        let mut found = difference(&inside, &met(node, &inside));
        found.retain(|area| area.size() > LEAST);
        if found.is_empty() {
            run.scene.skipped += 1;
        }
        for area in found {
            run.scene.volumes.push(Volume {
                name: profile.name.clone(),
                polygon: area.to_polygon(),
                height: height.unwrap_or(profile.height),
            });
            node.standing.built.push(area);
        }
    }
    run.suited(operation, before)
}

/// What a strip may meet of all that a region holds, which can be thousands of
/// things.
fn met(node: &Node, strip: &[Area]) -> Vec<Area> {
    // Around the circle, not in it: no corner of the footprint is met.
    let around = (std::f64::consts::PI / 36.0).cos();
    let mut met = Vec::new();
    for part in strip {
        let (low, high) = part.extent();
        let patches = [&node.carved, &node.standing.built];
        met.extend(patches.into_iter().flat_map(|p| p.near(low, high)).cloned());
        for disc in node.standing.near(low, high) {
            let radius = disc.radius / around;
            if !clear(part, disc.at, radius) {
                met.push(Area::new(circle(disc.at, radius), Vec::new()));
            }
        }
    }
    met
}

fn profile(run: &Run<'_>, branch: &Branch, places: &Places) -> Result<Profile, Failure> {
    let [only] = branch.body.operations.as_slice() else {
        return Err(Failure::fault(
            branch.span,
            "one thing is drawn along a line",
        ));
    };
    let name = only.name.text.as_str();
    if let Some(barrier) = library::barrier_named(name) {
        return Ok(Profile {
            name: barrier.name.to_owned(),
            width: barrier.width,
            height: barrier.height,
        });
    }
    match run.kind(name, places) {
        Some(kind) => Ok(Profile {
            name: kind.name.clone(),
            width: 2.0 * kind.radius,
            height: kind.height,
        }),
        None => {
            let error = format!("{name} cannot be drawn along a line");
            let names: Vec<&str> = library::BARRIERS.iter().map(|b| b.name).collect();
            Err(Failure::fault(only.span, error).hint(format!("there are {}", names.join(", "))))
        }
    }
}
