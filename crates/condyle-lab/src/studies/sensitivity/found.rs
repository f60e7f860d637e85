//! What the runs found, as tables.

use condyle_io::results::Summary;
use serde::Serialize;

use super::{super::table::aligned, assumption::Change};

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
            mass_loss_mg: summary.mass_loss_mg,
            max_depth_mm: summary.max_depth_mm,
            peak_pressure_mpa: summary.peak_pressure_mpa,
            ap_range_mm: summary.ap_range_mm,
            ie_range_deg: summary.ie_range_deg,
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
    pub(super) fn of(
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
