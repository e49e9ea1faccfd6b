//! Laws of the parceler over generated blocks.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use geo_types::Coord;
use proptest::prelude::*;

use super::geom::{area, dist, is_simple, nearest_on};
use super::quality::{cost, measure, Scratch};
use super::*;

fn c(x: f64, y: f64) -> Coord<f64> {
    Coord { x, y }
}

fn cases() -> ProptestConfig {
    let long = std::env::var("URBAN_LAYOUT_LONG").is_ok_and(|v| v == "1");
    ProptestConfig {
        cases: if long { 3000 } else { 16 },
        ..ProptestConfig::default()
    }
}

/// A simple ring around the origin, with a random street mask.
fn star() -> impl Strategy<Value = Block> {
    let spoke = (0.15..1.0f64, 0.25..1.0f64, prop::bool::weighted(0.6));
    (
        prop::collection::vec(spoke, 3..24),
        10.0..130.0f64,
        0.2..1.0f64,
    )
        .prop_map(|(spokes, size, squash)| {
            let total: f64 = spokes.iter().map(|s| s.0).sum();
            let mut at = 0.0;
            let (mut ring, mut front) = (Vec::new(), Vec::new());
            for (step, r, f) in spokes {
                at += step / total * TAU;
                ring.push(c(size * r * at.cos(), size * squash * r * at.sin()));
                front.push(f);
            }
            Block { ring, front }
        })
}

/// A strip along a wavy street with a ragged back, the usual case.
fn strip() -> impl Strategy<Value = Block> {
    (
        60.0..240.0f64,
        26.0..80.0f64,
        prop::collection::vec(-3.0..3.0f64, 3..20),
        -0.002..0.002f64,
        any::<[bool; 3]>(),
    )
        .prop_map(|(l, d, back, bend, [left, right, rear])| {
            let (mut ring, mut front) = (Vec::new(), Vec::new());
            let steps = 12;
            for k in 0..=steps {
                let x = l * f64::from(k) / f64::from(steps);
                ring.push(c(x, bend * x * x));
                front.push(k < steps || right);
            }
            let n = back.len();
            for (k, e) in back.iter().enumerate() {
                let x = l * (1.0 - k as f64 / (n - 1) as f64);
                ring.push(c(x, bend * x * x + d + e));
                front.push(if k + 1 == n { left } else { rear });
            }
            Block { ring, front }
        })
}

/// Shapes that hurt: needles, combs, dense and doubled vertices, hair spikes.
fn hostile() -> impl Strategy<Value = Block> {
    prop_oneof![
        // Needle.
        (10.0..500.0f64, -9.0..1.0f64).prop_map(|(l, e)| vec![
            c(0., 0.),
            c(l, 0.),
            c(l, 10f64.powf(e))
        ]),
        // Comb with narrow teeth.
        (2usize..9, 0.01..20.0f64, 5.0..60.0f64).prop_map(|(n, w, h)| {
            let mut ring = vec![c(0., 0.), c(n as f64 * (w + 7.0), 0.)];
            for k in (0..n).rev() {
                let x = k as f64 * (w + 7.0);
                ring.extend([
                    c(x + w + 7.0, 8.),
                    c(x + w, 8.),
                    c(x + w, 8. + h),
                    c(x, 8. + h),
                ]);
                if k > 0 {
                    ring.push(c(x, 8.));
                }
            }
            ring
        }),
        // A thousand vertices on a rough circle.
        (200usize..1000, 0.0..0.1f64, 5.0..120.0f64).prop_map(|(n, rough, r)| {
            (0..n)
                .map(|k| {
                    let a = k as f64 / n as f64 * TAU;
                    let q = r * (1.0 + rough * (17.3 * k as f64).sin());
                    c(q * a.cos(), q * a.sin())
                })
                .collect()
        }),
        // A rectangle with a hair spike and doubled corners.
        (1e-9..1.0f64, 1.0..80.0f64).prop_map(|(w, h)| vec![
            c(0., 0.),
            c(50., 0.),
            c(50., 0.),
            c(100., 0.),
            c(100., 40.),
            c(50. + w, 40.),
            c(50., 40. + h),
            c(50. - w, 40.),
            c(0., 40.),
            c(0., 40.),
        ]),
        // Tiny and huge.
        (-6.0..5.0f64).prop_map(|e| {
            let s = 10f64.powf(e);
            vec![c(0., 0.), c(s, 0.), c(1.2 * s, 0.7 * s), c(0.1 * s, s)]
        }),
        // Not simple at all.
        Just(vec![c(0., 0.), c(100., 100.), c(100., 0.), c(0., 100.)]),
        Just(vec![c(0., 0.), c(0., 0.), c(0., 0.)]),
    ]
    .prop_flat_map(|ring| {
        let n = ring.len();
        (Just(ring), prop::collection::vec(any::<bool>(), n))
            .prop_map(|(ring, front)| Block { ring, front })
    })
}

/// The laws that every answer must keep.
fn check(block: &Block, options: &ParcelOptions) -> Result<(), TestCaseError> {
    let pieces = parcel(block, options);
    let total = area(&block.ring);
    prop_assert!(!pieces.is_empty());
    if !is_simple(&block.ring) || total <= 0.0 {
        return Ok(());
    }
    let sum: f64 = pieces.iter().map(|p| area(&p.ring)).sum();
    prop_assert!((sum - total).abs() <= 1e-9 * total, "area {sum} of {total}");
    // Every directed edge once; without its twin only along the outline.
    let bits = |p: Coord<f64>| (p.x.to_bits(), p.y.to_bits());
    let mut edges = BTreeMap::new();
    for p in &pieces {
        prop_assert!(area(&p.ring) > 0.0 && is_simple(&p.ring), "{:?}", p.ring);
        for i in 0..p.ring.len() {
            let (a, b) = (p.ring[i], p.ring[(i + 1) % p.ring.len()]);
            prop_assert!(
                edges.insert((bits(a), bits(b)), (a, b)).is_none(),
                "edge used twice"
            );
        }
    }
    let n = block.ring.len();
    let outline: f64 = (0..n)
        .map(|i| dist(block.ring[i], block.ring[(i + 1) % n]))
        .sum();
    let open: f64 = edges
        .iter()
        .filter(|((a, b), _)| !edges.contains_key(&(*b, *a)))
        .map(|(_, (a, b))| dist(*a, *b))
        .sum();
    prop_assert!(
        (open - outline).abs() <= 1e-9 * outline,
        "outline {open} of {outline}"
    );
    for v in &block.ring {
        prop_assert!(
            pieces.iter().any(|p| p.ring.contains(v)),
            "lost vertex {v:?}"
        );
    }
    for p in pieces.iter().filter(|p| p.kind == PieceKind::Parcel) {
        let f = frontage(block, &p.ring);
        prop_assert!(f >= options.min_frontage * (1.0 - 1e-9), "frontage {f}");
    }
    Ok(())
}

/// Which edges of a piece lie on a street edge of the block.
fn street_edges(block: &Block, ring: &[Coord<f64>]) -> Vec<bool> {
    let n = block.ring.len();
    let size = block
        .ring
        .iter()
        .fold(1.0, |m: f64, p| m.max(p.x.abs()).max(p.y.abs()));
    let near = |k: usize, q: Coord<f64>| {
        let (s, e) = (block.ring[k], block.ring[(k + 1) % n]);
        dist(q, super::geom::lerp(s, e, nearest_on(s, e, q))) < 1e-9 * size
    };
    (0..ring.len())
        .map(|i| {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            (0..n).any(|k| block.front[k] && near(k, a) && near(k, b))
        })
        .collect()
}

/// Frontage of a piece, measured on the block itself.
fn frontage(block: &Block, ring: &[Coord<f64>]) -> f64 {
    measure(ring, &street_edges(block, ring), &mut Scratch::default()).frontage
}

/// What the pieces cost in the search's own measure.
fn total_cost(block: &Block) -> f64 {
    let o = ParcelOptions::default();
    let mut scratch = Scratch::default();
    parcel(block, &o)
        .iter()
        .map(|p| {
            cost(
                &measure(&p.ring, &street_edges(block, &p.ring), &mut scratch),
                &o,
            )
        })
        .sum()
}

/// Bad parcels, parcels, green area.
fn score(block: &Block) -> (usize, usize, f64) {
    let mut out = (0, 0, 0.0);
    for p in parcel(block, &ParcelOptions::default()) {
        if p.kind == PieceKind::Green {
            out.2 += area(&p.ring);
        } else {
            let q = measure(&p.ring, &vec![true; p.ring.len()], &mut Scratch::default());
            out.0 += usize::from(q.is_bad());
            out.1 += 1;
        }
    }
    out
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn stars_are_tiled_with_access(block in star()) {
        check(&block, &ParcelOptions::default())?;
    }

    #[test]
    fn strips_are_tiled_with_access(block in strip()) {
        check(&block, &ParcelOptions::default())?;
    }

    #[test]
    fn hostile_rings_are_survived(block in hostile()) {
        check(&block, &ParcelOptions::default())?;
    }

    #[test]
    fn odd_options_are_survived(
        block in star(),
        depth in -5.0..200.0f64,
        width in -5.0..90.0f64,
        least in -1.0..40.0f64,
    ) {
        let options = ParcelOptions {
            depth,
            width,
            min_frontage: least,
            good_frontage: 0.5 * width,
        };
        let used = sane(&options);
        // What is asked for may be nonsense; what is used must hold.
        check(&block, &used)?;
        prop_assert_eq!(parcel(&block, &options), parcel(&block, &used));
    }

    #[test]
    fn the_same_block_gives_the_same_pieces(block in strip()) {
        let o = ParcelOptions::default();
        prop_assert_eq!(parcel(&block, &o), parcel(&block, &o));
    }

    #[test]
    fn pieces_move_with_the_block(block in strip(), x in -4000i32..4000, y in -4000i32..4000) {
        // Coordinates of 10 binary digits and an integer shift: the local
        // frame sees the same block to the bit.
        let q = |v: f64| (v * 1024.0).round() / 1024.0;
        let near = Block { ring: block.ring.iter().map(|p| c(q(p.x), q(p.y))).collect(), ..block };
        let shift = c(f64::from(x), f64::from(y));
        let far = Block { ring: near.ring.iter().map(|&p| p + shift).collect(), ..near.clone() };
        let o = ParcelOptions::default();
        let (a, b) = (parcel(&near, &o), parcel(&far, &o));
        prop_assert_eq!(a.len(), b.len());
        for (p, r) in a.iter().zip(&b) {
            prop_assert_eq!(p.kind, r.kind);
            prop_assert_eq!(p.ring.len(), r.ring.len());
            for (&u, &v) in p.ring.iter().zip(&r.ring) {
                prop_assert!(dist(u + shift, v) < 1e-9);
            }
        }
    }

    #[test]
    fn turning_the_block_changes_little(block in strip(), turn in 0.0..TAU) {
        // Rounding may tip a tie early in the search, and so lead to another
        // plan, but not to one of another class: about one bad lot apart.
        let (s, k) = turn.sin_cos();
        let turned = Block {
            ring: block.ring.iter().map(|p| c(k * p.x - s * p.y, s * p.x + k * p.y)).collect(),
            ..block.clone()
        };
        let (a, b) = (total_cost(&block), total_cost(&turned));
        prop_assert!((a - b).abs() <= 2.0 + 0.2 * a.min(b), "{a} {b}");
    }
}

/// A strip between two arcs, both streets or only the lower one.
fn arcs(radius: f64, depth: f64, length: f64, both: bool) -> Block {
    let steps = (length / 10.0).ceil() as i32;
    let (mut ring, mut front) = (Vec::new(), Vec::new());
    for k in 0..=steps {
        let a = length / radius * f64::from(k) / f64::from(steps);
        ring.push(c(radius * a.sin(), radius - radius * a.cos()));
        front.push(k < steps);
    }
    let r = radius - depth;
    for k in (0..=steps).rev() {
        let a = length / radius * f64::from(k) / f64::from(steps);
        ring.push(c(r * a.sin(), radius - r * a.cos()));
        front.push(both && k > 0);
    }
    Block { ring, front }
}

#[test]
fn curved_strips_have_no_bad_parcel() {
    for radius in [150.0, -150.0, 400.0] {
        for (depth, both) in [(31.0, false), (60.0, true)] {
            let block = arcs(radius, depth, 170.0, both);
            let (bad, count, green) = score(&block);
            assert_eq!((bad, green), (0, 0.0), "radius {radius} depth {depth}");
            let rows = if both { 2.0 } else { 1.0 };
            assert!(
                (count as f64 - rows * 170.0 / 18.0).abs() < 3.0 + rows,
                "{count}"
            );
        }
    }
}

#[test]
fn a_double_row_is_back_to_back() {
    let block = Block {
        ring: vec![c(0., 0.), c(126., 0.), c(126., 60.), c(0., 60.)],
        front: vec![true; 4],
    };
    let pieces = parcel(&block, &ParcelOptions::default());
    assert_eq!(pieces.len(), 14);
    for p in &pieces {
        assert!((area(&p.ring) - 540.0).abs() < 1e-6);
    }
}

#[test]
fn no_street_means_one_green() {
    let block = Block {
        ring: vec![c(0., 0.), c(90., 0.), c(90., 60.), c(0., 60.)],
        front: vec![false; 4],
    };
    let pieces = parcel(&block, &ParcelOptions::default());
    assert_eq!(pieces.len(), 1);
    assert_eq!(pieces[0].kind, PieceKind::Green);
    assert_eq!(pieces[0].ring, block.ring);
}

#[test]
fn land_beyond_reach_is_green() {
    // 120 m deep behind one street: lots in front, the rest landlocked.
    let block = Block {
        ring: vec![c(0., 0.), c(90., 0.), c(90., 120.), c(0., 120.)],
        front: vec![true, false, false, false],
    };
    let (bad, count, green) = score(&block);
    assert_eq!(bad, 0);
    assert!(
        count >= 5 && green > 90.0 * 40.0 && green < 90.0 * 90.0,
        "{count} {green}"
    );
}

#[test]
fn what_is_no_block_gives_no_panic() {
    let o = ParcelOptions::default();
    let nan = Block {
        ring: vec![c(0., 0.), c(f64::NAN, 0.), c(1., 1.)],
        front: vec![true; 3],
    };
    assert!(parcel(&nan, &o).is_empty());
    let short = Block {
        ring: vec![c(0., 0.), c(1., 0.)],
        front: vec![true; 2],
    };
    assert!(parcel(&short, &o).is_empty());
    let uneven = Block {
        ring: vec![c(0., 0.), c(1., 0.), c(1., 1.)],
        front: vec![true],
    };
    assert!(parcel(&uneven, &o).is_empty());
}
