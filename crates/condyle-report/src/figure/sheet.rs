//! A picture as a file of its own: on white, its style inside.

use super::escape::escape;
use super::panel::Panel;
use super::style::css_on_white;

/// Margin around a picture that stands alone, px.
const MARGIN: f64 = 16.0;
/// Space between rows of panels, px.
const GAP: f64 = 14.0;
/// Height of the line under the panels that says what the curves are, px.
const CAPTION: f64 = 26.0;

/// An SVG file of a drawing of `size` (width, height) px.
pub(crate) fn alone(title: &str, desc: &str, size: (f64, f64), body: &str) -> String {
    let (width, height) = (size.0 + 2.0 * MARGIN, size.1 + 2.0 * MARGIN);
    let (title, desc, style) = (escape(title), escape(desc), css_on_white());
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" class="fig" role="img" aria-labelledby="t d" viewBox="0 0 {width} {height}" width="{width}" height="{height}"><title id="t">{title}</title><desc id="d">{desc}</desc><style>{style}</style><rect width="{width}" height="{height}" fill="#fff"/><g transform="translate({MARGIN} {MARGIN})">{body}</g></svg>
"##
    )
}

/// An SVG file of panels in rows of `columns`, with a key of (class, meaning) below.
pub(crate) fn sheet(
    title: &str,
    desc: &str,
    panels: &[Panel],
    columns: usize,
    key: &[(&str, &str)],
) -> String {
    let rows = panels.len().div_ceil(columns);
    let cell = panels
        .first()
        .map_or((0.0, 0.0), |panel| (panel.size.0, panel.size.1 + GAP));
    let (width, height) = (columns as f64 * cell.0, rows as f64 * cell.1);
    let mut body = String::new();
    for (index, panel) in panels.iter().enumerate() {
        let x = (index % columns) as f64 * cell.0;
        let y = (index / columns) as f64 * cell.1;
        body += &format!(r#"<g transform="translate({x} {y})">{}</g>"#, panel.body());
    }
    body += &key_line(key, height + CAPTION / 2.0);
    alone(title, desc, (width, height + CAPTION), &body)
}

fn key_line(key: &[(&str, &str)], y: f64) -> String {
    // What a letter takes, and the least from one entry to the next, px.
    const LETTER: f64 = 6.2;
    const PITCH: f64 = 130.0;
    let mut x = 46.0;
    let mut line = String::new();
    for (class, meaning) in key {
        let (end, text, base) = (x + 24.0, x + 32.0, y + 3.8);
        x += PITCH.max(56.0 + LETTER * meaning.chars().count() as f64);
        let meaning = escape(meaning);
        line += &format!(
            r#"<path class="{class}" d="M{} {y}H{end}"/><text x="{text}" y="{base}">{meaning}</text>"#,
            end - 24.0
        );
    }
    line
}
