//! The textures of materials, as patterns.

use std::fmt::Write as _;

use super::colour::{darker, lighter};
use super::pen::dot;

/// A pattern: the side of its square tile in centimetres, and what is drawn in
/// that.
pub(super) struct Texture {
    pub(super) size: [i64; 2],
    pub(super) elements: String,
}

/// The texture of a material of some colour; `None` for plain ones.
pub(super) fn texture(material: &str, colour: &str) -> Option<Texture> {
    let square = |size: i64, elements: String| {
        Some(Texture {
            size: [size, size],
            elements,
        })
    };
    match material {
        "Lawn" | "GREEN_GRASS" | "BLUE_GRASS" | "GrassPath" => square(900, tufts(900, 16, colour)),
        "Meadow" => {
            let mut elements = tufts(800, 20, colour);
            let bloom = ["#fdf6c9", "#f2d86b", "#ffffff", "#d9b3d1"];
            dots(&mut elements, 800, 26, [9, 13], &bloom);
            square(800, elements)
        }
        "FlowerBed" => {
            let mut elements = String::new();
            dots(&mut elements, 320, 26, [17, 27], &["#8fb56c", "#7da85e"]);
            let bloom = ["#d76f93", "#f0c65c", "#f7f1ec", "#c9526f", "#e79ab4"];
            dots(&mut elements, 320, 30, [11, 19], &bloom);
            square(320, elements)
        }
        "ShrubBed" | "Planting" => {
            let mut elements = String::new();
            let leaves = [
                darker(colour, 0.18),
                darker(colour, 0.1),
                lighter(colour, 0.12),
            ];
            dots(
                &mut elements,
                420,
                22,
                [34, 62],
                &leaves.each_ref().map(String::as_str),
            );
            square(420, elements)
        }
        "Soil" | "Sand" | "Gravel" => {
            let mut elements = String::new();
            let grains = [darker(colour, 0.16), lighter(colour, 0.4)];
            dots(
                &mut elements,
                260,
                30,
                [3, 6],
                &grains.each_ref().map(String::as_str),
            );
            square(260, elements)
        }
        "Paving" => Some(Texture {
            size: [120, 120],
            elements: lines("M0 30h120M0 90h120M30 30v60M90 90v30M90 0v30", colour, 3),
        }),
        "StonePath" => Some(Texture {
            size: [300, 240],
            elements: lines(
                "M0 40h300M0 120h300M0 190h300M60 40v80M150 40v80M230 40v80M20 120v70M110 120v70M200 120v70M265 120v70M80 190v50M175 190v50M250 190v50M80 0v40M175 0v40M250 0v40",
                colour,
                4,
            ),
        }),
        "CementPath" => Some(Texture {
            size: [300, 300],
            elements: lines("M0 150h300M150 0v300", colour, 3),
        }),
        "Deck" => Some(Texture {
            size: [240, 40],
            elements: lines("M0 0h240M70 0v20M190 20v20M0 20h240", colour, 4),
        }),
        "Water" => Some(Texture {
            size: [1100, 640],
            elements: format!(
                "<path d=\"M90 170q70-50 140 0t140 0M610 480q70-50 140 0t140 0\" fill=\"none\" stroke=\"{}\" stroke-width=\"14\" stroke-linecap=\"round\"/>",
                lighter(colour, 0.45)
            ),
        }),
        _ => None,
    }
}

/// Blades of grass.
fn tufts(size: i64, count: u32, colour: &str) -> String {
    let mut data = String::new();
    for k in 0..count {
        let [x, y] = spread(size - 60, k, count).map(|at| at + 30);
        let _ = write!(data, "M{} {y}l-7-24m15 24v-30m15 30l7-24", x - 15);
    }
    format!(
        "<path d=\"{data}\" fill=\"none\" stroke=\"{}\" stroke-width=\"6\" stroke-linecap=\"round\"/>",
        darker(colour, 0.17)
    )
}

/// Dots of several colours and sizes, over the edges of the tile too.
fn dots(elements: &mut String, size: i64, count: u32, radii: [i64; 2], colours: &[&str]) {
    for (c, colour) in colours.iter().enumerate() {
        let mut data = String::new();
        for k in (0..count).filter(|k| *k as usize % colours.len() == c) {
            let [x, y] = spread(size, k, count);
            let r = radii[0] + (radii[1] - radii[0]) * i64::from(k * 7 % 5) / 4;
            let around = |at: i64| {
                let mut all = vec![at];
                if at < r {
                    all.push(at + size);
                }
                if at > size - r {
                    all.push(at - size);
                }
                all
            };
            for x in around(x) {
                for y in around(y) {
                    dot(&mut data, [x, y], r);
                }
            }
        }
        let _ = write!(elements, "<path d=\"{data}\" fill=\"{colour}\"/>");
    }
}

fn lines(data: &str, colour: &str, width: u32) -> String {
    format!(
        "<path d=\"{data}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\"/>",
        darker(colour, 0.16)
    )
}

/// The k-th of `count` points spread over a tile: one in each square of a grid,
/// anywhere within that.
fn spread(size: i64, k: u32, count: u32) -> [i64; 2] {
    let across = f64::from(count).sqrt().ceil() as u32;
    let cell = size as f64 / f64::from(across);
    // Two numbers from 0 to 1 that look like chance (Weyl's sequence, stirred).
    let stirred = |salt: u32| {
        let mut x = (k + 1).wrapping_mul(0x9e37_79b9) ^ salt;
        x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
        x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
        f64::from(x ^ (x >> 16)) / f64::from(u32::MAX)
    };
    let place = |square: u32, salt: u32| ((f64::from(square) + stirred(salt)) * cell) as i64;
    [place(k % across, 0x51), place(k / across % across, 0xa7)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_material_but_asphalt_has_a_texture() {
        for material in crate::library::MATERIALS {
            let found = texture(material.name, material.colour);
            assert_eq!(
                found.is_none(),
                material.name == "Asphalt",
                "{}",
                material.name
            );
        }
    }
}
