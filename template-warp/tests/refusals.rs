//! What is wrong is said, each fault with an error of its own.

#![allow(
    clippy::unwrap_used,
    reason = "a test that cannot go on should stop where it stands"
)]

use template_warp::geo_types::{coord, Coord};
use template_warp::{
    match_templates, warp, EdgeUse, Library, MatchOptions, Region, Sizes, WarpError, WarpOptions,
};

type P = Coord<f64>;

fn rectangle(w: f64, h: f64) -> Vec<P> {
    vec![
        coord! { x: 0.0, y: 0.0 },
        coord! { x: w, y: 0.0 },
        coord! { x: w, y: h },
        coord! { x: 0.0, y: h },
    ]
}

fn region(ring: Vec<P>) -> Region {
    let n = ring.len();
    Region::new(ring, vec![EdgeUse::Street; n], "block").unwrap()
}

/// A minimal file with one line replaced.
fn file(change: (&str, &str)) -> String {
    let text = r#"
[[template]]
name = "plot"
label = "block"
points = { a = [0, 0], b = ["w", 0], c = ["w", "l"], d = [0, "l"] }
outline = ["a", "b", "c", "d"]
sides = ["street", "any", "any", "any"]
[[template.face]]
label = "parcel"
points = ["a", "b", "c", "d"]
class = "rigid"
"#;
    assert!(text.contains(change.0), "{}", change.0);
    text.replacen(change.0, change.1, 1)
}

#[test]
fn a_minimal_file_is_read() {
    let library = Library::from_toml(&file(("", ""))).unwrap();
    assert_eq!(library.names(), ["plot"]);
    let region = region(rectangle(18.0, 30.0));
    let found = match_templates(&library, &region, &MatchOptions::default());
    let warped = warp(&library, &region, &found[0], &WarpOptions::default()).unwrap();
    assert_eq!(warped.faces.len(), 1);
    assert_eq!(warped.faces[0].frontage, 96.0);
}

#[test]
fn every_contradiction_in_a_file_is_named() {
    let cases = [
        (("\"w\", 0]", "\"2q\", 0]"), "2q"),
        (
            ("label = \"block\"", "label = \"block\"\nlable = 1"),
            "lable",
        ),
        (
            ("outline = [\"a\", \"b\",", "outline = [\"a\", \"x\","),
            "`x`",
        ),
        (
            (
                "outline = [\"a\", \"b\", \"c\", \"d\"]",
                "outline = [\"d\", \"c\", \"b\", \"a\"]",
            ),
            "counter-clockwise",
        ),
        (
            (
                "outline = [\"a\", \"b\", \"c\", \"d\"]",
                "outline = [\"a\", \"b\"]",
            ),
            "counter-clockwise",
        ),
        (
            (
                "outline = [\"a\", \"b\", \"c\", \"d\"]",
                "outline = [\"a\", \"b\", \"d\", \"c\"]",
            ),
            "outline",
        ),
        (
            (
                "sides = [\"street\", \"any\", \"any\", \"any\"]",
                "sides = [\"street\"]",
            ),
            "4 corners",
        ),
        (
            (
                "sides = [\"street\"",
                "probability = -1\nsides = [\"street\"",
            ),
            "probability",
        ),
        (
            ("sides = [\"street\"", "symmetry = 3\nsides = [\"street\""),
            "symmetry",
        ),
        (
            (
                "sides = [\"street\"",
                "corners = { a = \"concave\" }\nsides = [\"street\"",
            ),
            "`a`",
        ),
        (
            (
                "\npoints = [\"a\", \"b\", \"c\", \"d\"]",
                "\npoints = [\"a\", \"b\", \"c\"]",
            ),
            "cover",
        ),
        (
            (
                "\npoints = [\"a\", \"b\", \"c\", \"d\"]",
                "\npoints = [\"d\", \"c\", \"b\", \"a\"]",
            ),
            "face 0",
        ),
        (
            ("class = \"rigid\"", "class = { similarity = [2, 1] }"),
            "range",
        ),
        (
            ("class = \"rigid\"", "class = { area = 0.5 }"),
            "area ratio",
        ),
        (
            ("class = \"rigid\"", "class = \"rigid\"\ntolerance = 0"),
            "tolerance",
        ),
        (
            ("class = \"rigid\"", "class = \"rigid\"\ncorners = [\"q\"]"),
            "`q`",
        ),
        (
            (
                "class = \"rigid\"",
                "class = \"rigid\"\ncorners = [\"a\", \"b\"]",
            ),
            "at least 3",
        ),
        (
            (
                "class = \"rigid\"",
                "class = \"rigid\"\n[[template.divide]]\nedges = [[\"a\", \"c\"]]\nlength = 3",
            ),
            "no face",
        ),
        (("class = \"rigid\"", "class = \"rubber\""), "rubber"),
        (
            (
                "class = \"rigid\"",
                "class = \"rigid\"\n[[template.divide]]\nedges = []\nlength = 3",
            ),
            "divide",
        ),
        (
            (
                "class = \"rigid\"",
                "class = \"rigid\"\n[[template.divide]]\nedges = [[\"a\", \"b\"]]\nlength = \"-w\"",
            ),
            "divide",
        ),
        (
            (
                "class = \"rigid\"",
                "class = \"rigid\"\n[[template.centreline]]\nface = 3\npoints = [\"a\", \"b\"]",
            ),
            "centreline",
        ),
        (("[[template]]", "[[template"), "line 2"),
    ];
    for (change, word) in cases {
        let error = Library::from_toml(&file(change)).unwrap_err();
        let fine = matches!(
            error,
            WarpError::Format { .. } | WarpError::BadTemplate { .. }
        );
        assert!(
            fine && error.to_string().contains(word),
            "{change:?}: {error}"
        );
    }
    let twice = file(("", "")) + &file(("", ""));
    assert!(matches!(
        Library::from_toml(&twice),
        Err(WarpError::BadTemplate { .. })
    ));
}

#[test]
fn a_missing_child_and_a_cycle_are_found() {
    let with_child = |child: &str| {
        file((
            "class = \"rigid\"",
            &format!("class = \"rigid\"\nchild = [\"{child}\"]"),
        ))
    };
    let region = region(rectangle(18.0, 30.0));
    for (child, word) in [("nobody", "nobody"), ("plot", "cycle")] {
        let library = Library::from_toml(&with_child(child)).unwrap();
        let found = match_templates(&library, &region, &MatchOptions::default());
        let error = warp(&library, &region, &found[0], &WarpOptions::default()).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
    }
    assert!(matches!(
        Library::from_toml(&with_child("nobody"))
            .unwrap()
            .subset(&["plot"]),
        Err(WarpError::UnknownTemplate { .. })
    ));
}

#[test]
fn stray_candidates_and_options_are_refused() {
    let library = Library::standard();
    let region = region(rectangle(108.0, 60.0));
    let good = match_templates(&library, &region, &MatchOptions::default()).remove(0);
    let options = WarpOptions::default();
    let stray = |change: &dyn Fn(&mut template_warp::Candidate)| {
        let mut c = good.clone();
        change(&mut c);
        matches!(
            warp(&library, &region, &c, &options),
            Err(WarpError::BadCandidate { .. })
        )
    };
    assert!(stray(&|c| c.template = 999));
    assert!(stray(&|c| c.corners[2] = 44));
    assert!(stray(&|c| c.corners.truncate(3)));
    assert!(stray(&|c| c.corners.swap(1, 2)));
    assert!(stray(&|c| c.corners[1] = c.corners[0]));
    assert!(stray(&|c| c.mirrored = true));
    for bad in [
        WarpOptions {
            max_area_ratio: 0.5,
            ..WarpOptions::default()
        },
        WarpOptions {
            min_frontage: f64::NAN,
            ..WarpOptions::default()
        },
        WarpOptions {
            tolerance: -1.0,
            ..WarpOptions::default()
        },
    ] {
        assert!(matches!(
            warp(&library, &region, &good, &bad),
            Err(WarpError::BadOption { .. })
        ));
    }
    let tiny = WarpOptions {
        min_frontage: 50.0,
        ..WarpOptions::default()
    };
    assert!(matches!(
        warp(&library, &region, &good, &tiny),
        Err(WarpError::NoFrontage { .. })
    ));
    let strict = WarpOptions {
        max_area_ratio: 1.0,
        ..WarpOptions::default()
    };
    let other = self::region(rectangle(100.0, 60.0));
    let found = match_templates(&library, &other, &MatchOptions::default()).remove(0);
    assert!(matches!(
        warp(&library, &other, &found, &strict),
        Err(WarpError::WrongSize { .. })
    ));
}

#[test]
fn sizes_change_the_parcels() {
    let library = Library::standard();
    assert!(matches!(
        library.try_with_sizes(Sizes {
            parcel_width: -1.0,
            ..Sizes::default()
        }),
        Err(WarpError::BadOption {
            option: "parcel_width",
            ..
        })
    ));
    // Town houses 7 m wide and 24 m deep on the same block.
    let town = library
        .with_sizes(24.0, 7.0, 9.0)
        .subset(&["double-row"])
        .unwrap();
    let region = region(rectangle(105.0, 48.0));
    let found = match_templates(&town, &region, &MatchOptions::default());
    let warped = warp(&town, &region, &found[0], &WarpOptions::default()).unwrap();
    assert_eq!(warped.faces.len(), 30);
    assert!(warped.energy < 1e-12);
}

/// A template that allows it fits the mirror image of its outline as its own
/// mirror image, and not otherwise.
#[test]
fn mirror_images_fit_where_allowed() {
    let library = Library::standard()
        .subset(&["double-row-half-capped"])
        .unwrap();
    // The cap at the left, as drawn, needs a street there; mirrored, at the right.
    use EdgeUse::{NoStreet, Street};
    for (uses, mirrored) in [
        ([Street, NoStreet, Street, Street], false),
        ([Street, Street, Street, NoStreet], true),
    ] {
        let region = Region::new(rectangle(120.0, 60.0), uses.to_vec(), "block").unwrap();
        let found = match_templates(&library, &region, &MatchOptions::default());
        let fitting: Vec<_> = found
            .iter()
            .filter(|c| {
                warp(&library, &region, c, &WarpOptions::default()).is_ok_and(|w| w.energy < 1e-6)
            })
            .collect();
        assert!(fitting.iter().any(|c| c.mirrored == mirrored), "{found:?}");
    }
}
