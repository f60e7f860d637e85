//! `converge.csv`, `converge.json` and `converge.svg`.

use std::{collections::BTreeMap, fmt::Write, fs, path::Path};

use condyle_report::{Plot, plots_svg};
use serde::Serialize;

use super::converge::{Convergence, Point, QUANTITIES, Quantity};
use super::converge_plan::ConvergeError;
use super::observed_order::Extrapolation;

/// The least that a plot shows, as a share of the finest value: less is the same to a reader.
const MIN_SHOWN_SHARE: f64 = 1e-3;

impl Convergence {
    /// Writes the three files into `folder`.
    pub(super) fn write(&self, folder: &Path) -> Result<(), ConvergeError> {
        for (name, text) in [
            ("converge.csv", self.csv()),
            ("converge.json", self.json()),
            ("converge.svg", self.svg()),
        ] {
            let path = folder.join(name);
            fs::write(&path, text).map_err(|source| ConvergeError::Refused { path, source })?;
        }
        Ok(())
    }

    /// A row a run, from coarse to fine.
    fn csv(&self) -> String {
        let names = QUANTITIES.map(|quantity| quantity.name);
        let differences =
            QUANTITIES.map(|quantity| format!("{}_difference_percent", base(&quantity)));
        let mut text = format!(
            "{},{},cycles_solved,{}\n",
            self.key,
            names.join(","),
            differences.join(",")
        );
        let columns = QUANTITIES.map(|quantity| self.differences_percent(&quantity));
        for (row, point) in self.points.iter().enumerate() {
            let values = QUANTITIES.map(|quantity| (quantity.of)(&point.summary).to_string());
            let differences = columns.each_ref().map(|column| column[row].to_string());
            writeln!(
                text,
                "{},{},{},{}",
                point.value,
                values.join(","),
                point.summary.cycles_solved,
                differences.join(",")
            )
            .expect("writing to a string cannot fail");
        }
        text
    }

    fn json(&self) -> String {
        let file = File {
            version: env!("CARGO_PKG_VERSION"),
            key: &self.key,
            finest: self.points.last().map_or(f64::NAN, |point| point.value),
            runs: (0..self.points.len()).map(|row| self.run(row)).collect(),
            extrapolations: QUANTITIES
                .iter()
                .map(|quantity| (quantity.name, self.extrapolation(quantity)))
                .collect(),
        };
        let mut text =
            serde_json::to_string_pretty(&file).expect("numbers and text always serialise");
        text.push('\n');
        text
    }

    fn run(&self, row: usize) -> Run<'_> {
        let point = &self.points[row];
        Run {
            value: point.value,
            folder: &point.folder,
            results: QUANTITIES
                .iter()
                .map(|quantity| (quantity.name, (quantity.of)(&point.summary)))
                .collect(),
            cycles_solved: point.summary.cycles_solved,
            differences_percent: QUANTITIES
                .iter()
                .map(|quantity| (quantity.name, self.differences_percent(quantity)[row]))
                .collect(),
            inputs_blake3: &point.summary.inputs_blake3,
        }
    }

    fn svg(&self) -> String {
        // Mass is volume times a constant: one plot for both.
        let shown = QUANTITIES
            .iter()
            .filter(|quantity| quantity.name != "volume_loss_mm3");
        let plots: Vec<Plot> = shown.map(|quantity| self.plot(quantity)).collect();
        let line = format!("a run for each value of {}", self.key);
        plots_svg("Convergence", &plots, ["extrapolated", &line])
    }

    fn plot(&self, quantity: &Quantity) -> Plot {
        let places = self.places();
        let line: Vec<(f64, f64)> = places.iter().copied().zip(self.values(quantity)).collect();
        let finest = line.last().map_or(0.0, |point| point.1);
        let across = [places[0], places[places.len() - 1]];
        Plot {
            title: first_upper(quantity.title),
            unit: quantity.unit.replace('2', "\u{b2}").replace('3', "\u{b3}"),
            x_title: "",
            x_marks: places
                .iter()
                .zip(&self.points)
                .map(|(place, point)| (*place, mark(point)))
                .collect(),
            from_zero: false,
            least_span: MIN_SHOWN_SHARE * finest.abs().max(f64::MIN_POSITIVE),
            reference: match self.extrapolation(quantity) {
                Extrapolation::Converging { extrapolated, .. } => {
                    across.map(|place| (place, extrapolated)).to_vec()
                }
                _ => Vec::new(),
            },
            line,
        }
    }

    /// Where each run stands from left to right: finer to the right, by the logarithm of its step.
    fn places(&self) -> Vec<f64> {
        if self.steps.iter().all(|step| *step > 0.0) {
            self.steps.iter().map(|step| -step.ln()).collect()
        } else {
            (0..self.steps.len()).map(|place| place as f64).collect()
        }
    }
}

/// What `converge.json` holds.
#[derive(Serialize)]
struct File<'a> {
    version: &'static str,
    key: &'a str,
    finest: f64,
    runs: Vec<Run<'a>>,
    extrapolations: BTreeMap<&'static str, Extrapolation>,
}

/// One run of `converge.json`.
#[derive(Serialize)]
struct Run<'a> {
    value: f64,
    folder: &'a str,
    #[serde(flatten)]
    results: BTreeMap<&'static str, f64>,
    cycles_solved: f64,
    differences_percent: BTreeMap<&'static str, f64>,
    inputs_blake3: &'a str,
}

fn mark(point: &Point) -> String {
    point.value.to_string()
}

/// The name of a quantity without its unit.
fn base(quantity: &Quantity) -> &'static str {
    let unit = quantity.name.rfind('_').unwrap_or(quantity.name.len());
    &quantity.name[..unit]
}

fn first_upper(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}
