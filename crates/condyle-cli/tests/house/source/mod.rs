//! The sources of the workspace as the compiler sees them: modules, what they define and what they name.

mod names;
mod read;
mod resolve;
mod tests;

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::LazyLock;

use crate::repository::{cargo_metadata, root};

pub use resolve::Edge;
pub use tests::made_up;

/// A place in [`Sources::modules`].
pub type ModuleId = usize;

/// Every module of some crates, tests left out.
#[derive(Default)]
pub struct Sources {
    pub modules: Vec<Module>,
    /// The outermost module of each crate, by the name that others call it by.
    crates: BTreeMap<String, ModuleId>,
}

/// A file, or a `mod name { ... }` within one.
pub struct Module {
    /// Such as `condyle::contact::law`.
    pub path: String,
    /// From the root of the repository, with forward slashes.
    pub file: String,
    /// Functions with a body, in the order of the file.
    pub functions: Vec<Function>,
    parent: Option<ModuleId>,
    root: ModuleId,
    children: BTreeMap<String, ModuleId>,
    /// A name can be a type and a function at once.
    items: Vec<(String, Kind)>,
    imports: Vec<Import>,
    /// Paths before `::*`.
    globs: Vec<Names>,
    mentions: Vec<Mention>,
}

/// A function outside of tests.
pub struct Function {
    pub name: String,
    pub line: usize,
    /// From the line of `fn` to that of the closing brace.
    pub length_lines: usize,
}

/// What a defined name stands for, as far as paths through it are concerned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A path may go on behind it: to a variant, a constant, a function of the type.
    Type,
    /// A function, a constant or a static: a path ends here.
    Value,
    Macro,
}

/// A path in parts, such as `crate`, `contact`, `Foundation`.
pub type Names = Vec<String>;

/// `use path as name`.
struct Import {
    name: String,
    path: Names,
}

/// A path that stands in the code, in a `use` or elsewhere.
struct Mention {
    path: Names,
    line: usize,
    is_macro: bool,
}

/// How the text of a file is got; nothing where there is no such file.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Option<String>;

impl Sources {
    /// The libraries and commands of this workspace, read once for all tests.
    pub fn of_workspace() -> &'static Self {
        static WORKSPACE: LazyLock<Sources> = LazyLock::new(Sources::read_workspace);
        &WORKSPACE
    }

    fn read_workspace() -> Self {
        let mut sources = Self::default();
        let from_root = |path: &str| std::fs::read_to_string(root().join(path)).ok();
        for (name, file) in outermost_files() {
            sources.add_crate(&name, &file, &from_root);
        }
        sources
    }

    /// Whether a path such as `condyle::contact::Foundation` is that of a module or of an item.
    pub fn has(&self, path: &str) -> bool {
        let (parent, name) = path.rsplit_once("::").unwrap_or(("", path));
        self.modules.iter().any(|module| {
            let mut items = module.items.iter();
            module.path == path || module.path == parent && items.any(|(item, _)| item == name)
        })
    }

    /// Reads a crate from its outermost file.
    pub fn add_crate(&mut self, name: &str, file: &str, read_file: ReadFile) {
        let outermost = read::read_crate(&mut self.modules, name, file, read_file);
        self.crates.insert(name.to_owned(), outermost);
    }
}

/// Each crate's name and its `src/lib.rs` or `src/main.rs`.
fn outermost_files() -> Vec<(String, String)> {
    let metadata = cargo_metadata();
    let top = metadata["workspace_root"].as_str().expect("has a root");
    let mut found = Vec::new();
    for package in metadata["packages"].as_array().expect("are listed") {
        let name = package["name"].as_str().expect("has a name");
        for target in package["targets"].as_array().expect("are listed") {
            let file = target["src_path"].as_str().expect("has a file");
            let file = Path::new(file).strip_prefix(top).expect("lies within");
            if file.ends_with("src/lib.rs") || file.ends_with("src/main.rs") {
                found.push((name.replace('-', "_"), slashed(file)));
            }
        }
    }
    found
}

/// A path with forward slashes, `folder/..` taken out.
fn slashed(path: &Path) -> String {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => assert!(plain.pop(), "{path:?} leaves the repository"),
            other => plain.push(other),
        }
    }
    let parts: Vec<_> = plain.iter().map(|part| part.to_string_lossy()).collect();
    parts.join("/")
}
