//! Made-up crates, and what is seen of them.

use super::Sources;

/// A crate called `made` of these files, each a path within `src` and a text.
pub fn made_up(files: &[(&str, &str)]) -> Sources {
    let mut sources = Sources::default();
    let read_file = |path: &str| {
        let found = files.iter().find(|(name, _)| path == format!("src/{name}"));
        found.map(|(_, text)| (*text).to_owned())
    };
    sources.add_crate("made", "src/lib.rs", &read_file);
    sources
}

/// Each edge between files as `a.rs -> b.rs: Item`.
fn edges(files: &[(&str, &str)]) -> Vec<String> {
    let sources = made_up(files);
    let file = |id: usize| sources.modules[id].file.trim_start_matches("src/");
    let edges = sources.edges().into_iter();
    let mut told: Vec<_> = edges
        .map(|edge| format!("{} -> {}: {}", file(edge.from), file(edge.to), edge.item))
        .collect();
    told.dedup();
    told
}

#[test]
fn a_name_leads_to_the_file_that_defines_it() {
    let library = ("lib.rs", "mod a; mod b;");
    let other = ("b.rs", "pub struct B; pub fn f() {}");
    for text in [
        "use crate::b::B;",
        "use super::b::{B};",
        "use super::b::B as Other;",
        "use super::b; fn g(_: b::B) {}",
        "fn g(_: crate::b::B) {}",
        "use super::b::*; fn g() { let _ = B; }",
        "fn g() { use crate::b; let _ = b::B::new(); }",
        "fn g() { assert_eq!(1, super::b::B::size(2)); }",
        "impl crate::b::B {}",
    ] {
        assert_eq!(
            edges(&[library, ("a.rs", text), other]),
            ["a.rs -> b.rs: B"],
            "{text}"
        );
    }
}

#[test]
fn a_re_export_is_followed_and_is_no_edge_itself() {
    let files = [
        ("lib.rs", "mod a; mod b; pub use b::Inner as Outer;"),
        ("a.rs", "use crate::Outer;"),
        ("b/mod.rs", "mod c; pub use c::*;"),
        ("b/c.rs", "pub struct Inner;"),
    ];
    assert_eq!(edges(&files), ["a.rs -> b/c.rs: Inner"]);
}

#[test]
fn what_is_handed_on_and_used_is_an_edge() {
    let files = [
        ("lib.rs", "mod a; pub use a::A; pub fn f(_: A) {}"),
        ("a.rs", "pub struct A;"),
    ];
    assert_eq!(edges(&files), ["lib.rs -> a.rs: A"]);
}

#[test]
fn re_exports_of_each_other_end() {
    let files = [
        ("lib.rs", "mod a; mod b; use a::Nothing;"),
        ("a.rs", "pub use super::b::*;"),
        ("b.rs", "pub use super::a::*;"),
    ];
    assert!(edges(&files).is_empty());
}

#[test]
fn super_goes_up_as_often_as_it_stands() {
    let files = [
        ("lib.rs", "mod a; pub struct Top;"),
        ("a/mod.rs", "mod b; mod d; pub struct Middle;"),
        ("a/b/mod.rs", "mod c;"),
        (
            "a/b/c.rs",
            "use super::super::{d::D, Middle}; use super::super::super::Top;",
        ),
        ("a/d.rs", "pub struct D;"),
    ];
    let expected = [
        "a/b/c.rs -> lib.rs: Top",
        "a/b/c.rs -> a/mod.rs: Middle",
        "a/b/c.rs -> a/d.rs: D",
    ];
    assert_eq!(edges(&files), expected);
}

#[test]
fn declarations_and_tests_are_no_edges() {
    let tests = "mod b; #[cfg(test)] mod tests { use super::b::B; }
        #[cfg(test)] use b::B; #[cfg(test)] fn g(_: b::B) {}
        #[cfg(all(test, unix))] mod more;
        struct A; impl A { #[cfg(test)] fn g(_: b::B) {} }";
    let files = [("lib.rs", tests), ("b.rs", "pub struct B;")];
    assert!(edges(&files).is_empty());
}

#[test]
fn a_function_called_as_its_module_is_no_type_of_it() {
    let files = [
        (
            "lib.rs",
            "mod step; use step::step; fn f() { step(); step::Other::new(); }",
        ),
        (
            "step.rs",
            "mod other; pub use other::Other; pub fn step() {}",
        ),
        ("step/other.rs", "pub struct Other;"),
    ];
    assert_eq!(
        edges(&files),
        ["lib.rs -> step.rs: step", "lib.rs -> step/other.rs: Other"]
    );
}

#[test]
fn a_module_in_braces_is_its_file() {
    let files = [
        ("lib.rs", "mod a { pub mod b { pub struct B; } } mod c;"),
        ("c.rs", "use crate::a::b::B;"),
    ];
    assert_eq!(edges(&files), ["c.rs -> lib.rs: B"]);
    let within = "mod a { pub struct A; } use a::A;";
    assert_eq!(edges(&[("lib.rs", within)]), ["lib.rs -> lib.rs: A"]);
}

#[test]
fn a_macro_is_in_sight_without_an_import() {
    let files = [
        ("lib.rs", "macro_rules! shout { () => {} } mod a;"),
        ("a.rs", "shout!();"),
    ];
    assert_eq!(edges(&files), ["a.rs -> lib.rs: shout"]);
}

#[test]
fn a_module_may_say_its_file() {
    let mut sources = Sources::default();
    let read_file = |path: &str| {
        let text = match path {
            "src/lib.rs" => "#[path = \"../else/where.rs\"] mod a; use a::A;",
            "else/where.rs" => "pub struct A;",
            _ => return None,
        };
        Some(text.to_owned())
    };
    sources.add_crate("made", "src/lib.rs", &read_file);
    assert_eq!(sources.modules[1].file, "else/where.rs");
}

#[test]
fn other_crates_are_seen_by_their_name() {
    let mut sources = made_up(&[("lib.rs", "pub mod a;"), ("a.rs", "pub struct A;")]);
    let user = |path: &str| (path == "user/lib.rs").then(|| "use made::a::A;".to_owned());
    sources.add_crate("user", "user/lib.rs", &user);
    let edges = sources.edges();
    assert_eq!(edges.len(), 1);
    assert_eq!(sources.modules[edges[0].to].path, "made::a");
}

#[test]
fn a_function_is_measured_from_its_name_to_its_brace() {
    let text =
        "/// Says.\n#[inline]\nfn f(\n    x: u8,\n) -> u8 {\n    x\n}\ntrait T { fn g(); }\n";
    let sources = made_up(&[("lib.rs", text)]);
    let functions = &sources.modules[0].functions;
    assert_eq!(functions.len(), 1);
    let f = &functions[0];
    assert_eq!((f.name.as_str(), f.line, f.length_lines), ("f", 3, 5));
}
