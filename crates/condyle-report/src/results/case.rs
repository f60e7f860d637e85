//! What the report takes from the case file: its title, the side of the knee, the model of contact.

use condyle_results::Side;

use toml::{Table, Value};

/// The text of `title` or `name` at the top of a case.
pub(crate) fn title(case: &str) -> Option<String> {
    let case: Table = case.parse().ok()?;
    let named = ["title", "name"]
        .iter()
        .find_map(|key| case.get(*key)?.as_str())?;
    Some(named.to_owned())
}

/// The gait cycles that the case asks for.
pub(crate) fn cycles_asked(case: &str) -> Option<f64> {
    let case: Table = case.parse().ok()?;
    let cycles = case.get("march")?.get("cycles")?;
    let whole = cycles.as_integer().map(|cycles| cycles as f64);
    whole.or_else(|| cycles.as_float())
}

/// Whether the insert of the case deforms, and is no foundation.
pub(crate) fn is_deformable(case: &str) -> bool {
    let case: Option<Table> = case.parse().ok();
    let model = case
        .as_ref()
        .and_then(|case| case.get("contact")?.get("model")?.as_str());
    model == Some("deformable")
}

/// Whether the insert of the case yields.
pub(crate) fn yields(case: &str) -> bool {
    let case: Option<Table> = case.parse().ok();
    let plasticity = case.as_ref().and_then(|case| {
        let contact = case.get("contact")?;
        // Results of version 0.1 have the key in the table above.
        let model = contact.get("deformable").unwrap_or(contact);
        model.get("plasticity")?.as_str()
    });
    plasticity.is_some_and(|plasticity| plasticity != "none")
}

/// Whether the insert of the case creeps.
pub(crate) fn creeps(case: &str) -> bool {
    let case: Option<Table> = case.parse().ok();
    let law = case
        .as_ref()
        .and_then(|case| case.get("creep")?.get("law")?.as_str());
    law.is_some_and(|law| law != "none")
}

/// The side of the knee: left where any table of the case says `side = "left"`, else right.
pub(super) fn side(case: &str) -> Side {
    match case.parse::<Table>() {
        Ok(case) if says_left(&case) => Side::Left,
        _ => Side::Right,
    }
}

fn says_left(table: &Table) -> bool {
    table.iter().any(|(key, value)| match value {
        Value::String(text) => key == "side" && text == "left",
        Value::Table(inner) => says_left(inner),
        _ => false,
    })
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
        assert_eq!(cycles_asked("[march]\ncycles = 5_000_000"), Some(5e6));
        assert_eq!(cycles_asked("[run]\ncycles = 2"), None);
    }

    #[test]
    fn an_insert_deforms_where_the_case_says_so() {
        assert!(is_deformable("[contact]\nmodel = \"deformable\""));
        assert!(!is_deformable("[contact]\nmodel = \"foundation\""));
        assert!(!is_deformable("model = \"deformable\""));
    }

    #[test]
    fn an_insert_yields_where_the_case_says_how() {
        assert!(yields("[contact.deformable]\nplasticity = \"j2\""));
        assert!(yields("[contact]\nplasticity = \"j2\""));
        assert!(!yields("[contact]\nplasticity = \"none\""));
        assert!(!yields("[contact]\nmodel = \"deformable\""));
    }

    #[test]
    fn an_insert_creeps_where_the_case_has_a_law_of_it() {
        assert!(creeps("[creep]\nlaw = \"lee-pienkowski\""));
        assert!(!creeps("[creep]\nlaw = \"none\""));
        assert!(!creeps("[wear]\nlaw = \"archard\""));
    }

    #[test]
    fn the_title_is_the_case_s_own() {
        assert_eq!(title("title = \"A knee\"").as_deref(), Some("A knee"));
        assert_eq!(title("[machine]\npreset = \"x\""), None);
    }
}
