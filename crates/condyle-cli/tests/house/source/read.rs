//! Reads the modules of a crate from its files.

use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, Span, TokenTree};
use syn::visit::{self, Visit};

use super::names::{imports_of, is_test_only, path_attribute, path_of, paths_in};
use super::{Function, Kind, Mention, Module, ModuleId, Names, ReadFile, slashed};

/// Reads a crate's modules behind those that are known; gives the outermost.
pub fn read_crate(
    modules: &mut Vec<Module>,
    name: &str,
    file: &str,
    read_file: ReadFile,
) -> ModuleId {
    let outermost = modules.len();
    modules.push(module(name.to_owned(), file, None, outermost));
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let mut reader = Reader {
        modules,
        here: outermost,
        folder: folder.to_owned(),
        read_file,
    };
    reader.read_file(file);
    outermost
}

fn module(path: String, file: &str, parent: Option<ModuleId>, root: ModuleId) -> Module {
    Module {
        path,
        file: file.to_owned(),
        parent,
        root,
        children: Default::default(),
        functions: Vec::new(),
        items: Vec::new(),
        imports: Vec::new(),
        globs: Vec::new(),
        mentions: Vec::new(),
    }
}

struct Reader<'a> {
    modules: &'a mut Vec<Module>,
    here: ModuleId,
    /// Where the files of the modules declared here lie.
    folder: PathBuf,
    read_file: ReadFile<'a>,
}

impl Reader<'_> {
    fn here(&mut self) -> &mut Module {
        &mut self.modules[self.here]
    }

    fn read_file(&mut self, file: &str) {
        let text = (self.read_file)(file).unwrap_or_else(|| panic!("there is no {file}"));
        let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{file}: {error}"));
        self.read_items(&parsed.items);
    }

    fn read_items(&mut self, items: &[syn::Item]) {
        for item in items {
            if !is_test_only(attributes(item)) {
                self.here().items.extend(defined(item));
                self.here().items.extend(made_by_macro(item));
            }
            self.visit_item(item);
        }
    }

    /// The module's items, within it: those of its braces, or of its file.
    fn read_module(&mut self, item: &syn::ItemMod) {
        let name = item.ident.to_string();
        let (file, folder) = if item.content.is_some() {
            (self.here().file.clone(), self.folder.join(&name))
        } else {
            self.file_of(item)
        };
        let outer = self.enter(&name, &file, folder);
        match &item.content {
            Some((_, items)) => self.read_items(items),
            None => self.read_file(&file),
        }
        (self.here, self.folder) = outer;
    }

    /// Goes into a new module; gives where we were.
    fn enter(&mut self, name: &str, file: &str, folder: PathBuf) -> (ModuleId, PathBuf) {
        let (parent, id) = (self.here, self.modules.len());
        let (path, root) = (format!("{}::{name}", self.here().path), self.here().root);
        self.modules.push(module(path, file, Some(parent), root));
        self.modules[parent].children.insert(name.to_owned(), id);
        self.here = id;
        (parent, std::mem::replace(&mut self.folder, folder))
    }

    /// The file of `mod name;`, and where those of its own modules lie.
    fn file_of(&mut self, item: &syn::ItemMod) -> (String, PathBuf) {
        let beside = self.folder.join(item.ident.to_string());
        if let Some(path) = path_attribute(&item.attrs) {
            let file = self.folder.join(path);
            let folder = file.parent().unwrap_or(Path::new("")).to_owned();
            return (slashed(&file), folder);
        }
        let inside = slashed(&beside.join("mod.rs"));
        let is_inside = (self.read_file)(&inside).is_some();
        let file = if is_inside {
            inside
        } else {
            slashed(&beside.with_extension("rs"))
        };
        (file, beside)
    }

    fn mention(&mut self, path: Names, span: Span, is_macro: bool) {
        let line = span.start().line;
        self.here().mentions.push(Mention {
            path,
            line,
            is_macro,
        });
    }

    fn measure(&mut self, signature: &syn::Signature, body: &syn::Block) {
        let line = signature.fn_token.span.start().line;
        let last = body.brace_token.span.close().end().line;
        self.here().functions.push(Function {
            name: signature.ident.to_string(),
            line,
            length_lines: last + 1 - line,
        });
    }
}

/// What an item defines, unless it is a module or nothing with a name.
fn defined(item: &syn::Item) -> Option<(String, Kind)> {
    use syn::Item;
    let (name, kind) = match item {
        Item::Const(item) => (&item.ident, Kind::Value),
        Item::Static(item) => (&item.ident, Kind::Value),
        Item::Fn(item) => (&item.sig.ident, Kind::Value),
        Item::Enum(item) => (&item.ident, Kind::Type),
        Item::Struct(item) => (&item.ident, Kind::Type),
        Item::Union(item) => (&item.ident, Kind::Type),
        Item::Trait(item) => (&item.ident, Kind::Type),
        Item::Type(item) => (&item.ident, Kind::Type),
        Item::Macro(item) => (item.ident.as_ref()?, Kind::Macro),
        _ => return None,
    };
    Some((name.to_string(), kind))
}

/// The types that the call of a macro declares. Its grammar is not known: a type has a name with a capital letter, behind
/// its documentation, a keyword, or the end of the one before.
fn made_by_macro(item: &syn::Item) -> Vec<(String, Kind)> {
    let syn::Item::Macro(syn::ItemMacro {
        ident: None, mac, ..
    }) = item
    else {
        return Vec::new();
    };
    let mut made = Vec::new();
    let mut may_follow = true;
    for token in mac.tokens.clone() {
        may_follow = match &token {
            TokenTree::Ident(word) => {
                let word = word.to_string();
                if may_follow && word.starts_with(char::is_uppercase) {
                    made.push((word.clone(), Kind::Type));
                }
                ["pub", "struct", "enum"].contains(&word.as_str())
            }
            TokenTree::Group(group) => group.delimiter() != Delimiter::Parenthesis,
            _ => false,
        };
    }
    made
}

fn attributes(item: &syn::Item) -> &[syn::Attribute] {
    use syn::Item;
    match item {
        Item::Const(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        _ => &[],
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        if !is_test_only(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        self.read_module(item);
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        let start = item.leading_colon.map(|_| String::new());
        // What is only handed on is not used here; where it is used, its name stands in the code.
        let is_handed_on = !matches!(item.vis, syn::Visibility::Inherited);
        for found in imports_of(&item.tree, start.into_iter().collect()) {
            if !is_handed_on {
                self.mention(found.path.clone(), found.span, false);
            }
            self.here().globs.extend(found.glob());
            self.here().imports.extend(found.import());
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.measure(&item.sig, &item.block);
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item(&mut self, item: &'ast syn::ImplItem) {
        let attributes: &[syn::Attribute] = match item {
            syn::ImplItem::Fn(item) => &item.attrs,
            syn::ImplItem::Const(item) => &item.attrs,
            _ => &[],
        };
        if !is_test_only(attributes) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.measure(&item.sig, &item.block);
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(body) = &item.default {
            self.measure(&item.sig, body);
        }
        visit::visit_trait_item_fn(self, item);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if let Some(first) = path.segments.first() {
            self.mention(path_of(path), first.ident.span(), false);
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast syn::Macro) {
        if let Some(first) = called.path.segments.first() {
            self.mention(path_of(&called.path), first.ident.span(), true);
        }
        for (path, span) in paths_in(called.tokens.clone()) {
            self.mention(path, span, false);
        }
    }

    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
}
