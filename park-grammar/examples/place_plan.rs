//! Draws a park with everything that can be placed, as SVG: an outline from a
//! GeoJSON file in degrees, or an oblong one.
//!
//! `cargo run -p park-grammar --example place_plan -- [outline.geojson] > plan.svg`

use std::fmt::Write as _;

use park_grammar::geo_types::{coord, polygon, Coord, LineString, Polygon};
use park_grammar::{library, DeriveOptions, Grammar, Scene};

const RULES: &str = r##"grammar 1
param Oak = Object(radius = 0.5, spread = 4 m, height = 14 m, colour = "#7d8f3f")

Region -> Lawn
    Place(CENTRE) { Circle(6) Paving Fountain Distribute(ALL: 1.2, 4) { Bench } } else { Place(CENTRE) { Tree } }
    ScatterCircles(4 {[3-5]}, gap = 4, margin = 5, least = 0) { FlowerBed Distribute(ALL: 0.6, 1.2) { Flowers } Place(CENTRE) { Statue } }
    Sweep(Part(WEST or SOUTH, [0.05, 0.95]): 0.5) { Hedge }
    Distribute(NORTH: 3, 8) { 2: TallTree | SmallTree }
    Distribute(EAST: 3, 6, Middles) { Conifer }
    Place(CORNER[0], CORNER[2], offset = 9) { Oak }
    Scatter(density = 0.15, margin = 3) { 3: Tree | 2: SmallTree | 2: Bush | Oak }
    Distribute(Continuous(SOUTH): 2.5, 12) { Lamp }
"##;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let park = match std::env::args().nth(1) {
        Some(file) => outline(&std::fs::read_to_string(file)?)?,
        None => polygon![
            (x: 0., y: 0.), (x: 96., y: 6.), (x: 90., y: 58.), (x: 52., y: 60.),
            (x: 48., y: 46.), (x: 4., y: 52.)
        ],
    };
    let scene = Grammar::new(RULES)?.derive(&park, &DeriveOptions::default())?;
    println!("{}", svg(&scene));
    Ok(())
}

/// The first ring of a GeoJSON text, degrees made metres around its first point.
fn outline(text: &str) -> Result<Polygon<f64>, String> {
    let start = text
        .find("\"coordinates\"")
        .ok_or("there are no coordinates")?;
    let rest = &text[start..];
    let open = rest.find('[').ok_or("there are no coordinates")?;
    let body = rest[open..].trim_start_matches(['[', ' ', '\n', '\t', '\r']);
    let ring = body.split("]]").next().unwrap_or(body);
    let ring = ring.split("] ]").next().unwrap_or(ring);
    let numbers: Vec<f64> = ring
        .split(|c: char| !(c.is_ascii_digit() || "-+.eE".contains(c)))
        .filter_map(|word| word.parse().ok())
        .collect();
    let [x, y, ..] = numbers[..] else {
        return Err("there are no coordinates".to_owned());
    };
    let metres = 111_320.0;
    let points = numbers.chunks_exact(2).map(|p| {
        coord! {
            x: (p[0] - x) * metres * y.to_radians().cos(),
            y: (p[1] - y) * metres,
        }
    });
    Ok(Polygon::new(LineString(points.collect()), Vec::new()))
}

fn svg(scene: &Scene) -> String {
    let points = || scene.pieces.iter().flat_map(|p| &p.polygon.exterior().0);
    let low = points().fold(
        coord! { x: f64::MAX, y: f64::MAX },
        |a, p| coord! { x: a.x.min(p.x), y: a.y.min(p.y) },
    );
    let high = points().fold(
        coord! { x: f64::MIN, y: f64::MIN },
        |a, p| coord! { x: a.x.max(p.x), y: a.y.max(p.y) },
    );
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{} {} {} {}\">\n",
        low.x - 2.0,
        -high.y - 2.0,
        high.x - low.x + 4.0,
        high.y - low.y + 4.0
    );
    for piece in &scene.pieces {
        let colour = library::material_named(&piece.material).map_or("#cccccc", |m| m.colour);
        shape(&mut out, &piece.polygon, colour);
    }
    for volume in &scene.volumes {
        let colour = library::barrier_named(&volume.name).map_or("#777777", |b| b.colour);
        shape(&mut out, &volume.polygon, colour);
    }
    let mut objects: Vec<_> = scene.objects.iter().collect();
    objects.sort_by(|a, b| a.height.total_cmp(&b.height));
    for object in objects {
        let Coord { x, y } = object.at;
        let turn = -object.facing.to_degrees();
        let picture = library::thing_named(&object.name).map_or_else(
            || {
                let kind = scene.kinds.iter().find(|k| k.name == object.name);
                let colour = kind.map_or("#777777", |k| k.colour.as_str());
                format!("<circle r=\"1\" fill=\"{colour}\" fill-opacity=\".85\"/>")
            },
            |thing| thing.picture.to_owned(),
        );
        let _ = writeln!(
            out,
            "<g transform=\"translate({x:.2} {:.2}) rotate({turn:.1}) scale({})\">{picture}</g>",
            -y, object.spread
        );
    }
    out + "</svg>"
}

fn shape(out: &mut String, polygon: &Polygon<f64>, colour: &str) {
    let mut path = String::new();
    for ring in std::iter::once(polygon.exterior()).chain(polygon.interiors()) {
        for (k, c) in ring.0.iter().enumerate() {
            let _ = write!(
                path,
                "{}{:.2} {:.2}",
                if k == 0 { 'M' } else { 'L' },
                c.x,
                -c.y
            );
        }
        path.push('Z');
    }
    let _ = writeln!(out, "<path d=\"{path}\" fill=\"{colour}\" fill-rule=\"evenodd\" stroke=\"#555\" stroke-width=\".06\"/>");
}
