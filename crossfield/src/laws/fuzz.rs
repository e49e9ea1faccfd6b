//! Hostile domains: whatever comes in, no panic, no hang, no wrong mesh.

use geo_types::{coord, Coord};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestCaseError};

use super::shapes::{hostile, Hostile};
use crate::{
    BoundaryField, Cursor, DistanceField, Domain, Field, FieldDesign, MedialAxis, Sight, Weighting,
};

fn config(cases: u32, long: u32) -> Config {
    let wanted = std::env::var_os("URBAN_LAYOUT_LONG").is_some_and(|v| v == "1");
    Config {
        failure_persistence: None,
        ..Config::with_cases(if wanted { long } else { cases })
    }
}

proptest! {
    #![proptest_config(config(300, 100_000))]

    #[test]
    fn nothing_panics(seed in any::<u64>()) {
        tried(seed)?;
    }
}

fn tried(seed: u64) -> Result<(), TestCaseError> {
    let Hostile {
        polygon,
        lines,
        options,
    } = hostile(seed);
    let Ok(domain) = Domain::with_lines(&polygon, &lines, &options) else {
        return Ok(());
    };
    prop_assert!(domain.vertex_count() <= options.max_vertices);
    sound(&domain)?;
    locate(&domain, seed)?;
    let mut weights = vec![Vec::new(); domain.ring_count()];
    for piece in domain.pieces() {
        let list = &mut weights[piece.ring];
        list.push([1.0, 1e-6, 1e6][(list.len() + piece.ring) % 3]);
    }
    let plain = DistanceField::default();
    let clear = DistanceField {
        sight: Sight::Clear,
        medial_axis: MedialAxis::LeftOut,
        weights,
        weighting: Weighting::Pieces,
        ..plain.clone()
    };
    for design in [
        &plain as &dyn FieldDesign,
        &clear,
        &BoundaryField::default(),
    ] {
        if let Ok(field) = design.design(&domain) {
            analysed(&field)?;
        }
    }
    prop_assert!(plain.design(&domain).is_ok());
    Ok(())
}

/// Triangles have no negative area and add up to the polygon's.
fn sound(domain: &Domain) -> Result<(), TestCaseError> {
    let inner = &*domain.inner;
    let mut total = 0.0;
    for triangle in &inner.mesh.triangles {
        let [a, b, c] = triangle.map(|v| inner.mesh.points[v as usize]);
        // Vertices are on a needle's edge within rounding.
        let area = crate::plane::orient(a, b, c) / 2.0;
        prop_assert!(area >= -1e-14 * inner.frame.size * inner.frame.size);
        total += area;
    }
    let slack = 1e-6 * domain.area() + 1e-11 * inner.frame.size * inner.frame.size;
    prop_assert!((total - domain.area()).abs() <= slack);
    for edge in domain.line_edges() {
        prop_assert!(domain.neighbours(edge.from).contains(&(edge.to as u32)));
    }
    Ok(())
}

/// Vertices are found, and exits from them answer.
fn locate(domain: &Domain, seed: u64) -> Result<(), TestCaseError> {
    let mut cursor = Cursor::default();
    let count = domain.vertex_count();
    for k in 0..8 {
        let (v, w) = (seed as usize % (count - k % count), (7 * k) % count);
        let (from, to) = (domain.vertex(v), domain.vertex(w));
        let beyond = coord! {x: 3.0 * to.x - 2.0 * from.x, y: 3.0 * to.y - 2.0 * from.y};
        for target in [
            to,
            beyond,
            coord! {x: f64::NAN, y: 0.0},
            coord! {x: 1e300, y: -1e300},
        ] {
            let _ = domain.exit(from, target, &mut cursor);
            let _ = domain.locate(target, &mut cursor);
            let _ = domain.nearest_boundary(target);
        }
    }
    Ok(())
}

fn analysed(field: &Field) -> Result<(), TestCaseError> {
    let report = field.report();
    prop_assert!(report.check.winding_law());
    prop_assert!(report.mean_boundary_deviation.is_finite());
    let domain = field.domain();
    let last = domain.vertex_count() - 1;
    let curve: Vec<Coord<f64>> = [0, last / 2, last].map(|v| domain.vertex(v)).to_vec();
    let along = field.along(&curve.into());
    prop_assert!(along.length.is_finite() && along.left_out >= 0.0);
    Ok(())
}

/// Inputs that broke a law once.
#[test]
fn found_inputs_stay_harmless() {
    for seed in [
        // A bow-tie whose centroid is astronomically far away.
        4_872_071_847_882_045_427,
        // A constraint line across a hole that is thinner than the tolerance.
        4_025_278_381_989_726_623,
    ] {
        tried(seed).expect("harmless");
    }
}
