//! `study.html`: tables and pictures of a study, one file that opens anywhere.

use std::path::{Path, PathBuf};

use crate::error::ReportError;
use crate::figure::{css, escape, variables};
use crate::file::write_text;

/// The style of the report's page.
const STYLE: &str = include_str!("../page/page.css");

/// What the page of a study shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudyPage {
    /// Its heading.
    pub title: String,
    /// What was done, in a sentence or two.
    pub lede: String,
    /// Each with a heading, and rows of which the first is the head.
    pub tables: Vec<(String, Vec<Vec<String>>)>,
    /// Names of the files, what they show, and their texts.
    pub pictures: Vec<(&'static str, String, String)>,
}

/// Writes `study.html` and every picture into `folder`, and returns the path of the page.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_study_page(folder: &Path, page: &StudyPage) -> Result<PathBuf, ReportError> {
    for (name, _, svg) in &page.pictures {
        write_text(folder.join(name), svg)?;
    }
    write_text(folder.join("study.html"), &html(page))
}

fn html(page: &StudyPage) -> String {
    let (light, dark) = variables();
    let (title, lede, figures) = (escape(&page.title), escape(&page.lede), css());
    let tables: String = page.tables.iter().map(table).collect();
    let pictures: String = page.pictures.iter().map(picture).collect();
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width,initial-scale=1\"><title>{title}</title><style>:root{{{light}}}\
         @media(prefers-color-scheme:dark){{:root{{{dark}}}}}{STYLE}{figures}{OWN_STYLE}</style></head><body><main>\
         <p class=\"kicker\">condyle study</p><h1>{title}</h1><p class=\"lede\">{lede}</p>{tables}{pictures}</main></body></html>\n"
    )
}

/// Pictures are drawn on white, and stay so on a dark page.
const OWN_STYLE: &str = ".sheet{background:#fff;overflow-x:auto}.sheet svg{max-width:100%;height:auto}.wide{overflow-x:auto}\
    .wide td,.wide th{padding:4px 14px 4px 0;text-align:left;white-space:nowrap;font-size:14px}";

fn table((heading, rows): &(String, Vec<Vec<String>>)) -> String {
    let row = |cells: &Vec<String>, tag: &str| {
        let cells = cells
            .iter()
            .map(|cell| format!("<{tag}>{}</{tag}>", escape(cell)));
        format!("<tr>{}</tr>", cells.collect::<String>())
    };
    let body: String = rows.iter().skip(1).map(|cells| row(cells, "td")).collect();
    let head = rows
        .first()
        .map(|cells| row(cells, "th"))
        .unwrap_or_default();
    let heading = escape(heading);
    format!(
        "<section><h2>{heading}</h2><div class=\"wide\"><table>{head}{body}</table></div></section>"
    )
}

fn picture((name, caption, svg): &(&'static str, String, String)) -> String {
    // Titles of pictures on one page have names of their own.
    let id = name.trim_end_matches(".svg");
    let svg = svg.replace(
        "aria-labelledby=\"t d\"",
        &format!("aria-labelledby=\"{id}-t {id}-d\""),
    );
    let svg = svg.replace("id=\"t\"", &format!("id=\"{id}-t\""));
    let svg = svg.replace("id=\"d\"", &format!("id=\"{id}-d\""));
    let caption = escape(caption);
    format!(
        "<section><figure class=\"sheet\">{svg}</figure><p class=\"note\">{caption}</p></section>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_asks_for_no_network_and_escapes_text() {
        let page = StudyPage {
            title: "a < b".to_owned(),
            lede: "10 tests & more".to_owned(),
            tables: vec![(
                "Outputs".to_owned(),
                vec![vec!["x".to_owned()], vec!["<1>".to_owned()]],
            )],
            pictures: vec![(
                "one.svg",
                "what".to_owned(),
                "<svg id=\"t\"></svg>".to_owned(),
            )],
        };
        let html = html(&page);
        assert!(html.contains("a &lt; b") && html.contains("&lt;1&gt;") && html.contains("one-t"));
        assert!(!html.contains("src=") && !html.contains("href="));
    }
}
