//! How wear per cycle changes over the test, from wear.csv.

use crate::number::{fixed, significant};
use crate::results::{contents::Results, table::Table};

/// A change of the rate below this is none, %.
const MIN_CHANGE_PERCENT: f64 = 0.5;
const MILLION: f64 = 1e6;

/// Whether and how far wear per cycle grew or fell, in a sentence; none without wear.
pub(super) fn rate(results: &Results) -> Option<String> {
    let rates = rates_mg_per_million(results.wear.as_ref()?)?;
    let (first, last) = (*rates.first()?, *rates.last()?);
    if rates.len() == 1 {
        let rate = significant(first, 3);
        return Some(format!(
            "One solved cycle stands for the whole test: {rate} mg in a million cycles throughout"
        ));
    }
    let percent = 100.0 * (last / first - 1.0);
    let (from, to) = (significant(first, 3), significant(last, 3));
    let how = match percent {
        percent if percent >= MIN_CHANGE_PERCENT => "grew",
        percent if percent <= -MIN_CHANGE_PERCENT => "fell",
        _ => {
            return Some(format!(
                "Wear per cycle stayed the same, {to} mg in a million cycles"
            ));
        }
    };
    let change = fixed(percent.abs(), usize::from(percent.abs() < 10.0));
    Some(format!(
        "Wear per cycle {how} by {change}\u{a0}% from the first interval to the last, from {from} to {to} mg in a million cycles"
    ))
}

/// Mass lost in a million cycles, of each interval between updates; none where one has no cycles or no wear.
fn rates_mg_per_million(wear: &Table) -> Option<Vec<f64>> {
    let ends = wear
        .column("cycles")?
        .iter()
        .zip(wear.column("mass_loss_mg")?);
    let (mut rates, mut before) = (Vec::new(), (0.0, 0.0));
    for (&cycles, &mass_mg) in ends.filter(|(cycles, _)| **cycles > 0.0) {
        rates.push(MILLION * (mass_mg - before.1) / (cycles - before.0));
        before = (cycles, mass_mg);
    }
    let is_usable = rates.iter().all(|rate| rate.is_finite() && *rate > 0.0);
    is_usable.then_some(rates)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn said(rows: &str) -> Option<String> {
        let text = format!("cycles,mass_loss_mg\n{rows}");
        let wear = Table::parse(&text, Path::new("wear.csv")).expect("is a table");
        rate(&Results {
            wear: Some(wear),
            ..Results::default()
        })
    }

    #[test]
    fn a_rate_that_grows_or_falls_says_so_from_the_numbers() {
        let grows = said("1000000,10\n2000000,20\n3000000,32").expect("has wear");
        assert!(
            grows.contains("grew by 20\u{a0}%") && grows.contains("from 10.0 to 12.0 mg"),
            "{grows}"
        );
        let falls = said("0,0\n1000000,10\n2000000,19.3").expect("has wear");
        assert!(falls.contains("fell by 7.0\u{a0}%"), "{falls}");
        let same = said("1000000,10\n2000000,20.01").expect("has wear");
        assert!(same.contains("stayed the same"), "{same}");
        let alone = said("5000000,50").expect("has wear");
        assert!(
            alone.contains("One solved cycle stands for the whole test: 10.0 mg"),
            "{alone}"
        );
    }

    #[test]
    fn without_wear_nothing_is_said() {
        assert_eq!(said(""), None);
        assert_eq!(said("1000000,0\n2000000,0"), None);
    }
}
