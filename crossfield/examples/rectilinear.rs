//! Draws a picture of the README into `images/`: the B-fields of a square, an
//! L, a T, a plus and an H, which have no singularity, and next to them that
//! of a regular pentagon and a disc, which must have some.
//!
//! `cargo run -p crossfield --example rectilinear [FOLDER]`

use std::fmt::Write as _;
use std::path::PathBuf;

use crossfield::geo_types::{coord, Coord, Polygon};
use crossfield::{BoundaryField, Cursor, Domain, DomainOptions, Field, FieldDesign};

fn shapes() -> Vec<(&'static str, Vec<(f64, f64)>)> {
    let round = |count: u32| {
        let at = |k: u32| {
            let angle = (90.0 + 360.0 * f64::from(k) / f64::from(count)).to_radians();
            (30.0 + 31.0 * angle.cos(), 29.0 + 31.0 * angle.sin())
        };
        (0..count).map(at).collect()
    };
    vec![
        ("square", vec![(3., 3.), (57., 3.), (57., 57.), (3., 57.)]),
        (
            "L",
            vec![
                (6., 0.),
                (56., 0.),
                (56., 22.),
                (28., 22.),
                (28., 60.),
                (6., 60.),
            ],
        ),
        (
            "T",
            vec![
                (20., 0.),
                (40., 0.),
                (40., 38.),
                (60., 38.),
                (60., 60.),
                (0., 60.),
                (0., 38.),
                (20., 38.),
            ],
        ),
        (
            "plus",
            vec![
                (20., 0.),
                (40., 0.),
                (40., 20.),
                (60., 20.),
                (60., 40.),
                (40., 40.),
                (40., 60.),
                (20., 60.),
                (20., 40.),
                (0., 40.),
                (0., 20.),
                (20., 20.),
            ],
        ),
        (
            "H",
            vec![
                (0., 0.),
                (20., 0.),
                (20., 20.),
                (40., 20.),
                (40., 0.),
                (60., 0.),
                (60., 60.),
                (40., 60.),
                (40., 40.),
                (20., 40.),
                (20., 60.),
                (0., 60.),
            ],
        ),
        ("pentagon", round(5)),
        ("disc", round(90)),
    ]
}

/// Turned a little, so that no grid of the drawing is mistaken for the
/// field's.
fn turned((x, y): (f64, f64)) -> (f64, f64) {
    let (s, c) = 0.22_f64.sin_cos();
    let (x, y) = (x - 30.0, y - 30.0);
    (30.0 + c * x - s * y, 30.0 + s * x + c * y)
}

/// Crosses on a grid, and dots at the singularities; `left` is where the
/// drawing starts.
fn draw(svg: &mut String, name: &str, ring: &[(f64, f64)], field: &Field, left: f64) {
    // Southwards is down in an SVG.
    let place = |at: Coord<f64>| (left + at.x, 72.0 - at.y);
    let mut outline = String::new();
    for (k, &(x, y)) in ring.iter().enumerate() {
        let (x, y) = place(coord! { x: x, y: y });
        let _ = write!(outline, "{}{x:.2} {y:.2}", if k == 0 { 'M' } else { 'L' });
    }
    let mut crosses = String::new();
    let mut cursor = Cursor::default();
    for row in 0..26 {
        for column in 0..26 {
            let at = coord! { x: -10.0 + 3.2 * f64::from(column), y: -10.0 + 3.2 * f64::from(row) };
            let Some(cross) = field.cross(at, &mut cursor) else {
                continue;
            };
            let (x, y) = place(at);
            for arm in &cross.arms()[..2] {
                let (dx, dy) = (1.35 * arm.x, -1.35 * arm.y);
                let _ = write!(
                    crosses,
                    "M{:.2} {:.2}l{:.2} {:.2}",
                    x - dx,
                    y - dy,
                    2.0 * dx,
                    2.0 * dy
                );
            }
        }
    }
    let found = field.singularities();
    let mut marks = String::new();
    for singularity in &found {
        let (x, y) = place(singularity.at);
        let colour = if singularity.quarter_index > 0 {
            "#d9480f"
        } else {
            "#1971c2"
        };
        let _ = write!(
            marks,
            "<circle cx='{x:.2}' cy='{y:.2}' r='1.8' fill='{colour}'/>"
        );
    }
    let indices: Vec<String> = found
        .iter()
        .map(|s| format!("{:+}/4", s.quarter_index))
        .collect();
    let label = if indices.is_empty() {
        "none".to_owned()
    } else {
        indices.join(", ")
    };
    let _ = write!(
        svg,
        "<path d='{outline}Z' fill='#f4f1ea' stroke='#343a40' stroke-width='.8'/>\
         <path d='{crosses}' stroke='#495057' stroke-width='.35'/>{marks}\
         <text x='{:.1}' y='87' text-anchor='middle'>{name}: {label}</text>",
        left + 30.0
    );
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("images"),
        PathBuf::from,
    );
    let shapes = shapes();
    let width = 78.0 * shapes.len() as f64;
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} 92' \
         font-family='sans-serif' font-size='6' fill='#343a40'>"
    );
    for (k, (name, ring)) in shapes.into_iter().enumerate() {
        let ring: Vec<(f64, f64)> = ring.into_iter().map(turned).collect();
        let site = Polygon::new(ring.clone().into(), vec![]);
        let domain = Domain::new(&site, &DomainOptions::default())?;
        let field = BoundaryField::default().design(&domain)?;
        println!("{name}: {} singularities", field.singularities().len());
        draw(&mut svg, name, &ring, &field, 9.0 + 78.0 * k as f64);
    }
    svg.push_str("</svg>\n");
    std::fs::write(folder.join("rectilinear.svg"), svg)?;
    Ok(())
}
