//! What stands on the ground: shadows first, then everything by its height, so
//! that a crown is drawn above the bench that it shades.

use std::fmt::Write as _;

use geo_types::Coord;

use super::colour::{darker, lighter};
use super::pen::{closed, dot, escaped, Pen, UNITS};
use crate::library;
use crate::plane::Area;
use crate::scene::{Kind, Object, Scene, Volume};

/// How far a shadow reaches to the east and to the south, metres for each metre
/// of height: light falls from the north-west, as on maps.
const SHADOW: f64 = 0.2;

/// The longest shadow, metres of height.
const HIGHEST: f64 = 20.0;

/// Meshes of more triangles are drawn as discs.
const FINE: usize = 4000;

/// An object reaches so much farther above the ground than on it: it has a
/// crown.
const CROWN: f64 = 1.5;

pub(super) fn draw(pen: &mut Pen, scene: &Scene) {
    if pen.shadows {
        pen.raw("<g fill=\"#18240f\" fill-opacity=\"1\" opacity=\".22\">\n");
        let data: String = scene.volumes.iter().map(|v| below(pen, v)).collect();
        pen.path(&data, "");
        let objects = scene.objects.iter().filter(|o| o.spread >= pen.least);
        let objects: Vec<&Object> = objects.collect();
        objects.into_iter().for_each(|object| shade(pen, object));
        pen.raw("</g>\n");
    }
    let mut all: Vec<(f64, Thing<'_>)> = Vec::new();
    let volumes = scene.volumes.iter();
    all.extend(volumes.map(|volume| (volume.height, Thing::Volume(volume))));
    let objects = scene.objects.iter().filter(|o| o.spread >= pen.least);
    all.extend(objects.map(|object| (object.height, Thing::Object(object))));
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, thing) in all {
        match thing {
            Thing::Volume(volume) => draw_volume(pen, volume),
            Thing::Object(object) => draw_object(pen, scene, object),
        }
    }
}

enum Thing<'s> {
    Volume(&'s Volume),
    Object(&'s Object),
}

/// How far a shadow falls, units of the drawing on both axes.
fn fall(height: f64) -> f64 {
    UNITS * SHADOW * height.clamp(0.0, HIGHEST)
}

/// The shadow of a volume.
fn below(pen: &Pen, volume: &Volume) -> String {
    let by = fall(volume.height).round() as i64;
    let area = Area::from_polygon(&volume.polygon);
    let mut data = String::new();
    for ring in area.rings() {
        let points: Vec<[i64; 2]> = ring.iter().map(|&c| pen.place(c)).collect();
        swept(&mut data, &points, by);
    }
    data
}

/// The shadow of a ring: where it is and where its top falls, and what each of
/// its edges sweeps in between.
fn swept(data: &mut String, ring: &[[i64; 2]], by: i64) {
    for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        let [c, d] = [b, a].map(|p| [p[0] + by, p[1] + by]);
        let turn = (b[0] - a[0]) * by - (b[1] - a[1]) * by;
        // All the same way round, so that none takes another's shadow away.
        let quad = if turn > 0 { [a, b, c, d] } else { [d, c, b, a] };
        closed(data, quad.into_iter());
    }
    for by in [0, by] {
        closed(data, ring.iter().map(|p| [p[0] + by, p[1] + by]));
    }
}

/// What of an object throws a shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Body {
    /// A disc so wide, as a share of its spread.
    Round(f64),
    /// A box so long and wide, half of each as a share of its spread.
    Box(f64, f64),
    /// Nothing to speak of.
    Flat,
}

fn body(object: &Object) -> Body {
    match object.name.as_str() {
        "Bench" => Body::Box(0.3, 0.95),
        "Table" => Body::Box(0.75, 0.75),
        "Statue" => Body::Box(0.4, 0.4),
        "Lamp" => Body::Round(0.25),
        "Flowers" | "Pond" | "Playground" => Body::Flat,
        _ => Body::Round(1.0),
    }
}

/// The shadow of an object: that of what it reaches to, as high as it is, and
/// what lies between that and its foot.
fn shade(pen: &mut Pen, object: &Object) {
    let by = fall(object.height);
    if by < 1.0 {
        return;
    }
    let [x, y] = pen.place(object.at);
    let spread = UNITS * object.spread;
    let round = match body(object) {
        Body::Flat => return,
        Body::Round(share) => share * spread,
        Body::Box(long, wide) => {
            let (sin, cos) = object.facing.sin_cos();
            let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
            let ring = corners.map(|(u, v)| {
                let (u, v) = (u * long * spread, v * wide * spread);
                // Counter-clockwise, where y points down.
                let at = [u * cos - v * sin, -u * sin - v * cos];
                [x + at[0].round() as i64, y + at[1].round() as i64]
            });
            let mut data = String::new();
            swept(&mut data, &ring, by.round() as i64);
            pen.path(&data, "");
            return;
        }
    };
    // A crown begins above the ground: its shadow lies apart from the trunk's.
    let crown = has_crown(object);
    let from = if crown { 0.45 * by } else { 0.0 };
    let t = 0.6 * UNITS * object.radius * std::f64::consts::FRAC_1_SQRT_2;
    if crown {
        let _ = writeln!(
            pen.drawing.body,
            "<path d=\"M{:.0} {:.0}l{by:.0} {by:.0} {:.0} {:.0} {:.0} {:.0}z\"/>",
            x as f64 + t,
            y as f64 - t,
            -2.0 * t,
            2.0 * t,
            -by,
            -by
        );
    }
    let t = round * std::f64::consts::FRAC_1_SQRT_2;
    let rest = by - from;
    let _ = writeln!(
        pen.drawing.body,
        "<path d=\"M{:.0} {:.0}a{round:.0} {round:.0} 0 0 0 {:.0} {:.0}l{rest:.0} {rest:.0}a{round:.0} {round:.0} 0 0 0 {:.0} {:.0}z\"/>",
        x as f64 + from + t,
        y as f64 + from - t,
        -2.0 * t,
        2.0 * t,
        2.0 * t,
        -2.0 * t
    );
}

/// Whether an object reaches farther above the ground than on it.
pub(crate) fn has_crown(object: &Object) -> bool {
    object.spread > CROWN * object.radius
}

fn draw_volume(pen: &mut Pen, volume: &Volume) {
    let data = pen.polygon(&volume.polygon);
    let colour = colour_of(&volume.name);
    let dark = darker(colour, 0.4);
    let line = f64::max(6.0, 0.8 * pen.line);
    pen.path(
        &data,
        &format!(
            "fill=\"{colour}\" fill-rule=\"evenodd\" stroke=\"{dark}\" stroke-width=\"{line:.0}\" stroke-linejoin=\"round\""
        ),
    );
    if let Some(id) = leaves(pen, &volume.name) {
        pen.path(&data, &format!("fill=\"url(#{id})\" fill-rule=\"evenodd\""));
    }
}

/// The colour of a volume: a barrier's, or that of the object it is drawn of.
pub(super) fn colour_of(name: &str) -> &'static str {
    let barrier = library::barrier_named(name).map(|b| b.colour);
    barrier
        .or_else(|| library::thing_named(name).map(|t| t.colour))
        .unwrap_or("#8a8578")
}

/// The texture of what grows along a line.
pub(super) fn leaves(pen: &mut Pen, name: &str) -> Option<String> {
    if !matches!(name, "Hedge" | "Bush") {
        return None;
    }
    let colour = colour_of(name);
    Some(pen.define(&format!("along-{name}"), |id| {
        let dots = |fill: String, places: [[i64; 2]; 4], r: i64| {
            let mut data = String::new();
            for [x, y] in places {
                dot(&mut data, [x, y], r);
            }
            format!("<path d=\"{data}\" fill=\"{fill}\"/>")
        };
        format!(
            "<pattern id=\"{id}\" width=\"150\" height=\"150\" patternUnits=\"userSpaceOnUse\">{}{}</pattern>\n",
            dots(darker(colour, 0.2), [[30, 40], [110, 25], [70, 110], [125, 105]], 20),
            dots(lighter(colour, 0.16), [[24, 32], [104, 18], [64, 102], [119, 97]], 13),
        )
    }))
}

fn draw_object(pen: &mut Pen, scene: &Scene, object: &Object) {
    let id = symbol(pen, scene, &object.name);
    let [x, y] = pen.place(object.at);
    let size = UNITS * object.spread;
    // Counter-clockwise from east, where y points down.
    let turn = -object.facing.to_degrees();
    let turned = if turn.abs() < 0.05 {
        String::new()
    } else {
        format!("rotate({turn:.1})")
    };
    let _ = writeln!(
        pen.drawing.body,
        "<use href=\"#{id}\" transform=\"translate({x} {y}){turned}scale({size:.1})\"/>"
    );
    if has_crown(object) {
        let light = light(pen);
        let _ = writeln!(
            pen.drawing.body,
            "<use href=\"#{light}\" transform=\"translate({x} {y})scale({size:.1})\"/>"
        );
    }
}

/// Light on a crown, from the north-west whichever way it is turned.
pub(super) fn light(pen: &mut Pen) -> String {
    pen.define("gradient", |id| {
        format!(
            "<radialGradient id=\"{id}\" cx=\".36\" cy=\".34\" r=\".72\"><stop offset=\"0\" stop-color=\"#fffbd6\" stop-opacity=\".42\"/>\
             <stop offset=\".5\" stop-color=\"#fffbd6\" stop-opacity=\".06\"/><stop offset=\"1\" stop-color=\"#10210a\" stop-opacity=\".3\"/></radialGradient>\n"
        )
    });
    pen.define("light", |id| {
        format!("<circle id=\"{id}\" r=\".95\" fill=\"url(#park-gradient)\"/>\n")
    })
}

/// The id of an object's picture.
pub(super) fn symbol(pen: &mut Pen, scene: &Scene, name: &str) -> String {
    let own = scene.kinds.iter().find(|kind| kind.name == name);
    match own {
        Some(kind) => {
            // Another park's kind of that name may look different.
            let colour = kind.colour.trim_start_matches('#');
            pen.define(&format!("{name}-{colour}"), |id| {
                format!("<g id=\"{id}\">{}</g>\n", own_picture(kind))
            })
        }
        None => pen.define(name, |id| {
            let picture = library::thing_named(name)
                .map_or_else(|| disc("#8a8578"), |thing| thing.picture.to_owned());
            format!("<g id=\"{id}\">{picture}</g>\n")
        }),
    }
}

fn disc(colour: &str) -> String {
    let (fill, edge) = (escaped(colour), darker(colour, 0.4));
    format!("<circle r=\".97\" fill=\"{fill}\" fill-opacity=\".92\" stroke=\"{edge}\" stroke-width=\".06\"/>")
}

/// The picture of a grammar's own kind: its mesh from above, a crown, or a disc.
fn own_picture(kind: &Kind) -> String {
    if let Some(mesh) = kind.mesh.as_ref().filter(|m| m.triangles.len() <= FINE) {
        return from_above(kind, &mesh.vertices, &mesh.triangles);
    }
    if kind.spread > CROWN * kind.radius {
        return library::crown(
            &kind.colour,
            &lighter(&kind.colour, 0.18),
            &darker(&kind.colour, 0.35),
        );
    }
    disc(&kind.colour)
}

/// The triangles of a mesh that are not upright, the lowest first, shaded by the
/// way they face.
fn from_above(kind: &Kind, vertices: &[[f64; 3]], triangles: &[[usize; 3]]) -> String {
    // A mesh's z points south when its x points east.
    let place = |k: usize| {
        let [x, _, z] = vertices.get(k).copied().unwrap_or_default();
        Coord { x, y: z } / kind.spread
    };
    let height = |k: usize| vertices.get(k).map_or(0.0, |v| v[1]);
    let mut faces: Vec<(f64, f64, [Coord<f64>; 3])> = Vec::new();
    for triangle in triangles {
        let [p, q, r] = triangle.map(|k| vertices.get(k).copied().unwrap_or_default());
        let [u, v] = [q, r].map(|end| [0, 1, 2].map(|k| end[k] - p[k]));
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let size = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        // Nobody knows how the triangles of a file are wound: all are drawn, and
        // those below are hidden by those above.
        let normal = normal.map(|n| n * normal[1].signum());
        if normal[1] > 1e-9 * size {
            // From the north-west and above.
            let light = (0.8 * normal[1] - 0.42 * normal[0] - 0.42 * normal[2]) / size;
            let top = triangle.map(height).into_iter().sum::<f64>();
            faces.push((top, light, triangle.map(place)));
        }
    }
    faces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut out = String::new();
    for (_, light, corners) in faces {
        let fill = if light > 0.8 {
            lighter(&kind.colour, 0.8 * (light - 0.8))
        } else {
            darker(&kind.colour, 0.6 * (0.8 - light))
        };
        let points = corners.map(|c| format!("{:.3} {:.3}", c.x, c.y));
        let _ = write!(
            out,
            "<path d=\"M{}L{}L{}z\" fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\".01\"/>",
            points[0], points[1], points[2]
        );
    }
    if out.is_empty() {
        disc(&kind.colour)
    } else {
        out
    }
}
