//! The pages agree with the code and with each other.

use std::collections::BTreeSet;
use std::path::Path;

use crate::repository::{TextFile, cargo_metadata, read, root, text_files, text_files_ending};

/// `condyle::contact` and the like: every public module of every library.
fn public_modules() -> Vec<String> {
    let mut modules = Vec::new();
    for file in text_files_ending("/src/lib.rs") {
        let package = file.path.split('/').nth(1).unwrap_or_default();
        let library = package.replace('-', "_");
        let names = file
            .text
            .lines()
            .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
        modules.extend(names.map(|name| format!("{library}::{name}")));
    }
    modules
}

#[test]
fn architecture_names_every_crate_and_every_public_module() {
    let page = read("ARCHITECTURE.md");
    for module in public_modules() {
        assert!(page.contains(&format!("`{module}`")), "{module} is missing");
    }
    let metadata = cargo_metadata();
    for package in metadata["packages"].as_array().expect("are listed") {
        let name = package["name"].as_str().expect("has a name");
        assert!(page.contains(&format!("`{name}`")), "{name} is missing");
    }
}

/// What the Markdown links `[text](target)` of a page point at, code left out.
fn link_targets(page: &TextFile) -> Vec<String> {
    let outside_blocks = page.text.split("```").step_by(2).collect::<String>();
    let prose = outside_blocks.split('`').step_by(2).collect::<String>();
    let starts = prose.split("](").skip(1);
    starts
        .filter_map(|rest| Some(rest.split_once(')')?.0.to_owned()))
        .collect()
}

#[test]
fn links_of_pages_lead_somewhere() {
    let mut broken = Vec::new();
    let metadata = cargo_metadata();
    let repositories = metadata["packages"].as_array().expect("are listed").iter();
    let mut repository = repositories.filter_map(|package| package["repository"].as_str());
    let published = format!(
        "{}/blob/main/",
        repository.next_back().expect("one is named")
    );
    for page in text_files_ending(".md") {
        let folder = root().join(Path::new(&page.path).parent().unwrap_or(Path::new("")));
        for target in link_targets(&page) {
            let file = target.split('#').next().unwrap_or_default();
            // READMEs of crates and of the Python package are read outside of the repository.
            let (folder, file) = match file.strip_prefix(&published) {
                Some(file) => (root(), file),
                None => (folder.clone(), file),
            };
            let is_elsewhere = file.contains("://") || file.is_empty();
            if !is_elsewhere && !folder.join(file).exists() {
                broken.push(format!("{}: {target}", page.path));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn packages_have_a_readme_whose_links_work_anywhere() {
    let metadata = cargo_metadata();
    for package in metadata["packages"].as_array().expect("are listed") {
        if package["publish"].is_array() {
            continue;
        }
        let name = package["name"].as_str().expect("has a name");
        for key in ["license", "repository", "documentation", "readme"] {
            assert!(package[key].is_string(), "{name} has no {key}");
        }
        let path = format!("crates/{name}/README.md");
        let text = read(&path);
        for target in link_targets(&TextFile { path, text }) {
            assert!(target.contains("://"), "README of {name}: {target}");
        }
    }
}

#[test]
fn summary_of_the_book_names_every_page() {
    let summary = read("docs/src/SUMMARY.md");
    for page in text_files_ending(".md") {
        let in_book = page.path.strip_prefix("docs/src/");
        if let Some(name) = in_book.filter(|name| *name != "SUMMARY.md") {
            assert!(summary.contains(&format!("({name})")), "{name} is missing");
        }
    }
}

#[test]
fn rust_of_the_book_is_compiled() {
    let compiled = read("verification/src/book.rs");
    for page in text_files_ending(".md") {
        let has_rust = page.text.contains("```rust");
        let is_compiled = compiled.contains(&format!("\"../../{}\"", page.path));
        assert_eq!(
            has_rust, is_compiled,
            "{} in verification/src/book.rs",
            page.path
        );
        assert!(!page.text.contains("```rust,ignore"), "{}", page.path);
    }
}

/// A key of references.bib: small letters, a year, perhaps a letter; not the name of a case, such as knight-2007.
fn is_key(word: &str) -> bool {
    let year = word.trim_start_matches(|c: char| c.is_ascii_lowercase() || c == '-');
    let digits: String = year.chars().take_while(char::is_ascii_digit).collect();
    let letter = &year[digits.len()..];
    year.len() < word.len()
        && !word.ends_with(&format!("-{year}"))
        && digits.len() == 4
        && letter.len() <= 1
        && letter.chars().all(|c| c.is_ascii_lowercase())
}

/// Sources that the pages cite, such as archard1953 in square brackets.
fn cited() -> BTreeSet<String> {
    let pages = text_files().into_iter().filter(|file| {
        file.path.ends_with(".md") || file.path.ends_with(".rs") || file.path.ends_with(".toml")
    });
    let mut keys = BTreeSet::new();
    for page in pages {
        for group in page.text.split('[').skip(1) {
            let words = group.split(']').next().unwrap_or_default();
            keys.extend(words.split(", ").filter(|w| is_key(w)).map(str::to_owned));
        }
    }
    keys
}

#[test]
fn every_source_cited_is_in_the_references_and_the_other_way_round() {
    let bibliography = read("references.bib");
    let entries = bibliography
        .lines()
        .filter_map(|line| line.strip_prefix('@')?.split_once('{')?.1.strip_suffix(','));
    let entries: Vec<String> = entries.map(str::to_owned).collect();
    let in_order = entries.is_sorted_by(|one, next| one < next);
    assert!(in_order, "each once, by the alphabet: {entries:?}");
    let entries = BTreeSet::from_iter(entries);
    let cited = cited();
    let missing: Vec<_> = cited.difference(&entries).collect();
    assert!(missing.is_empty(), "not in references.bib: {missing:?}");
    let unused: Vec<_> = entries.difference(&cited).collect();
    assert!(unused.is_empty(), "cited nowhere: {unused:?}");
}

#[test]
fn a_key_is_known_by_its_form() {
    assert!(
        ["archard1953", "halloran2005b", "bei-fregly2004"]
            .iter()
            .all(|k| is_key(k))
    );
    assert!(
        !["1953", "Archard 1953", "iso", "archard1953ab"]
            .iter()
            .any(|k| is_key(k))
    );
}

#[test]
fn readme_opens_with_the_two_commands() {
    let page = read("README.md");
    let first_block = page.split("```").nth(1).unwrap_or_default();
    assert!(first_block.contains("cargo run --release -- run cases/stanmore-force.toml"));
    assert!(first_block.contains("./scripts/test"));
}

#[test]
fn numbers_of_the_changes_match_the_version() {
    let metadata = cargo_metadata();
    let version = metadata["packages"][0]["version"]
        .as_str()
        .expect("has one");
    assert!(
        read("CHANGELOG.md").contains(&format!("## {version}")),
        "{version}"
    );
    assert!(
        read("CITATION.cff").contains(&format!("\nversion: {version}\n")),
        "{version}"
    );
}
