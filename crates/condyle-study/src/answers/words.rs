//! Names and numbers of answers in words.

use condyle_case::study::Bound;
use condyle_results::{catalogue, split_unit};

/// Returns the label of an output; of an input, its key.
pub(crate) fn label(key: &str) -> String {
    let is_input = key.contains('.');
    let of_formula = || match is_input {
        true => key.to_owned(),
        false => split_unit(key).0.replace('_', " "),
    };
    catalogue::output(key).map_or_else(of_formula, |output| output.label.to_owned())
}

/// Returns the label with the unit of an output; of an input, its key.
pub(crate) fn labelled(key: &str) -> String {
    match split_unit(key).1 {
        Some(unit) if !key.contains('.') => format!("{}, {unit}", label(key)),
        _ => label(key),
    }
}

/// Returns both sides of a limit in words.
pub(crate) fn sides_in_words(bound: &Bound) -> impl Iterator<Item = String> {
    let (label, unit) = (bound.output.label, bound.output.unit());
    bound.sides().map(move |(sign, limit)| {
        let side = if sign > 0.0 { "at most" } else { "at least" };
        let words = format!("{label} {side} {limit} {unit}");
        words.trim_end().to_owned()
    })
}

/// Returns the title of an output within a sentence, with its design if there are several.
pub(crate) fn within_design(title: &str, design: Option<&str>) -> String {
    design.map_or_else(|| title.to_owned(), |design| format!("{title} of {design}"))
}

/// Returns a title as it stands within a sentence: "AP force" keeps its capitals.
pub(crate) fn within_sentence(title: &str) -> String {
    let is_word = title.chars().nth(1).is_none_or(char::is_lowercase);
    let mut letters = title.chars();
    match letters.next().filter(|_| is_word) {
        Some(first) => first.to_lowercase().chain(letters).collect(),
        None => title.to_owned(),
    }
}

/// Returns a number with four significant digits; a dash for one that is not known.
pub(crate) fn shown(value: f64) -> String {
    if value.is_nan() {
        return "-".to_owned();
    }
    if value == 0.0 || !value.is_finite() {
        return format!("{value:.0}");
    }
    let decimals = (3 - value.abs().log10().floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}

pub(crate) fn with_interval(share: f64, [low, high]: [f64; 2]) -> String {
    let low = 100.0 * low;
    format!("{} ({low:.1} to {})", percent(share), percent(high))
}

/// Returns a probability in percent, to a ten thousandth; a smaller one than a thousandth to two digits.
fn chance(probability: f64) -> String {
    let percent = 100.0 * probability;
    if percent <= 0.0 || percent >= 0.1 {
        return format!("{percent:.2} %");
    }
    let decimals = (1 - percent.log10().floor() as i32) as usize;
    format!("{percent:.decimals$} %")
}

/// Returns a small probability with its 95 % interval in words; of one that its points do not resolve, the upper end.
pub(crate) fn chance_in_words(probability: f64, [low, high]: [f64; 2]) -> String {
    if high < 0.01 && low < 0.01 * high {
        return format!("below {}", chance(high));
    }
    let [probability, low, high] = [probability, low, high].map(chance);
    format!("{probability} ({low} to {high})")
}

pub(crate) fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Returns the share between two ends, or one if they are equal.
pub(crate) fn percents([low, high]: [f64; 2]) -> String {
    match low == high {
        true => percent(low),
        false => format!("{} to {}", percent(low), percent(high)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_probability_below_the_resolution_of_its_interval_is_its_upper_end() {
        let words = [
            (8.8e-7, [5.4e-9, 2.7e-5], "below 0.0027 %"),
            (5.6e-12, [4.3e-9, 2.5e-5], "below 0.0025 %"),
            (5.5e-4, [1.7e-4, 1.4e-3], "0.055 % (0.017 % to 0.14 %)"),
            (0.9992, [0.9975, 1.0], "99.92 % (99.75 % to 100.00 %)"),
        ];
        for (probability, interval, words) in words {
            assert_eq!(chance_in_words(probability, interval), words);
        }
    }

    #[test]
    fn outputs_have_the_labels_of_the_catalogue_and_inputs_their_keys() {
        assert_eq!(label("mass_loss_mg"), "mass loss");
        assert_eq!(labelled("mass_loss_mg"), "mass loss, mg");
        assert_eq!(labelled("medial_load_share"), "medial load share");
        assert_eq!(labelled("contact.friction"), "contact.friction");
    }
}
