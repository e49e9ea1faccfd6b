//! Draws every kind of field on each site of a folder and prints what they are
//! compared by:
//! `cargo run --release -p urban-layout --example field_gallery -- SITES_FOLDER OUT_FOLDER`.
//!
//! Writes `SITE.svg`: of each field the crosses, and below them dense
//! streamlines over the divergence. A field that a site does not admit is said
//! to be missing, with the reason.

use std::path::{Path, PathBuf};

use crossfield::{
    compare, BoundaryField, ConstrainedField, DistanceField, Domain, DomainOptions, Field,
    FieldDesign, FieldError, GradientField, HarmonicField, OptimalField, PrescribedField,
    Singularity, Stroke, Symmetry,
};
use geo_types::{Coord, LineString, Polygon};
use urban_layout::io::svg::{field_sheet_svg, FieldPanel};
use urban_layout::io::write::write_all_or_nothing;
use urban_layout::Site;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args_os().skip(1).map(PathBuf::from);
    let (Some(sites), Some(out)) = (words.next(), words.next()) else {
        return Err("usage: field_gallery SITES_FOLDER OUT_FOLDER".into());
    };
    let mut paths: Vec<PathBuf> = std::fs::read_dir(&sites)?
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<_, _>>()?;
    paths.retain(|path| path.extension().is_some_and(|e| e == "geojson"));
    paths.sort();
    for path in paths {
        draw(&path, &out)?;
    }
    Ok(())
}

fn draw(path: &Path, out: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let site = Site::read(path)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    println!("{stem}");
    let domains = site
        .parts
        .iter()
        .map(|part| Domain::new(part, &DomainOptions::default()))
        .collect::<Result<Vec<_>, FieldError>>()?;
    let stroke = sketch(&site.parts);
    let mut panels = Vec::new();
    for (name, design) in designs(&stroke) {
        let fields: Result<Vec<Field>, FieldError> = domains.iter().map(design).collect();
        match fields {
            Ok(fields) => panels.push(FieldPanel {
                name: name.to_owned(),
                fields,
                strokes: Vec::from_iter((name == STROKE).then(|| stroke.clone())),
            }),
            Err(error) => println!("  {name}: {error}"),
        }
    }
    let named: Vec<(&str, &Field)> = panels
        .iter()
        .filter_map(|panel| Some((panel.name.as_str(), panel.fields.first()?)))
        .collect();
    println!("{}", compare(&named)?);
    let file = out.join(format!("{stem}.svg"));
    write_all_or_nothing(&[(file, field_sheet_svg(&site, &panels).into_bytes())])?;
    Ok(())
}

type Design<'a> = Box<dyn Fn(&Domain) -> Result<Field, FieldError> + 'a>;

const STROKE: &str = "B-field along a sketch";

fn designs(stroke: &LineString<f64>) -> Vec<(&'static str, Design<'_>)> {
    let another = HarmonicField {
        entry: 1,
        ..HarmonicField::default()
    };
    vec![
        ("D-field", Box::new(|d| DistanceField::default().design(d))),
        ("B-field", Box::new(|d| BoundaryField::default().design(d))),
        (
            "Globally optimal",
            Box::new(|d| OptimalField::default().design(d)),
        ),
        (
            "Along a gradient",
            Box::new(|d| GradientField::default().design(d)),
        ),
        ("H-field", Box::new(|d| HarmonicField::default().design(d))),
        (
            "H-field, second choice",
            Box::new(move |d| another.design(d)),
        ),
        (
            STROKE,
            Box::new(move |d| {
                let sketch = Stroke::new(stroke.clone(), 300.0);
                ConstrainedField::new(BoundaryField::default())
                    .with(sketch)
                    .design(d)
            }),
        ),
        (
            "Prescribed singularities",
            Box::new(|d| PrescribedField::new(spread_out(d)).design(d)),
        ),
    ]
}

/// A street that someone might draw: an S across the middle of the site.
fn sketch(parts: &[Polygon<f64>]) -> LineString<f64> {
    let points = || parts.iter().flat_map(|p| p.exterior().0.iter());
    let fold = |of: fn(&Coord<f64>) -> f64, best: fn(f64, f64) -> f64, from| {
        points().map(of).fold(from, best)
    };
    let (x, y) = (
        [
            fold(|c| c.x, f64::min, f64::INFINITY),
            fold(|c| c.x, f64::max, f64::NEG_INFINITY),
        ],
        [
            fold(|c| c.y, f64::min, f64::INFINITY),
            fold(|c| c.y, f64::max, f64::NEG_INFINITY),
        ],
    );
    (0..=40)
        .map(|k| {
            let t = f64::from(k) / 40.0;
            Coord {
                x: x[0] + (0.2 + 0.6 * t) * (x[1] - x[0]),
                y: y[0] + (0.5 + 0.2 * (t * std::f64::consts::TAU).sin()) * (y[1] - y[0]),
            }
        })
        .collect::<Vec<_>>()
        .into()
}

/// As many singularities as the boundary asks for, and one pair more, each
/// where it is farthest from the boundary and from those before it.
fn spread_out(domain: &Domain) -> Vec<Singularity> {
    let needed = PrescribedField::needed_sum(domain, Symmetry::Cross);
    let mut indices = vec![needed.signum(); needed.unsigned_abs() as usize];
    indices.extend([1, -1]);
    let distance = |a: Coord<f64>, b: Coord<f64>| (a.x - b.x).hypot(a.y - b.y);
    let vertices: Vec<usize> = domain.inner_vertices().collect();
    let mut room: Vec<f64> = vertices
        .iter()
        .map(|&v| {
            let at = domain.vertex(v);
            distance(at, domain.nearest_boundary(at).point)
        })
        .collect();
    let mut chosen = Vec::new();
    for quarter_index in indices {
        let Some(best) = (0..room.len()).max_by(|&a, &b| room[a].total_cmp(&room[b])) else {
            break;
        };
        let at = domain.vertex(vertices[best]);
        for (room, &v) in room.iter_mut().zip(&vertices) {
            *room = room.min(0.5 * distance(domain.vertex(v), at));
        }
        chosen.push(Singularity { at, quarter_index });
    }
    chosen
}
