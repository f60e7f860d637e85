//! Pages from templates.

use minijinja::{Environment, syntax::SyntaxConfig, value::Serde};
use serde::Serialize;

use crate::number::{fixed, significant};

/// The style of all pages.
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
    environment.add_filter("known", |value: Option<f64>, digits: i32| {
        value.map_or_else(|| "\u{2013}".to_owned(), |value| significant(value, digits))
    });
    environment.add_filter("signed", |value: f64, digits: i32| {
        let sign = if value < 0.0 { '\u{2212}' } else { '+' };
        format!("{sign}{}", significant(value.abs(), digits))
    });
    // Errors are those of the template itself, which the tests render.
    let page = environment.render_named_str("page.html", template, Serde(context));
    page.unwrap_or_else(|error| panic!("a template cannot be rendered: {error:#}"))
}
