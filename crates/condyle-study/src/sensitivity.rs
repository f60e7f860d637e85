//! Sensitivity to assumptions: a case and, one at a time, other values of everything that it assumes.

use std::{collections::BTreeMap, path::Path};

use condyle::parameter::unit_of;
use condyle_case::{
    case::{Assignment, Case},
    study::{Alternative, Design, FactorialKeys, Outputs, Study},
};
use condyle_lab::aligned;
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{
    answers::tables::table,
    engine::{Listener, TestBench, run_in_memory},
    error::StudyError,
    plan::{Plan, TestResult},
    uncertainty::{compared, records},
};

/// Assumptions of a case that may affect its results. Columns: the name; the keys, which change together and of which
/// a case may have some; the kind of the change; the factors, terms or texts.
const ASSUMPTIONS: &str = include_str!("assumptions.csv");

/// The results of a case without changes and with each of its assumptions changed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    as_given: Results,
    /// The checks that the case without changes fails.
    doubts: Vec<String>,
    changed: Vec<Changed>,
}

/// Values by the keys of the outputs.
type Results = BTreeMap<&'static str, f64>;

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Changed {
    assumption: &'static str,
    change: String,
    /// The change in the notation of `--set`.
    set: Vec<String>,
    /// The results; none if the test failed.
    found: Option<Results>,
    /// Changes of the results, %, in the order of the columns; none if a result was 0.
    above_percent: Option<Vec<Option<f64>>>,
    /// The checks that the test fails.
    doubts: Vec<String>,
    not_run: Option<String>,
}

/// Runs the case at `case_path` without changes and with each of its assumptions changed. Nothing is written, and results
/// do not depend on the number of threads.
///
/// # Errors
/// The case does not run without changes. A change that fails is part of the results.
pub fn sensitivity(
    case_path: &Path,
    threads: usize,
    listener: &mut Listener<'_>,
) -> Result<Sensitivity, StudyError> {
    // Without inputs, each of the designs below is one test.
    let mut study = Study::of_case(
        case_path,
        Design::FullFactorial(FactorialKeys { points: 2 }),
    )?;
    let bench = TestBench::default();
    let as_given = bench.summary(&study.case)?;
    let doubts = as_given.doubts().into_iter().map(str::to_owned).collect();
    let mut changes = changes_of(&study.case);
    // The law or the curve of the case itself is not a change.
    changes.retain(|(_, _, set)| study.changed_case(set).ok().as_ref() != Some(&study.case));
    let alternatives = changes.iter();
    study.alternatives = alternatives
        .map(|(_, change, set)| Alternative::new(change.clone(), set.clone()))
        .collect();
    let plan = Plan::of(study)?;
    let found = run_in_memory(&plan, &bench, threads, listener)?;
    let outputs = compared(|output| as_given.get(output).is_some());
    let as_given = outputs
        .map(|output| (output.key, as_given[output]))
        .collect();
    let changed = changes.into_iter().zip(found);
    let changed = changed.map(|((assumption, change, set), found)| {
        Changed::new(assumption, change, &set, found, &as_given)
    });
    Ok(Sensitivity {
        changed: changed.collect(),
        as_given,
        doubts,
    })
}

type NamedChange = (&'static str, String, Vec<Assignment>);

fn changes_of(case: &Case) -> Vec<NamedChange> {
    let mut changes = Vec::new();
    for [name, keys, kind, values] in records(ASSUMPTIONS) {
        let keys: Vec<&str> = keys.split(' ').collect();
        changes.extend(values.split('|').map(|value| {
            let (words, set) = match kind {
                "replace" => replaced(case, &keys, value),
                _ => moved(
                    case,
                    &keys,
                    kind == "scale",
                    value.parse().expect("a number"),
                ),
            };
            (name, words, set)
        }));
    }
    changes.retain(|(_, _, set): &NamedChange| !set.is_empty());
    changes
}

/// Returns the assignments that replace the text of the keys, and the change in words.
fn replaced(case: &Case, keys: &[&str], text: &str) -> (String, Vec<Assignment>) {
    let is_other = |key: &&&str| case.has(key) && case.word_at(key).as_deref() != Some(text);
    let set = keys.iter().filter(is_other);
    let set = set.map(|key| Assignment::new(key, processed(case, key, text)));
    // Of a table of one key, its word.
    let words = text.split('"').nth(1).unwrap_or(text);
    (words.to_owned(), set.collect())
}

/// Returns the table of another shipped waveform with the scale and the offset of the case; those of a file or of points stay
/// with them.
fn processed(case: &Case, key: &str, table: &str) -> String {
    let is_own = ["file", "knots_n"].map(|source| case.is_written(&format!("{key}.{source}")));
    let number = |name: &str| case.number_at_or_written(&format!("{key}.{name}"));
    match (
        table.strip_suffix(" }"),
        is_own,
        number("scale"),
        number("offset"),
    ) {
        (Some(open), [false, false], Some(scale), Some(offset)) => {
            format!("{open}, scale = {scale:?}, offset = {offset:?} }}")
        }
        _ => table.to_owned(),
    }
}

/// Returns the assignments that multiply the keys by a number or add it to them, and the change in words.
fn moved(case: &Case, keys: &[&str], is_factor: bool, by: f64) -> (String, Vec<Assignment>) {
    let words = match by {
        0.0 if is_factor => "none".to_owned(),
        -1.0 if is_factor => "reversed".to_owned(),
        factor if is_factor => format!("x {factor}"),
        term => {
            let unit = unit_of(keys[0]).map(|unit| format!(" {unit}"));
            format!("{term:+}{}", unit.unwrap_or_default())
        }
    };
    let set = keys.iter().filter_map(|key| {
        let value = case.number_at(key)?;
        let other = if is_factor { by * value } else { value + by };
        // Sums of decimal numbers have rounding errors in their last digits.
        let other = (other * 1e9).round() / 1e9;
        (other != value).then(|| Assignment::new(key, format!("{other}")))
    });
    (words, set.collect())
}

/// Returns the outputs among some results.
fn outputs(results: &Results) -> impl Iterator<Item = &'static Scalar> {
    compared(|output| results.contains_key(output.key))
}

impl Changed {
    fn new(
        assumption: &'static str,
        change: String,
        set: &[Assignment],
        found: TestResult,
        as_given: &Results,
    ) -> Self {
        let (found, doubts, not_run) = match found {
            Ok(test) => {
                let all = Outputs::default();
                let value = |output: &'static Scalar| (output.key, all.value(&test.values, output));
                let found: Results = outputs(as_given).map(value).collect();
                let doubts = test.doubts.split_whitespace().map(str::to_owned);
                (Some(found), doubts.collect(), None)
            }
            Err(reason) => (None, Vec::new(), Some(reason)),
        };
        let above_percent = found.as_ref().map(|found| {
            let above = outputs(as_given).map(|output| {
                let (value, base) = (found[output.key], as_given[output.key]);
                (base != 0.0).then(|| 100.0 * (value / base - 1.0))
            });
            above.collect()
        });
        Self {
            assumption,
            change,
            set: set.iter().map(ToString::to_string).collect(),
            found,
            above_percent,
            doubts,
            not_run,
        }
    }
}

impl Sensitivity {
    /// Returns a table in Markdown, and the changes without effect or result.
    pub fn markdown(&self) -> String {
        let is_without_effect = |one: &&Changed| one.found.as_ref() == Some(&self.as_given);
        let name = |one: &Changed| format!("{}: {}", one.assumption, one.change);
        let outputs = || outputs(&self.as_given);
        let titles: Vec<String> = outputs().map(Scalar::title).collect();
        let mut head = vec!["assumption"];
        head.extend(titles.iter().map(String::as_str));
        let mut as_given = vec!["as given".to_owned()];
        as_given.extend(outputs().map(|output| output.text(self.as_given[output.key])));
        let shown = self.changed.iter().filter(|one| !is_without_effect(one));
        let shown: Vec<_> = shown
            .filter_map(|one| Some((one, one.found.as_ref()?, one.above_percent.as_ref()?)))
            .collect();
        let mut rows = table(&head, &shown, |(one, found, above)| {
            let cells = outputs().zip(above.iter()).map(|(output, above)| {
                let value = output.text(found[output.key]);
                above.map_or(value.clone(), |above| format!("{value} ({above:+.1} %)"))
            });
            [name(one)].into_iter().chain(cells).collect()
        });
        rows.insert(1, as_given);
        let mut text = aligned(&rows);
        let without_effect = self.changed.iter().filter(is_without_effect);
        let not_run = self.changed.iter().filter_map(|one| {
            let reason = one.not_run.as_ref()?;
            Some(format!("{} ({reason})", name(one)))
        });
        let doubtful = self.changed.iter().filter_map(|one| {
            let own = one
                .doubts
                .iter()
                .filter(|check| !self.doubts.contains(check));
            let own: Vec<&str> = own.map(String::as_str).collect();
            (!own.is_empty()).then(|| format!("{} ({})", name(one), own.join(", ")))
        });
        let lists: [(&str, Vec<String>); 4] = [
            ("The case as given is doubtful", self.doubts.clone()),
            ("Doubtful after the change", doubtful.collect()),
            ("Without effect here", without_effect.map(name).collect()),
            ("Not run", not_run.collect()),
        ];
        for (opening, list) in lists.iter().filter(|(_, list)| !list.is_empty()) {
            text += &format!("\n{opening}: {}.\n", list.join("; "));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::TestOutputs;

    fn values(mass_loss_mg: f64) -> Vec<f64> {
        let value = |key: &str| match key {
            "mass_loss_mg" => mass_loss_mg,
            "max_depth_mm" => 0.5,
            "ap_range_mm" => 0.0,
            _ => 5.0,
        };
        let outputs = condyle_results::catalogue::outputs();
        outputs.map(|output| value(output.key)).collect()
    }

    #[test]
    fn another_curve_keeps_the_scale_of_a_shipped_one() {
        let paper = "{ waveform = \"paper-like\" }";
        let set = |text: &str| {
            let case = Case::parse(text, "case", Path::new("")).expect("a case");
            let (_, set) = replaced(&case, &["machine.axial_force"], paper);
            set[0].to_string()
        };
        let scaled = "{ waveform = \"paper-like\", scale = 0.5, offset = 0.0 }";
        let kept = set("[machine.axial_force]\nscale = 0.5\n");
        assert_eq!(kept, format!("machine.axial_force={scaled}"));
        let in_kn = "[machine.axial_force]\nscale = 1e3\nknots_n = [[0.0, 1.0], [50.0, 2.0]]\n";
        assert_eq!(set(in_kn), format!("machine.axial_force={paper}"));
    }

    #[test]
    fn the_table_shows_changes_and_lists_those_without_effect_or_result() {
        let all = Outputs::default();
        let value = |output: &'static Scalar| (output.key, all.value(&values(80.0), output));
        let as_given: Results = compared(|_| true).map(value).collect();
        let changed = |assumption, ran: Result<f64, &str>| {
            let outputs = |mass_loss_mg| TestOutputs {
                values: values(mass_loss_mg),
                doubts: "impact".to_owned(),
            };
            let found = ran.map(outputs).map_err(str::to_owned);
            Changed::new(assumption, "x 2".to_owned(), &[], found, &as_given)
        };
        let study = Sensitivity {
            changed: vec![
                changed("friction", Ok(84.0)),
                changed("damping", Ok(80.0)),
                changed("law", Err("it slipped away")),
            ],
            as_given: as_given.clone(),
            doubts: vec!["single_update".to_owned()],
        };
        let text = study.markdown();
        assert!(
            text.contains("| friction: x 2 | 84.00 (+5.0 %) | 0.5000 (+0.0 %)"),
            "{text}"
        );
        assert!(text.contains("| 0.00 "), "no part of nothing: {text}");
        assert!(
            text.contains("\nThe case as given is doubtful: single_update.\n\nDoubtful after the change: friction: x 2 (impact); damping: x 2 \
                 (impact).\n\nWithout effect here: damping: x 2.\n"),
            "{text}"
        );
        assert!(
            text.ends_with("\nNot run: law: x 2 (it slipped away).\n"),
            "{text}"
        );
    }
}
