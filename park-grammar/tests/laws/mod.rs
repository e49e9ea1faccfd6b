//! The laws of a park, checked from its scene alone and by other means than the
//! crate's own.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use park_grammar::geo_types::{Coord, LineString, Polygon};
use park_grammar::scene::{Ground, Object};
use park_grammar::Scene;

type Shapes = Vec<Vec<Vec<[f64; 2]>>>;

/// Rounding of coordinates, metres.
const NEAR: f64 = 1e-6;

/// What is wrong with a park; empty if nothing is.
pub(crate) fn broken(park: &Polygon<f64>, scene: &Scene) -> Vec<String> {
    let mut found = Vec::new();
    let whole = size(park);
    let sum: f64 = scene.pieces.iter().map(|piece| size(&piece.polygon)).sum();
    if (sum - whole).abs() > 1e-9 * whole {
        found.push(format!("pieces of {sum} square metres in {whole}"));
    }
    let all: Shapes = scene.pieces.iter().map(|p| shape(&p.polygon)).collect();
    let land = vec![shape(park)];
    let beyond = area(&all.overlay_as::<i64>(&land, OverlayRule::Difference, FillRule::NonZero));
    let bare = area(&land.overlay_as::<i64>(&all, OverlayRule::Difference, FillRule::NonZero));
    if beyond.max(bare) > 1e-9 * whole {
        found.push(format!("{beyond} outside, {bare} without a piece"));
    }
    let paths: Vec<&Polygon<f64>> = scene
        .pieces
        .iter()
        .filter(|piece| piece.ground == Ground::Path)
        .map(|piece| &piece.polygon)
        .collect();
    found.extend(apart(park, &paths));
    found.extend(collisions(&scene.objects));
    for object in scene.objects.iter().filter(|o| o.ground == Ground::Region) {
        if !within(park, object.at) || clearance(park, object.at) < object.radius - NEAR {
            found.push(format!(
                "{} leaves the park at {:?}",
                object.name, object.at
            ));
        }
        let clear = |path: &&Polygon<f64>| {
            let near = extent(path);
            let (at, reach) = (object.at, object.radius);
            let far = at.x + reach < near[0]
                || at.x - reach > near[2]
                || at.y + reach < near[1]
                || at.y - reach > near[3];
            far || (!within(path, at) && clearance(path, at) >= reach - NEAR)
        };
        if !paths.iter().all(clear) {
            found.push(format!("{} on a path at {:?}", object.name, object.at));
        }
    }
    let walls: Shapes = scene.volumes.iter().map(|v| shape(&v.polygon)).collect();
    let walked: Shapes = paths.iter().map(|p| shape(p)).collect();
    let shared = area(&walls.overlay_as::<i64>(&walked, OverlayRule::Intersect, FillRule::NonZero));
    if shared > 1e-9 * whole {
        found.push(format!("hedges or walls on {shared} square metres of path"));
    }
    found
}

/// Paths from which no way leads to the park's edge.
fn apart(park: &Polygon<f64>, paths: &[&Polygon<f64>]) -> Option<String> {
    let all: Shapes = paths.iter().map(|p| shape(p)).collect();
    let none: Shapes = Vec::new();
    // The edge of a hole in the park is no entrance.
    let edge = Polygon::new(park.exterior().clone(), Vec::new());
    let whole = all.overlay_as::<i64>(&none, OverlayRule::Union, FillRule::NonZero);
    let lost: Vec<f64> = whole
        .iter()
        .filter(|part| {
            let touches = |p: &[f64; 2]| clearance(&edge, Coord { x: p[0], y: p[1] }) < NEAR;
            !part.iter().flatten().any(touches)
        })
        .map(|part| area(&vec![part.clone()]))
        // Rounding where paths touch.
        .filter(|size| *size > NEAR)
        .collect();
    let first = whole
        .iter()
        .find(|part| area(&vec![(*part).clone()]) == *lost.first().unwrap_or(&-1.0));
    let at = first.and_then(|part| part.first()?.first().copied());
    (!lost.is_empty()).then(|| {
        format!(
            "{} of {} paths without an entrance, the first of {:.2} square metres at {at:?}",
            lost.len(),
            whole.len(),
            lost[0]
        )
    })
}

fn collisions(objects: &[Object]) -> Option<String> {
    let mut sorted: Vec<&Object> = objects.iter().collect();
    sorted.sort_by(|a, b| a.at.x.total_cmp(&b.at.x));
    let widest = objects.iter().map(|o| o.radius).fold(0.0, f64::max);
    for (k, a) in sorted.iter().enumerate() {
        let near = sorted[k + 1..]
            .iter()
            .take_while(|b| b.at.x - a.at.x < a.radius + widest);
        for b in near {
            let away = (a.at.x - b.at.x).hypot(a.at.y - b.at.y);
            if away < a.radius + b.radius - NEAR {
                return Some(format!("{} stands in {} at {:?}", a.name, b.name, a.at));
            }
        }
    }
    None
}

/// Outer rings counter-clockwise, holes clockwise.
fn shape(polygon: &Polygon<f64>) -> Vec<Vec<[f64; 2]>> {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    rings
        .enumerate()
        .map(|(k, ring)| {
            let origin = ring.0[0];
            let turn = |l: park_grammar::geo_types::Line<f64>| {
                let (a, b) = (l.start - origin, l.end - origin);
                a.x * b.y - a.y * b.x
            };
            let clockwise = ring.lines().map(turn).sum::<f64>() < 0.0;
            let open = &ring.0[..ring.0.len() - 1];
            let mut points: Vec<[f64; 2]> = open.iter().map(|c| [c.x, c.y]).collect();
            if clockwise != (k > 0) {
                points.reverse();
            }
            points
        })
        .collect()
}

fn area(shapes: &Shapes) -> f64 {
    let ring = |ring: &Vec<[f64; 2]>| -> f64 {
        let n = ring.len();
        let [x, y] = ring.first().copied().unwrap_or_default();
        let doubled: f64 = (0..n)
            .map(|k| {
                let (a, b) = (ring[k], ring[(k + 1) % n]);
                (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x)
            })
            .sum();
        doubled.abs() / 2.0
    };
    let one = |shape: &Vec<Vec<[f64; 2]>>| {
        let holes: f64 = shape.iter().skip(1).map(ring).sum();
        shape.first().map_or(0.0, ring) - holes
    };
    shapes.iter().map(one).sum()
}

fn size(polygon: &Polygon<f64>) -> f64 {
    area(&vec![shape(polygon)])
}

fn lines(polygon: &Polygon<f64>) -> impl Iterator<Item = park_grammar::geo_types::Line<f64>> + '_ {
    let rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    rings.flat_map(LineString::lines)
}

fn extent(polygon: &Polygon<f64>) -> [f64; 4] {
    let mut found = [f64::MAX, f64::MAX, f64::MIN, f64::MIN];
    for c in &polygon.exterior().0 {
        found = [
            found[0].min(c.x),
            found[1].min(c.y),
            found[2].max(c.x),
            found[3].max(c.y),
        ];
    }
    found
}

fn within(polygon: &Polygon<f64>, p: Coord<f64>) -> bool {
    let crosses = |a: Coord<f64>, b: Coord<f64>| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y)
    };
    lines(polygon).filter(|l| crosses(l.start, l.end)).count() % 2 == 1
}

/// How far a point is from any edge of a polygon.
fn clearance(polygon: &Polygon<f64>, p: Coord<f64>) -> f64 {
    let away = |l: park_grammar::geo_types::Line<f64>| {
        let (d, v) = (l.delta(), p - l.start);
        let square = d.x * d.x + d.y * d.y;
        let t = if square > 0.0 {
            ((v.x * d.x + v.y * d.y) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (v.x - t * d.x).hypot(v.y - t * d.y)
    };
    lines(polygon).map(away).fold(f64::MAX, f64::min)
}
