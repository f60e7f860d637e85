//! Pages from templates, pages of tables and pictures, and their files.

use std::path::PathBuf;

use askama::Template;

use crate::error::ReportError;
use crate::figure::STYLE;

pub(crate) const PAGE_STYLE: &str = include_str!("page/page.css");

/// Returns the text of a page.
pub(crate) fn filled(page: &impl Template) -> String {
    page.render()
        .expect("a page is written to memory, and no part of it fails")
}

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
pub(crate) type Sheet = (String, String, String);

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
#[derive(Default, Template)]
#[template(path = "sheets.html")]
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
            "one.svg".to_owned(),
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
        let html = filled(&sheets);
        assert!(
            html.contains("a &#60; b") && html.contains("&#60;1&#62;") && html.contains("one-t")
        );
        assert!(html.contains("1 &#60; 2"));
        assert!(!html.contains("src=") && !html.contains("href="));
    }
}
