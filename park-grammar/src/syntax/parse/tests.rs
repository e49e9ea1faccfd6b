use super::*;
use crate::syntax::{parse as read, print, Sources};

fn tree(text: &str) -> File {
    let (tree, found) = parse(text, 0);
    let mut sources = Sources::default();
    sources.add("test.park", text);
    let shown: Vec<String> = found.iter().map(|fault| fault.show(&sources)).collect();
    assert!(found.is_empty(), "{}", shown.join("\n"));
    tree
}

fn faults(text: &str) -> Vec<(String, String)> {
    let (_, found) = parse(text, 0);
    let place = |fault: &Diagnostic| text[fault.span.start..fault.span.end].to_owned();
    found
        .iter()
        .map(|fault| (place(fault), fault.message.clone()))
        .collect()
}

/// The examples of the notes, as they stand there but for their arrows.
const NOTES: &str = concat!(
    "grammar 1\nPathWidth = 2\nCentreRegionSize = 5\n",
    include_str!("../../../tests/notes/simple_square.park"),
    r#"Beams -> CastRays(CentrePoint [CentreRegionSize], CastToList) { CentreRegion } { CutRegion }
CentrePoint -> ScatterCircles(1 {15})
CastToList -> Corners(Region)
Free -> VoronoiRegions(CircleRegions) { SmoothRegions } { Path }
CircleRegions -> ScatterCircles(5 {[5-10]})
Nested -> Grid(3 {2, 6, 2} , 2 {6} ) { NestedRegion } { CementPath }
NestedRegion -> Grid { TreeRegion } { StonePath }
Odd -> Grid (3 {[7,15]a[-15,15]}, 2) { NonWalkableRegion }
NonWalkableRegion -> Grid (2 {a[-5,5]}, {[1.5,4]a[-25,25]}) { PlantedRegion } {}
PlantedRegion -> Choose { GrassRegion, BushRegion, Plant1Region /*, … */ }
Strip -> Peel(OuterEdgesSelection, 0.75, CornersOrthogonal) { TreeStrip | GrassRegion }
"#
);

#[test]
fn the_notes_are_read() {
    let file = tree(NOTES);
    assert_eq!(file.items.len(), 19);
    let again = print(&file);
    assert_eq!(tree(&again), file, "{again}");
    assert_eq!(print(&tree(&again)), again);
}

#[test]
fn operators_bind_as_they_should() {
    let value = |text: &str| {
        let file = tree(&format!("grammar 1\nparam x = {text}"));
        let ItemKind::Param { value, .. } = file.items[0].kind.clone() else {
            panic!("a parameter");
        };
        value
    };
    for (text, same) in [
        ("1 + 2 * 3 - 4", "(1 + (2 * 3)) - 4"),
        ("a and b or c minus d", "(a and b) or (c minus d)"),
        ("not a == b and c", "(not (a == b)) and c"),
        ("-x[0] * 2", "(-(x[0])) * 2"),
        ("[5-10]", "[5, 10]"),
        ("[-15--5]", "[-15, -5]"),
    ] {
        assert_eq!(value(text), value(same), "{text}");
    }
    // A difference in brackets of its own is no range.
    assert_ne!(value("[(5 - 10)]"), value("[5 - 10]"));
    assert_eq!(value("[(5) - (10)]"), value("[5, 10]"));
}

#[test]
fn every_fault_is_reported_where_it_is() {
    let text = "grammar 1\nA -> Grid(2, ) { B }\nB -> Peel(OUTER { C | D }\nC -> Place(1 < 2 < 3) {X}\nD -> Ok\n";
    let found = faults(text);
    let places: Vec<&str> = found.iter().map(|(place, _)| place.as_str()).collect();
    assert_eq!(places, ["|", "<"], "{found:?}");
    let (file, all) = parse(text, 0);
    let hint = all[0].hint.as_deref().unwrap_or_default();
    assert!(hint.contains(") missing"), "{hint}");
    // What is right is read all the same; a comma at the end is no fault.
    assert_eq!(file.items.len(), 2);
}

#[test]
fn a_block_that_is_not_closed_ends_at_the_next_rule() {
    let found = faults("grammar 1\nA -> Grid(2, 2) { B\nB -> C\n");
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, "B");
    assert!(found[0].1.contains("not closed"));
}

#[test]
fn versions_are_asked_for() {
    assert!(faults("A -> B")[0].1.contains("version"));
    assert!(faults("grammar 2\nA -> B")[0].1.contains("not known"));
    assert!(faults("").len() == 1);
}

#[test]
fn deep_nesting_is_a_fault_and_no_overflow() {
    for open in ["(", "[", "{", "-", "not "] {
        let text = format!("grammar 1\nparam x = {}1", open.repeat(100_000));
        assert!(!faults(&text).is_empty());
    }
    let text = format!("grammar 1\nA -> {}", "B { ".repeat(100_000));
    assert!(faults(&text)
        .iter()
        .any(|(_, what)| what.contains("deeply")));
}

#[test]
fn comments_are_kept() {
    let text = "// top\ngrammar 1\n// of A\nA ->\n    // first\n    Lawn\n    Place(CENTRE) { /* big */ Tree }\n// end\n";
    let file = tree(text);
    assert_eq!(file.head, ["top"]);
    assert_eq!(file.foot, ["end"]);
    let printed = print(&file);
    for words in ["top", "of A", "first", "big", "end"] {
        assert!(printed.contains(words), "{words} in\n{printed}");
    }
    assert_eq!(tree(&printed), file, "{printed}");
    let mut sources = Sources::default();
    sources.add("x", printed.clone());
    assert_eq!(print(&read(&sources, 0).expect("reads")), printed);
}
