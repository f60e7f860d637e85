//! Names in syntax: paths, imports, attributes.

use proc_macro2::{Span, TokenStream, TokenTree};
use syn::{Attribute, Expr, Lit, Meta, UseTree};

use super::{Import, Names};

/// One leaf of a `use`.
pub struct Imported {
    /// Without the `*` of a glob.
    pub path: Names,
    pub span: Span,
    /// What it is called here; nothing for a glob and for `_`.
    name: Option<String>,
    is_glob: bool,
}

impl Imported {
    pub fn import(&self) -> Option<Import> {
        let (name, path) = (self.name.clone()?, self.path.clone());
        Some(Import { name, path })
    }

    pub fn glob(&self) -> Option<Names> {
        self.is_glob.then(|| self.path.clone())
    }
}

/// The leaves of a `use` behind the path `before`.
pub fn imports_of(tree: &UseTree, before: Names) -> Vec<Imported> {
    let joined = |name: &syn::Ident| [before.clone(), vec![name.to_string()]].concat();
    match tree {
        UseTree::Path(path) => imports_of(&path.tree, joined(&path.ident)),
        UseTree::Group(group) => {
            let leaves = group.items.iter();
            leaves
                .flat_map(|leaf| imports_of(leaf, before.clone()))
                .collect()
        }
        UseTree::Name(leaf) => vec![named(joined(&leaf.ident), &leaf.ident, None)],
        UseTree::Rename(leaf) => vec![named(joined(&leaf.ident), &leaf.ident, Some(&leaf.rename))],
        UseTree::Glob(glob) => vec![Imported {
            path: before,
            span: glob.star_token.span,
            name: None,
            is_glob: true,
        }],
    }
}

fn named(mut path: Names, leaf: &syn::Ident, rename: Option<&syn::Ident>) -> Imported {
    // `use a::b::{self}` is `use a::b`.
    if leaf == "self" && path.len() > 1 {
        path.pop();
    }
    let name = rename.map_or_else(|| path.last().cloned(), |name| Some(name.to_string()));
    Imported {
        name: name.filter(|name| name != "_"),
        path,
        span: leaf.span(),
        is_glob: false,
    }
}

/// The parts of a path; the first is empty where it starts with `::`.
pub fn path_of(path: &syn::Path) -> Names {
    let start = path.leading_colon.map(|_| String::new());
    let names = path
        .segments
        .iter()
        .map(|segment| segment.ident.to_string());
    start.into_iter().chain(names).collect()
}

/// What looks like a path among the tokens of a macro, whose grammar is not known: names joined by
/// `::`, and single names that no dot stands before.
pub fn paths_in(tokens: TokenStream) -> Vec<(Names, Span)> {
    let mut found: Vec<(Names, Span)> = Vec::new();
    let (mut colons, mut is_field) = (0, false);
    for token in tokens {
        match &token {
            TokenTree::Ident(name) => match found.last_mut().filter(|_| colons == 2) {
                Some((path, _)) => path.push(name.to_string()),
                None if !is_field => found.push((vec![name.to_string()], name.span())),
                None => {}
            },
            TokenTree::Group(group) => found.extend(paths_in(group.stream())),
            _ => {}
        }
        let punct = match &token {
            TokenTree::Punct(punct) => punct.as_char(),
            _ => ' ',
        };
        colons = if punct == ':' { colons + 1 } else { 0 };
        is_field = punct == '.';
    }
    found
}

/// Whether an item is compiled for tests alone.
pub fn is_test_only(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let Meta::List(list) = &attribute.meta else {
            return attribute.path().is_ident("test");
        };
        let condition = list.tokens.to_string().replace(' ', "");
        list.path.is_ident("cfg") && (condition == "test" || condition.starts_with("all(test,"))
    })
}

/// The file of `#[path = "file"]`.
pub fn path_attribute(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| {
        let Meta::NameValue(pair) = &attribute.meta else {
            return None;
        };
        match &pair.value {
            Expr::Lit(literal) if pair.path.is_ident("path") => match &literal.lit {
                Lit::Str(text) => Some(text.value()),
                _ => None,
            },
            _ => None,
        }
    })
}
