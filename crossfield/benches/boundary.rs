//! A B-field against the bare factorisation and solution of its own matrix,
//! in one run: processor seconds, their ratio, and peak memory.
//!
//! `cargo bench -p crossfield --bench boundary [-- VERTICES...]`
//!
//! On Linux times are processor time of the thread and memory is the peak of
//! a process of its own; elsewhere times are those of the clock, and memory is
//! not measured.

use std::f64::consts::TAU;
use std::time::Instant;

use crossfield::geo_types::{Coord, LineString, Polygon};
use crossfield::{BoundaryField, Domain, DomainOptions, FieldDesign};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, CholeskySymbolicParams, SymmetricOrdering,
};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// An irregular site of 0.43 km2 with 30 corners and a hole.
fn site() -> Polygon<f64> {
    let ring = |count: u32, radius: f64, wave: f64| -> LineString<f64> {
        let corner = |k: u32| {
            let angle = TAU * f64::from(k) / f64::from(count);
            let r = radius * (1.0 + wave * (3.0 * angle).sin() + 0.5 * wave * (7.0 * angle).cos());
            (5e5 + r * angle.cos(), 5e6 + r * angle.sin())
        };
        (0..count).map(corner).collect::<Vec<_>>().into()
    };
    Polygon::new(ring(30, 375.0, 0.2), vec![ring(9, 60.0, 0.1)])
}

fn domain(vertices: usize) -> Domain {
    let options = |edge_length| DomainOptions {
        edge_length,
        max_vertices: 4 * vertices,
        ..DomainOptions::default()
    };
    // The lattice has one vertex for sqrt(3) / 2 squared edge lengths.
    let area = Domain::new(&site(), &options(50.0)).expect("valid").area();
    let edge_length = (area / (0.866 * vertices as f64)).sqrt();
    Domain::new(&site(), &options(edge_length)).expect("valid")
}

/// Seconds that this thread has run.
fn seconds(since: Instant) -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = stat.split(' ').next().and_then(|n| n.parse::<f64>().ok());
    nanoseconds.map_or_else(|| since.elapsed().as_secs_f64(), |n| n * 1e-9)
}

/// Seconds of one of `times` runs in a row: processor time is counted in
/// ticks of some milliseconds.
fn timed(times: usize, mut run: impl FnMut()) -> f64 {
    let start = Instant::now();
    let before = seconds(start);
    for _ in 0..times {
        run();
    }
    (seconds(start) - before) / times as f64
}

/// Upper triangle of L + 100 M_b in compressed columns, and the right-hand
/// sides, from the public interface of the domain alone.
struct Matrix {
    starts: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<f64>,
    columns: Vec<f64>,
}

fn matrix(domain: &Domain) -> Matrix {
    let points = domain.vertices();
    let count = points.len();
    let mut starts = vec![0_u32];
    let mut rows = Vec::new();
    for v in 0..count {
        rows.extend(domain.neighbours(v).iter().filter(|&&w| (w as usize) < v));
        rows.push(v as u32);
        starts.push(rows.len() as u32);
    }
    let mut values = vec![0.0; rows.len()];
    let mut columns = vec![0.0; 2 * count];
    let slot = |i: u32, j: u32| {
        let (low, high) = (i.min(j), i.max(j) as usize);
        let start = starts[high] as usize;
        let column = &rows[start..starts[high + 1] as usize];
        start + column.binary_search(&low).expect("an edge")
    };
    let less = |a: Coord<f64>, b: Coord<f64>| (a.x - b.x, a.y - b.y);
    let unit = domain.area().sqrt();
    for t in domain.triangles() {
        for k in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|j| t[(k + j) % 3]);
            let [p, q, r] = [a, b, c].map(|v| points[v as usize]);
            let ((ux, uy), (vx, vy)) = (less(q, p), less(r, p));
            let half = (ux * vx + uy * vy) / (ux * vy - uy * vx) / 2.0;
            values[slot(b, c)] -= half;
            values[slot(b, b)] += half;
            values[slot(c, c)] += half;
            if domain.is_boundary(b as usize) && domain.is_boundary(c as usize) {
                let (dx, dy) = less(r, q);
                let mass = 50.0 * dx.hypot(dy) / unit;
                values[slot(b, b)] += mass;
                values[slot(c, c)] += mass;
                let angle = 4.0 * dy.atan2(dx);
                for v in [b as usize, c as usize] {
                    columns[v] += mass * angle.cos();
                    columns[count + v] += mass * angle.sin();
                }
            }
        }
    }
    Matrix {
        starts,
        rows,
        values,
        columns,
    }
}

/// Analysis, factorisation, and one solution for both columns.
fn bare(matrix: &Matrix) -> Vec<f64> {
    let count = matrix.starts.len() - 1;
    let pattern =
        SymbolicSparseColMatRef::new_checked(count, count, &matrix.starts, None, &matrix.rows);
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    let symbolic =
        factorize_symbolic_cholesky(pattern, Side::Upper, SymmetricOrdering::Amd, parameters)
            .expect("analysed");
    let mut values = vec![0.0; symbolic.len_val()];
    let mut memory = MemBuffer::new(StackReq::any_of(&[
        symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
        symbolic.solve_in_place_scratch::<f64>(2, Par::Seq),
    ]));
    let factor = symbolic
        .factorize_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, &matrix.values),
            Side::Upper,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        )
        .expect("positive definite");
    let mut solved = matrix.columns.clone();
    factor.solve_in_place_with_conj(
        Conj::No,
        MatMut::from_column_major_slice_mut(&mut solved, count, 2),
        Par::Seq,
        MemStack::new(&mut memory),
    );
    solved
}

/// Peak memory of this process, megabytes.
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}

/// Peak memory of a process that does one thing only.
fn peak_of(what: &str, vertices: usize) -> String {
    let run = || {
        let program = std::env::current_exe().ok()?;
        let output = std::process::Command::new(program)
            .args([what, &vertices.to_string()])
            .output()
            .ok()?;
        String::from_utf8(output.stdout).ok()
    };
    run().map_or_else(|| "?".into(), |text| text.trim().to_owned())
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [what, vertices] = &arguments[..] {
        if let (true, Ok(vertices)) = (what.starts_with("peak"), vertices.parse()) {
            let domain = domain(vertices);
            if what == "peak-mesh" {
                println!("{:.0}", peak().unwrap_or(f64::NAN));
                return;
            }
            // From here on: the mesh was a peak of its own.
            let _ = std::fs::write("/proc/self/clear_refs", "5");
            if what == "peak-field" {
                let field = BoundaryField::default().design(&domain).expect("a field");
                assert_eq!(field.domain().vertex_count(), domain.vertex_count());
            } else {
                assert!(!bare(&matrix(&domain)).is_empty());
            }
            println!("{:.0}", peak().unwrap_or(f64::NAN));
            return;
        }
    }
    let asked: Vec<usize> = arguments.iter().filter_map(|a| a.parse().ok()).collect();
    let sizes = if asked.is_empty() {
        vec![10_000, 100_000, 1_000_000]
    } else {
        asked
    };
    println!(
        "| vertices | B-field, s | bare solve, s | ratio | mesh, s | peak MB: mesh | field | bare |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for size in sizes {
        let times = (1_000_000 / size).max(1);
        let mut domain = None;
        let meshed = timed(1, || domain = Some(self::domain(size)));
        let domain = domain.expect("just made");
        let matrix = matrix(&domain);
        // In turns, so that what else the machine does meets both alike.
        let (mut field, mut solve) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..4 {
            field = field.min(timed(times, || {
                BoundaryField::default().design(&domain).expect("a field");
            }));
            solve = solve.min(timed(times, || {
                bare(&matrix);
            }));
        }
        println!(
            "| {} | {field:.4} | {solve:.4} | {:.3} | {meshed:.3} | {} | {} | {} |",
            domain.vertex_count(),
            field / solve,
            peak_of("peak-mesh", size),
            peak_of("peak-field", size),
            peak_of("peak-bare", size),
        );
    }
}
