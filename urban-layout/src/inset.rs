//! The land of a region inside its streets: each edge moved in by its own
//! width (the paper's "offset region boundaries by half the street width").

use geo_types::Coord;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::{FloatOverlay, OverlayOptions};

use crate::network::{Side, SideKind};
use crate::plane::{at, cross, dist, dot, left, nearest_on, signed_area, turn, unit};
use crate::region::Region;

/// A piece of land inside the streets around it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plot {
    /// Outer ring, counter-clockwise and open; then holes, clockwise.
    pub(crate) rings: Vec<Vec<Coord<f64>>>,
    /// For each edge of each ring, what it borders on.
    pub(crate) sides: Vec<Vec<PlotSide>>,
    /// Area, square metres.
    pub(crate) area: f64,
}

/// What an edge of a [`Plot`] borders on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlotSide {
    /// Parcels may front here.
    pub(crate) access: bool,
    /// A street runs along it.
    pub(crate) street: bool,
}

/// Boolean operations here run on points as pairs.
pub(crate) type Shapes = Vec<Vec<Vec<[f64; 2]>>>;

/// Overlap of neighbouring strips, metres: enough to leave no crack between
/// them after the boolean operation's rounding.
const LAP: f64 = 1e-4;
/// An inset edge lies at its source's own distance, but for the sag of a
/// corner's chords, metres, and runs along it, but for half of a corner's arc.
const MOST_GAP: f64 = 0.15;
const MOST_SKEW: f64 = 0.4;
/// Plots smaller than this are street verge, square metres.
const LEAST_PLOT: f64 = 1.0;

/// The plots of a region, largest first.
pub(crate) fn inset(region: &Region) -> Vec<Plot> {
    let mut strips: Vec<Vec<[f64; 2]>> = Vec::new();
    for l in &region.loops {
        let n = l.points.len();
        for i in 0..n {
            let (a, b) = l.edge(i);
            let w = l.sides[i].inset;
            if w > 0.0 && dist(a, b) > 1e-9 {
                let d = unit(b - a);
                let (a, b) = (a - d * LAP, b + d * LAP);
                let m = left(d) * w;
                let back = left(d) * -LAP;
                strips.push(ring_of(&[a + back, b + back, b + m, a + m]));
            }
            let previous = (i + n - 1) % n;
            strips.extend(reflex_fill(
                l.points[previous],
                a,
                b,
                l.sides[previous].inset,
                w,
            ));
        }
    }
    let subject: Vec<Vec<[f64; 2]>> = region.loops.iter().map(|l| ring_of(&l.points)).collect();
    let shapes = if strips.is_empty() {
        vec![subject]
    } else {
        difference(&[subject], &strips)
    };
    let mut plots: Vec<Plot> = shapes
        .into_iter()
        .filter_map(|shape| plot(region, shape))
        .collect();
    plots.sort_by(|a, b| b.area.total_cmp(&a.area));
    plots
}

/// Fills the wedge that strips leave open at a reflex vertex: to a mitre where
/// the turn is slight, with a fan of at most 10 degrees a step elsewhere.
fn reflex_fill(
    before: Coord<f64>,
    v: Coord<f64>,
    after: Coord<f64>,
    w0: f64,
    w1: f64,
) -> Option<Vec<[f64; 2]>> {
    let (d0, d1) = (unit(v - before), unit(after - v));
    let t = turn(d0, d1);
    if t >= -1e-6 || w0 <= 0.0 || w1 <= 0.0 {
        return None;
    }
    let (n0, n1) = (left(d0), left(d1));
    let mut ring = vec![v - unit(n0 + n1) * LAP, v + n1 * w1];
    if -t < 40f64.to_radians() && (w0 - w1).abs() < 1e-6 {
        ring.push(v + (n0 + n1) * (w0 / (1.0 + dot(n0, n1))));
    } else {
        let steps = (-t / 9f64.to_radians()).ceil().max(1.0);
        let mut k = 1.0;
        while k < steps {
            let angle = -t * k / steps;
            let n = at(
                n1.x * angle.cos() - n1.y * angle.sin(),
                n1.x * angle.sin() + n1.y * angle.cos(),
            );
            ring.push(v + n * (w1 + (w0 - w1) * k / steps));
            k += 1.0;
        }
    }
    ring.push(v + n0 * w0);
    Some(ring_of(&ring))
}

fn ring_of(points: &[Coord<f64>]) -> Vec<[f64; 2]> {
    points.iter().map(|p| [p.x, p.y]).collect()
}

/// `subject` without `clip` (strips may overlap each other).
pub(crate) fn difference(subject: &[Vec<Vec<[f64; 2]>>], clip: &[Vec<[f64; 2]>]) -> Shapes {
    boolean(subject, clip, OverlayRule::Difference)
}

/// A boolean operation with the options that give valid polygons.
pub(crate) fn boolean(
    subject: &[Vec<Vec<[f64; 2]>>],
    clip: &[Vec<[f64; 2]>],
    rule: OverlayRule,
) -> Shapes {
    overlay(subject, clip, rule, OverlayOptions::ogc())
}

fn overlay(
    subject: &[Vec<Vec<[f64; 2]>>],
    clip: &[Vec<[f64; 2]>],
    rule: OverlayRule,
    options: OverlayOptions<f64, i64>,
) -> Shapes {
    FloatOverlay::<[f64; 2], i64>::from_subj_and_clip_custom(
        subject,
        clip,
        options,
        Solver::default(),
    )
    .overlay(rule, FillRule::NonZero)
}

/// `subject` without `clip`, of which no part lies in another or outside: the
/// areas show whether the result is whole. Where holes that nearly touch each
/// other were lost on the way to valid polygons the rings come as they are,
/// and may touch.
pub(crate) fn without_parts(
    subject: &[Vec<Vec<[f64; 2]>>],
    clip: &[Vec<[f64; 2]>],
    tolerance: f64,
) -> Shapes {
    let area = |rings: &mut dyn Iterator<Item = &Vec<[f64; 2]>>| -> f64 {
        rings
            .map(|r| signed_area(&r.iter().map(|p| at(p[0], p[1])).collect::<Vec<_>>()))
            .sum()
    };
    let left = area(&mut subject.iter().flatten()) - area(&mut clip.iter());
    let off = |shapes: &Shapes| (area(&mut shapes.iter().flatten()) - left).abs();
    let shapes = difference(subject, clip);
    if off(&shapes) <= tolerance {
        return shapes;
    }
    let plain = overlay(
        subject,
        clip,
        OverlayRule::Difference,
        OverlayOptions::default(),
    );
    if off(&plain) < off(&shapes) {
        plain
    } else {
        shapes
    }
}

/// A cleaned plot with its sides, or `None` if nothing is left of it.
fn plot(region: &Region, shape: Vec<Vec<[f64; 2]>>) -> Option<Plot> {
    let rings: Vec<Vec<Coord<f64>>> = shape
        .into_iter()
        .map(|ring| clean_ring(&ring.into_iter().map(|p| at(p[0], p[1])).collect::<Vec<_>>()))
        .filter(|ring| ring.len() >= 3)
        .map(|ring| with_changes(region, ring))
        .collect();
    let area: f64 = rings.iter().map(|r| signed_area(r)).sum();
    if rings.is_empty() || area < LEAST_PLOT {
        return None;
    }
    let sides = rings.iter().map(|ring| label(region, ring)).collect();
    Some(Plot { rings, sides, area })
}

/// The ring with the points of the boundary at which access begins or ends:
/// they lie on straight edges, but the edge is not the same on both sides.
fn with_changes(region: &Region, mut ring: Vec<Coord<f64>>) -> Vec<Coord<f64>> {
    for l in &region.loops {
        let n = l.points.len();
        for i in 0..n {
            let (before, after) = (&l.sides[(i + n - 1) % n], &l.sides[i]);
            if before.access == after.access || before.inset > 0.0 || after.inset > 0.0 {
                continue;
            }
            let p = l.points[i];
            let count = ring.len();
            let on = (0..count)
                .find(|&k| dist(nearest_on(ring[k], ring[(k + 1) % count], p).0, p) < 1e-3);
            if let Some(k) = on {
                if dist(ring[k], p) > 0.01 && dist(ring[(k + 1) % count], p) > 0.01 {
                    ring.insert(k + 1, p);
                }
            }
        }
    }
    ring
}

/// The ring without points closer than a millimetre, spikes, and points on the
/// straight line between their neighbours.
pub(crate) fn clean_ring(ring: &[Coord<f64>]) -> Vec<Coord<f64>> {
    let mut out: Vec<Coord<f64>> = Vec::with_capacity(ring.len());
    for &p in ring {
        if out.last().is_none_or(|&q| dist(p, q) > 1e-3) {
            out.push(p);
        }
    }
    while out.len() > 1 && dist(out[0], out[out.len() - 1]) <= 1e-3 {
        out.pop();
    }
    let mut i = 0;
    let mut kept = 0;
    while out.len() >= 3 && kept < out.len() {
        let n = out.len();
        let (a, b, c) = (out[(i + n - 1) % n], out[i % n], out[(i + 1) % n]);
        let (u, v) = (b - a, c - b);
        let reach = dist(a, b).max(dist(b, c)).max(1e-12);
        if cross(u, v).abs() / reach < 2e-4 || dist(a, c) < 1e-3 {
            out.remove(i % n);
            i = (i + n - 1) % n % out.len().max(1);
            kept = 0;
        } else {
            i = (i + 1) % n;
            kept += 1;
        }
    }
    out
}

/// What each edge of an inset ring borders on: the source edge whose own
/// offset it lies on, judged at its middle.
fn label(region: &Region, ring: &[Coord<f64>]) -> Vec<PlotSide> {
    let n = ring.len();
    (0..n)
        .map(|i| {
            let (a, b) = (ring[i], ring[(i + 1) % n]);
            let (middle, dir) = ((a + b) * 0.5, unit(b - a));
            let mut best: (f64, Option<&Side>) = (f64::INFINITY, None);
            for (p, q, side) in region.edges() {
                let near = dist(middle, nearest_on(p, q, middle).0);
                let (gap, skew) = ((near - side.inset).abs(), 1.0 - dot(dir, unit(q - p)));
                // Of two edges at the right distance, the one that runs
                // alongside; a cut through open land borders on neither.
                let off = gap + 0.05 * skew;
                if gap < MOST_GAP && skew < MOST_SKEW && off < best.0 {
                    best = (off, Some(side));
                }
            }
            best.1.map_or(
                PlotSide {
                    access: false,
                    street: false,
                },
                |side| PlotSide {
                    access: side.access,
                    street: side.kind == SideKind::Street,
                },
            )
        })
        .collect()
}

impl Plot {
    /// This plot without holes: cut by lines through them, so that each piece
    /// is a simple ring.
    pub(crate) fn without_holes(&self, region: &Region) -> Vec<Self> {
        if self.rings.len() <= 1 {
            return vec![self.clone()];
        }
        let hole = &self.rings[1];
        let centre = hole.iter().fold(at(0.0, 0.0), |s, &p| s + p) / hole.len() as f64;
        // Cut across the hole along its long direction's normal: short cuts.
        let far = hole
            .iter()
            .copied()
            .max_by(|a, b| dist(*a, centre).total_cmp(&dist(*b, centre)))
            .unwrap_or(centre);
        let axis = unit(left(far - centre));
        let reach = 4.0
            * self.rings[0]
                .iter()
                .map(|&p| dist(p, centre))
                .fold(1.0, f64::max);
        let subject: Vec<Vec<[f64; 2]>> = self.rings.iter().map(|r| ring_of(r)).collect();
        [1.0, -1.0]
            .into_iter()
            .flat_map(|sign| {
                let (a, b) = (
                    centre - axis * (reach * sign),
                    centre + axis * (reach * sign),
                );
                let deep = left(axis) * (reach * sign);
                let half = ring_of(&[a, b, b + deep, a + deep]);
                boolean(
                    std::slice::from_ref(&subject),
                    &[half],
                    OverlayRule::Intersect,
                )
            })
            .filter_map(|shape| plot(region, shape))
            .flat_map(|p| p.without_holes(region))
            .collect()
    }

    /// Whether any edge gives access.
    pub(crate) fn has_access(&self) -> bool {
        self.sides.iter().flatten().any(|s| s.access)
    }
}
