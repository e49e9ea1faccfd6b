//! The pages of the repository: every link leads somewhere, every page of the
//! guide is in its table of contents, every command of the front page exists.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().expect("the workspace").to_owned()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The Markdown files of a folder, sorted.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut out: Vec<PathBuf> = entries
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect();
    out.sort();
    out
}

/// The targets of inline links and pictures: what stands in `](...)`, outside
/// code.
fn targets(text: &str) -> Vec<String> {
    let mut out = Vec::new();
    let mut fenced = false;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        }
        if fenced {
            continue;
        }
        // Code spans are the odd pieces between backticks.
        let prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        for rest in prose.split("](").skip(1) {
            if let Some((target, _)) = rest.split_once(')') {
                out.push(target.to_owned());
            }
        }
    }
    out
}

#[test]
fn every_relative_link_leads_to_a_file() {
    let root = root();
    let mut files = pages(&root);
    files.extend(pages(&root.join("docs/src")));
    assert!(files.len() > 8, "{files:?}");
    let mut broken = Vec::new();
    for file in files {
        for target in targets(&read(&file)) {
            let path = target.split('#').next().unwrap_or_default();
            if target.contains("://") || target.starts_with("mailto:") || path.is_empty() {
                continue;
            }
            let folder = file.parent().expect("a file lies in a folder");
            if !folder.join(path).exists() {
                broken.push(format!("{}: {target}", file.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn every_page_of_the_guide_is_in_its_contents() {
    let source = root().join("docs/src");
    let contents = targets(&read(&source.join("SUMMARY.md")));
    for page in pages(&source) {
        let name = page.file_name().expect("a name").to_string_lossy();
        assert!(
            name == "SUMMARY.md" || contents.iter().any(|target| *target == name),
            "{name} is not in SUMMARY.md"
        );
    }
}

#[test]
fn the_front_page_has_two_commands_and_their_files() {
    let text = read(&root().join("README.md"));
    let commands: Vec<&str> = text
        .split("```sh\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .flat_map(str::lines)
        .collect();
    let [generate, test] = commands[..] else {
        panic!("not two commands: {commands:?}");
    };
    assert!(generate.starts_with("cargo run -p urban-layout -- generate "));
    assert_eq!(test, "cargo test --workspace");
    let site = generate.split_whitespace().nth(6).expect("a site");
    assert!(root().join(site).is_file(), "{site}");
}

/// Links are found where there are some, and code is not taken for one.
#[test]
fn targets_of_links() {
    let text = "a [b](c.md), ![d](e.svg#f) `[x](y)`\n```\n[g](h)\n```\n[i](https://j.k)";
    assert_eq!(targets(text), ["c.md", "e.svg#f", "https://j.k"]);
}
