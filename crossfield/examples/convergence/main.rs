//! Errors of every kind of field against closed forms as the mesh is refined,
//! the edge length halved four times.
//!
//! `cargo run --release -p crossfield --features laws --example convergence [FILE]`
//! prints the tables of `convergence.md`, or writes them there.

mod fluxes;
mod shapes;

use std::fmt::Write as _;

use crossfield::geo_types::{Coord, Polygon};
use crossfield::laws::converge;
use crossfield::{
    BoundaryField, Cross, DistanceField, Domain, DomainOptions, Elements, FieldDesign, FieldError,
    GradientField, HarmonicField, OptimalField,
};
use fluxes::{by_edge, Fluxes};

/// A design on a shape whose crosses are known.
struct Case<'a> {
    name: &'a str,
    design: &'a dyn FieldDesign,
    /// The outline for an edge length: curves may be resolved as finely as
    /// the inside.
    outline: fn(f64) -> Polygon<f64>,
    exact: fn(Coord<f64>) -> Option<Cross>,
    coarsest: f64,
}

impl Case<'_> {
    fn table(&self) -> Result<String, Box<dyn std::error::Error>> {
        let domains = [1.0, 0.5, 0.25, 0.125, 0.0625]
            .map(|part| {
                let edge_length = part * self.coarsest;
                let options = DomainOptions {
                    edge_length,
                    ..DomainOptions::default()
                };
                Domain::new(&(self.outline)(edge_length), &options)
            })
            .into_iter()
            .collect::<Result<Vec<_>, FieldError>>()?;
        let table = converge(self.design, &domains, self.exact)?;
        Ok(format!("\n## {}\n\n{table}", self.name))
    }
}

const ABOUT: &str = "\
# Convergence

Deviation from the exact cross, mean by area and largest, as the edge length h is halved; shapes are some
100 m across, and circles are sampled every h where nothing else is said. Exact means to rounding. Written by
`examples/convergence.rs`.

- A D-field takes the cross of the nearest edge, which on a sampled circle is off by up to half the angle that an
  edge spans: first order. Where the exact field jumps, on the axis of the wedge, smoothing blurs a strip of fixed
  width in edges: first order in the mean, and the largest error stays.
- B-fields are harmonic but for their length. On a disc the crosses of the harmonic extension are radial throughout; on
  the sector they are a series, met only as omega grows (here 10^9). Where two sides meet at an angle that is no
  multiple of 90 degrees the crosses at the corner itself have no limit.
- H-fields have the fluxes of a function known in closed form: Re w^3 on a disc of 96 edges and between two sides at 60
  degrees, log r on an annulus, x^2 - y^2 on a turned L, and Re w^(2/3) around a concave right angle, the singular
  behaviour of an L's corner: there theory gives finite elements on an even mesh the order 4/3 everywhere, and no more.
  A rectangle has one H-field only. With the paper's linear elements and quadric fit the largest error stays.
- Gradient-aligned fields choose their constants themselves: the annulus and the wedge between two arcs have log r.
- The largest error is that of the worst vertex in the belt between the boundary and the lattice inside, whose triangles
  are not those of the mesh before, halved: it scatters from mesh to mesh, and stays longest beside the hole of the
  annulus, where crosses on the boundary itself are compared too.
";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let d = DistanceField::default();
    let raw = DistanceField {
        smoothing_rounds: 0,
        ..d.clone()
    };
    let round = DistanceField {
        concave_tangents: false,
        ..d.clone()
    };
    let b = BoundaryField::default();
    let hard = BoundaryField {
        omega: 1e9,
        ..b.clone()
    };
    let optimal = OptimalField::default();
    let h = HarmonicField::default();
    let paper = HarmonicField {
        elements: Elements::Linear,
        ..h.clone()
    };
    let gradient = GradientField::default();
    let fluxes = |harmonic: HarmonicField,
                  outline: fn(f64) -> Polygon<f64>,
                  flux: fn(Coord<f64>, Coord<f64>) -> f64| Fluxes {
        harmonic,
        outline,
        flux,
    };
    let disc = fluxes(by_edge(), fluxes::disc::outline, fluxes::disc::flux);
    let wedge = fluxes(by_edge(), fluxes::wedge::outline, fluxes::wedge::flux);
    let concave = fluxes(by_edge(), fluxes::concave::outline, fluxes::concave::flux);
    let annulus = fluxes(h.clone(), fluxes::annulus::outline, fluxes::annulus::flux);
    let corner = fluxes(h.clone(), fluxes::corner::outline, fluxes::corner::flux);

    let case = |name, design, outline, exact, coarsest| Case {
        name,
        design,
        outline,
        exact,
        coarsest,
    };
    let cases = [
        case(
            "D-field, rectangle",
            &d as &dyn FieldDesign,
            shapes::rectangle as fn(f64) -> Polygon<f64>,
            shapes::along_rectangle as fn(Coord<f64>) -> Option<Cross>,
            8.0,
        ),
        case("D-field, disc", &d, shapes::disc, shapes::radial, 8.0),
        case(
            "D-field, annulus, no smoothing",
            &raw,
            shapes::annulus,
            shapes::radial,
            8.0,
        ),
        case(
            "D-field, annulus, one round of smoothing",
            &d,
            shapes::annulus,
            shapes::radial,
            8.0,
        ),
        case(
            "D-field, wedge of 30 degrees, no smoothing",
            &raw,
            shapes::wedge,
            shapes::nearer_side,
            8.0,
        ),
        case(
            "D-field, wedge of 30 degrees, one round of smoothing",
            &d,
            shapes::wedge,
            shapes::nearer_side,
            8.0,
        ),
        case(
            "D-field, L, concave corner by its tangents",
            &d,
            shapes::l_shape,
            shapes::along_axes,
            8.0,
        ),
        case(
            "D-field, L, around the concave corner",
            &round,
            shapes::l_shape,
            shapes::around_the_corner,
            8.0,
        ),
        case(
            "B-field, rectangle",
            &b,
            shapes::rectangle,
            shapes::along_rectangle,
            8.0,
        ),
        case("B-field, disc", &b, shapes::disc, shapes::radial, 8.0),
        case("B-field, annulus", &b, shapes::annulus, shapes::radial, 8.0),
        case(
            "B-field, sector of 60 degrees, sides held",
            &hard,
            shapes::sector,
            shapes::between_sides,
            8.0,
        ),
        case("B-field, L", &b, shapes::l_shape, shapes::along_axes, 8.0),
        case(
            "Globally optimal field, disc",
            &optimal,
            shapes::disc,
            shapes::radial,
            8.0,
        ),
        case(
            "H-field, rectangle",
            &h,
            shapes::rectangle,
            shapes::along_rectangle,
            16.0,
        ),
        case(
            "H-field, rectangle, the paper's elements",
            &paper,
            shapes::rectangle,
            shapes::along_rectangle,
            16.0,
        ),
        case(
            "H-field, disc, Re w^3",
            &disc,
            fluxes::disc::outline,
            fluxes::disc::exact,
            16.0,
        ),
        case(
            "H-field, annulus, log r",
            &annulus,
            fluxes::annulus::outline,
            shapes::radial,
            16.0,
        ),
        case(
            "H-field, sector of 60 degrees, Re w^3",
            &wedge,
            fluxes::wedge::outline,
            fluxes::wedge::exact,
            16.0,
        ),
        case(
            "H-field, L, x^2 - y^2",
            &corner,
            fluxes::corner::outline,
            fluxes::corner::exact,
            16.0,
        ),
        case(
            "H-field, sector of 270 degrees, Re w^(2/3)",
            &concave,
            fluxes::concave::outline,
            fluxes::concave::exact,
            16.0,
        ),
        case(
            "Gradient-aligned field, rectangle",
            &gradient,
            shapes::rectangle,
            shapes::along_rectangle,
            16.0,
        ),
        case(
            "Gradient-aligned field, annulus",
            &gradient,
            shapes::annulus,
            shapes::radial,
            16.0,
        ),
        case(
            "Gradient-aligned field, wedge between arcs",
            &gradient,
            shapes::arched,
            shapes::radial,
            16.0,
        ),
    ];
    let mut text = ABOUT.to_owned();
    for case in cases {
        write!(text, "{}", case.table()?)?;
        eprintln!("{}", case.name);
    }
    match std::env::args_os().nth(1) {
        Some(file) => std::fs::write(file, text)?,
        None => print!("{text}"),
    }
    Ok(())
}
