//! Lists of pairs of numbers.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeValue;

use super::key_reason::KeyReason;
use super::log::Log;
use super::value::{number, type_name};

/// A pair of numbers and where it stands.
pub(crate) type PlacedPair = ([f64; 2], Range<usize>);

/// A list of pairs of numbers with their places, or everything in it that is none.
pub(crate) fn pairs(
    value: &Spanned<DeValue<'_>>,
    key: &str,
    log: &mut Log<'_>,
) -> Option<Vec<PlacedPair>> {
    let mut wrong = |value: &Spanned<DeValue<'_>>, wanted: &str| {
        let reason = KeyReason::WrongType {
            key: key.to_owned(),
            wanted: wanted.to_owned(),
            found: type_name(value.get_ref()),
        };
        log.problem(value.span(), reason);
    };
    let Some(list) = value.get_ref().as_array() else {
        wrong(value, "a list of pairs, such as [[0.0, 1.0], [50.0, 2.0]]");
        return None;
    };
    let mut pairs = Vec::new();
    for item in list {
        match pair(item.get_ref()) {
            Some(pair) => pairs.push((pair, item.span())),
            None => wrong(item, "made of pairs of numbers"),
        }
    }
    (pairs.len() == list.len()).then_some(pairs)
}

/// A list of two numbers.
fn pair(value: &DeValue<'_>) -> Option<[f64; 2]> {
    let cells = value.as_array()?.iter();
    let numbers: Option<Vec<f64>> = cells.map(|cell| number(cell.get_ref())).collect();
    numbers?.try_into().ok()
}
