//! Plans of parks: whole documents, the same for the same park, with what the park
//! has in their legend.

mod common;

use std::collections::BTreeSet;

use park_grammar::picture::{PictureOptions, SheetOptions, ViewersFont};
use park_grammar::Scene;

use common::park_with_mesh;

const RULES: &str = "grammar 1
param Oak = Object(radius = 0.5, spread = 4 m, height = 14 m, colour = \"#8a9a3f\")
param Stone = Object(radius = 1, height = 1, mesh = \"stone.obj\")
Region -> Grid(2, 2) { Quarter } { Gravel } { Circle(4) Paving Fountain }
Quarter -> Place((0.3, 0.3)) { Circle(3) Water }
    Sweep(OUTER: 0.5) { Hedge } Distribute(INNER: 1, 6) { Bench } Scatter(20) { Tree | Oak | Stone }
";

const STONE: &str = "v 1 0 0\nv -1 0 1\nv -1 0 -1\nv 0 1 0\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";

fn park(x: f64, y: f64) -> Scene {
    park_with_mesh(RULES, STONE, x, y)
}

/// What stands between two marks, for each time the first comes.
fn between<'t>(text: &'t str, from: &str, to: char) -> BTreeSet<&'t str> {
    let parts = text.split(from).skip(1);
    parts.filter_map(|rest| rest.split(to).next()).collect()
}

/// Every element that is opened is closed, in order.
fn balanced(svg: &str) -> bool {
    let mut open: Vec<&str> = Vec::new();
    for tag in svg.split('<').skip(1) {
        let Some((tag, _)) = tag.split_once('>') else {
            return false;
        };
        let name = tag.trim_start_matches('/').split([' ', '/']).next();
        let name = name.unwrap_or_default();
        if tag.starts_with('/') {
            if open.pop() != Some(name) {
                return false;
            }
        } else if !tag.ends_with('/') {
            open.push(name);
        }
    }
    open.is_empty()
}

#[test]
fn a_sheet_is_a_whole_document() {
    let sheet = SheetOptions::default()
        .with_title("A <park> & more")
        .with_attribution(Some("Nobody, who else".to_owned()));
    let svg = park(0.0, 0.0).sheet(&sheet, &ViewersFont);
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
    assert!(balanced(&svg) && !svg.contains("NaN") && !svg.contains("inf"));
    assert!(svg.contains("A &lt;park&gt; &amp; more"));
    let ids = between(&svg, " id=\"", '"');
    assert_eq!(svg.matches(" id=\"").count(), ids.len(), "ids are unique");
    let mut used = between(&svg, "url(#", ')');
    used.extend(between(&svg, "href=\"#", '"'));
    let missing: Vec<_> = used.difference(&ids).collect();
    assert!(missing.is_empty(), "{missing:?}");
    for words in [
        ">Lawn<",
        ">Water<",
        ">Gravel<",
        ">Paving<",
        ">Hedge<",
        ">Bench<",
        ">Tree<",
        ">Oak<",
        ">Stone<",
        ">Fountain<",
        ">4800 m\u{b2}<",
        ">N<",
        ">Nobody, who else<",
    ] {
        assert!(svg.contains(words), "{words}");
    }
    assert!(!svg.contains(">Wall<"));
}

#[test]
fn a_picture_is_that_of_the_park_wherever_it_lies() {
    let sheet = |x: f64, y: f64| park(x, y).sheet(&SheetOptions::default(), &ViewersFont);
    let here = sheet(0.0, 0.0);
    assert!(here == sheet(0.0, 0.0), "the same park, the same bytes");
    // Far away coordinates have fewer digits: whole centimetres may be rounded
    // otherwise, and a step between two of them by twice as much.
    let there = sheet(4e5, 6.7e6);
    let numbers = |svg: &str| -> Vec<f64> {
        let lines = svg.lines().filter(|line| !line.contains("clip-rule"));
        let split = |c: char| !(c.is_ascii_digit() || c == '.');
        let words = lines.flat_map(|line| line.split(split));
        words.filter_map(|word| word.parse().ok()).collect()
    };
    let (here, there) = (numbers(&here), numbers(&there));
    assert_eq!(here.len(), there.len());
    assert!(here.iter().zip(&there).all(|(a, b)| (a - b).abs() <= 2.0));
}

#[test]
fn several_parks_share_a_document() {
    let [one, two] = ["one", "two"].map(|name| {
        let options = PictureOptions::default().with_prefix(name);
        park(0.0, 0.0).draw(&options)
    });
    assert_eq!(one.defs, two.defs);
    let ids = |body: &str| {
        let found = between(body, " id=\"", '"');
        found
            .into_iter()
            .map(str::to_owned)
            .collect::<BTreeSet<_>>()
    };
    assert!(ids(&one.body).is_disjoint(&ids(&two.body)));
    assert!(one.defs.contains_key("park-Oak-8a9a3f"));
    assert!(balanced(&one.body));
}

#[test]
fn shadows_can_be_left_out() {
    let mut options = PictureOptions::default();
    let with = park(0.0, 0.0).draw(&options).body;
    options.shadows = false;
    let without = park(0.0, 0.0).draw(&options).body;
    assert!(without.len() < with.len() && !without.contains("opacity=\".22\""));
}

/// Nothing to draw is no reason to panic.
#[test]
fn an_empty_scene_is_an_empty_sheet() {
    let svg = Scene::default().sheet(&SheetOptions::default(), &ViewersFont);
    assert!(balanced(&svg) && !svg.contains("NaN"));
}
