//! Texts of sites, and what is expected of reading them.
#![allow(
    dead_code,
    unreachable_pub,
    reason = "each test file uses a part of it"
)]

use urban_layout::site::{Site, Units, WarningKind};
use urban_layout::Error;

/// A collection in metres of features given as (properties, geometry).
pub fn collection(features: &[(&str, &str)]) -> String {
    let features: Vec<String> = features
        .iter()
        .map(|(properties, geometry)| {
            format!(r#"{{"type": "Feature", "properties": {properties}, "geometry": {geometry}}}"#)
        })
        .collect();
    format!(
        r#"{{"type": "FeatureCollection", "coordinate_units": "metres", "features": [{}]}}"#,
        features.join(", ")
    )
}

pub fn polygon(rings: &str) -> String {
    format!(r#"{{"type": "Polygon", "coordinates": [{rings}]}}"#)
}

pub fn line(positions: &str) -> String {
    format!(r#"{{"type": "LineString", "coordinates": [{positions}]}}"#)
}

pub const SITE: &str = r#"{"kind": "site"}"#;
pub const SQUARE: &str = "[[0, 0], [400, 0], [400, 300], [0, 300], [0, 0]]";

/// A site of the rings given.
pub fn site(rings: &str) -> String {
    collection(&[(SITE, &polygon(rings))])
}

/// The square site, and one feature more.
pub fn with(properties: &str, geometry: &str) -> String {
    collection(&[(SITE, &polygon(SQUARE)), (properties, geometry)])
}

/// The square site with a hole.
pub fn pierced(hole: &str) -> String {
    site(&format!("{SQUARE}, {hole}"))
}

pub fn refused(text: &str) -> Error {
    match Site::from_geojson(text, Units::Auto) {
        Ok(site) => panic!("accepted, {} m2: {text:.300}", site.area()),
        Err(error) => error,
    }
}

/// Refused with this code, at this place, in one line that says these words.
#[track_caller]
pub fn refuse(
    text: &str,
    code: &str,
    place: (Option<usize>, Option<usize>, Option<usize>),
    says: &[&str],
) {
    let error = refused(text);
    let message = error.to_string();
    assert_eq!(error.code(), code, "{message}");
    assert_eq!(
        (error.feature(), error.ring(), error.vertex()),
        place,
        "{message}"
    );
    assert!(error.is_input() && error.exit_code() == 1, "{message}");
    assert!(!message.contains('\n') && message.len() < 400, "{message}");
    for words in says {
        assert!(message.contains(words), "no {words:?} in: {message}");
    }
}

/// Accepted with this area and these warnings.
#[track_caller]
pub fn accept(text: &str, area: f64, warnings: &[WarningKind]) -> Site {
    let site = match Site::from_geojson(text, Units::Auto) {
        Ok(site) => site,
        Err(error) => panic!("{error}"),
    };
    let kinds: Vec<WarningKind> = site.warnings.iter().map(|w| w.kind).collect();
    assert_eq!(kinds, warnings, "{:?}", site.warnings);
    assert!((site.area() - area).abs() < 1e-6 * area, "{}", site.area());
    for warning in &site.warnings {
        assert!(!warning.message.contains('\n') && !warning.message.is_empty());
    }
    site
}

/// Seconds that this thread has run: not those for which other work kept it waiting,
/// where the system tells them apart.
pub fn seconds() -> f64 {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    let start = START.get_or_init(std::time::Instant::now);
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok())
        .map_or_else(|| start.elapsed().as_secs_f64(), |nanos| nanos * 1e-9)
}
