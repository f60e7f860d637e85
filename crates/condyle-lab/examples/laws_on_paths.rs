//! Prints the wear by every wear law on paths given on standard input, as JSON on standard output.
//!
//! In: `{"name": [[pressure_mpa, anterior_mm, lateral_mm], ...], ...}`, a step each, by a place that presses with all of
//! its share. Out, for each path: its length, pressure times slip, cross-shear, and by law the depth and what part of it
//! is outside of the law's fit.

use std::collections::BTreeMap;
use std::error::Error;
use std::io::{read_to_string, stdin};

use condyle::contact::{CycleHistory, Moment, Record};
use condyle::wear::{MeanCycle, WEAR_LAWS};
use serde::Serialize;

type Step = [f64; 3];

#[derive(Serialize)]
struct OnPath {
    slid_mm: f64,
    pressure_slip_mpa_mm: f64,
    cross_shear: f64,
    /// In the order of condyle's list.
    laws: Vec<Worn>,
}

#[derive(Serialize)]
struct Worn {
    law: &'static str,
    depth_mm: f64,
    part_outside: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let paths: BTreeMap<String, Vec<Step>> = serde_json::from_str(&read_to_string(stdin())?)?;
    let on_paths: BTreeMap<&str, OnPath> = paths
        .iter()
        .map(|(name, path)| (name.as_str(), on(path)))
        .collect();
    println!("{}", serde_json::to_string_pretty(&on_paths)?);
    Ok(())
}

fn on(path: &[Step]) -> OnPath {
    let history = history(path);
    let shared = [(1.0, &history)];
    let cycle = MeanCycle::new(&shared, 0, 1.0);
    let laws = WEAR_LAWS.iter().map(|law| {
        let worn = law.with_defaults().law.wear(&cycle);
        Worn {
            law: law.word,
            depth_mm: worn.depth_mm,
            part_outside: worn.part_outside,
        }
    });
    OnPath {
        slid_mm: cycle.sliding_distance_mm,
        pressure_slip_mpa_mm: cycle.pressure_slip_mpa_mm,
        cross_shear: cycle.slip_work.cross_shear(),
        laws: laws.collect(),
    }
}

/// The history of a node of 1 mm2 that goes this way.
fn history(path: &[Step]) -> CycleHistory {
    let mut history = CycleHistory::default();
    let record = |&[pressure_mpa, anterior_mm, lateral_mm]: &Step| Record {
        node: 0,
        pressed_mm2: 1.0,
        moment: Moment {
            pressure_mpa,
            slip_mm: [anterior_mm, lateral_mm],
        },
    };
    let instants: Vec<_> = path
        .iter()
        .map(|step| history.record(std::iter::once(record(step))))
        .collect();
    history.sort(1, &instants);
    history
}
