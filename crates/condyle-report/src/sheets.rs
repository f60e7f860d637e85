//! A page of tables and pictures on white sheets, one file that opens anywhere.

use crate::figure::{css, escape, variables};

/// The style of the report's page.
const STYLE: &str = include_str!("page/page.css");

/// What such a page shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sheets<'a> {
    /// What kind of page it is.
    pub kicker: &'a str,
    /// Its heading.
    pub title: &'a str,
    /// What was done, in a sentence or two.
    pub lede: &'a str,
    /// What is to be known before, a sentence each.
    pub notes: &'a [String],
    /// Each with a heading, and rows of which the first is the head.
    pub tables: &'a [(String, Vec<Vec<String>>)],
    /// Names of the files, what they show, and their texts.
    pub pictures: &'a [(&'static str, String, String)],
}

impl Sheets<'_> {
    /// The page as text.
    pub(crate) fn html(&self) -> String {
        let (light, dark) = variables();
        let [kicker, title, lede] = [self.kicker, self.title, self.lede].map(escape);
        let figures = css();
        let notes = self.notes.iter().map(|note| escape(note));
        let notes: String = notes
            .map(|note| format!("<p class=\"note\">{note}</p>"))
            .collect();
        let tables: String = self.tables.iter().map(table).collect();
        let pictures: String = self.pictures.iter().map(picture).collect();
        format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
             content=\"width=device-width,initial-scale=1\"><title>{title}</title><style>:root{{{light}}}\
             @media(prefers-color-scheme:dark){{:root{{{dark}}}}}{STYLE}{figures}{OWN_STYLE}</style></head><body><main>\
             <p class=\"kicker\">{kicker}</p><h1>{title}</h1><p class=\"lede\">{lede}</p>{notes}{tables}{pictures}</main></body></html>\n"
        )
    }
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
            tables: &tables,
            pictures: &pictures,
        };
        let html = sheets.html();
        assert!(html.contains("a &lt; b") && html.contains("&lt;1&gt;") && html.contains("one-t"));
        assert!(html.contains("1 &lt; 2"));
        assert!(!html.contains("src=") && !html.contains("href="));
    }
}
