//! Pictures as SVG, drawn from numbers; they know no file.

mod axis;
mod contour;
mod map;
mod panel;
mod path;
mod sheet;
mod style;

pub(crate) use axis::Axis;
pub(crate) use map::{Map, Range, Shades};
pub(crate) use panel::{Curve, Panel};
pub(crate) use sheet::{alone, sheet};
pub(crate) use style::{css, variables};

/// Text made safe inside SVG and HTML.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            other => out.push(other),
        }
    }
    out
}
