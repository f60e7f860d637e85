//! Pages from templates, pages of tables and pictures, and their files.

use std::path::PathBuf;

use minijinja::{Environment, syntax::SyntaxConfig, value::Serde};
use serde::Serialize;
use serde_json::json;

use crate::error::ReportError;
use crate::figure::{STYLE, colour_variables};
use crate::number::{fixed, significant};
use crate::program::policy;

pub(crate) const PAGE_STYLE: &str = include_str!("page/page.css");

/// Fills a template of HTML, which is part of the program; texts are escaped.
pub(crate) fn render(template: &str, context: &impl Serialize) -> String {
    let syntax = SyntaxConfig::builder()
        .trim_blocks(true)
        .lstrip_blocks(true)
        .build();
    let mut environment = Environment::new();
    environment.set_syntax(syntax.expect("the default delimiters differ from each other"));
    environment.add_filter("fixed", fixed);
    environment.add_filter("significant", significant);
    // Errors are those of the template itself, which the tests render.
    let page = environment.render_named_str("page.html", template, Serde(context));
    page.unwrap_or_else(|error| panic!("a template cannot be rendered: {error:#}"))
}

/// Writes a text and returns its path.
pub(crate) fn write_text(path: PathBuf, text: &str) -> Result<PathBuf, ReportError> {
    match condyle_results::replace_file(&path, text.as_bytes()) {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Inaccessible {
            path,
            action: "written",
            source,
        }),
    }
}

/// File name, caption and text of a picture.
pub(crate) type Sheet = (&'static str, String, String);

/// Returns text and caption of a picture. Every picture calls its title and description `t` and `d`: on one page these
/// need different names.
pub(crate) fn with_own_ids((name, caption, svg): &Sheet) -> (String, String) {
    let id = name.trim_end_matches(".svg");
    let svg = svg.replace(r#"="t d""#, &format!(r#"="{id}-t {id}-d""#));
    let svg = svg.replace(r#"id="t""#, &format!(r#"id="{id}-t""#));
    let svg = svg.replace(r#"id="d""#, &format!(r#"id="{id}-d""#));
    (svg, caption.clone())
}

/// A page of tables and pictures on white, one file that opens anywhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sheets<'a> {
    /// The kind of page, above the title.
    pub kicker: &'a str,
    pub title: &'a str,
    /// One or two sentences below the title.
    pub lede: &'a str,
    /// Warnings before the tables, a sentence each.
    pub notes: &'a [String],
    /// HTML before the tables.
    pub body: &'a str,
    /// Heading and rows of each table; the first row is the head.
    pub tables: &'a [(String, Vec<Vec<String>>)],
    pub pictures: &'a [Sheet],
    /// The program of the page, with its scenes, as HTML.
    pub program: Option<&'a str>,
}

impl Sheets<'_> {
    pub(crate) fn html(&self) -> String {
        let (light, dark) = colour_variables();
        let pictures: Vec<(String, String)> = self.pictures.iter().map(with_own_ids).collect();
        render(
            include_str!("sheets.html"),
            &json!({
                "policy": policy(self.program.is_some()),
                "program": self.program,
                "light": light,
                "dark": dark,
                "style": PAGE_STYLE,
                "figure_style": STYLE,
                "kicker": self.kicker,
                "title": self.title,
                "lede": self.lede,
                "notes": self.notes,
                "body": self.body,
                "tables": self.tables,
                "pictures": pictures,
            }),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_asks_for_no_network_and_escapes_text() {
        let tables = [(
            "Outputs".to_owned(),
            vec![vec!["x".to_owned()], vec!["<1>".to_owned()]],
        )];
        let pictures = [(
            "one.svg",
            "what".to_owned(),
            "<svg id=\"t\"></svg>".to_owned(),
        )];
        let sheets = Sheets {
            kicker: "a page",
            title: "a < b",
            lede: "10 tests & more",
            notes: &["1 < 2".to_owned()],
            body: "",
            tables: &tables,
            pictures: &pictures,
            program: None,
        };
        let html = sheets.html();
        assert!(html.contains("a &lt; b") && html.contains("&lt;1&gt;") && html.contains("one-t"));
        assert!(html.contains("1 &lt; 2"));
        assert!(!html.contains("src=") && !html.contains("href="));
    }
}
