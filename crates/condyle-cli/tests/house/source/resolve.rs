//! From a path in the code to the file that defines what it names, through all re-exports.

use std::collections::BTreeSet;

use super::{Import, Kind, Mention, Module, ModuleId, Names, Sources};

/// An item of another module that a module names.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Edge {
    pub from: ModuleId,
    pub to: ModuleId,
    pub line: usize,
    /// As it is written.
    pub path: String,
    /// Its name where it is defined.
    pub item: String,
}

/// What a path leads to.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Found {
    Module(ModuleId),
    Item(ModuleId, String, Kind),
}

/// Names that are being looked up, so that two re-exports of each other end.
type Asked = Vec<(ModuleId, String)>;

impl Sources {
    /// Every name of an item that another module defines. A module itself defines nothing: `use
    /// super::law` is no edge, and `law::Linear` behind it is one to where `Linear` stands.
    pub fn edges(&self) -> Vec<Edge> {
        let ids = 0..self.modules.len();
        ids.flat_map(|from| self.edges_from(from)).collect()
    }

    fn edges_from(&self, from: ModuleId) -> BTreeSet<Edge> {
        let mut edges = BTreeSet::new();
        for mention in &self.modules[from].mentions {
            for (to, item) in self.items_of(from, mention) {
                if to != from {
                    let (line, path) = (mention.line, mention.path.join("::"));
                    edges.insert(Edge {
                        from,
                        to,
                        line,
                        path,
                        item,
                    });
                }
            }
        }
        edges
    }

    fn items_of(&self, from: ModuleId, mention: &Mention) -> Vec<(ModuleId, String)> {
        let mut found = self.resolve(from, &mention.path, &mut Vec::new());
        if mention.is_macro && mention.path.len() == 1 {
            found.extend(self.macro_in_sight(from, &mention.path[0]));
        }
        let items = found.into_iter().filter_map(|found| match found {
            Found::Item(module, name, _) => Some((module, name)),
            Found::Module(_) => None,
        });
        items.collect()
    }

    /// What a path names, as seen from a module: several where a name is a type and a function.
    fn resolve(&self, from: ModuleId, path: &[String], asked: &mut Asked) -> BTreeSet<Found> {
        let Some((first, rest)) = path.split_first() else {
            return BTreeSet::new();
        };
        let mut found = self.first_of(from, first, asked);
        for (i, name) in rest.iter().enumerate() {
            let is_start = i == 0 || rest[..i].iter().all(|name| name == "super");
            let steps = found.into_iter();
            found = steps
                .flat_map(|at| self.step(at, name, is_start, asked))
                .collect();
        }
        found
    }

    fn first_of(&self, from: ModuleId, name: &str, asked: &mut Asked) -> BTreeSet<Found> {
        let module = |id: ModuleId| BTreeSet::from([Found::Module(id)]);
        match name {
            "crate" => module(self.modules[from].root),
            "self" => module(from),
            "super" => self.modules[from].parent.map(module).unwrap_or_default(),
            "" => BTreeSet::new(),
            name => {
                let found = self.lookup(from, name, asked);
                let other = self.crates.get(name).filter(|_| found.is_empty());
                other.map_or(found, |id| module(*id))
            }
        }
    }

    /// From what a path has led to so far one name on.
    fn step(&self, at: Found, name: &str, is_start: bool, asked: &mut Asked) -> BTreeSet<Found> {
        match at {
            Found::Module(id) if name == "super" && is_start => self.first_of(id, "super", asked),
            Found::Module(id) => self.lookup(id, name, asked),
            Found::Item(_, _, Kind::Type) => BTreeSet::from([at]),
            Found::Item(..) => BTreeSet::new(),
        }
    }

    /// What a name stands for in a module: its own, then imported, then through globs.
    fn lookup(&self, id: ModuleId, name: &str, asked: &mut Asked) -> BTreeSet<Found> {
        let question = (id, name.to_owned());
        if asked.contains(&question) {
            return BTreeSet::new();
        }
        asked.push(question);
        let module = &self.modules[id];
        let mut found = own(id, module, name);
        let imports = module.imports.iter().filter(|import| import.name == name);
        found.extend(imports.flat_map(|Import { path, .. }| self.resolve(id, path, asked)));
        if found.is_empty() {
            let globs = module.globs.iter();
            found.extend(globs.flat_map(|glob| self.in_glob(id, glob, name, asked)));
        }
        asked.pop();
        found
    }

    fn in_glob(&self, id: ModuleId, glob: &Names, name: &str, asked: &mut Asked) -> Vec<Found> {
        let of = self.resolve(id, glob, asked).into_iter();
        of.flat_map(|found| match found {
            Found::Module(module) => self.lookup(module, name, asked),
            Found::Item(..) => BTreeSet::new(),
        })
        .collect()
    }

    /// A `macro_rules!` is in sight in the modules declared behind it, without an import.
    fn macro_in_sight(&self, from: ModuleId, name: &str) -> Option<Found> {
        let mut at = Some(from);
        while let Some(id) = at {
            let is_here = own(id, &self.modules[id], name);
            let found = is_here
                .into_iter()
                .find(|found| matches!(found, Found::Item(_, _, Kind::Macro)));
            if found.is_some() {
                return found;
            }
            at = self.modules[id].parent;
        }
        None
    }
}

/// What a module defines under a name.
fn own(id: ModuleId, module: &Module, name: &str) -> BTreeSet<Found> {
    let child = module.children.get(name).map(|id| Found::Module(*id));
    let items = module.items.iter().filter(|(item, _)| item == name);
    let items = items.map(|(item, kind)| Found::Item(id, item.clone(), *kind));
    child.into_iter().chain(items).collect()
}
