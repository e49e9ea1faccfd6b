//! Draws the pictures of the README and of the designs' documentation into
//! `images/`: a site with a hole, its fields of each kind as crosses on a grid,
//! and their singularities.
//!
//! `cargo run -p crossfield --example doc_images [FOLDER]`

use std::fmt::Write as _;
use std::path::PathBuf;

use crossfield::geo_types::{coord, Coord, LineString, Polygon};
use crossfield::{
    BoundaryField, ConstrainedField, Cursor, DistanceField, Domain, DomainOptions, Field,
    FieldDesign, GradientField, HarmonicField, OptimalField, PrescribedField, Singularity, Stroke,
    Symmetry,
};

/// A suburban site, in metres: a bend of a road to the south, a straight one
/// to the east, a concave corner, and a pond.
fn site() -> Polygon<f64> {
    let bend = (0..=24).map(|k| {
        let angle = (200.0 + 2.5 * f64::from(k)).to_radians();
        (260.0 + 300.0 * angle.cos(), 300.0 + 300.0 * angle.sin())
    });
    let rest = [
        (480.0, 40.0),
        (560.0, 300.0),
        (400.0, 330.0),
        (380.0, 420.0),
        (60.0, 400.0),
    ];
    let pond = (0..24).map(|k| {
        let angle = (15.0 * f64::from(k)).to_radians();
        (200.0 + 48.0 * angle.cos(), 270.0 + 34.0 * angle.sin())
    });
    Polygon::new(
        bend.chain(rest).collect::<Vec<_>>().into(),
        vec![pond.collect::<Vec<_>>().into()],
    )
}

/// Southwards is down in an SVG.
fn flip(at: Coord<f64>) -> (f64, f64) {
    (at.x + 40.0, 450.0 - at.y)
}

fn path(ring: &LineString<f64>) -> String {
    let mut path = String::new();
    for (k, &at) in ring.0.iter().enumerate() {
        let (x, y) = flip(at);
        let _ = write!(path, "{}{x:.1} {y:.1}", if k == 0 { 'M' } else { 'L' });
    }
    path + "Z"
}

fn draw(polygon: &Polygon<f64>, field: &Field, sketch: Option<&LineString<f64>>) -> String {
    let mut crosses = String::new();
    let mut cursor = Cursor::default();
    for row in 0..28 {
        for column in 0..40 {
            let at = coord! { x: -35.0 + 16.0 * f64::from(column), y: 5.0 + 16.0 * f64::from(row) };
            let Some(cross) = field.cross(at, &mut cursor) else {
                continue;
            };
            let (x, y) = flip(at);
            for arm in &cross.arms()[..2] {
                let (dx, dy) = (6.5 * arm.x, -6.5 * arm.y);
                let _ = write!(
                    crosses,
                    "M{:.1} {:.1}l{:.1} {:.1}",
                    x - dx,
                    y - dy,
                    2.0 * dx,
                    2.0 * dy
                );
            }
        }
    }
    let mut marks = String::new();
    for singularity in field.singularities() {
        let (x, y) = flip(singularity.at);
        let colour = if singularity.quarter_index > 0 {
            "#d9480f"
        } else {
            "#1971c2"
        };
        let _ = write!(
            marks,
            "<circle cx='{x:.1}' cy='{y:.1}' r='6' fill='{colour}'/>"
        );
    }
    if let Some(sketch) = sketch {
        let data = path(sketch).replace('Z', "");
        let _ = write!(
            marks,
            "<path d='{data}' fill='none' stroke='#2b8a3e' stroke-width='4'/>"
        );
    }
    let outline: String = std::iter::once(polygon.exterior())
        .chain(polygon.interiors())
        .map(path)
        .collect();
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='560' height='402' viewBox='0 0 640 460'>\
         <path d='{outline}' fill='#f4f1ea' fill-rule='evenodd' stroke='#343a40' stroke-width='3'/>\
         <path d='{crosses}' stroke='#495057' stroke-width='1.2'/>{marks}</svg>\n"
    )
}

/// A roundabout where five streets meet, one where three do, and what else
/// the boundary asks for north of the pond.
fn prescribed(domain: &Domain) -> Vec<Singularity> {
    let at = |x: f64, y: f64, quarter_index| Singularity {
        at: coord! { x: x, y: y },
        quarter_index,
    };
    let mut all = vec![at(120.0, 170.0, -1), at(400.0, 190.0, 1)];
    match PrescribedField::needed_sum(domain, Symmetry::Cross) {
        0 => {}
        rest => all.push(at(230.0, 360.0, rest)),
    }
    all
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("images"),
        PathBuf::from,
    );
    let site = site();
    let domain = Domain::new(&site, &DomainOptions::default())?;
    // A street that someone drew.
    let sketch = LineString::from(vec![
        (70.0, 90.0),
        (190.0, 110.0),
        (300.0, 170.0),
        (360.0, 260.0),
        (365.0, 350.0),
    ]);
    let fields = [
        ("d-field.svg", DistanceField::default().design(&domain)?),
        ("b-field.svg", BoundaryField::default().design(&domain)?),
        ("h-field.svg", HarmonicField::default().design(&domain)?),
        ("g-field.svg", GradientField::default().design(&domain)?),
        ("o-field.svg", OptimalField::default().design(&domain)?),
        (
            "c-field.svg",
            ConstrainedField::new(BoundaryField::default())
                .with(Stroke::new(sketch.clone(), 300.0))
                .design(&domain)?,
        ),
        (
            "p-field.svg",
            PrescribedField::new(prescribed(&domain)).design(&domain)?,
        ),
    ];
    for (name, field) in fields {
        let check = field.index_check();
        println!(
            "{name}: {} singularities, indices {} = 4 x {} - {}, mean |div| {:.2e} per metre",
            field.singularities().len(),
            check.interior,
            check.euler,
            check.corners,
            field.mean_abs_divergence(),
        );
        let sketch = (name == "c-field.svg").then_some(&sketch);
        std::fs::write(folder.join(name), draw(&site, &field, sketch))?;
    }
    Ok(())
}
