//! Lettering drawn as lines, so that no label depends on a machine's fonts.
//!
//! One pen stroke a glyph part, as on a drawing board. A glyph is a path in a
//! box whose baseline is y = 0, whose capitals reach y = -10 and small letters
//! y = -7 (y downwards, as in SVG). Commands: `M x y` moves, `L x y` draws a
//! line, `Q cx cy x y` a quarter of an ellipse towards the corner (cx, cy).

use std::fmt::Write as _;

/// Height of the capitals in the units of the glyphs.
pub(super) const CAP: f64 = 10.0;
/// Space between two glyphs.
const GAP: f64 = 2.3;
/// Width of a space.
const SPACE: f64 = 3.4;

/// How far the elliptic arcs' handles reach towards the corner.
const ARC: f64 = 0.552_284_75;

/// Character, width, path.
const GLYPHS: &[(char, f64, &str)] = &[
    ('A', 8.0, "M0 0L4-10L8 0M1.4-3.5L6.6-3.5"),
    ('B', 6.6, "M0 0L0-10L3.8-10Q6.2-10 6.2-7.6Q6.2-5.2 3.8-5.2L0-5.2M3.8-5.2Q6.6-5.2 6.6-2.6Q6.6 0 3.8 0L0 0"),
    ('C', 7.5, "M7.5-8Q6.7-10 4.3-10Q0-10 0-5Q0 0 4.3 0Q6.7 0 7.5-2"),
    ('D', 7.6, "M0 0L0-10L3-10Q7.6-10 7.6-5Q7.6 0 3 0L0 0"),
    ('E', 5.8, "M5.8-10L0-10L0 0L5.8 0M0-5.2L5-5.2"),
    ('F', 5.6, "M5.6-10L0-10L0 0M0-5.2L4.8-5.2"),
    ('G', 8.0, "M7.5-8.2Q6.7-10 4.3-10Q0-10 0-5Q0 0 4.3 0Q8 0 8-4L8-4.6L4.8-4.6"),
    ('H', 7.2, "M0 0L0-10M7.2 0L7.2-10M0-5.2L7.2-5.2"),
    ('I', 0.0, "M0 0L0-10"),
    ('J', 4.4, "M4.4-10L4.4-2.6Q4.4 0 2.2 0Q0 0 0-2.4"),
    ('K', 6.8, "M0 0L0-10M6.6-10L0-4.2M2.3-6.2L6.8 0"),
    ('L', 5.4, "M0-10L0 0L5.4 0"),
    ('M', 8.6, "M0 0L0-10L4.3-2.5L8.6-10L8.6 0"),
    ('N', 7.2, "M0 0L0-10L7.2 0L7.2-10"),
    ('O', 8.6, "M4.3-10Q0-10 0-5Q0 0 4.3 0Q8.6 0 8.6-5Q8.6-10 4.3-10"),
    ('P', 6.4, "M0 0L0-10L3.6-10Q6.4-10 6.4-7.2Q6.4-4.4 3.6-4.4L0-4.4"),
    ('Q', 8.6, "M4.3-10Q0-10 0-5Q0 0 4.3 0Q8.6 0 8.6-5Q8.6-10 4.3-10M5.4-2.6L8.4 0.6"),
    ('R', 6.6, "M0 0L0-10L3.6-10Q6.4-10 6.4-7.2Q6.4-4.4 3.6-4.4L0-4.4M3.4-4.4L6.6 0"),
    ('S', 6.4, "M6-8.1Q5.4-10 3.2-10Q0.4-10 0.4-7.6Q0.4-5.7 3.2-5.2Q6.4-4.6 6.4-2.6Q6.4 0 3.3 0Q0.7 0 0-2"),
    ('T', 6.8, "M0-10L6.8-10M3.4-10L3.4 0"),
    ('U', 7.2, "M0-10L0-3.6Q0 0 3.6 0Q7.2 0 7.2-3.6L7.2-10"),
    ('V', 7.8, "M0-10L3.9 0L7.8-10"),
    ('W', 11.4, "M0-10L2.9 0L5.7-9L8.5 0L11.4-10"),
    ('X', 6.8, "M0-10L6.8 0M6.8-10L0 0"),
    ('Y', 7.4, "M0-10L3.7-5L7.4-10M3.7-5L3.7 0"),
    ('Z', 6.6, "M0-10L6.5-10L0 0L6.6 0"),
    ('a', 5.4, "M5.4-7L5.4 0M5.4-3.5Q5.4-7 2.7-7Q0-7 0-3.5Q0 0 2.7 0Q5.4 0 5.4-3.5"),
    ('b', 5.4, "M0-10L0 0M0-3.5Q0-7 2.7-7Q5.4-7 5.4-3.5Q5.4 0 2.7 0Q0 0 0-3.5"),
    ('c', 4.9, "M4.9-5.6Q4.4-7 2.8-7Q0-7 0-3.5Q0 0 2.8 0Q4.4 0 4.9-1.4"),
    ('d', 5.4, "M5.4-10L5.4 0M5.4-3.5Q5.4-7 2.7-7Q0-7 0-3.5Q0 0 2.7 0Q5.4 0 5.4-3.5"),
    ('e', 5.4, "M0-3.7L5.4-3.7Q5.4-7 2.7-7Q0-7 0-3.5Q0 0 2.8 0Q4.5 0 5.2-1.4"),
    ('f', 3.4, "M3.4-9.9Q1.3-10.4 1.3-8L1.3 0M0-7L3-7"),
    ('g', 5.4, "M5.4-7L5.4 0.2Q5.4 3 2.7 3Q0.9 3 0.4 1.8M5.4-3.5Q5.4-7 2.7-7Q0-7 0-3.5Q0 0 2.7 0Q5.4 0 5.4-3.5"),
    ('h', 5.0, "M0-10L0 0M0-4Q0-7 2.6-7Q5-7 5-4.4L5 0"),
    ('i', 0.0, "M0-7L0 0M0-9.6L0-9.5"),
    ('j', 1.5, "M1.5-7L1.5 1Q1.5 3 0 2.9M1.5-9.6L1.5-9.5"),
    ('k', 4.8, "M0-10L0 0M4.6-7L0-2.7M1.7-4.3L4.8 0"),
    ('l', 0.0, "M0-10L0 0"),
    ('m', 8.6, "M0-7L0 0M0-4.2Q0-7 2.2-7Q4.3-7 4.3-4.4L4.3 0M4.3-4.2Q4.3-7 6.5-7Q8.6-7 8.6-4.4L8.6 0"),
    ('n', 5.0, "M0-7L0 0M0-4Q0-7 2.6-7Q5-7 5-4.4L5 0"),
    ('o', 5.6, "M2.8-7Q0-7 0-3.5Q0 0 2.8 0Q5.6 0 5.6-3.5Q5.6-7 2.8-7"),
    ('p', 5.4, "M0-7L0 3M0-3.5Q0-7 2.7-7Q5.4-7 5.4-3.5Q5.4 0 2.7 0Q0 0 0-3.5"),
    ('q', 5.4, "M5.4-7L5.4 3M5.4-3.5Q5.4-7 2.7-7Q0-7 0-3.5Q0 0 2.7 0Q5.4 0 5.4-3.5"),
    ('r', 3.0, "M0-7L0 0M0-4Q0-7 3-6.9"),
    ('s', 4.5, "M4.2-5.8Q3.8-7 2.2-7Q0.3-7 0.3-5.3Q0.3-4 2.2-3.6Q4.5-3.2 4.5-1.9Q4.5 0 2.3 0Q0.5 0 0-1.3"),
    ('t', 3.3, "M1.3-9.2L1.3-2Q1.3 0 3.3-0.1M0-7L3.1-7"),
    ('u', 5.0, "M0-7L0-2.6Q0 0 2.5 0Q5 0 5-3M5-7L5 0"),
    ('v', 5.2, "M0-7L2.6 0L5.2-7"),
    ('w', 8.2, "M0-7L2.1 0L4.1-6.4L6.1 0L8.2-7"),
    ('x', 4.8, "M0-7L4.8 0M4.8-7L0 0"),
    ('y', 5.2, "M0-7L2.7 0M5.2-7L2.2 1.4Q1.6 3 0.2 2.9"),
    ('z', 4.7, "M0-7L4.6-7L0 0L4.7 0"),
    ('0', 6.0, "M3-10Q0-10 0-5Q0 0 3 0Q6 0 6-5Q6-10 3-10"),
    ('1', 6.0, "M1.2-8.2L3.6-10L3.6 0"),
    ('2', 6.0, "M0.2-7.4Q0.2-10 3-10Q5.8-10 5.8-7.4Q5.8-6 4.6-4.7L0 0L6 0"),
    ('3', 6.0, "M0.4-8.2Q1-10 3-10Q5.6-10 5.6-7.7Q5.6-5.4 2.8-5.4M2.8-5.4Q6-5.4 6-2.7Q6 0 3 0Q0.6 0 0-2"),
    ('4', 6.0, "M4.5 0L4.5-10L0-3L6-3"),
    ('5', 6.0, "M5.4-10L0.9-10L0.5-5.4Q1.4-6.4 3-6.4Q6-6.4 6-3.2Q6 0 2.9 0Q0.7 0 0-1.8"),
    ('6', 6.0, "M4.8-9.9Q0-8.4 0-3.1Q0 0 3 0Q6 0 6-3.1Q6-6.2 3-6.2Q0-6.2 0-3.1"),
    ('7', 6.0, "M0-10L6-10L2 0"),
    ('8', 6.0, "M3-5.4Q0.4-5.4 0.4-7.7Q0.4-10 3-10Q5.6-10 5.6-7.7Q5.6-5.4 3-5.4Q0-5.4 0-2.7Q0 0 3 0Q6 0 6-2.7Q6-5.4 3-5.4"),
    ('9', 6.0, "M1.2-0.1Q6-1.6 6-6.9Q6-10 3-10Q0-10 0-6.9Q0-3.8 3-3.8Q6-3.8 6-6.9"),
    ('.', 0.0, "M0-0.1L0 0"),
    (',', 0.6, "M0.6-0.2L0 1.7"),
    (':', 0.0, "M0-0.1L0 0M0-5.8L0-5.7"),
    (';', 0.6, "M0.6-0.2L0 1.7M0.6-5.8L0.6-5.7"),
    ('-', 3.2, "M0-4L3.2-4"),
    ('\u{2013}', 5.0, "M0-4L5-4"),
    ('\u{2014}', 8.0, "M0-4L8-4"),
    ('+', 5.6, "M2.8-7L2.8-1.4M0-4.2L5.6-4.2"),
    ('\u{d7}', 4.4, "M0-6.4L4.4-2M4.4-6.4L0-2"),
    ('=', 5.4, "M0-5.4L5.4-5.4M0-3L5.4-3"),
    ('<', 4.6, "M4.6-7L0-4.2L4.6-1.4"),
    ('>', 4.6, "M0-7L4.6-4.2L0-1.4"),
    ('/', 4.2, "M0 1.2L4.2-10.8"),
    ('(', 2.2, "M2.2-11Q0-9 0-4.8Q0-0.6 2.2 1.5"),
    (')', 2.2, "M0-11Q2.2-9 2.2-4.8Q2.2-0.6 0 1.5"),
    ('[', 2.0, "M2-11L0-11L0 1.5L2 1.5"),
    (']', 2.0, "M0-11L2-11L2 1.5L0 1.5"),
    ('%', 8.6, "M7.4-10L1.2 0M2-10Q0-10 0-7.8Q0-5.6 2-5.6Q4-5.6 4-7.8Q4-10 2-10M6.6-4.4Q4.6-4.4 4.6-2.2Q4.6 0 6.6 0Q8.6 0 8.6-2.2Q8.6-4.4 6.6-4.4"),
    ('\u{b0}', 3.0, "M1.5-10.4Q0-10.4 0-8.9Q0-7.4 1.5-7.4Q3-7.4 3-8.9Q3-10.4 1.5-10.4"),
    ('\u{b2}', 3.0, "M0.1-9.6Q0.1-10.9 1.5-10.9Q2.9-10.9 2.9-9.6Q2.9-8.9 2.2-8.2L0-6L3-6"),
    ('\u{b7}', 0.0, "M0-4.1L0-4"),
    ('\'', 0.0, "M0-10L0-7.4"),
    ('\u{2019}', 0.6, "M0.6-10L0-7.8"),
    ('"', 2.0, "M0-10L0-7.4M2-10L2-7.4"),
    ('!', 0.0, "M0-10L0-3M0-0.1L0 0"),
    ('?', 5.0, "M0-8Q0.4-10 2.5-10Q5-10 5-7.6Q5-6 3.6-5Q2.4-4.2 2.4-2.8M2.4-0.1L2.4 0"),
    ('&', 7.6, "M7.6 0L1.8-7.2Q0.9-8.4 1.4-9.2Q2-10 3-10Q4.8-10 4.8-8.2Q4.8-6.6 2.4-5.4Q0-4.4 0-2.6Q0 0 2.8 0Q6 0 7-4.4"),
    ('#', 6.6, "M2-9L1-1M5.4-9L4.4-1M0.4-6.6L6.4-6.6M0-3.4L6-3.4"),
    ('*', 4.4, "M2.2-10L2.2-6M0.4-9L4-7M4-9L0.4-7"),
    ('_', 5.6, "M0 1.4L5.6 1.4"),
    ('|', 0.0, "M0-11L0 1.5"),
    ('\u{a9}', 9.6, "M4.8-9.6Q0-9.6 0-4.8Q0 0 4.8 0Q9.6 0 9.6-4.8Q9.6-9.6 4.8-9.6M6.8-6.2Q6.2-7.2 5-7.2Q2.8-7.2 2.8-4.8Q2.8-2.4 5-2.4Q6.2-2.4 6.8-3.4"),
    ('\u{df}', 5.4, "M0 0L0-7.6Q0-10 2.4-10Q4.6-10 4.6-8Q4.6-6.4 3-5.8Q5.4-5.2 5.4-2.7Q5.4 0 2.4 0"),
    ('\u{e6}', 9.0, "M0.4-6Q1-7 2.4-7Q4.6-7 4.6-4.6L4.6-2.4Q4.6 0 2.2 0Q0 0 0-2Q0-3.8 2.4-3.8L9-3.8Q9-7 6.8-7Q4.6-7 4.6-3.5Q4.6 0 6.9 0Q8.4 0 8.9-1.4"),
    ('\u{c6}', 9.6, "M0 0L4.6-10L9.6-10M4.6-10L4.6 0L9.6 0M1.6-3.5L4.6-3.5M4.6-5.2L8.8-5.2"),
    ('\u{131}', 0.0, "M0-7L0 0"),
];

/// Accented letters as letter and accent.
const ACCENTED: &[(&str, &str, char)] = &[
    (
        "\u{e4}\u{eb}\u{ef}\u{f6}\u{fc}\u{ff}\u{c4}\u{cb}\u{cf}\u{d6}\u{dc}",
        "aeıouyAEIOU",
        ':',
    ),
    ("áéíóúýćńśźĺŕÁÉÍÓÚÝĆŃŚŹ", "aeıouycnszlrAEIOUYCNSZ", '/'),
    ("àèìòùÀÈÌÒÙ", "aeıouAEIOU", '\\'),
    ("âêîôûÂÊÎÔÛ", "aeıouAEIOU", '^'),
    ("ãñõÃÑÕ", "anoANO", '~'),
    ("åůÅ", "auA", 'o'),
    ("čďěňřšťžČĎĚŇŘŠŤŽǎğĞ", "cdenrstzCDENRSTZagG", 'v'),
    ("çşÇŞ", "csCS", ','),
    ("āēīōūĀĒĪŌŪ", "aeıouAEIOU", '-'),
    ("øØłŁđĐ", "oOlLdD", '!'),
    ("őűŐŰ", "ouOU", '"'),
    ("ėżİĖŻ", "ezIEZ", '.'),
];

/// An accent around x = 0 for letters that reach y = 0 here.
fn accent_path(accent: char) -> &'static str {
    match accent {
        ':' => "M-1.3-2L-1.3-1.9M1.3-2L1.3-1.9",
        '/' => "M-0.5-1.3L1-3.2",
        '\\' => "M0.5-1.3L-1-3.2",
        '^' => "M-1.5-1.2L0-3L1.5-1.2",
        'v' => "M-1.5-3L0-1.2L1.5-3",
        '~' => "M-1.8-1.4Q-1-3 0-2.1Q1-1.2 1.8-2.7",
        'o' => "M0-3.6Q-1.2-3.6-1.2-2.4Q-1.2-1.2 0-1.2Q1.2-1.2 1.2-2.4Q1.2-3.6 0-3.6",
        '-' => "M-1.6-2L1.6-2",
        '"' => "M-1.3-1.3L-0.4-3.2M0.8-1.3L1.7-3.2",
        '.' => "M0-2L0-1.9",
        _ => "",
    }
}

/// The letter and accent that make a character.
fn decomposed(c: char) -> Option<(char, char)> {
    ACCENTED.iter().find_map(|(composed, plain, accent)| {
        let place = composed.chars().position(|k| k == c)?;
        Some((plain.chars().nth(place)?, *accent))
    })
}

fn glyph(c: char) -> Option<&'static (char, f64, &'static str)> {
    GLYPHS.iter().find(|(known, ..)| *known == c)
}

/// Whether every character of a text can be drawn.
pub(super) fn can_draw(text: &str) -> bool {
    text.chars()
        .all(|c| c.is_whitespace() || glyph(c).is_some() || decomposed(c).is_some())
}

/// A space, or a character's width.
fn advance(c: char) -> f64 {
    if c.is_whitespace() {
        // A thin space keeps groups of digits together.
        return if c == '\u{2009}' { 1.0 } else { SPACE };
    }
    let plain = decomposed(c).map_or(c, |(letter, _)| letter);
    glyph(plain).map_or(5.0, |(_, width, _)| *width)
}

/// Width of a text whose capitals are `cap` high.
pub(super) fn width(text: &str, cap: f64) -> f64 {
    let glyphs: f64 = text.chars().map(|c| advance(c) + GAP).sum();
    (glyphs - GAP).max(0.0) * cap / CAP
}

/// Where a glyph stands: origin on the baseline, and the direction of writing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pen {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Radians, clockwise on the sheet.
    pub(super) angle: f64,
}

/// Path data of a text, one pen for each character: `pen` is told how far along
/// the text each character's middle is, and puts it there.
pub(super) fn path_along(text: &str, cap: f64, mut pen: impl FnMut(f64) -> Pen) -> String {
    let mut data = String::new();
    let scale = cap / CAP;
    let mut along = 0.0;
    for c in text.chars() {
        let wide = advance(c);
        let place = pen((along + wide / 2.0) * scale);
        draw(&mut data, c, wide, scale, place);
        along += wide + GAP;
    }
    data
}

/// Path data of a text on a straight line, from its left end on the baseline.
pub(super) fn path(text: &str, cap: f64, x: f64, y: f64) -> String {
    path_along(text, cap, |along| Pen {
        x: x + along,
        y,
        angle: 0.0,
    })
}

/// One character, its middle at the pen.
fn draw(data: &mut String, c: char, wide: f64, scale: f64, pen: Pen) {
    let (letter, accent) = decomposed(c).unwrap_or((c, ' '));
    let Some((_, _, strokes)) = glyph(letter) else {
        return;
    };
    append(data, strokes, [-wide / 2.0, 0.0], scale, pen);
    let tall = letter.is_uppercase() || "bdfhklt".contains(letter);
    match accent {
        ' ' => {}
        ',' => append(data, "M0.4 0.2L-0.6 2.4", [0.0, 0.0], scale, pen),
        '!' => append(
            data,
            "M-2.6 2.6L2.6-2.6",
            [0.0, if tall { -5.0 } else { -3.5 }],
            scale,
            pen,
        ),
        other => append(
            data,
            accent_path(other),
            [0.0, if tall { -10.0 } else { -7.0 }],
            scale,
            pen,
        ),
    }
}

/// Translates glyph strokes to path data; glyphs are ours, so that their
/// numbers are known to be well formed.
fn append(data: &mut String, strokes: &str, shift: [f64; 2], scale: f64, pen: Pen) {
    let (sin, cos) = pen.angle.sin_cos();
    let place = |x: f64, y: f64| {
        let (u, v) = ((x + shift[0]) * scale, (y + shift[1]) * scale);
        (pen.x + u * cos - v * sin, pen.y + u * sin + v * cos)
    };
    let mut last = (0.0, 0.0);
    for (command, numbers) in commands(strokes) {
        match (command, numbers.as_slice()) {
            ('M' | 'L', [x, y]) => {
                let (px, py) = place(*x, *y);
                let _ = write!(data, "{command}{} {}", round(px), round(py));
                last = (*x, *y);
            }
            ('Q', [cx, cy, x, y]) => {
                let handle =
                    |(px, py): (f64, f64)| place(px + ARC * (cx - px), py + ARC * (cy - py));
                let ((ax, ay), (bx, by), (px, py)) =
                    (handle(last), handle((*x, *y)), place(*x, *y));
                let _ = write!(
                    data,
                    "C{} {} {} {} {} {}",
                    round(ax),
                    round(ay),
                    round(bx),
                    round(by),
                    round(px),
                    round(py)
                );
                last = (*x, *y);
            }
            _ => {}
        }
    }
}

/// Whole units of the sheet (0.01 mm).
fn round(v: f64) -> i64 {
    v.round() as i64
}

/// The commands of a glyph with their numbers.
fn commands(strokes: &str) -> Vec<(char, Vec<f64>)> {
    let mut all: Vec<(char, Vec<f64>)> = Vec::new();
    let mut number = String::new();
    let finish = |number: &mut String, all: &mut Vec<(char, Vec<f64>)>| {
        if let (Ok(value), Some((_, numbers))) = (number.parse(), all.last_mut()) {
            numbers.push(value);
        }
        number.clear();
    };
    for c in strokes.chars() {
        match c {
            'M' | 'L' | 'Q' => {
                finish(&mut number, &mut all);
                all.push((c, Vec::new()));
            }
            ' ' => finish(&mut number, &mut all),
            '-' => {
                finish(&mut number, &mut all);
                number.push('-');
            }
            digit => number.push(digit),
        }
    }
    finish(&mut number, &mut all);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_is_well_formed_and_as_wide_as_it_says() {
        for (c, wide, strokes) in GLYPHS {
            let mut right = 0.0_f64;
            for (command, numbers) in commands(strokes) {
                assert_eq!(
                    numbers.len(),
                    if command == 'Q' { 4 } else { 2 },
                    "{c}: {command} {numbers:?}"
                );
                right = numbers.chunks(2).map(|p| p[0]).fold(right, f64::max);
                assert!(
                    numbers
                        .chunks(2)
                        .all(|p| p[0] >= 0.0 && (-11.0..=3.0).contains(&p[1])),
                    "{c}"
                );
            }
            assert!(right <= wide + 1e-9, "{c} is {right} wide, not {wide}");
        }
    }

    #[test]
    fn accents_have_their_letters() {
        for (composed, plain, _) in ACCENTED {
            assert_eq!(
                composed.chars().count(),
                plain.chars().count(),
                "{composed}"
            );
            assert!(plain.chars().all(|c| glyph(c).is_some()), "{plain}");
        }
        assert!(can_draw("Virsumäentie 12–14, Šiauliai (1.5 km²)"));
        assert!(!can_draw("東京"));
    }

    #[test]
    fn texts_are_drawn_where_they_say() {
        assert_eq!(path("I", 1000.0, 500.0, 700.0), "M500 700L500 -300");
        assert!((width("II", 1000.0) - 230.0).abs() < 1e-9);
    }
}
