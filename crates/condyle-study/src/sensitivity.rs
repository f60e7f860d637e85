//! A case run again with each of its assumptions changed, one at a time.

use condyle_results::catalogue;
use std::path::Path;

use Tried::{Instead, Plus, Times};
use condyle::parameter::unit_of;
use condyle_case::{
    cache::Cache,
    case::{Assignment, Case, SharedBodies},
};
use condyle_lab::{RunError, aligned, batch_run};
use condyle_results::Summary;
use serde::Serialize;

use crate::engine::{first_line, in_parallel};

/// Runs the case at `case_path` as it is and with each of its assumptions changed, `threads` at a
/// time; nothing is written, and results do not depend on the threads.
///
/// `tell` hears of every change that has been run, from any thread.
///
/// # Errors
/// A case that cannot be run as it is. A change that cannot be run is among the results.
pub fn sensitivity(
    case_path: &Path,
    threads: usize,
    tell: &(dyn Fn(&Change) + Sync),
) -> Result<Sensitivity, RunError> {
    let case = Case::read(case_path)?;
    let bodies = SharedBodies::default();
    let as_given = batch_run(&case, &Cache::of_user(), &bodies)?;
    let changes = changes_of(&case);
    let ran = in_parallel(changes.len(), threads, |index| {
        let change = &changes[index];
        let found = changed(case_path, &case, change, &bodies);
        tell(change);
        found
    });
    let all = changes.into_iter().zip(ran);
    let changed = all.filter_map(|(change, ran)| Some((change, ran?)));
    Ok(Sensitivity::of(&as_given, changed))
}

/// What a run with one change found, or why it found nothing; none where the case stays the same.
fn changed(
    case_path: &Path,
    case: &Case,
    change: &Change,
    bodies: &SharedBodies,
) -> Option<Result<Summary, String>> {
    let ran = |other| batch_run(other, &Cache::of_user(), bodies);
    match Case::read_changed(case_path, &change.assignments) {
        Ok(other) if other == *case => None,
        Ok(other) => Some(ran(&other).map_err(|error| first_line(&error))),
        Err(error) => Some(Err(first_line(&error))),
    }
}

/// Something that a case assumes, and what is tried in its place.
struct Assumption {
    /// What a reader calls it.
    name: &'static str,
    /// Its keys, of which a case may have some.
    keys: &'static [&'static str],
    tried: Tried,
}

/// What is tried in place of a value.
enum Tried {
    /// The value times each of these.
    Times(&'static [f64]),
    /// The value and each of these.
    Plus(&'static [f64]),
    /// Each of these, as a case has them.
    Instead(&'static [&'static str]),
}

const DAMPING: &[&str] = &[
    "machine.freedoms.ap.damping_n_s_per_mm",
    "machine.freedoms.ml.damping_n_s_per_mm",
    "machine.freedoms.is.damping_n_s_per_mm",
    "machine.freedoms.ie.damping_nm_s_per_rad",
    "machine.freedoms.vv.damping_nm_s_per_rad",
    "machine.freedoms.flexion.damping_nm_s_per_rad",
];

const INERTIA: &[&str] = &[
    "machine.freedoms.ap.inertia_kg",
    "machine.freedoms.ml.inertia_kg",
    "machine.freedoms.is.inertia_kg",
    "machine.freedoms.ie.inertia_kg_m2",
    "machine.freedoms.vv.inertia_kg_m2",
    "machine.freedoms.flexion.inertia_kg_m2",
];

/// Damping and inertia of every freedom.
const DYNAMICS: &[&str] = &[
    DAMPING[0], DAMPING[1], DAMPING[2], DAMPING[3], DAMPING[4], DAMPING[5], INERTIA[0], INERTIA[1],
    INERTIA[2], INERTIA[3], INERTIA[4], INERTIA[5],
];

const SPRINGS: &[&str] = &[
    "machine.springs.posterior_n_per_mm",
    "machine.springs.anterior_n_per_mm",
];

/// Everything that a case assumes and that its results may hang on.
const ASSUMPTIONS: &[Assumption] = &[
    Assumption {
        name: "friction",
        keys: &["contact.friction"],
        tried: Times(&[0.5, 2.0]),
    },
    Assumption {
        name: "damping",
        keys: DAMPING,
        tried: Times(&[0.0, 0.5, 2.0]),
    },
    Assumption {
        name: "inertia",
        keys: INERTIA,
        tried: Times(&[0.5, 2.0]),
    },
    Assumption {
        name: "damping and inertia",
        keys: DYNAMICS,
        tried: Times(&[0.0]),
    },
    Assumption {
        name: "springs",
        keys: SPRINGS,
        tried: Times(&[0.0]),
    },
    Assumption {
        name: "stiffness of springs",
        keys: &["machine.springs.stiffness_of"],
        tried: Instead(&["pair", "each"]),
    },
    Assumption {
        name: "free play of springs",
        keys: &["machine.springs.free_play_mm"],
        tried: Plus(&[-1.0, 1.0]),
    },
    Assumption {
        name: "offset of springs",
        keys: &["machine.springs.lateral_offset_mm"],
        tried: Plus(&[-4.0, 4.0]),
    },
    Assumption {
        name: "sign of AP force",
        keys: &["machine.ap_force_sign"],
        tried: Times(&[-1.0]),
    },
    Assumption {
        name: "sign of IE torque",
        keys: &["machine.ie_torque_sign"],
        tried: Times(&[-1.0]),
    },
    Assumption {
        name: "curve of axial force",
        keys: &["machine.axial_force"],
        tried: Instead(&[
            "{ waveform = \"iso-like\" }",
            "{ waveform = \"paper-like\" }",
        ]),
    },
    Assumption {
        name: "varus-valgus axis, medial",
        keys: &["machine.vv_axis_medial_mm"],
        tried: Plus(&[-2.0, 2.0]),
    },
    Assumption {
        name: "Young's modulus",
        keys: &["material.youngs_modulus_mpa"],
        tried: Times(&[0.75, 1.5]),
    },
    Assumption {
        name: "Poisson's ratio",
        keys: &["material.poissons_ratio"],
        tried: Plus(&[-0.02, 0.02]),
    },
    Assumption {
        name: "thickness",
        keys: &["insert.thickness_mm"],
        tried: Plus(&[-1.0, 1.0]),
    },
    Assumption {
        name: "pressure law",
        keys: &["contact.foundation.law"],
        tried: Instead(&["linear", "logarithmic", "softening"]),
    },
];

/// One assumption of a case changed.
#[derive(Clone, Debug)]
pub struct Change {
    /// What is changed, in words.
    pub assumption: &'static str,
    /// How, in words: `x 0.5`, `+1 mm`, `each`.
    pub change: String,
    /// The keys with their other values.
    pub assignments: Vec<Assignment>,
}

/// Every change of `case`, in the order of the table; none that leaves all its keys as they are.
pub(crate) fn changes_of(case: &Case) -> Vec<Change> {
    let all = ASSUMPTIONS.iter().flat_map(|one| one.changes(case));
    all.filter(|change| !change.assignments.is_empty())
        .collect()
}

impl Assumption {
    fn changes(&self, case: &Case) -> Vec<Change> {
        let by_number = |factor: f64, term: f64, change: String| Change {
            assumption: self.name,
            change,
            assignments: self.numbers(case, |value| factor * value + term),
        };
        match self.tried {
            Times(factors) => {
                let times = |factor: &f64| by_number(*factor, 0.0, in_words(*factor));
                factors.iter().map(times).collect()
            }
            Plus(terms) => {
                let plus = |term: &f64| by_number(1.0, *term, self.step(*term));
                terms.iter().map(plus).collect()
            }
            Instead(texts) => texts.iter().map(|text| self.instead(case, text)).collect(),
        }
    }

    /// A step with its unit, such as `+1 mm`.
    fn step(&self, term: f64) -> String {
        let unit = self.keys.first().and_then(|key| unit_of(key));
        unit.map_or_else(|| format!("{term:+}"), |unit| format!("{term:+} {unit}"))
    }

    /// The keys that are numbers of the case, where `other` changes them.
    fn numbers(&self, case: &Case, other: impl Fn(f64) -> f64) -> Vec<Assignment> {
        let changed = self.keys.iter().filter_map(|key| {
            let value = case.number_at(key)?;
            // Sums of decimal numbers end in ones nobody wrote.
            let other = (other(value) * 1e9).round() / 1e9;
            (other != value).then(|| assignment(key, &format!("{other}")))
        });
        changed.collect()
    }

    fn instead(&self, case: &Case, text: &str) -> Change {
        let is_there = |key: &&&str| case.has(key) && case.word_at(key).as_deref() != Some(text);
        let keys = self.keys.iter().filter(is_there);
        Change {
            assumption: self.name,
            change: named(text).to_owned(),
            assignments: keys.map(|key| assignment(key, text)).collect(),
        }
    }
}

fn in_words(factor: f64) -> String {
    match factor {
        0.0 => "none".to_owned(),
        -1.0 => "turned round".to_owned(),
        factor => format!("x {factor}"),
    }
}

/// The word inside a table of one key.
fn named(text: &str) -> &str {
    text.split('"').nth(1).unwrap_or(text)
}

fn assignment(key: &str, text: &str) -> Assignment {
    Assignment::parse(&format!("{key}={text}")).expect("a key and a value")
}

/// A result that is compared.
#[derive(Clone, Copy, Debug)]
pub struct SensitivityQuantity {
    /// Its name and unit on the screen.
    pub title: &'static str,
    /// Decimals that are shown.
    pub decimals: usize,
    of: fn(&Results) -> f64,
}

/// The results that are compared, in the order of the columns.
pub fn sensitivity_quantities() -> [SensitivityQuantity; 5] {
    [
        SensitivityQuantity {
            title: "mass loss, mg",
            decimals: 2,
            of: |found| found.mass_loss_mg,
        },
        SensitivityQuantity {
            title: "deepest wear, mm",
            decimals: 3,
            of: |found| found.max_depth_mm,
        },
        SensitivityQuantity {
            title: "peak pressure, MPa",
            decimals: 1,
            of: |found| found.peak_pressure_mpa,
        },
        SensitivityQuantity {
            title: "AP range, mm",
            decimals: 2,
            of: |found| found.ap_range_mm,
        },
        SensitivityQuantity {
            title: "IE range, degrees",
            decimals: 2,
            of: |found| found.ie_range_deg,
        },
    ]
}

/// Results of a run; units are in the names.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Results {
    /// Mass worn.
    pub mass_loss_mg: f64,
    /// Deepest wear.
    pub max_depth_mm: f64,
    /// Highest pressure anywhere, in any cycle.
    pub peak_pressure_mpa: f64,
    /// Range of AP in the first cycle.
    pub ap_range_mm: f64,
    /// Range of IE in the first cycle.
    pub ie_range_deg: f64,
}

/// A run with one assumption changed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Changed {
    /// What was changed, in words.
    pub assumption: &'static str,
    /// How, in words.
    pub change: String,
    /// The same as `--set` takes it.
    pub set: Vec<String>,
    /// What it found; none where it could not be run.
    pub found: Option<Results>,
    /// How far that lies above the case as it is, %; none where that is 0.
    pub above_percent: Option<[Option<f64>; 5]>,
    /// Why it could not be run.
    pub not_run: Option<String>,
}

/// A case as it is and with each of its assumptions changed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sensitivity {
    /// The case as it is.
    pub as_given: Results,
    /// With one assumption changed.
    pub changed: Vec<Changed>,
}

impl Results {
    fn of(summary: &Summary) -> Self {
        Self {
            mass_loss_mg: summary[&catalogue::MASS_LOSS_MG],
            max_depth_mm: summary[&catalogue::MAX_DEPTH_MM],
            peak_pressure_mpa: summary[&catalogue::PEAK_PRESSURE_MPA],
            ap_range_mm: summary[&catalogue::AP_RANGE_MM],
            ie_range_deg: summary[&catalogue::IE_RANGE_DEG],
        }
    }

    fn above_percent(&self, other: &Self) -> [Option<f64>; 5] {
        sensitivity_quantities().map(|quantity| {
            let (value, base) = ((quantity.of)(self), (quantity.of)(other));
            (base != 0.0).then(|| 100.0 * (value / base - 1.0))
        })
    }
}

impl Changed {
    /// Whether it changed no result at all.
    pub fn is_without_effect(&self, as_given: &Results) -> bool {
        self.found.as_ref() == Some(as_given)
    }
}

impl Sensitivity {
    /// The tables of `changed`, each a summary or why there is none.
    pub(crate) fn of(
        as_given: &Summary,
        changed: impl Iterator<Item = (Change, Result<Summary, String>)>,
    ) -> Self {
        let as_given = Results::of(as_given);
        let one = |(change, ran): (Change, Result<Summary, String>)| {
            let found = ran.as_ref().ok().map(Results::of);
            Changed {
                assumption: change.assumption,
                change: change.change,
                set: change.assignments.iter().map(ToString::to_string).collect(),
                above_percent: found.map(|found| found.above_percent(&as_given)),
                found,
                not_run: ran.err(),
            }
        };
        let changed = changed.map(one).collect();
        Self { as_given, changed }
    }

    /// A table in Markdown, whose columns stand below each other.
    pub fn markdown(&self) -> String {
        let titles = sensitivity_quantities().map(|quantity| quantity.title.to_owned());
        let head = [vec!["assumption".to_owned()], titles.to_vec()].concat();
        let mut rows = vec![head, self.row_as_given()];
        let shown = |one: &&Changed| !one.is_without_effect(&self.as_given);
        rows.extend(self.changed.iter().filter(shown).filter_map(Self::row));
        let mut text = aligned(&rows);
        text += &self.said("Without effect here", |one| {
            one.is_without_effect(&self.as_given).then(|| name(one))
        });
        text += &self.said("Not run", |one| {
            let why = one.not_run.as_ref()?;
            Some(format!("{} ({why})", name(one)))
        });
        text
    }

    fn row_as_given(&self) -> Vec<String> {
        let cell = |quantity: SensitivityQuantity| {
            format!("{:.*}", quantity.decimals, (quantity.of)(&self.as_given))
        };
        let cells = sensitivity_quantities().map(cell);
        [vec!["as given".to_owned()], cells.to_vec()].concat()
    }

    fn row(changed: &Changed) -> Option<Vec<String>> {
        let (found, above) = (changed.found?, changed.above_percent?);
        let cells = sensitivity_quantities().into_iter().zip(above);
        let cells = cells.map(|(quantity, above)| {
            let value = format!("{:.*}", quantity.decimals, (quantity.of)(&found));
            above.map_or(value.clone(), |above| format!("{value} ({above:+.1} %)"))
        });
        Some([name(changed)].into_iter().chain(cells).collect())
    }

    /// A line below the table of what `of` says of some changes; nothing where it says none.
    fn said(&self, opening: &str, of: impl Fn(&Changed) -> Option<String>) -> String {
        let said: Vec<String> = self.changed.iter().filter_map(of).collect();
        if said.is_empty() {
            return String::new();
        }
        format!("\n{opening}: {}.\n", said.join("; "))
    }
}

fn name(changed: &Changed) -> String {
    format!("{}: {}", changed.assumption, changed.change)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn results(mass_loss_mg: f64) -> Results {
        Results {
            mass_loss_mg,
            max_depth_mm: 0.5,
            peak_pressure_mpa: 30.0,
            ap_range_mm: 0.0,
            ie_range_deg: 5.0,
        }
    }

    fn changed(assumption: &'static str, ran: Result<f64, &str>) -> Changed {
        let found = ran.ok().map(results);
        Changed {
            assumption,
            change: "x 2".to_owned(),
            set: Vec::new(),
            above_percent: found.map(|found| found.above_percent(&results(80.0))),
            found,
            not_run: ran.err().map(str::to_owned),
        }
    }

    #[test]
    fn the_table_says_what_changed_what_did_not_and_what_could_not_be_run() {
        let study = Sensitivity {
            as_given: results(80.0),
            changed: vec![
                changed("friction", Ok(84.0)),
                changed("damping", Ok(80.0)),
                changed("law", Err("it slipped away")),
            ],
        };
        let text = study.markdown();
        assert!(
            text.contains("| friction: x 2 | 84.00 (+5.0 %) | 0.500 (+0.0 %)"),
            "{text}"
        );
        assert!(text.contains("| 0.00 "), "no part of nothing: {text}");
        assert!(
            text.contains("\nWithout effect here: damping: x 2.\n"),
            "{text}"
        );
        assert!(
            text.ends_with("\nNot run: law: x 2 (it slipped away).\n"),
            "{text}"
        );
    }
}
