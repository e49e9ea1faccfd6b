//! Every package that a build may need has a licence that lets users do as they
//! like: no copyleft, nothing unnamed.

use std::process::Command;

use serde_json::Value;

/// Licences that ask for no more than a notice.
const ALLOWED: [&str; 11] = [
    "0BSD",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "Unicode-3.0",
    "Zlib",
];

/// Licences that are as free, but that nobody should choose for new work.
const TOLERATED: [&str; 2] = ["Unlicense", "Apache-2.0 WITH LLVM-exception"];

/// Whether one may comply with an SPDX expression by allowed licences alone.
///
/// `OR` needs one side, `AND` both and binds tighter; `/`, which old manifests
/// use, is an `OR`. An error says what could not be read.
fn permits(expression: &str) -> Result<bool, String> {
    let spaced = expression
        .replace('(', " ( ")
        .replace(')', " ) ")
        .replace('/', " OR ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = &words[..];
    let verdict = either(&mut rest)?;
    match rest.first() {
        None => Ok(verdict),
        Some(word) => Err(format!("`{word}` was not expected in `{expression}`")),
    }
}

fn either(words: &mut &[&str]) -> Result<bool, String> {
    let mut verdict = both(words)?;
    while let ["OR", rest @ ..] = words {
        *words = rest;
        verdict |= both(words)?;
    }
    Ok(verdict)
}

fn both(words: &mut &[&str]) -> Result<bool, String> {
    let mut verdict = one(words)?;
    while let ["AND", rest @ ..] = words {
        *words = rest;
        verdict &= one(words)?;
    }
    Ok(verdict)
}

fn one(words: &mut &[&str]) -> Result<bool, String> {
    match words {
        ["(", rest @ ..] => {
            *words = rest;
            let verdict = either(words)?;
            match words {
                [")", rest @ ..] => {
                    *words = rest;
                    Ok(verdict)
                }
                _ => Err("a bracket is not closed".to_owned()),
            }
        }
        [name, "WITH", exception, rest @ ..] => {
            let whole = format!("{name} WITH {exception}");
            *words = rest;
            Ok(TOLERATED.contains(&whole.as_str()))
        }
        ["OR" | "AND" | "WITH" | ")", ..] | [] => Err("a licence is missing".to_owned()),
        [name, rest @ ..] => {
            let verdict = ALLOWED.contains(name) || TOLERATED.contains(name);
            *words = rest;
            Ok(verdict)
        }
    }
}

/// All packages of the lock file's graph, whatever their platform.
fn packages() -> Vec<Value> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--locked"])
        .args([
            "--manifest-path",
            concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"),
        ])
        .output()
        .expect("cargo runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo writes JSON");
    metadata["packages"].as_array().expect("packages").clone()
}

#[test]
fn every_package_has_a_licence_of_the_list() {
    let packages = packages();
    assert!(packages.len() > 50, "only {} packages", packages.len());
    let mut faults = Vec::new();
    for package in &packages {
        let name = format!("{} {}", package["name"], package["version"]);
        match package["license"].as_str() {
            None => faults.push(format!("{name} names no licence")),
            Some(licence) => match permits(licence) {
                Ok(true) => {}
                Ok(false) => faults.push(format!("{name}: {licence}")),
                Err(problem) => faults.push(format!("{name}: {licence}: {problem}")),
            },
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn our_own_crates_are_ready_to_be_published() {
    let packages = packages();
    let ours: Vec<&Value> = packages.iter().filter(|p| p["source"].is_null()).collect();
    assert_eq!(ours.len(), 7, "six crates and these tests");
    for package in ours {
        let name = package["name"].as_str().expect("a name");
        assert_eq!(package["license"], "MIT OR Apache-2.0", "{name}");
        assert_eq!(package["rust_version"], "1.89", "{name}");
        if name == "urban-layout-tests" {
            assert_eq!(package["publish"], serde_json::json!([]), "never published");
            continue;
        }
        for key in ["description", "readme", "repository"] {
            assert!(package[key].is_string(), "{name} has no {key}");
        }
        for key in ["keywords", "categories"] {
            let words = package[key].as_array().expect("a list");
            assert!((1..=5).contains(&words.len()), "{name}: {key}");
        }
    }
}

#[test]
fn expressions_are_read_as_spdx_means_them() {
    for (expression, verdict) in [
        ("MIT", true),
        ("GPL-3.0-only", false),
        ("MIT OR GPL-3.0-only", true),
        ("GPL-3.0-only OR Apache-2.0", true),
        ("MIT AND GPL-3.0-only", false),
        ("MIT/Apache-2.0", true),
        ("(MIT OR GPL-2.0-only) AND BSD-3-Clause", true),
        ("MIT OR GPL-2.0-only AND LGPL-2.1-only", true),
        ("(MIT OR GPL-2.0-only) AND LGPL-2.1-only", false),
        ("Apache-2.0 WITH LLVM-exception", true),
        ("GPL-2.0-only WITH Classpath-exception-2.0", false),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", true),
        ("Unlicense/MIT", true),
    ] {
        assert_eq!(permits(expression), Ok(verdict), "{expression}");
    }
    for nonsense in ["", "MIT OR", "(MIT", "MIT Apache-2.0", "AND MIT", "MIT )"] {
        assert!(permits(nonsense).is_err(), "{nonsense}");
    }
}
