//! Values of a case set from outside, before the case is read.

use std::fmt;

use thiserror::Error;
use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

use super::contents::{Case, LeftOutConstant};
use super::key_names::{KeyNameError, OverrideError, path_called};
use super::table::WearLaws;
use crate::config::{Problems, likeliest};

/// A number to be taken in place of the one that the case file gives, or leaves out.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    path: String,
    text: String,
    value: f64,
}

impl Override {
    /// The number written as `text` for the key at the dotted `path`.
    ///
    /// # Errors
    /// A text that is no finite number of TOML. Whether the key exists and the number is in its
    /// range is seen when a case is read with it.
    pub fn new(path: &str, text: &str) -> Result<Self, OverrideError> {
        let value = match text.parse::<Value>() {
            Ok(Value::Integer(whole)) => Some(*whole.value() as f64),
            Ok(Value::Float(float)) => Some(*float.value()),
            Ok(_) | Err(_) => None,
        };
        let (path, text) = (path.to_owned(), text.trim().to_owned());
        match value.filter(|value| value.is_finite()) {
            Some(value) => Ok(Self { path, text, value }),
            None => Err(OverrideError::NotNumber { path, text }),
        }
    }

    /// Dotted path of the key.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The number as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The number, in the unit of the key's name.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The text of a case with this number in it; a text that is not TOML stays as it is.
    pub(super) fn applied_to(&self, case: &str) -> String {
        let value = self.text.parse().unwrap_or(self.value.into());
        with_value(case, &self.path, value)
    }
}

/// The text of a case with `value` at the dotted `path`; a text that is not TOML stays as it is.
pub(super) fn with_value(case: &str, path: &str, value: Value) -> String {
    let Ok(mut document) = case.parse::<DocumentMut>() else {
        return case.to_owned();
    };
    let (tables, key) = path.rsplit_once('.').unwrap_or(("", path));
    let names: Vec<&str> = tables.split('.').filter(|name| !name.is_empty()).collect();
    set(table_at(document.as_table_mut(), &names), key, value);
    document.to_string()
}

/// The table at the end of a path; of a list of tables the one with the name that follows.
fn table_at<'a>(above: &'a mut dyn TableLike, names: &[&str]) -> &'a mut dyn TableLike {
    match names {
        [] => above,
        [list, name, below @ ..] if above.get(list).is_some_and(Item::is_array_of_tables) => {
            table_at(named_in(above, list, name), below)
        }
        [name, below @ ..] => table_at(table_in(above, name), below),
    }
}

/// The table called `name` of the list `list`, put there if it is not; a reader then says what it lacks.
fn named_in<'a>(above: &'a mut dyn TableLike, list: &str, name: &str) -> &'a mut dyn TableLike {
    let tables = above
        .get_mut(list)
        .and_then(Item::as_array_of_tables_mut)
        .expect("it was seen there");
    let is_called = |table: &Table| table.get("name").and_then(Item::as_str) == Some(name);
    let place = tables.iter().position(is_called);
    if place.is_none() {
        let mut table = Table::new();
        table.insert("name", toml_edit::value(name));
        tables.push(table);
    }
    let place = place.unwrap_or(tables.len() - 1);
    tables.get_mut(place).expect("it was put there")
}

/// The table `name`, put there if it is not; a reader then says what should be there instead.
fn table_in<'a>(above: &'a mut dyn TableLike, name: &str) -> &'a mut dyn TableLike {
    if !above.get(name).is_some_and(Item::is_table_like) {
        above.insert(name, toml_edit::table());
    }
    above
        .get_mut(name)
        .and_then(Item::as_table_like_mut)
        .expect("it was put there")
}

/// Sets a value, with the blanks and the comment around the one before.
fn set(table: &mut dyn TableLike, key: &str, mut value: Value) {
    if let Some(before) = table.get(key).and_then(Item::as_value) {
        *value.decor_mut() = before.decor().clone();
    }
    table.insert(key, Item::Value(value));
}

/// The key that chooses the law.
const CHOOSES: &str = "wear.law";

/// The text of a case with `set` keys changed to those of `changed`, less the constants of the file's own law where
/// another was set; and these.
///
/// A constant that is itself set from outside stays, for the reader to judge.
pub(super) fn without_other_laws(
    changed: &str,
    set: &[&str],
    laws: WearLaws,
) -> (String, Vec<LeftOutConstant>) {
    let as_it_is = || (changed.to_owned(), Vec::new());
    let Ok(mut document) = changed.parse::<DocumentMut>() else {
        return as_it_is();
    };
    let table = document.get_mut("wear").and_then(Item::as_table_like_mut);
    let (true, Some(table)) = (set.contains(&CHOOSES), table) else {
        return as_it_is();
    };
    let left_out = take_out(table, set, laws);
    (document.to_string(), left_out)
}

/// Takes out of `[wear]` what other laws than its own have, unless it was set.
fn take_out(table: &mut dyn TableLike, set: &[&str], laws: WearLaws) -> Vec<LeftOutConstant> {
    let word = table.get("law").and_then(Item::as_str);
    let Some(own) = laws.iter().find(|law| Some(law.word) == word) else {
        return Vec::new();
    };
    let others = laws.iter().flat_map(|law| law.parameters);
    let others: Vec<&str> = others.map(|parameter| parameter.name).collect();
    let belongs_elsewhere = |key: &&str| {
        let is_own = own.parameters.iter().any(|own| own.name == *key);
        let is_set = set.contains(&format!("wear.{key}").as_str());
        others.contains(key) && !is_own && !is_set
    };
    let keys: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).collect();
    let keys = keys.iter().map(String::as_str).filter(belongs_elsewhere);
    let take = |key: &str| {
        let value = table.remove(key)?;
        let written = format!("{key} = {}", value.as_value()?.to_string().trim());
        let law = own.word;
        Some(LeftOutConstant { written, law })
    };
    keys.filter_map(take).collect()
}

/// A value to be taken in place of the one that the case file gives, or leaves out.
#[derive(Clone, Debug)]
pub struct Assignment {
    key: String,
    text: String,
}

/// Why a value of a case cannot be set from outside.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum AssignmentError {
    /// Not written as a key with a value.
    #[error("`{written}` is no key with a value; write them as `march.updates=5`")]
    NotKeyAndValue {
        /// As written.
        written: String,
    },
    /// A name that is not that of one key.
    #[error(transparent)]
    Name(#[from] KeyNameError),
}

/// Why a case cannot be read with values set from outside.
#[derive(Clone, Debug, Error)]
pub enum ChangeError {
    /// What is wrong with the case, as it is or changed.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A value that cannot be set.
    #[error(transparent)]
    Assignment(#[from] AssignmentError),
}

impl Assignment {
    /// The one written as `key=value`: the key a dotted path, or the last word of one, with or
    /// without its unit; the value as in a case, but a word needs no quotes.
    ///
    /// # Errors
    /// A text without a key or without a value.
    pub fn parse(written: &str) -> Result<Self, AssignmentError> {
        let (key, text) = written.split_once('=').unwrap_or_default();
        let (key, text) = (key.trim().to_owned(), text.trim().to_owned());
        if key.is_empty() || text.is_empty() {
            let written = written.to_owned();
            return Err(AssignmentError::NotKeyAndValue { written });
        }
        Ok(Self { key, text })
    }

    /// The one that gives `key` a value, written as in a case, but a word needs no quotes.
    pub fn of(key: &str, text: String) -> Self {
        let key = key.to_owned();
        Self { key, text }
    }

    /// Whether its key is a dotted path, which says where it stands without a look at the case.
    pub(super) fn is_placed(&self) -> bool {
        self.key.contains('.')
    }

    /// The dotted path of its key, once it is placed.
    pub(super) fn key(&self) -> &str {
        &self.key
    }

    /// The same with the dotted path of its key in `case`.
    pub(super) fn placed_in(&self, case: &Case) -> Result<Self, AssignmentError> {
        let key = case.path_of_key(&self.key)?;
        let text = self.text.clone();
        Ok(Self { key, text })
    }

    /// The text of a case with this value in it; a text that is not TOML stays as it is.
    pub(super) fn applied_to(&self, case: &str) -> String {
        let value = self.text.parse::<Value>();
        with_value(
            case,
            &self.key,
            value.unwrap_or_else(|_| self.text.as_str().into()),
        )
    }

    /// The key and the value, as messages name them.
    pub(super) fn in_words(&self) -> String {
        format!("{} = {}", self.key, self.text)
    }
}

impl Case {
    /// The dotted path of the key that `written` names: a dotted path as it is, or the last word of one, with or without
    /// its unit.
    pub(crate) fn path_of_key(&self, written: &str) -> Result<String, KeyNameError> {
        if written.contains('.') {
            return Ok(written.to_owned());
        }
        let paths: Vec<String> = self.keys().into_iter().map(|(path, _)| path).collect();
        let near = |names: &[&str]| likeliest(written, names);
        path_called("key", written, &paths, near)
    }
}

impl fmt::Display for Assignment {
    /// As [`Assignment::parse`] reads it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.text)
    }
}

#[cfg(test)]
mod tests {
    use condyle::wear::WEAR_LAWS;

    use super::*;

    fn applied(path: &str, text: &str, case: &str) -> String {
        let number = Override::new(path, text).expect("a number");
        number.applied_to(case)
    }

    #[test]
    fn only_the_number_changes() {
        let case = "title = \"a\"\n\n[march] # long\ncycles = 10  # few\nupdates = 2   # fewer\n";
        let changed = applied("march.updates", "5", case);
        assert_eq!(changed, case.replace("= 2 ", "= 5 "));
        assert_eq!(applied("march.updates", "5", &changed), changed);
        assert_eq!(
            applied("march.updates", "0x10", case),
            case.replace("= 2 ", "= 0x10 ")
        );
    }

    #[test]
    fn a_key_or_table_that_is_not_there_is_added() {
        assert_eq!(
            applied("time.increments", "50", "[march]\nupdates = 2\n"),
            "[march]\nupdates = 2\n\n[time]\nincrements = 50\n"
        );
        assert_eq!(
            applied(
                "machine.springs.free_play_mm",
                "1.5",
                "machine.frequency_hz = 1\n"
            ),
            "machine.frequency_hz = 1\n\n[machine.springs]\nfree_play_mm = 1.5\n"
        );
        assert_eq!(applied("a.b", "1", "a = {}\n"), "a = { b = 1 }\n");
    }

    #[test]
    fn a_text_that_is_not_toml_is_left_for_the_reader() {
        assert_eq!(applied("march.updates", "5", "[march\n"), "[march\n");
    }

    #[test]
    fn values_are_finite_numbers() {
        let value = |text| Override::new("a", text).map(|number| number.value());
        assert_eq!(value("1_000"), Ok(1000.0));
        assert_eq!(value("-1e-3"), Ok(-1e-3));
        for text in ["", "ten", "inf", "nan", "[1]", "1 2", ".5"] {
            let error = Override::new("march.updates", text).expect_err(text);
            let expected = format!("`{text}` is no value for `march.updates`; write a number");
            assert!(error.to_string().starts_with(&expected), "{error}");
        }
    }

    const CHANGED: &str = "[wear]\nlaw = \"kang\"\nwear_factor_mm3_per_nm = 2.64e-7 # paper\ndecay_per_mpa = 0.2\nlog = 1\n";

    #[test]
    fn only_constants_of_other_laws_are_left_out_and_told() {
        let (text, left_out) = without_other_laws(CHANGED, &["wear.law"], WEAR_LAWS);
        assert_eq!(
            text,
            "[wear]\nlaw = \"kang\"\ndecay_per_mpa = 0.2\nlog = 1\n"
        );
        let [one] = &left_out[..] else {
            panic!("{left_out:?}");
        };
        // A comment behind a value is the file's, not the value's.
        assert!(one.written.starts_with("wear_factor_mm3_per_nm = 2.64e-7"));
        assert_eq!(one.law, "kang");
    }

    #[test]
    fn a_file_that_is_wrong_itself_or_a_constant_that_was_set_stays_for_the_reader() {
        for set in [
            &["march.updates"][..],
            &["wear.law", "wear.wear_factor_mm3_per_nm"],
        ] {
            let (text, left_out) = without_other_laws(CHANGED, set, WEAR_LAWS);
            assert_eq!((text.as_str(), left_out.len()), (CHANGED, 0));
        }
        let nothing = without_other_laws("[wear\n", &["wear.law"], WEAR_LAWS);
        assert_eq!(nothing, ("[wear\n".to_owned(), Vec::new()));
    }
}
