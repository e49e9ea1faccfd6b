//! The ground: regions and paths with what they are made of.

use super::colour::{darker, lighter};
use super::pen::Pen;
use super::texture::texture;
use crate::library;
use crate::plane::{signed_area, union, Area};
use crate::scene::{Ground, Piece, Scene};

/// The colour of ground whose material is none of the library's.
const BARE: &str = "#d8d4c8";

/// How far the soft rim of a region reaches into it, units.
const RIM: f64 = 70.0;

/// A hole of the park is larger, square metres.
const CRACK: f64 = 1e-3;

/// The colour of a material.
pub(super) fn colour_of(material: &str) -> &'static str {
    library::material_named(material).map_or(BARE, |m| m.colour)
}

pub(super) fn draw(pen: &mut Pen, scene: &Scene) {
    let of = |ground: Ground| scene.pieces.iter().filter(move |p| p.ground == ground);
    // The outer half of a line around all pieces is left by what they cover: the
    // park's outline.
    let all: String = scene
        .pieces
        .iter()
        .map(|piece| pen.polygon(&piece.polygon))
        .collect();
    pen.path(
        &all,
        &format!(
            "fill=\"none\" stroke=\"#57604a\" stroke-width=\"{:.0}\" stroke-linejoin=\"round\"",
            4.0 * pen.line
        ),
    );
    // Rims and kerbs lie half outside of their pieces; not outside of the park.
    let areas: Vec<Area> = scene
        .pieces
        .iter()
        .map(|piece| Area::from_polygon(&piece.polygon))
        .collect();
    let mut whole = union(&areas);
    for area in &mut whole {
        // Cracks between pieces that differ by rounding are no holes.
        area.holes.retain(|hole| signed_area(hole) > CRACK);
    }
    let whole: String = whole
        .iter()
        .map(|area| pen.polygon(&area.to_polygon()))
        .collect();
    let clip = pen.clip(&whole);
    pen.raw(&format!(
        "<g clip-path=\"url(#{clip})\" fill-rule=\"evenodd\" stroke-linejoin=\"round\">\n"
    ));
    fills(pen, of(Ground::Region));
    let rims: String = of(Ground::Region)
        .map(|piece| pen.polygon(&piece.polygon))
        .collect();
    pen.path(
        &rims,
        &format!(
            "fill=\"none\" stroke=\"#2f4a1c\" stroke-opacity=\".09\" stroke-width=\"{:.0}\"",
            2.0 * RIM
        ),
    );
    pen.path(
        &rims,
        &format!(
            "fill=\"none\" stroke=\"#3c5226\" stroke-opacity=\".28\" stroke-width=\"{:.0}\"",
            pen.line
        ),
    );
    for piece in of(Ground::Region).filter(|p| p.material == "Water") {
        banks(pen, piece);
    }
    // All kerbs first, then all surfaces: paths that meet are open to each other.
    let paths: Vec<&Piece> = of(Ground::Path).collect();
    let kerbs: String = paths.iter().map(|p| pen.polygon(&p.polygon)).collect();
    for (width, colour, opacity) in [(40.0, "#4a4630", 0.16), (18.0, "#7d7357", 0.9)] {
        pen.path(
            &kerbs,
            &format!(
                "fill=\"none\" stroke=\"{colour}\" stroke-opacity=\"{opacity}\" stroke-width=\"{:.0}\"",
                2.0 * f64::max(width * 0.5, pen.line * width / 18.0 * 0.6)
            ),
        );
    }
    fills(pen, paths.into_iter());
    pen.raw("</g>\n");
}

/// Pieces, those of one material together.
fn fills<'p>(pen: &mut Pen, pieces: impl Iterator<Item = &'p Piece>) {
    let mut materials: Vec<(&str, String)> = Vec::new();
    for piece in pieces {
        let data = pen.polygon(&piece.polygon);
        match materials.iter_mut().find(|(m, _)| *m == piece.material) {
            Some((_, all)) => all.push_str(&data),
            None => materials.push((&piece.material, data)),
        }
    }
    for (material, data) in materials {
        let colour = colour_of(material);
        // A hair wider than it is, so that nothing shines through between two.
        pen.path(
            &data,
            &format!("fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\"4\""),
        );
        if let Some(id) = pattern(pen, material) {
            pen.path(&data, &format!("fill=\"url(#{id})\""));
        }
    }
}

/// The id of a material's pattern, if it has one.
pub(super) fn pattern(pen: &mut Pen, material: &str) -> Option<String> {
    let found = texture(material, colour_of(material))?;
    Some(pen.define(&format!("on-{material}"), |id| {
        let [width, height] = found.size;
        format!(
            "<pattern id=\"{id}\" width=\"{width}\" height=\"{height}\" patternUnits=\"userSpaceOnUse\">{}</pattern>\n",
            found.elements
        )
    }))
}

/// The banks of water: a dark line at its edge and a light one further in.
fn banks(pen: &mut Pen, piece: &Piece) {
    let data = pen.polygon(&piece.polygon);
    let clip = pen.clip(&data);
    let colour = colour_of("Water");
    pen.raw(&format!("<g clip-path=\"url(#{clip})\" fill=\"none\">\n"));
    for (width, stroke) in [
        (190.0, lighter(colour, 0.35)),
        (150.0, colour.to_owned()),
        (90.0, darker(colour, 0.1)),
        (36.0, darker(colour, 0.35)),
    ] {
        pen.path(
            &data,
            &format!("stroke=\"{stroke}\" stroke-width=\"{width}\""),
        );
    }
    pen.raw("</g>\n");
}
