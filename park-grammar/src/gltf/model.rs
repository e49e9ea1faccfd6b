//! The things of the library as solids.

use super::solid::{Paint, Solid};
use crate::picture::{darker, lighter};
use crate::scene::Object;

const TRUNK: &str = "#6b5138";
const STONE: &str = "#c9c2b6";
const METAL: &str = "#4a4d50";
const WATER: &str = "#7fb5d6";

/// The shape of a thing of the library; `None` for a name that is none of its.
pub(super) fn thing(object: &Object) -> Option<Solid> {
    let (r, h) = (object.spread, object.height);
    let mut solid = Solid::default();
    match object.name.as_str() {
        "Tree" | "TallTree" | "SmallTree" => {
            let leaves = match object.name.as_str() {
                "TallTree" => "#4c8540",
                "SmallTree" => "#74ab58",
                _ => "#5f9a4a",
            };
            tree(&mut solid, object, leaves);
        }
        "Conifer" => {
            trunk(&mut solid, object.radius, 0.3 * h);
            for (k, share) in [(0.0, 1.0), (1.0, 0.8), (2.0, 0.58)] {
                let (from, to) = (h * (0.12 + 0.24 * k), h * (0.52 + 0.24 * k));
                let line = [[0.0, from], [r * share, from], [0.0, to]];
                solid.lathe(&Paint::plain("#3f6f4e"), [0.0; 3], &line, 10);
            }
        }
        "Bush" => {
            let places = [(-0.3, 0.2, 0.62), (0.35, 0.1, 0.6), (0.0, -0.38, 0.58)];
            for (k, (x, z, size)) in places.into_iter().enumerate() {
                let paint = Paint::plain(["#6d9f50", "#7dae60", "#64954a"][k]);
                let middle = [x * r, 0.475 * h, z * r];
                solid.leaves(
                    &paint,
                    middle,
                    [size * r, 0.45 * h * (0.85 + 0.1 * k as f64)],
                );
            }
        }
        "Flowers" => {
            let mound = [[r, 0.0], [0.7 * r, 0.5 * h], [0.0, 0.6 * h]];
            solid.lathe(&Paint::plain("#7da85e"), [0.0; 3], &mound, 8);
            let bloom = [
                (0.0, 0.0),
                (0.5, 0.2),
                (-0.4, 0.45),
                (-0.2, -0.5),
                (0.3, -0.4),
            ];
            for (k, (x, z)) in bloom.into_iter().enumerate() {
                let paint = Paint::plain(["#d77f9a", "#e6b84d", "#f7f1ec"][k % 3]);
                let blossom = [[0.0, 0.5 * h], [0.24 * r, 0.85 * h], [0.0, h]];
                solid.lathe(&paint, [x * r, 0.0, z * r], &blossom, 5);
            }
        }
        "Bench" => bench(&mut solid, r, h),
        "Table" => table(&mut solid, r, h),
        "Bin" => {
            let line = [
                [0.8 * r, 0.0],
                [r, h],
                [0.85 * r, h],
                [0.75 * r, 0.3 * h],
                [0.0, 0.3 * h],
            ];
            solid.lathe(&Paint::plain(METAL), [0.0; 3], &line, 10);
        }
        "Lamp" => {
            let pole = [[0.1, 0.0], [0.06, 0.3], [0.05, 0.88 * h], [0.0, 0.88 * h]];
            solid.lathe(&Paint::plain(METAL), [0.0; 3], &pole, 8);
            let glass = Paint::plain("#f7dd94");
            let bell = [
                [0.0, 0.87 * h],
                [0.14, 0.88 * h],
                [0.22, 0.96 * h],
                [0.0, 0.97 * h],
            ];
            solid.lathe(&glass, [0.0; 3], &bell, 10);
            let cap = [[0.0, 0.96 * h], [0.26, 0.96 * h], [0.0, h]];
            solid.lathe(&Paint::plain(METAL), [0.0; 3], &cap, 10);
        }
        "Fountain" => fountain(&mut solid, r, h),
        "Statue" => statue(&mut solid, r, h),
        "Pond" => {
            let rim = [
                [r, 0.0],
                [0.97 * r, 0.12],
                [0.88 * r, 0.12],
                [0.86 * r, 0.05],
            ];
            solid.lathe(&Paint::plain(STONE), [0.0; 3], &rim, 24);
            solid.lathe(&water(), [0.0; 3], &[[0.86 * r, 0.05], [0.0, 0.05]], 24);
        }
        "Playground" => playground(&mut solid, r, h),
        "Gazebo" => gazebo(&mut solid, object.radius, r, h),
        _ => return None,
    }
    Some(solid)
}

/// What the library has no shape for: a tree if it has a crown, else a block.
pub(super) fn unknown(object: &Object, colour: &str) -> Solid {
    let mut solid = Solid::default();
    if crate::picture::has_crown(object) {
        tree(&mut solid, object, colour);
    } else {
        let (r, h) = (object.radius, object.height.max(0.05));
        let line = [[r, 0.0], [r, 0.92 * h], [0.92 * r, h], [0.0, h]];
        solid.lathe(&Paint::plain(colour), [0.0; 3], &line, 12);
    }
    solid
}

fn water() -> Paint {
    Paint {
        name: Some("Water"),
        ..Paint::plain(WATER)
    }
}

fn trunk(solid: &mut Solid, radius: f64, height: f64) {
    let line = [
        [radius, 0.0],
        [0.6 * radius, 0.15 * height],
        [0.45 * radius, height],
        [0.0, height],
    ];
    solid.lathe(&Paint::plain(TRUNK), [0.0; 3], &line, 7);
}

/// A trunk, and a crown with smaller ones at its sides.
fn tree(solid: &mut Solid, object: &Object, leaves: &str) {
    let (r, h) = (object.spread, object.height);
    trunk(solid, object.radius, 0.5 * h);
    // The crown begins above one's head, but is no disc.
    let low = (0.28 * h).max(h - 2.6 * r);
    let (middle, half) = (0.5 * (low + h), 0.5 * (h - low));
    let dark = darker(leaves, 0.1);
    let light = lighter(leaves, 0.08);
    solid.leaves(&Paint::plain(leaves), [0.0, middle, 0.0], [0.82 * r, half]);
    for (k, (x, up, z)) in [(0.42, -0.2, 0.2), (-0.35, 0.05, 0.36), (-0.1, -0.12, -0.45)]
        .into_iter()
        .enumerate()
    {
        let paint = Paint::plain(if k == 1 { &light } else { &dark });
        solid.leaves(
            &paint,
            [x * r, middle + up * half, z * r],
            [0.55 * r, 0.6 * half],
        );
    }
}

/// A seat along z that faces x, its back behind it.
fn bench(solid: &mut Solid, r: f64, h: f64) {
    let (wood, seat) = (Paint::plain("#8a6a45"), 0.55 * h);
    solid.upright(
        &wood,
        [0.02 * r, seat - 0.05, 0.0],
        [0.26 * r, 0.92 * r],
        0.05,
    );
    solid.upright(
        &wood,
        [-0.24 * r, seat + 0.12, 0.0],
        [0.04 * r, 0.92 * r],
        h - seat - 0.12,
    );
    for side in [-0.75, 0.75] {
        let foot = [-0.02 * r, 0.0, side * r];
        solid.upright(&Paint::plain(METAL), foot, [0.22 * r, 0.05], seat - 0.05);
        let post = [-0.24 * r, seat - 0.05, side * r];
        solid.upright(&Paint::plain(METAL), post, [0.03, 0.03], 0.2);
    }
}

fn table(solid: &mut Solid, r: f64, h: f64) {
    let wood = Paint::plain("#a07f55");
    solid.upright(&wood, [0.0, h - 0.06, 0.0], [0.33 * r, 0.75 * r], 0.06);
    for side in [-1.0, 1.0] {
        let seat = [0.63 * r * side, 0.55 * h, 0.0];
        solid.upright(&wood, seat, [0.13 * r, 0.75 * r], 0.05);
        let foot = [0.0, 0.0, 0.5 * r * side];
        solid.upright(&Paint::plain(TRUNK), foot, [0.06, 0.06], h - 0.06);
        let beam = [0.0, 0.55 * h - 0.08, 0.5 * r * side];
        solid.upright(&Paint::plain(TRUNK), beam, [0.7 * r, 0.05], 0.08);
        for end in [-1.0, 1.0] {
            let post = [0.63 * r * end, 0.0, 0.5 * r * side];
            solid.upright(&Paint::plain(TRUNK), post, [0.05, 0.05], 0.55 * h - 0.08);
        }
    }
}

fn fountain(solid: &mut Solid, r: f64, h: f64) {
    let stone = Paint::plain(STONE);
    let basin = [[0.96 * r, 0.0], [r, 0.5], [0.84 * r, 0.5], [0.84 * r, 0.1]];
    solid.lathe(&stone, [0.0; 3], &basin, 24);
    solid.lathe(&water(), [0.0; 3], &[[0.84 * r, 0.38], [0.0, 0.38]], 24);
    let stem = [
        [0.14 * r, 0.3],
        [0.09 * r, 0.55 * h],
        [0.36 * r, 0.66 * h],
        [0.38 * r, 0.7 * h],
        [0.3 * r, 0.68 * h],
        [0.1 * r, 0.6 * h],
    ];
    solid.lathe(&stone, [0.0; 3], &stem, 16);
    solid.lathe(
        &water(),
        [0.0; 3],
        &[[0.32 * r, 0.67 * h], [0.0, 0.67 * h]],
        16,
    );
    let jet = [[0.05 * r, 0.66 * h], [0.03 * r, 0.9 * h], [0.0, h]];
    solid.lathe(&Paint::plain("#dcedf5"), [0.0; 3], &jet, 8);
}

fn statue(solid: &mut Solid, r: f64, h: f64) {
    let stone = Paint::plain(STONE);
    solid.upright(&stone, [0.0; 3], [0.7 * r, 0.7 * r], 0.08 * h);
    solid.upright(&stone, [0.0, 0.08 * h, 0.0], [0.5 * r, 0.5 * r], 0.3 * h);
    solid.upright(&stone, [0.0, 0.38 * h, 0.0], [0.6 * r, 0.6 * r], 0.04 * h);
    let figure = [
        [0.34 * r, 0.42],
        [0.28 * r, 0.55],
        [0.22 * r, 0.66],
        [0.32 * r, 0.8],
        [0.3 * r, 0.85],
        [0.1 * r, 0.88],
        [0.14 * r, 0.93],
        [0.1 * r, 0.98],
        [0.0, 1.0],
    ];
    let figure = figure.map(|[r, y]| [r, y * h]);
    solid.lathe(&Paint::plain("#8a8d88"), [0.0; 3], &figure, 10);
}

/// Sand, a tower with a slide, and a swing.
fn playground(solid: &mut Solid, r: f64, h: f64) {
    let sand = Paint::plain("#ead9ae");
    solid.lathe(
        &sand,
        [0.0; 3],
        &[[r, 0.0], [0.98 * r, 0.06], [0.0, 0.06]],
        24,
    );
    let (red, blue) = (Paint::plain("#c65a4a"), Paint::plain("#5b8fb9"));
    let tower = [-0.35 * r, 0.06, -0.35 * r];
    let deck = 0.5 * h;
    for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)] {
        let foot = [tower[0] + 0.16 * r * x, 0.06, tower[2] + 0.16 * r * z];
        solid.upright(&Paint::plain(TRUNK), foot, [0.06, 0.06], 0.75 * h);
    }
    solid.upright(&blue, [tower[0], deck, tower[2]], [0.2 * r, 0.2 * r], 0.08);
    let roof = [[0.0, 0.76 * h], [0.3 * r, 0.76 * h], [0.0, h]];
    solid.lathe(&red, [tower[0], 0.0, tower[2]], &roof, 4);
    // The slide leads from the tower's deck to the sand.
    let (from, to) = (tower[0] + 0.2 * r, 0.45 * r);
    let at = |x: f64, y: f64, z: f64| [x, y, tower[2] + z * r];
    let slide = Paint {
        thin: true,
        ..Paint::plain("#e0936a")
    };
    solid.quad(
        &slide,
        [
            at(from, deck, 0.1),
            at(to, 0.12, 0.1),
            at(to, 0.12, -0.1),
            at(from, deck, -0.1),
        ],
    );
    // The swing.
    for x in [-0.35, 0.35] {
        let post = [x * r, 0.06, 0.45 * r];
        solid.upright(&Paint::plain(METAL), post, [0.05, 0.05], 0.85 * h);
    }
    let beam = [0.0, 0.86 * h, 0.45 * r];
    solid.upright(&Paint::plain(METAL), beam, [0.36 * r, 0.05], 0.08);
    for x in [-0.15, 0.15] {
        solid.upright(&red, [x * r, 0.45, 0.45 * r], [0.06 * r, 0.12], 0.05);
        for side in [-0.05, 0.05] {
            let rope = [(x + side) * r, 0.45, 0.45 * r];
            solid.upright(&Paint::plain(METAL), rope, [0.012, 0.012], 0.86 * h - 0.45);
        }
    }
}

/// Eight posts under a roof.
fn gazebo(solid: &mut Solid, foot: f64, r: f64, h: f64) {
    let wood = Paint::plain("#a67d4d");
    let floor = [[foot, 0.0], [foot, 0.15], [0.0, 0.15]];
    solid.lathe(&Paint::plain("#c9a779"), [0.0; 3], &floor, 8);
    for k in 0..8 {
        let angle = std::f64::consts::TAU * f64::from(k) / 8.0;
        let post = [0.9 * foot * angle.cos(), 0.15, 0.9 * foot * angle.sin()];
        solid.upright(&wood, post, [0.07, 0.07], 0.68 * h - 0.15);
    }
    let roof = [
        [0.0, 0.64 * h],
        [r, 0.66 * h],
        [0.12 * r, 0.97 * h],
        [0.0, h],
    ];
    solid.lathe(&Paint::plain("#8a5a3c"), [0.0; 3], &roof, 8);
}
