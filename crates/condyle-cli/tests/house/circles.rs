//! No circle of files: a reader of one need not have read another that needs the first.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt::Write;

use crate::source::{Edge, Sources, made_up};

/// Of each file the files that define what it names, with one place where it does.
struct Graph<'a>(BTreeMap<&'a str, BTreeMap<&'a str, &'a Edge>>);

impl<'a> Graph<'a> {
    fn of(sources: &'a Sources, edges: &'a [Edge]) -> Self {
        let mut files = BTreeMap::<&str, BTreeMap<&str, &Edge>>::new();
        for edge in edges {
            let [from, to] = [edge.from, edge.to].map(|id| sources.modules[id].file.as_str());
            if from != to {
                files.entry(from).or_default().entry(to).or_insert(edge);
            }
        }
        Self(files)
    }

    fn from(&self, file: &str) -> impl Iterator<Item = (&'a str, &'a Edge)> {
        let named = self.0.get(file).into_iter().flatten();
        named.map(|(to, edge)| (*to, *edge))
    }

    /// The shortest way from a file over others to itself, each file but the last named once.
    fn shortest_circle(&self, start: &'a str) -> Option<Vec<&'a str>> {
        let mut come_from = BTreeMap::new();
        let mut waiting = VecDeque::from([start]);
        while let Some(file) = waiting.pop_front() {
            for (next, _) in self.from(file) {
                come_from.entry(next).or_insert_with(|| {
                    waiting.push_back(next);
                    file
                });
            }
        }
        let mut way = vec![start, *come_from.get(start)?];
        while way[way.len() - 1] != start {
            way.push(come_from[way[way.len() - 1]]);
        }
        way.reverse();
        Some(way)
    }

    fn reached_from(&self, start: &'a str) -> BTreeSet<&'a str> {
        let mut reached = BTreeSet::new();
        let mut waiting = vec![start];
        while let Some(file) = waiting.pop() {
            let next = self.from(file).map(|(next, _)| next);
            waiting.extend(next.filter(|next| reached.insert(*next)));
        }
        reached
    }

    /// Sets of files each of which needs all others of its set, largest first.
    fn circles(&self) -> Vec<BTreeSet<&'a str>> {
        let reached: BTreeMap<_, _> = self.0.keys().map(|f| (*f, self.reached_from(f))).collect();
        let in_circle_with = |file: &str| {
            let others = reached[file].iter();
            let back = |other: &&&str| reached.get(**other).is_some_and(|back| back.contains(file));
            others.filter(back).copied().collect::<BTreeSet<_>>()
        };
        let sets: BTreeSet<_> = reached.keys().map(|file| in_circle_with(file)).collect();
        let mut sets: Vec<_> = sets.into_iter().filter(|set| !set.is_empty()).collect();
        sets.sort_by_key(|set| std::cmp::Reverse(set.len()));
        sets
    }

    fn line(&self, from: &str, to: &str) -> String {
        let edge = self.0[from][to];
        let (line, path) = (edge.line, &edge.path);
        format!("  {from}:{line}: `{path}` is defined in {to}\n")
    }

    /// The shortest circle of a set, then every file's way to another.
    fn described(&self, set: &BTreeSet<&'a str>) -> String {
        let circles = set.iter().filter_map(|file| self.shortest_circle(file));
        let shortest = circles.min_by_key(Vec::len).unwrap_or_default();
        let mut text = format!("a circle of {} files, closed by\n", set.len());
        for pair in shortest.windows(2) {
            text += &self.line(pair[0], pair[1]);
        }
        let _ = writeln!(text, " all that its files name of each other:");
        for from in set {
            for (to, _) in self.from(from).filter(|(to, _)| set.contains(to)) {
                text += &self.line(from, to);
            }
        }
        text
    }
}

/// Each circle with the imports that close it.
fn circles_of(sources: &Sources) -> Vec<String> {
    let edges = sources.edges();
    let graph = Graph::of(sources, &edges);
    let sets = graph.circles();
    sets.iter().map(|set| graph.described(set)).collect()
}

#[test]
fn circles_of_files_there_are_none() {
    let circles = circles_of(Sources::of_workspace());
    assert!(circles.is_empty(), "\n{}", circles.join("\n"));
}

#[test]
fn a_circle_of_two_is_told_with_both_imports() {
    let circles = circles_of(&made_up(&[
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use super::b::B;\npub struct A;"),
        ("b.rs", "\nuse super::a::A;\npub struct B;"),
        ("c.rs", "use super::{a::A, b::B};"),
    ]));
    assert_eq!(circles.len(), 1);
    let told = &circles[0];
    assert!(
        told.starts_with("a circle of 2 files, closed by\n"),
        "{told}"
    );
    assert!(
        told.contains("  src/a.rs:1: `super::b::B` is defined in src/b.rs\n"),
        "{told}"
    );
    assert!(
        told.contains("  src/b.rs:2: `super::a::A` is defined in src/a.rs\n"),
        "{told}"
    );
    assert!(!told.contains("c.rs"), "{told}");
}

#[test]
fn a_child_of_its_parent_and_back_is_a_circle_through_a_re_export() {
    let files = [
        ("lib.rs", "mod a;"),
        (
            "a/mod.rs",
            "mod b; pub use b::B; pub trait A { fn f(_: B); }",
        ),
        ("a/b.rs", "use super::A;\npub struct B;"),
    ];
    assert_eq!(circles_of(&made_up(&files)).len(), 1);
    let handed_on = ("a/mod.rs", "mod b; pub use b::B; pub trait A {}");
    assert!(circles_of(&made_up(&[files[0], handed_on, files[2]])).is_empty());
}

#[test]
fn a_circle_through_types_that_macros_declare_is_found() {
    let circles = circles_of(&made_up(&[
        ("lib.rs", "mod femur; mod placement;"),
        (
            "femur.rs",
            "use super::placement::Placement;\nvariants! {\n/// A femur.\nFemur by\n/// Its shape.\nshape = \"generic\" { Generic = \"generic\", } }\nfn read(_: Placement) {}",
        ),
        (
            "placement.rs",
            "use super::femur::Femur;\nsettings! {\n/// Where it sits.\nPlacement { x_mm: f64; }\n/// More.\nMore {} }\nfn check(_: Femur) {}",
        ),
    ]));
    assert_eq!(circles.len(), 1);
    assert!(
        circles[0].starts_with("a circle of 2 files"),
        "{}",
        circles[0]
    );
}

#[test]
fn circles_apart_are_told_apart_and_the_larger_first() {
    let circles = circles_of(&made_up(&[
        ("lib.rs", "mod a; mod b; mod c; mod d; mod e;"),
        ("a.rs", "use super::b::X; pub struct X;"),
        (
            "b.rs",
            "use super::a::X; use super::c::X as Y; pub struct X;",
        ),
        ("c.rs", "use super::d::X; pub struct X;"),
        ("d.rs", "use super::e::X; pub struct X;"),
        ("e.rs", "use super::c::X; pub struct X;"),
    ]));
    let sizes = circles.iter().map(|circle| circle.split(" files").next());
    let sizes: Vec<_> = sizes.flatten().collect();
    assert_eq!(sizes, ["a circle of 3", "a circle of 2"]);
}
