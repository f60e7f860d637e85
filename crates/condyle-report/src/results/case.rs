//! The facts of a case file that the report states.

use condyle_results::Side;
use toml::{Table, Value};

/// Returns the side of the knee: left if any table of the case has `side = "left"`, else right.
pub(super) fn side(case: &str) -> Side {
    match case.parse::<Table>() {
        Ok(case) if has_left(&case) => Side::Left,
        _ => Side::Right,
    }
}

fn has_left(table: &Table) -> bool {
    table.iter().any(|(key, value)| match value {
        Value::String(text) => key == "side" && text == "left",
        Value::Table(inner) => has_left(inner),
        _ => false,
    })
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CaseFacts {
    /// `title` or `name` at the top of the case.
    pub title: Option<String>,
    /// Cycles of the whole test.
    pub cycles: Option<f64>,
    /// True if the insert is a deformable solid rather than a foundation.
    pub is_deformable: bool,
    pub yields: bool,
    pub creeps: bool,
}

impl CaseFacts {
    /// Reads the facts of a case; empty for a text that is not TOML.
    pub(crate) fn of(case: &str) -> Self {
        let case: Table = case.parse().unwrap_or_default();
        let value = |table: &str, key: &str| case.get(table)?.get(key);
        let word = |table: &str, key: &str| value(table, key)?.as_str();
        // Results of version 0.1 have the key in the table above.
        let model = value("contact", "deformable").or(case.get("contact"));
        let plasticity = model.and_then(|model| model.get("plasticity")?.as_str());
        let yields = plasticity.is_some_and(|plasticity| plasticity != "none");
        let cycles = value("march", "cycles");
        let cycles = cycles.and_then(|cycles| match cycles {
            Value::Integer(cycles) => Some(*cycles as f64),
            other => other.as_float(),
        });
        let mut titles = ["title", "name"].into_iter();
        let title = titles.find_map(|key| case.get(key)?.as_str());
        Self {
            title: title.map(str::to_owned),
            cycles,
            is_deformable: word("contact", "model") == Some("deformable"),
            yields,
            creeps: word("creep", "law").is_some_and(|law| law != "none"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_side_is_found_in_any_table() {
        assert_eq!(side("[implant]\nside = \"left\"\n"), Side::Left);
        assert_eq!(side("side = \"right\"\n"), Side::Right);
        assert_eq!(side("no toml at all"), Side::Right);
    }

    #[test]
    fn the_cycles_are_those_of_the_march() {
        let cycles = |case| CaseFacts::of(case).cycles;
        assert_eq!(cycles("[march]\ncycles = 5_000_000"), Some(5e6));
        assert_eq!(cycles("[run]\ncycles = 2"), None);
    }

    #[test]
    fn an_insert_deforms_where_the_contact_model_is_deformable() {
        let is_deformable = |case| CaseFacts::of(case).is_deformable;
        assert!(is_deformable("[contact]\nmodel = \"deformable\""));
        assert!(!is_deformable("[contact]\nmodel = \"foundation\""));
        assert!(!is_deformable("model = \"deformable\""));
    }

    #[test]
    fn an_insert_yields_where_the_contact_has_a_plasticity() {
        let yields = |case| CaseFacts::of(case).yields;
        assert!(yields("[contact.deformable]\nplasticity = \"j2\""));
        assert!(yields("[contact]\nplasticity = \"j2\""));
        assert!(!yields("[contact]\nplasticity = \"none\""));
        assert!(!yields("[contact]\nmodel = \"deformable\""));
    }

    #[test]
    fn an_insert_creeps_where_the_case_has_a_creep_law() {
        let creeps = |case| CaseFacts::of(case).creeps;
        assert!(creeps("[creep]\nlaw = \"lee-pienkowski\""));
        assert!(!creeps("[creep]\nlaw = \"none\""));
        assert!(!creeps("[wear]\nlaw = \"archard\""));
    }

    #[test]
    fn the_title_is_the_case_s_own() {
        let title = |case| CaseFacts::of(case).title;
        assert_eq!(title("title = \"A knee\"").as_deref(), Some("A knee"));
        assert_eq!(title("[machine]\npreset = \"x\""), None);
    }
}
