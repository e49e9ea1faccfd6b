//! One region can be re-rolled, and every other byte stays.

use std::collections::BTreeMap;

use urban_layout::check::{check, CheckOptions};
use urban_layout::layout::{Layout, Tile, TileKind};
use urban_layout::planner::seed::Path;
use urban_layout::{generate, PlanOptions, Quiet};
use urban_layout_tests::Shipped;

/// The tiles of regions outside `path`, by id; streets' land is shared.
fn outside(layout: &Layout, path: &Path) -> BTreeMap<u64, Tile> {
    layout
        .tiles
        .iter()
        .filter(|t| t.kind != TileKind::StreetArea)
        .filter(|t| {
            let split = t.lineage.as_ref().and_then(|l| Path::parse(&l.split));
            split.is_none_or(|s| !s.is_within(path))
        })
        .map(|t| (t.id, t.clone()))
        .collect()
}

/// The vertices of a ring that turn: others may be added where a neighbour's
/// corner comes to lie on the edge.
fn bends(tile: &Tile) -> Vec<(i64, i64)> {
    let ring = &tile.polygon.exterior().0;
    let n = ring.len() - 1;
    (0..n)
        .filter(|&i| {
            let (a, b, c) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
            let cross = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
            cross.abs() > 1e-3
        })
        .map(|i| {
            (
                (ring[i].x * 1e6).round() as i64,
                (ring[i].y * 1e6).round() as i64,
            )
        })
        .collect()
}

#[test]
fn a_region_is_rerolled_and_all_else_stays() {
    let site = Shipped::named("kotka_northwest").site();
    let plan = generate(&site, &PlanOptions::default(), &mut Quiet).expect("the site has a plan");
    // A region of a few blocks: the deepest path with three leaves or more below it.
    let leaves: Vec<Path> = plan.tree().leaves.keys().cloned().collect();
    let mut parents: Vec<Path> = leaves
        .iter()
        .flat_map(|leaf| {
            (1..leaf.steps().len()).filter_map(|n| Path::parse(&join(&leaf.steps()[..n])))
        })
        .filter(|p| (3..=12).contains(&leaves.iter().filter(|l| l.is_within(p)).count()))
        .collect();
    parents.sort();
    parents.dedup();
    let mut changed = 0;
    let mut tried = 0;
    for path in parents.iter().take(4) {
        let Ok(again) = plan.reroll(path, 77, &mut Quiet) else {
            continue;
        };
        tried += 1;
        let (before, after) = (outside(&plan.layout, path), outside(&again.layout, path));
        assert_eq!(
            before.keys().collect::<Vec<_>>(),
            after.keys().collect::<Vec<_>>(),
            "{path}: other tiles come or go"
        );
        for (id, tile) in &before {
            assert_eq!(
                bends(tile),
                bends(&after[id]),
                "{path}: tile {id} outside has moved"
            );
        }
        let certificate = check(&site, &again.layout, &CheckOptions::default());
        assert!(certificate.is_ok(), "{path}: {certificate}");
        changed += usize::from(again.layout.streets != plan.layout.streets);
        // The same seed again: the same plan, bit for bit.
        let twice = plan
            .reroll(path, 77, &mut Quiet)
            .expect("it was re-rolled once");
        assert_eq!(again.layout, twice.layout);
    }
    assert!(tried > 0, "no region of the plan can be re-rolled");
    assert!(changed > 0, "re-rolling changes nothing in {tried} regions");
}

fn join(steps: &[u16]) -> String {
    steps
        .iter()
        .map(u16::to_string)
        .collect::<Vec<_>>()
        .join(".")
}
