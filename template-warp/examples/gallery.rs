//! Warps the standard library onto a range of regions and draws the best
//! result for each.
//!
//! `cargo run -p template-warp --example gallery -- OUT.svg` writes the picture
//! and prints the figures that planners measure: mean deviation of corners from
//! 90 degrees, area of the smallest enclosing box over area, share of
//! undesirable parcels (over 15 degrees or 1.2). Further arguments name the
//! templates to be tried; `--few` draws the twelve regions of the README.

use std::fmt::Write as _;
use template_warp::{
    geo_types::Coord, match_templates, warp, EdgeUse, Library, MatchOptions, Region, WarpOptions,
    Warped,
};

#[path = "shared/regions.rs"]
mod regions;

type P = Coord<f64>;

/// Mean deviation of the corners (turns over 20 degrees), degrees, and the
/// smallest box over the area.
fn measure(ring: &[P]) -> (f64, f64) {
    let n = ring.len();
    let mut corners = Vec::new();
    let (mut area, mut smallest) = (0.0, f64::INFINITY);
    for i in 0..n {
        let (a, b, c) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
        let (u, v) = (b - a, c - b);
        let turn = (u.x * v.y - u.y * v.x)
            .atan2(u.x * v.x + u.y * v.y)
            .to_degrees();
        if turn.abs() > 20.0 {
            corners.push((turn.abs() - 90.0).abs());
        }
        area +=
            0.5 * ((b.x - ring[0].x) * (c.y - ring[0].y) - (b.y - ring[0].y) * (c.x - ring[0].x));
        // Boxes along edges of the ring; enough for a picture's caption.
        let l = v.x.hypot(v.y);
        let (e, f) = (
            v / l,
            Coord {
                x: -v.y / l,
                y: v.x / l,
            },
        );
        let range = |d: P| {
            let s = ring.iter().map(|q| q.x * d.x + q.y * d.y);
            s.clone().fold(f64::NEG_INFINITY, f64::max) - s.fold(f64::INFINITY, f64::min)
        };
        smallest = smallest.min(range(e) * range(f));
    }
    (
        corners.iter().sum::<f64>() / corners.len().max(1) as f64,
        smallest / area,
    )
}

fn main() {
    let mut args = std::env::args().skip(1);
    let out = args.next().unwrap_or_else(|| "gallery.svg".into());
    let (flags, only): (Vec<String>, Vec<String>) = args.partition(|a| a.starts_with("--"));
    let mut library = Library::standard();
    if !only.is_empty() {
        let names: Vec<&str> = only.iter().map(String::as_str).collect();
        library = library.subset(&names).unwrap_or_else(|e| panic!("{e}"));
    }
    let (cols, cell) = (if flags.is_empty() { 5 } else { 4 }, 250.0);
    let mut shapes = regions::all();
    if !flags.is_empty() {
        shapes.retain(|s| regions::FEW.contains(&s.0));
    }
    let rows = shapes.len().div_ceil(cols);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"8\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        cell * cols as f64,
        cell * rows as f64
    );
    for (k, (name, ring, uses)) in shapes.into_iter().enumerate() {
        let origin = Coord {
            x: (k % cols) as f64 * cell + 0.5 * cell,
            y: (k / cols) as f64 * cell + 0.52 * cell,
        };
        let region = Region::new(ring.clone(), uses.clone(), "block")
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        let best = best(&library, &region);
        let _ = writeln!(
            svg,
            "<g transform=\"translate({:.1} {:.1})\" stroke=\"#555\" stroke-width=\"0.7\">",
            origin.x, origin.y
        );
        let size = ring
            .iter()
            .map(|q| q.x.abs().max(q.y.abs()))
            .fold(0.0, f64::max);
        let scale = (0.42 * cell / size).min(1.0);
        let put = |q: P| format!("{:.1},{:.1} ", q.x * scale, -q.y * scale);
        let caption = match &best {
            Ok(w) => {
                let (mut dev, mut ratio, mut bad, mut n) = (0.0, 0.0, 0, 0);
                for f in &w.faces {
                    let (fill, parcel) = match f.label.as_str() {
                        "parcel" => ("", true),
                        "park" => ("#bfe0b0", false),
                        _ => ("#ddd", false),
                    };
                    let mut fill = fill.to_owned();
                    if parcel {
                        let (d, r) = measure(&f.ring);
                        dev += d;
                        ratio += r;
                        n += 1;
                        let undesirable = d > 15.0 || r > 1.2;
                        bad += usize::from(undesirable);
                        let t = ((d / 15.0).max((r - 1.0) / 0.2)).min(1.0);
                        fill = if undesirable {
                            "#f3a58c".into()
                        } else {
                            format!(
                                "rgb({},{},{})",
                                214 + (30.0 * t) as i32,
                                228 - (10.0 * t) as i32,
                                245 - (60.0 * t) as i32
                            )
                        };
                    }
                    let d: String = f.ring.iter().map(|&q| put(q)).collect();
                    let _ = writeln!(svg, "<polygon points=\"{d}\" fill=\"{fill}\"/>");
                }
                for line in &w.centrelines {
                    let d: String = line.coords().map(|&q| put(q)).collect();
                    let _ = writeln!(svg, "<polyline points=\"{d}\" fill=\"none\" stroke=\"#888\" stroke-dasharray=\"3 2\" stroke-width=\"0.7\"/>");
                }
                let n = f64::from(n.max(1));
                let text = format!(
                    "{}: {:.1} deg, {:.3}, {bad} bad, E {:.4}, {} it",
                    w.template,
                    dev / n,
                    ratio / n,
                    w.energy,
                    w.iterations
                );
                println!("{name:24} {text}  n={n}");
                text
            }
            Err(e) => {
                println!("{name:24} none: {e}");
                "none".into()
            }
        };
        let n = ring.len();
        let start = (0..n)
            .find(|&i| uses[i] != uses[(i + n - 1) % n])
            .unwrap_or(0);
        let mut run = String::new();
        for i in 0..n {
            let (here, next) = ((start + i) % n, (start + i + 1) % n);
            run.push_str(&put(ring[here]));
            if i + 1 == n || uses[next] != uses[here] {
                let colour = if uses[here] == EdgeUse::Street {
                    "#222"
                } else {
                    "#d08"
                };
                let _ = writeln!(svg, "<polyline points=\"{run}{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\"/>", put(ring[next]));
                run.clear();
            }
        }
        let _ = writeln!(svg, "<text stroke=\"none\" text-anchor=\"middle\" y=\"-113\">{name}</text><text stroke=\"none\" text-anchor=\"middle\" y=\"-104\">{caption}</text></g>");
    }
    svg.push_str("</svg>\n");
    std::fs::write(&out, svg).unwrap_or_else(|e| panic!("{out}: {e}"));
}

/// The candidate with the least energy over probability.
fn best(library: &Library, region: &Region) -> Result<Warped, String> {
    let mut best: Option<(f64, Warped)> = None;
    let mut refused = "no candidate".to_owned();
    for c in match_templates(library, region, &MatchOptions::default()) {
        match warp(library, region, &c, &WarpOptions::default()) {
            Ok(w) => {
                let cost = (w.energy + 0.002) / c.probability;
                if best.as_ref().is_none_or(|b| cost < b.0) {
                    best = Some((cost, w));
                }
            }
            Err(e) => refused = e.to_string(),
        }
    }
    best.map(|b| b.1).ok_or(refused)
}
