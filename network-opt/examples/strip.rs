//! Optimises a bent street grid and draws it before and after:
//! `cargo run -p network-opt --example strip` writes
//! `images/strip.svg` of this crate (or the path given as argument).

use network_opt::geo_types::{coord, Coord, LineString};
use network_opt::{
    optimize, roads, Block, Freedom, OptimizeOptions, PlanarMesh, StripFit, VertexId, Wire,
};
use std::fmt::Write as _;

/// Columns and rows of blocks.
const BLOCKS: (usize, usize) = (5, 6);
/// Pieces per block side.
const PIECES: usize = 4;

/// Where the point (x, y) of the regular grid is drawn: blocks of 130 m by
/// 62 m in a rectangle, pushed about inside.
fn bent(x: f64, y: f64) -> Coord<f64> {
    let (w, h) = (BLOCKS.0 as f64, BLOCKS.1 as f64);
    let inside = (x * (w - x) / (w * w) * 4.0).min(1.0) * (y * (h - y) / (h * h) * 4.0).min(1.0);
    let wave = (2.1 * x + 0.7 * y).sin() * 20.0 + (3.3 * y + 1.3 * x).cos() * 9.0;
    let sway = (1.7 * y - 0.9 * x).sin() * 22.0;
    // Streets leave the long sides anywhere.
    let along = 18.0 * (5.0 * x).sin() * (1.0 - 2.0 * y / h);
    let bulge = if x > 0.0 && x < w { along } else { 0.0 };
    coord! { x: 130.0 * x + bulge + inside * sway, y: 62.0 * y + inside * wave }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (nx, ny) = BLOCKS;
    let line = |along_x: bool, k: usize| {
        let count = PIECES * if along_x { nx } else { ny };
        let points = (0..=count).map(|i| {
            let t = i as f64 / PIECES as f64;
            if along_x {
                bent(t, k as f64)
            } else {
                bent(k as f64, t)
            }
        });
        // The rim is straight: only its crossings count.
        let rim = k == 0 || k == if along_x { ny } else { nx };
        let every = if rim { PIECES } else { 1 };
        let line = LineString(points.step_by(every).collect());
        Wire {
            line,
            left: rim,
            right: rim,
            priority: u8::from(rim),
        }
    };
    let wires: Vec<Wire<bool>> = (0..=ny)
        .map(|k| line(true, k))
        .chain((0..=nx).map(|k| line(false, k)))
        .collect();
    let mut mesh = PlanarMesh::from_linework(&wires, 0.01)?;

    // Blocks between the crossings, inner roads, and what may move.
    let crossing = |mesh: &PlanarMesh<bool>, i: usize, j: usize| {
        let at = bent(i as f64, j as f64);
        mesh.vertices()
            .find(|&v| {
                let p = mesh.point(v);
                (p.x - at.x).hypot(p.y - at.y) < 0.02
            })
            .ok_or("a crossing is missing")
    };
    let mut blocks = Vec::new();
    for i in 0..nx {
        for j in 0..ny {
            let mut corners = [VertexId::NONE; 4];
            for (c, (di, dj)) in corners.iter_mut().zip([(0, 0), (1, 0), (1, 1), (0, 1)]) {
                *c = crossing(&mesh, i + di, j + dj)?;
            }
            let face = mesh.face_at(bent(i as f64 + 0.5, j as f64 + 0.5));
            blocks.push(Block {
                face,
                corners: Some(corners),
            });
        }
    }
    let inner = roads(&mesh, |&rim| !rim, 60.0);
    let mut freedom = vec![Freedom::Free; mesh.vertex_bound()];
    for h in mesh.half_edges().filter(|&h| *mesh.attr(h)) {
        let v = mesh.origin(h);
        freedom[v.0 as usize] = if mesh.degree(v) > 2 {
            Freedom::Slide
        } else {
            Freedom::Fixed
        };
    }

    let before = mesh.clone();
    let report = optimize(
        &mut mesh,
        &blocks,
        &inner,
        &|v| freedom[v.0 as usize],
        &StripFit::new(),
        &OptimizeOptions::default(),
        &mut |_| true,
    )?;
    println!(
        "energy {:.0} -> {:.0} m2 in {} rounds, {} unknowns, {} factorisation(s), moved up to {:.1} m",
        report.before.total(),
        report.after.total(),
        report.steps.len(),
        report.unknowns,
        report.factorizations,
        report.moved
    );

    let (w, h) = (130.0 * nx as f64, 62.0 * ny as f64);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-20 -20 {} {}\" width=\"900\">\n\
         <rect x=\"-20\" y=\"-20\" width=\"100%\" height=\"100%\" fill=\"#faf8f3\"/>\n",
        2.0 * w + 80.0,
        h + 40.0
    );
    for (mesh, shift) in [(&before, 0.0), (&mesh, w + 40.0)] {
        draw(&mut svg, mesh, &blocks, shift, h)?;
    }
    svg.push_str("</svg>\n");
    let path = std::env::args()
        .nth(1)
        .unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/images/strip.svg").to_owned());
    std::fs::write(&path, svg)?;
    Ok(())
}

/// Blocks tinted by how far they are from their strips, streets on top.
fn draw(
    svg: &mut String,
    mesh: &PlanarMesh<bool>,
    blocks: &[Block],
    shift: f64,
    height: f64,
) -> Result<(), Box<dyn std::error::Error>> {
    use network_opt::TargetShape;
    let path = |points: &[Coord<f64>]| {
        let mut d = String::new();
        for (i, p) in points.iter().enumerate() {
            let verb = if i == 0 { 'M' } else { 'L' };
            let _ = write!(d, "{verb}{:.1} {:.1}", p.x + shift, height - p.y);
        }
        d
    };
    for block in blocks {
        let Some(&outer) = mesh.loops(block.face).first() else {
            continue;
        };
        let ids: Vec<VertexId> = mesh.walk(outer).map(|h| mesh.origin(h)).collect();
        let ring = mesh.ring(outer);
        let corners = block.corners.and_then(|c| {
            let at = c.map(|v| ids.iter().position(|&w| w == v));
            Some([at[0]?, at[1]?, at[2]?, at[3]?])
        });
        let off = StripFit::new().targets(&ring, corners).map_or(0.0, |aims| {
            let square =
                |(a, b): (&Coord<f64>, &Coord<f64>)| (a.x - b.x).powi(2) + (a.y - b.y).powi(2);
            let sum: f64 = ring.iter().zip(&aims).map(square).sum();
            (sum / ring.len() as f64).sqrt()
        });
        let t = (off / 12.0).min(1.0);
        let mix = |a: f64, b: f64| (a + (b - a) * t) as u8;
        writeln!(
            svg,
            "<path d=\"{}Z\" fill=\"#{:02x}{:02x}{:02x}\"/>",
            path(&ring),
            mix(222.0, 214.0),
            mix(232.0, 96.0),
            mix(214.0, 77.0)
        )?;
    }
    for road in roads(mesh, |_| true, 60.0) {
        let points: Vec<Coord<f64>> = road.iter().map(|&v| mesh.point(v)).collect();
        writeln!(
            svg,
            "<path d=\"{}\" fill=\"none\" stroke=\"#4a4f57\" stroke-width=\"5\" stroke-linejoin=\"round\" stroke-linecap=\"round\"/>",
            path(&points)
        )?;
    }
    Ok(())
}
