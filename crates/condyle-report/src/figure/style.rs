//! Colours and type of all pictures, in one place.

/// Name, colour on white, colour on black.
const COLOURS: [(&str, &str, &str); 8] = [
    ("paper", "#ffffff", "#14171a"),
    ("panel", "#f6f7f8", "#1c2024"),
    ("ink", "#16191d", "#e9ecef"),
    ("soft", "#5d666f", "#a3adb6"),
    ("rule", "#d8dde2", "#343b42"),
    ("grid", "#e7eaed", "#2a3036"),
    ("last", "#0b4f7d", "#7cc4f5"),
    ("first", "#f3b562", "#a8701f"),
];

const FIGURE: &str = include_str!("figure.css");

/// The style of pictures, its colours as variables of the page.
pub(crate) fn css() -> &'static str {
    FIGURE
}

/// The style of pictures with the colours of white paper filled in, for readers without variables.
pub(crate) fn css_on_white() -> String {
    COLOURS
        .iter()
        .fold(FIGURE.to_owned(), |css, (name, light, _)| {
            css.replace(&format!("var(--{name})"), light)
        })
}

/// Declarations of the colours: (on white, on black).
pub(crate) fn variables() -> (String, String) {
    let declare = |pick: fn(&(&str, &'static str, &'static str)) -> &'static str| {
        COLOURS
            .iter()
            .map(|colour| format!("--{}:{};", colour.0, pick(colour)))
            .collect()
    };
    (declare(|colour| colour.1), declare(|colour| colour.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_on_white_need_no_variables() {
        assert!(!css_on_white().contains("var("));
    }
}
