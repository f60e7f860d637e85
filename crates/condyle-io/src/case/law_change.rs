//! A wear law chosen from outside: constants in the file of the law before it have no place under it.

use toml_edit::{DocumentMut, Item, TableLike};

use super::wear::WearLaws;

/// The key that chooses the law.
const CHOOSES: &str = "wear.law";

/// A constant of the file that the law chosen from outside does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LeftOutConstant {
    /// As the file writes it.
    pub(super) written: String,
    /// The law chosen from outside.
    pub(super) law: &'static str,
}

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

#[cfg(test)]
mod tests {
    use condyle::wear::WEAR_LAWS;

    use super::*;

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
