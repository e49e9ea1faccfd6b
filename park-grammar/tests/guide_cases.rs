//! The guide's pages about parks: every example derives, every picture that is
//! shown is drawn, and every test that is named exists.

mod guide;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use park_grammar::audit::Violation;

use guide::{folder, samples, Sample, PAGES};

fn read(folder: &Path, page: &str) -> String {
    std::fs::read_to_string(folder.join(page)).expect("a page of the guide")
}

fn all(folder: &Path) -> Vec<Sample> {
    let of = |page| samples(page, &read(folder, page));
    PAGES.into_iter().flat_map(of).collect()
}

#[test]
fn every_example_derives() {
    let Some(folder) = folder() else {
        return;
    };
    let mut names = BTreeSet::new();
    for sample in all(&folder) {
        let place = format!("{}:{} {}", sample.page, sample.line, sample.name);
        match (sample.derive(), &sample.fault) {
            (Ok(scene), None) => {
                assert!(names.insert(sample.name.clone()), "{place}: named twice");
                let park = guide::outline(&sample.outline).expect("an outline");
                // Examples of one rule need not make a park that one can enter.
                let mut broken = scene.audit(&park).violations;
                broken.retain(|what| !matches!(what, Violation::NoEntrance { .. }));
                assert!(broken.is_empty(), "{place}: {broken:?}");
            }
            (Err(error), Some(fault)) => {
                assert_eq!(error.to_string().trim(), fault.trim(), "{place}");
            }
            (Ok(_), Some(_)) => panic!("{place} derives"),
            (Err(error), None) => panic!("{place}: {error}"),
        }
    }
}

/// What stands between marks, for each time the first comes.
fn between<'t>(text: &'t str, from: &str, to: &str) -> Vec<&'t str> {
    let parts = text.split(from).skip(1);
    parts
        .filter_map(|rest| rest.split_once(to))
        .map(|p| p.0)
        .collect()
}

#[test]
fn every_picture_is_drawn_and_shown() {
    let Some(folder) = folder() else {
        return;
    };
    let mut shown = BTreeSet::new();
    for page in PAGES {
        let text = read(&folder, page);
        for file in between(&text, "(images/park/", ")") {
            let path = folder.join("images/park").join(file);
            assert!(path.is_file(), "{page} shows {file}, which is not drawn");
            shown.insert(file.trim_end_matches(".svg").to_owned());
        }
    }
    for sample in all(&folder).iter().filter(|s| s.fault.is_none()) {
        assert!(shown.contains(&sample.name), "{} is not shown", sample.name);
    }
}

/// Tests are named as `file::name` in the table of rules, the file without its
/// ending, by its path from the crate.
#[test]
fn every_test_that_is_named_exists() {
    let Some(folder) = folder() else {
        return;
    };
    let text = read(&folder, "park-rules.md");
    let mut files: BTreeMap<String, String> = BTreeMap::new();
    let mut count = 0;
    for named in text
        .split('`')
        .filter(|part| part.contains("::") && !part.contains(' '))
    {
        let (file, name) = named.rsplit_once("::").expect("has colons");
        let source = files.entry(file.to_owned()).or_insert_with(|| {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("{file}.rs"));
            std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{named}: {e}"))
        });
        assert!(
            source.contains(&format!("fn {name}(")),
            "there is no {named}"
        );
        count += 1;
    }
    assert!(count > 0, "the table names no test");
}
