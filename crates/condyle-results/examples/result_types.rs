//! Writes the types of results for Python and for the web page; run it in the root of the repository.
//!
//! `cargo run -q -p condyle-results --example result_types`

use std::{fs, io};

use condyle_results::{PARTS, PartKind, catalogue};

fn main() -> io::Result<()> {
    fs::write("python/condyle/_summary.py", python_types())?;
    fs::write("web/src/page/catalogue.ts", typescript_types())
}

/// `python/condyle/_summary.py`: the attributes of a result that come from `summary.json`.
fn python_types() -> String {
    let mut text = String::from(
        "\"\"\"The entries of ``summary.json``; written by ``cargo run -p condyle-results --example result_types``.\"\"\"\n\n\
         from __future__ import annotations\n\nfrom typing import Any\n\n__all__ = [\"Summary\"]\n\n\n\
         class Summary:\n    \"\"\"The entries of ``summary.json`` as attributes; a run does not have all of them.\"\"\"\n\n",
    );
    let mut add = |key: &str, kind: &str, about: &str| {
        text += &format!("    {key}: {kind}\n    \"\"\"{about}\"\"\"\n");
    };
    for scalar in catalogue::scalars() {
        let kind = if scalar.is_count { "int" } else { "float" };
        let unit = match scalar.unit() {
            "" => String::new(),
            unit => format!(" In {unit}."),
        };
        add(scalar.key, kind, &(scalar.description().to_owned() + &unit));
    }
    for part in PARTS {
        let kind = match part.kind {
            PartKind::Text => "str",
            PartKind::Texts => "list[str]",
            PartKind::Object => "dict[str, Any]",
            PartKind::ObjectOrNull => "dict[str, Any] | None",
            PartKind::Objects => "list[dict[str, Any]]",
        };
        add(part.key, kind, &part.about.replace('`', "``"));
    }
    text
}

/// `web/src/page/catalogue.ts`: the entries of `summary.json`, and those that the page shows in large type.
fn typescript_types() -> String {
    let mut text = String::from(
        "// The entries of summary.json; written by `cargo run -p condyle-results --example result_types`.\n\n\
         export interface Numbers {\n",
    );
    for scalar in catalogue::scalars() {
        let mark = if scalar.is_always_there() { "" } else { "?" };
        text += &format!("  {}{mark}: number;\n", scalar.key);
    }
    text += "}\n\nexport interface Headline {\n  key: keyof Numbers;\n  label: string;\n  unit: string;\n  isShare: boolean;\n}\n\n\
             export const HEADLINES: Headline[] = [\n";
    for scalar in catalogue::headlines() {
        let (key, label, is_share) = (scalar.key, scalar.label, scalar.is_share);
        let unit = scalar.shown_unit();
        text += &format!(
            "  {{ key: \"{key}\", label: \"{label}\", unit: \"{unit}\", isShare: {is_share} }},\n"
        );
    }
    text + "];\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn python_and_typescript_have_the_catalogue() {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        for (file, declared) in [
            ("python/condyle/_summary.py", python_types()),
            ("web/src/page/catalogue.ts", typescript_types()),
        ] {
            // A crate that was unpacked alone has neither.
            let Ok(text) = fs::read_to_string(format!("{root}/{file}")) else {
                continue;
            };
            assert!(
                text == declared,
                "{file} is out of date; run: cargo run -q -p condyle-results --example result_types"
            );
        }
    }
}
