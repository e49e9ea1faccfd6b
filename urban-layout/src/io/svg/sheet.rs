//! What stands around the plan: title, figures, legend, scale bar, north arrow.

use super::canvas::{Anchor, Canvas, Lettering, PathData};
use super::font;
use super::map::shade;
use super::palette::{land, LAND, SHADES, STREETS};
use crate::layout::plane::polygon_area;
use crate::layout::{Layout, TileKind};
use crate::metrics::Metrics;

use geo_types::Coord;

const INK: &str = "#3a3428";
const SOFT: &str = "#857b68";

const fn style(cap: f64, weight: f64, colour: &'static str, anchor: Anchor) -> Lettering {
    Lettering {
        cap,
        weight,
        colour,
        anchor,
    }
}

const HEAD: Lettering = style(225.0, 0.17, INK, Anchor::Left);
const BODY: Lettering = style(205.0, 0.11, INK, Anchor::Left);
const FIGURE: Lettering = style(205.0, 0.13, INK, Anchor::Right);
const NOTE: Lettering = style(155.0, 0.11, SOFT, Anchor::Left);

/// Distance between lines of text, sheet units.
const LEADING: f64 = 410.0;

/// A whole number in groups of three digits.
pub(super) fn grouped(value: f64) -> String {
    let digits = format!("{:.0}", value.abs());
    let mut out = String::from(if value < -0.5 { "-" } else { "" });
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i) % 3 == 0 {
            out.push('\u{2009}');
        }
        out.push(c);
    }
    out
}

/// A site's name as a title: `kotka_fields` is Kotka Fields.
pub(super) fn title_of(name: &str) -> String {
    if !name.contains('_') {
        return name.to_owned();
    }
    let word = |word: &str| {
        let mut letters = word.chars();
        letters.next().map_or_else(String::new, |first| {
            first.to_uppercase().chain(letters).collect()
        })
    };
    name.split('_')
        .filter(|w| !w.is_empty())
        .map(word)
        .collect::<Vec<_>>()
        .join(" ")
}

/// Title and subtitle; the y below them.
pub(super) fn title(
    canvas: &mut Canvas,
    title: &str,
    subtitle: &str,
    x: f64,
    y: f64,
    room: f64,
) -> f64 {
    // A long name is set smaller rather than cut.
    let cap = (520.0 * room / font::width(title, 520.0).max(room)).max(200.0);
    canvas.text(title, x, y + cap, style(cap, 0.13, INK, Anchor::Left));
    canvas.text(
        subtitle,
        x,
        y + cap + 420.0,
        style(185.0, 0.11, SOFT, Anchor::Left),
    );
    y + cap + 800.0
}

/// Key figures as a table; the y below it.
pub(super) fn figures(canvas: &mut Canvas, m: &Metrics, x: f64, y: f64, room: f64) -> f64 {
    let share = |part: usize| {
        if m.parcels > 0 {
            100.0 * part as f64 / m.parcels as f64
        } else {
            0.0
        }
    };
    let rows = [
        ("Site", format!("{:.2} km\u{b2}", m.site_km2)),
        ("Parcels", grouped(m.parcels as f64)),
        ("Parcels per km\u{b2}", grouped(m.p_n)),
        ("Blocks per km\u{b2}", format!("{:.0}", m.b_n)),
        ("Streets per km\u{b2}", format!("{:.1} km", m.s_l)),
        ("Corner deviation", format!("{:.1}\u{b0}", m.p_angle)),
        ("Box / area", format!("{:.3}", m.p_area)),
        (
            "Undesirable parcels",
            format!("{:.1} %", share(m.undesirable)),
        ),
        ("Seed", m.seed.to_string()),
    ];
    let mut at = y + HEAD.cap;
    canvas.text("Key figures", x, at, HEAD);
    for (label, value) in rows {
        at += LEADING;
        canvas.text(label, x, at, BODY);
        canvas.text(&value, x + room, at, FIGURE);
        canvas.path(
            &format!("M{x:.0} {:.0}h{room:.0}", at + 110.0),
            "fill=\"none\" stroke=\"#ddd6c6\" stroke-width=\"8\"",
        );
    }
    at + LEADING
}

/// The land by use as one bar with its shares; the y below it.
pub(super) fn land_use(
    canvas: &mut Canvas,
    layout: &Layout,
    m: &Metrics,
    x: f64,
    y: f64,
    room: f64,
) -> f64 {
    canvas.text("Land use", x, y + HEAD.cap, HEAD);
    let top = y + HEAD.cap + 180.0;
    let site = m.site_km2 * 1e6;
    let parts = [
        ("Parcels", SHADES[1].fill, m.l_r),
        ("Streets", "#fffdf8", m.l_s),
        ("Parks", land(TileKind::Park).fill, m.l_p),
        (
            "Water",
            land(TileKind::Lake).fill,
            100.0 * layout.area_of(TileKind::Lake) / site,
        ),
    ];
    let named: f64 = parts.iter().map(|part| part.2).sum();
    let rest = [("Other", land(TileKind::Other).fill, 100.0 - named)];
    let mut left = x;
    let mut at = top + 420.0 + LEADING * 0.92;
    for (word, fill, percent) in parts.into_iter().chain(rest).filter(|part| part.2 > 0.05) {
        let wide = room * percent / 100.0;
        canvas.rect(
            left,
            top,
            wide,
            420.0,
            &format!("fill=\"{fill}\" stroke=\"#8f856f\" stroke-width=\"12\""),
        );
        left += wide;
        canvas.rect(
            x,
            at - 170.0,
            260.0,
            190.0,
            &format!("fill=\"{fill}\" stroke=\"#8f856f\" stroke-width=\"10\""),
        );
        canvas.text(word, x + 460.0, at, BODY);
        canvas.text(&format!("{percent:.1} %"), x + room, at, FIGURE);
        at += LEADING * 0.92;
    }
    at + 100.0
}

/// How many parcels have which size, in steps of 100 m2; the y below it.
pub(super) fn histogram(canvas: &mut Canvas, layout: &Layout, x: f64, y: f64, room: f64) -> f64 {
    const STEP: f64 = 100.0;
    const BARS: usize = 16;
    let mut bars = [0_usize; BARS];
    for tile in layout.parcels() {
        let bar = (polygon_area(&tile.polygon) / STEP).max(0.0) as usize;
        bars[bar.min(BARS - 1)] += 1;
    }
    let most = bars.iter().copied().max().unwrap_or(0);
    if most == 0 {
        return y;
    }
    canvas.text("Parcel areas", x, y + HEAD.cap, HEAD);
    let (top, tall) = (y + HEAD.cap + 150.0, 900.0);
    let wide = room / BARS as f64;
    let mut data = PathData::default();
    for (i, count) in bars.iter().enumerate().filter(|(_, count)| **count > 0) {
        let high = tall * *count as f64 / most as f64;
        let (left, right) = (x + i as f64 * wide + 20.0, x + (i + 1) as f64 * wide - 20.0);
        let corners = [
            (left, top + tall),
            (left, top + tall - high),
            (right, top + tall - high),
            (right, top + tall),
        ];
        data.line(corners.map(|(x, y)| Coord { x, y }), true);
    }
    canvas.path(
        &data.0,
        "fill=\"#dcbf82\" stroke=\"#a3926b\" stroke-width=\"8\"",
    );
    canvas.path(
        &format!("M{x:.0} {:.0}h{room:.0}", top + tall),
        "fill=\"none\" stroke=\"#857b68\" stroke-width=\"12\"",
    );
    let base = top + tall + 250.0;
    for k in [0, 5, 10, 15] {
        let at = x + k as f64 * wide;
        let anchor = if k == 0 { Anchor::Left } else { Anchor::Middle };
        let words = if k == 15 {
            "1500 m\u{b2}".to_owned()
        } else {
            (k * 100).to_string()
        };
        canvas.text(&words, at, base, Lettering { anchor, ..NOTE });
    }
    base + 330.0
}

/// What colours and lines mean, only what the plan has; the y below it.
pub(super) fn legend(canvas: &mut Canvas, layout: &Layout, x: f64, y: f64, room: f64) -> f64 {
    let mut at = y + HEAD.cap;
    canvas.text("Parcels: corners, box / area", x, at, HEAD);
    let step = LEADING * 0.92;
    let shades: Vec<usize> = layout.parcels().map(shade).collect();
    for (number, style) in SHADES.iter().enumerate() {
        at += step;
        swatch(canvas, x, at, style.fill, "#a3926b", None);
        canvas.text(style.words, x + 520.0, at, BODY);
        let count = shades.iter().filter(|s| **s == number).count();
        canvas.text(
            &grouped(count as f64),
            x + room,
            at,
            Lettering {
                colour: SOFT,
                ..FIGURE
            },
        );
    }
    at += LEADING * 1.35;
    canvas.text("Land and streets", x, at, HEAD);
    for style in LAND
        .iter()
        .filter(|style| layout.tiles_of(style.kind).next().is_some())
    {
        at += step;
        let edge = if style.edge.is_empty() {
            "#7d7360"
        } else {
            style.edge
        };
        swatch(canvas, x, at, style.fill, edge, style.pattern);
        canvas.text(style.words, x + 520.0, at, BODY);
    }
    if layout.streets.iter().any(|s| s.given) {
        at += step;
        swatch(canvas, x, at, "#d8cfbd", "#7d7360", None);
        canvas.text("Given roads", x + 520.0, at, BODY);
    }
    for style in STREETS
        .iter()
        .filter(|style| layout.streets.iter().any(|s| s.class == style.class))
    {
        at += step;
        canvas.path(
            &format!("M{x:.0} {:.0}h400", at - 80.0),
            &format!("fill=\"none\" {}", style.stroke),
        );
        canvas.text(style.words, x + 520.0, at, BODY);
    }
    at += step;
    canvas.path(
        &format!("M{x:.0} {:.0}h400", at - 80.0),
        "fill=\"none\" stroke=\"#a8402d\" stroke-width=\"42\" stroke-dasharray=\"170 60 50 60\"",
    );
    canvas.text("Site boundary", x + 520.0, at, BODY);
    at + LEADING
}

fn swatch(canvas: &mut Canvas, x: f64, y: f64, fill: &str, edge: &str, pattern: Option<&str>) {
    canvas.rect(
        x,
        y - 185.0,
        400.0,
        220.0,
        &format!("fill=\"{fill}\" stroke=\"{edge}\" stroke-width=\"12\""),
    );
    if let Some(pattern) = pattern {
        canvas.rect(
            x,
            y - 185.0,
            400.0,
            220.0,
            &format!("fill=\"url(#{pattern})\""),
        );
    }
}

/// A bar of a round length with its scale; the y below it.
pub(super) fn scale_bar(
    canvas: &mut Canvas,
    units_per_metre: f64,
    x: f64,
    y: f64,
    room: f64,
) -> f64 {
    let metres = round_below(0.86 * room / units_per_metre);
    let wide = metres * units_per_metre;
    for k in 0..4 {
        let fill = if k % 2 == 0 { INK } else { "#fffdf8" };
        canvas.rect(
            x + wide * f64::from(k) / 4.0,
            y + 330.0,
            wide / 4.0,
            110.0,
            &format!("fill=\"{fill}\" stroke=\"{INK}\" stroke-width=\"12\""),
        );
    }
    let length = |m: f64| {
        if m >= 1000.0 && m % 500.0 == 0.0 {
            format!("{} km", m / 1000.0)
        } else {
            format!("{m} m")
        }
    };
    canvas.text("0", x, y + 230.0, NOTE);
    for (part, anchor) in [(0.5, Anchor::Middle), (1.0, Anchor::Middle)] {
        canvas.text(
            &length(metres * part),
            x + wide * part,
            y + 230.0,
            Lettering { anchor, ..NOTE },
        );
    }
    let denominator = 100_000.0 / units_per_metre;
    let words = format!("1 : {}", grouped(denominator));
    canvas.text(&words, x, y + 800.0, BODY);
    y + 800.0 + LEADING
}

/// The greatest of a few round numbers times a power of ten that is not above `value`.
pub(super) fn round_below(value: f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return 1.0;
    }
    let power = 10_f64.powf(value.log10().floor());
    [10.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.5, 1.0]
        .into_iter()
        .map(|k| k * power)
        .find(|v| *v <= value * (1.0 + 1e-9))
        .unwrap_or(power)
}

/// An arrow towards north (the sheet's top), its tip at (x, y).
pub(super) fn north(canvas: &mut Canvas, x: f64, y: f64) {
    canvas.path(
        &format!("M{x:.0} {y:.0}l330 1050-330-230z"),
        &format!("fill=\"{INK}\" stroke=\"{INK}\" stroke-width=\"20\" stroke-linejoin=\"round\""),
    );
    canvas.path(
        &format!("M{x:.0} {y:.0}l-330 1050 330-230z"),
        &format!("fill=\"#fffdf8\" stroke=\"{INK}\" stroke-width=\"20\" stroke-linejoin=\"round\""),
    );
    canvas.text("N", x, y + 1480.0, style(300.0, 0.14, INK, Anchor::Middle));
}

/// The last line: what made the plan, and whose data it shows.
pub(super) fn imprint(canvas: &mut Canvas, attribution: Option<&str>, x: f64, y: f64, room: f64) {
    let mut at = y;
    let lines = attribution
        .map(|text| wrapped(text, NOTE.cap, room))
        .unwrap_or_default();
    for line in lines.iter().rev() {
        canvas.text(line, x, at, NOTE);
        at -= 240.0;
    }
    canvas.text("Drawn by urban-layout", x, at, NOTE);
}

/// A text in lines no wider than `room`, broken at spaces.
fn wrapped(text: &str, cap: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if font::width(&format!("{line} {word}"), cap) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_names_are_set_well() {
        assert_eq!(grouped(1234567.0), "1\u{2009}234\u{2009}567");
        assert_eq!(grouped(999.0), "999");
        assert_eq!(title_of("kotka_fields"), "Kotka Fields");
        assert_eq!(title_of("Tengah"), "Tengah");
    }

    #[test]
    fn bars_have_round_lengths() {
        assert_eq!(round_below(437.0), 400.0);
        assert_eq!(round_below(187.0), 150.0);
        assert_eq!(round_below(1000.0), 1000.0);
        assert_eq!(round_below(0.07), 0.06);
        assert_eq!(round_below(f64::NAN), 1.0);
    }
}
