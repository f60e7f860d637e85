//! Values that must be one of a few words, and values of another type than their key takes.

use toml::Spanned;
use toml::de::DeValue;

use super::key::Key;
use super::key_reason::KeyReason;
use super::log::Log;
use super::unknown::nearest;
use super::value::{quoted_list, type_name};

/// Reports that `value` is not what `key` takes.
pub(crate) fn wrong_type(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) {
    let reason = KeyReason::WrongType {
        key: key.name.to_owned(),
        wanted: key.kind.to_string(),
        found: type_name(value.get_ref()),
    };
    log.problem(value.span(), reason);
}

/// The one of `words` that `value` is, or the reason in `log`.
pub(crate) fn read_word<'w>(
    value: &Spanned<DeValue<'_>>,
    key: &Key,
    words: &[&'w str],
    log: &mut Log<'_>,
) -> Option<&'w str> {
    let Some(written) = value.get_ref().as_str() else {
        wrong_type(value, key, log);
        return None;
    };
    let known = words.iter().find(|word| **word == written);
    if known.is_none() {
        let reason = KeyReason::UnknownWord {
            key: key.name.to_owned(),
            word: written.to_owned(),
            near: nearest(written, words.iter().copied()),
            words: quoted_list(words),
        };
        log.problem(value.span(), reason);
    }
    known.copied()
}
