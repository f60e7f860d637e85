//! Problems of keys, values and files.

use std::error::Error;
use std::path::Path;

use condyle::parameter::{split_unit, unit_of};
use thiserror::Error;
use toml::de::DeValue;

use super::key::{number, quoted_list};
use super::suggest::{bases, convert, likeliest, nearest};

/// A problem of a file as data; `Display` describes it.
///
/// Every part of a file has its own reasons, each an enum with fields or a struct.
pub trait Reason: Error + Send + Sync + 'static {
    /// Returns the remedy, if it does not follow from the description.
    fn advice(&self) -> Option<String>;
}

/// A problem and its remedy in words.
#[derive(Clone, Debug, Error)]
#[error("{message}")]
pub(crate) struct Fault {
    message: String,
    advice: String,
}

impl Fault {
    pub(crate) fn new(message: impl Into<String>, advice: impl Into<String>) -> Self {
        let (message, advice) = (message.into(), advice.into());
        Self { message, advice }
    }
}

impl Reason for Fault {
    fn advice(&self) -> Option<String> {
        (!self.advice.is_empty()).then(|| self.advice.clone())
    }
}

pub(crate) fn wrong_type(key: &str, wanted: &str, found: &str) -> Fault {
    Fault::new(format!("`{key}` must be {wanted}, this is {found}"), "")
}

pub(crate) fn idle(key: &str, needs: &str) -> Fault {
    Fault::new(
        format!("`{key}` means nothing here: it needs {needs}"),
        format!("remove `{key}`, or add what it needs"),
    )
}

pub(crate) fn both(section: &str, first: &str, second: &str) -> Fault {
    Fault::new(
        format!("{section} has both `{first}` and `{second}`, which say the same thing twice"),
        format!("keep `{first}` or `{second}`, not both"),
    )
}

pub(crate) fn out_of_range(key: &str, value: &str, range: &str) -> Fault {
    Fault::new(
        format!("`{key}` is {value}, outside its range"),
        format!("it can be {range}"),
    )
}

/// Returns the likeliest reason why `section` has no `key` among `keys`.
pub(crate) fn explain(key: &str, value: &DeValue<'_>, section: &str, keys: &[&str]) -> Fault {
    if let Some(fault) = wrong_unit(key, value, keys) {
        return fault;
    }
    let advice = match likeliest(key, keys) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("remove it; the keys here are {}", keys.join(", ")),
    };
    Fault::new(format!("{section} has no key `{key}`"), advice)
}

fn wrong_unit(key: &str, value: &DeValue<'_>, keys: &[&str]) -> Option<Fault> {
    let same_quantity = |known: &&&str| {
        let (base, unit) = split_unit(known);
        unit.is_some() && bases(key).any(|written| written == base)
    };
    let meant = *keys.iter().find(same_quantity)?;
    let unit = unit_of(meant)?;
    let advice = match number(value).and_then(|number| convert(key, meant, number)) {
        Some(value) => format!("write `{meant} = {value}`"),
        None => format!("write `{meant}`, with the value in {unit}"),
    };
    let message = format!("`{key}` is in another unit: the key is `{meant}`, in {unit}");
    Some(Fault::new(message, advice))
}

pub(crate) fn unknown_word(key: &str, word: &str, words: &[&str]) -> Fault {
    let listed = quoted_list(words);
    let advice = match nearest(word, words.iter().copied()) {
        Some(near) => format!("did you mean \"{near}\"? It can be {listed}"),
        None => format!("it can be {listed}"),
    };
    Fault::new(format!("`{key}` cannot be \"{word}\""), advice)
}

pub(crate) fn other_choice(key: &str, owner: &str, chosen: &str) -> Fault {
    Fault::new(
        format!("`{key}` belongs to {owner}, but this case has {chosen}"),
        format!("remove it, or write `{owner}`"),
    )
}

pub(crate) fn missing_key(section: &str, key: &str, wanted: &str) -> Fault {
    Fault::new(
        format!("{section} needs `{key}`"),
        format!("add `{key} = `, {wanted}"),
    )
}

pub(crate) fn syntax(message: &str) -> Fault {
    let advice = "a line is `key = value`: text in quotes, a number without its unit, a list in square brackets; a key \
        is in its table once";
    Fault::new(format!("this is not TOML: {message}"), advice)
}

pub(crate) fn missing_file(key: &str, path: &Path) -> Fault {
    let holds = |name: &str| path.iter().any(|part| part == name);
    let advice = if holds("dm-knee") {
        "data are not part of condyle: fetch the Grand Challenge subject DM meshes and gait \
         (Fregly et al. 2012; in jam-resources, models/knee_tka/grand_challenge/DM) and put them \
         there; see the comment at the top of the case"
    } else if holds("data") {
        "data are not part of condyle: the comment at the top of the case says where they come \
         from"
    } else {
        "correct the path; it counts from the folder of the file that names it"
    };
    let message = format!("`{key}`: there is no file {}", path.display());
    Fault::new(message, advice)
}
