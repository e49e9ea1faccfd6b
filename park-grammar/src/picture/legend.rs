//! What a park has, for the legend of its plan.

use super::colour::darker;
use super::ground::{colour_of, pattern};
use super::pen::Pen;
use super::standing::{self, leaves, light, symbol};
use crate::plane::Area;
use crate::scene::{Ground, Scene};

/// A line of a legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// Elements in a box of [`WIDTH`] by [`HEIGHT`] from (0, 0) on.
    pub(super) swatch: String,
    pub(super) words: String,
    pub(super) value: String,
}

/// The box of a swatch, sheet units.
pub(super) const WIDTH: f64 = 520.0;
pub(super) const HEIGHT: f64 = 300.0;

/// How much smaller textures are in swatches than on the ground: one unit of a
/// texture is a centimetre.
const GRAIN: f64 = 0.55;

/// Ground by its share of the park, then volumes and objects, each in the order
/// in which the scene has them. Definitions that swatches need go to the pen.
pub(super) fn entries(pen: &mut Pen, scene: &Scene) -> Vec<Entry> {
    let mut found = Vec::new();
    let areas: Vec<f64> = scene
        .pieces
        .iter()
        .map(|p| Area::from_polygon(&p.polygon).size())
        .collect();
    let whole: f64 = areas.iter().sum();
    let mut materials: Vec<(&str, Ground, f64)> = Vec::new();
    for (piece, area) in scene.pieces.iter().zip(areas) {
        match materials.iter_mut().find(|m| m.0 == piece.material) {
            Some(known) => known.2 += area,
            None => materials.push((&piece.material, piece.ground, area)),
        }
    }
    materials.sort_by(|a, b| b.2.total_cmp(&a.2));
    for ground in [Ground::Region, Ground::Path] {
        for (material, _, area) in materials.iter().filter(|m| m.1 == ground) {
            let colour = colour_of(material);
            let mut swatch = block(colour, &darker(colour, 0.35));
            if let Some(id) = pattern(pen, material) {
                swatch.push_str(&over(&id));
            }
            found.push(Entry {
                swatch,
                words: words(material),
                value: share(100.0 * area / whole),
            });
        }
    }
    for (name, count) in counted(scene.volumes.iter().map(|v| v.name.as_str())) {
        let colour = standing::colour_of(name);
        let mut swatch = block(colour, &darker(colour, 0.4));
        if let Some(id) = leaves(pen, name) {
            swatch.push_str(&over(&id));
        }
        found.push(Entry {
            swatch,
            words: words(name),
            value: count.to_string(),
        });
    }
    let light = light(pen);
    for (name, count) in counted(scene.objects.iter().map(|o| o.name.as_str())) {
        let id = symbol(pen, scene, name);
        let at = format!("translate({:.0} {:.0})", WIDTH / 2.0, HEIGHT / 2.0);
        let size = 0.62 * HEIGHT;
        let mut swatch = format!("<use href=\"#{id}\" transform=\"{at}scale({size:.0})\"/>");
        let object = scene.objects.iter().find(|o| o.name == name);
        if object.is_some_and(standing::has_crown) {
            swatch.push_str(&format!(
                "<use href=\"#{light}\" transform=\"{at}scale({size:.0})\"/>"
            ));
        }
        found.push(Entry {
            swatch,
            words: words(name),
            value: count.to_string(),
        });
    }
    found
}

fn block(fill: &str, edge: &str) -> String {
    format!(
        "<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"{fill}\" stroke=\"{edge}\" stroke-width=\"12\"/>"
    )
}

fn over(id: &str) -> String {
    format!(
        "<g transform=\"scale({GRAIN})\"><rect width=\"{:.0}\" height=\"{:.0}\" fill=\"url(#{id})\"/></g>",
        WIDTH / GRAIN,
        HEIGHT / GRAIN
    )
}

fn share(percent: f64) -> String {
    if percent < 0.95 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.0} %")
    }
}

/// Names with how often they come, in the order of their first time.
fn counted<'n>(names: impl Iterator<Item = &'n str>) -> Vec<(&'n str, usize)> {
    let mut found: Vec<(&str, usize)> = Vec::new();
    for name in names {
        match found.iter_mut().find(|(known, _)| *known == name) {
            Some((_, count)) => *count += 1,
            None => found.push((name, 1)),
        }
    }
    found
}

/// A name as words: `TallTree` is Tall tree, `GREEN_GRASS` Green grass.
pub(super) fn words(name: &str) -> String {
    let mut out = String::new();
    let mut small = false;
    for c in name.chars() {
        if c == '_' {
            out.push(' ');
        } else if c.is_uppercase() && small {
            out.push(' ');
            out.extend(c.to_lowercase());
        } else if out.is_empty() {
            out.extend(c.to_uppercase());
        } else {
            out.extend(c.to_lowercase());
        }
        small = c.is_lowercase();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_words() {
        assert_eq!(words("TallTree"), "Tall tree");
        assert_eq!(words("GREEN_GRASS"), "Green grass");
        assert_eq!(words("oak"), "Oak");
        assert_eq!(counted(["a", "b", "a"].into_iter()), [("a", 2), ("b", 1)]);
        assert_eq!(
            (share(0.24), share(12.6)),
            ("0.2 %".to_owned(), "13 %".to_owned())
        );
    }
}
