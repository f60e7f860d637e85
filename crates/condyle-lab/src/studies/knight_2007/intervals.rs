//! What becomes of the results as the worn shape is brought up to date more often.

use serde::Serialize;

use super::series::{above_percent, at, range};
use super::{
    error::StudyError,
    ran::{Ran, TableOf, reference},
};

/// What becomes of the results as the worn shape is brought up to date more often.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Intervals {
    /// Volume worn against the updates it was computed with.
    pub volume_loss_mm3: Vec<OverUpdates>,
    /// Volume of 1 x 5M above that of 10 x 500k.
    pub volume_1_against_10_percent: f64,
    /// Peak pressure of the last cycle that 5 x 1M solves above that of 40 x 125k at the same cycles.
    pub pressure_5_against_40_percent: f64,
    /// The same of the largest contact area.
    pub area_5_against_40_percent: f64,
    /// Deepest wear against the updates.
    pub max_depth_mm: Vec<OverUpdates>,
    /// Deepest wear of 10 x 500k above that of 40 x 125k.
    pub depth_10_against_40_percent: f64,
    /// Largest and smallest excess of the depth over that of 40 updates, at the same cycles, from
    /// a fifth of the test on.
    pub depth_excess: Vec<Excess>,
}

/// A result against the updates it was computed with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OverUpdates {
    /// Updates.
    pub updates: usize,
    /// The result.
    pub value: f64,
    /// How far it lies above that of the most updates.
    pub above_finest_percent: f64,
}

/// How far a result goes above and below that of the finest run as the test goes on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Excess {
    /// Updates.
    pub updates: usize,
    /// Furthest below.
    pub least_percent: f64,
    /// Furthest above.
    pub most_percent: f64,
}

impl Intervals {
    /// What `runs` found, which are in the order of their updates.
    pub(super) fn of(runs: &[Ran]) -> Result<Self, StudyError> {
        let of_paper = &reference(runs).summary;
        let (coarsest, finest) = (&runs[0].summary, &runs[runs.len() - 1]);
        let five = with_updates(runs, 5);
        let coarser = runs[..runs.len() - 1].iter();
        Ok(Self {
            volume_loss_mm3: over_updates(runs, |ran| ran.summary.volume_loss_mm3),
            volume_1_against_10_percent: above_percent(
                coarsest.volume_loss_mm3,
                of_paper.volume_loss_mm3,
            ),
            pressure_5_against_40_percent: at_last_cycle(five, finest, "peak_pressure_mpa")?,
            area_5_against_40_percent: at_last_cycle(five, finest, "peak_contact_area_mm2")?,
            max_depth_mm: over_updates(runs, |ran| ran.summary.max_depth_mm),
            depth_10_against_40_percent: above_percent(
                of_paper.max_depth_mm,
                finest.summary.max_depth_mm,
            ),
            depth_excess: coarser
                .map(|ran| excess(ran, finest))
                .collect::<Result<_, _>>()?,
        })
    }
}

fn with_updates(runs: &[Ran], updates: usize) -> &Ran {
    let found = runs.iter().find(|ran| ran.updates == updates);
    found.unwrap_or(&runs[0])
}

fn over_updates(runs: &[Ran], of: fn(&Ran) -> f64) -> Vec<OverUpdates> {
    let finest = of(&runs[runs.len() - 1]);
    let one = |ran: &Ran| OverUpdates {
        updates: ran.updates,
        value: of(ran),
        above_finest_percent: above_percent(of(ran), finest),
    };
    runs.iter().map(one).collect()
}

/// A quantity of the last cycle that `coarse` solves above that of `fine` after as many cycles.
///
/// A row of wear.csv stands for the interval before it, and its cycle is solved at the start.
fn at_last_cycle(coarse: &Ran, fine: &Ran, name: &'static str) -> Result<f64, StudyError> {
    let starts = |ran: &Ran| -> Result<Vec<f64>, StudyError> {
        let ends = ran.column(TableOf::Wear, "cycles")?;
        let interval = ran.summary.cycles / ran.updates as f64;
        Ok(ends.iter().map(|end| end - interval).collect())
    };
    let (coarse_starts, fine_starts) = (starts(coarse)?, starts(fine)?);
    let coarse_values = coarse.column(TableOf::Wear, name)?;
    let last = coarse_values.len() - 1;
    let found = at(
        &fine_starts,
        fine.column(TableOf::Wear, name)?,
        coarse_starts[last],
    );
    let fine_value = found.ok_or_else(|| fine.lacks("cycle at the same place"))?;
    Ok(above_percent(coarse_values[last], fine_value))
}

fn excess(ran: &Ran, finest: &Ran) -> Result<Excess, StudyError> {
    const FROM_SHARE: f64 = 0.2;
    let (cycles, depth) = ran.depths()?;
    let (known_cycles, known_depth) = finest.depths()?;
    let from = FROM_SHARE * ran.summary.cycles * (1.0 - 1e-9);
    let later = cycles
        .iter()
        .zip(depth)
        .filter(|(cycles, _)| **cycles >= from);
    let (least_percent, most_percent) = range(later.filter_map(|(&cycles, &depth)| {
        let known = at(known_cycles, known_depth, cycles)?;
        Some(above_percent(depth, known))
    }));
    Ok(Excess {
        updates: ran.updates,
        least_percent,
        most_percent,
    })
}
