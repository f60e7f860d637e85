//! Values of inputs as places in their ranges, and inputs that take only some values: numbers as levels, and whole numbers.

use condyle_case::{
    config::Level,
    study::{Input, Variation},
};

use super::observed::Observed;
use crate::{
    distribution::{Place, level_along},
    statistics::extent,
};

/// Whole numbers up to this many are levels; among more, rounding moves a test too little to matter.
const MAX_LEVELS: f64 = 1000.0;

/// Returns the place of a value in the range of its input, 0 to 1; beyond for rare values of an unbounded distribution.
pub(super) fn along(input: &Input, value: Option<&Level>) -> Option<f64> {
    let [low, high] = ends(input);
    Some((value?.number()? - low) / (high - low))
}

/// Returns the numbers at both ends of the range of an input.
pub(crate) fn ends(input: &Input) -> [f64; 2] {
    let ends = || [0.0, 1.0].map(|end| level_along(input, end));
    match &input.variation {
        Variation::Levels(keys) => extent(keys.levels.0.iter().filter_map(Level::number)),
        _ => extent(ends().iter().filter_map(Level::number)),
    }
}

/// Returns the places of the values of an input in its range, in the order of the study; none if it is continuous.
pub(super) fn levels(input: &Input) -> Vec<f64> {
    let values = match &input.variation {
        Variation::Levels(keys) => keys.levels.0.clone(),
        Variation::Uniform(keys) if input.is_whole && keys.high - keys.low < MAX_LEVELS => {
            let whole = keys.low.round() as i64..=keys.high.round() as i64;
            whole.map(|one| Level::Number(one as f64)).collect()
        }
        _ => Vec::new(),
    };
    let places = values.iter().map(|value| along(input, Some(value)));
    places.map(|place| place.unwrap_or(0.5)).collect()
}

/// Returns the rule for the value at a place in the range: for levels the nearest one.
pub(super) fn place_along(input: &Input, part: f64) -> Place {
    let Variation::Levels(_) = input.variation else {
        return Place::Along(part);
    };
    let levels = levels(input);
    let share = |near| (near as f64 + 0.5) / levels.len() as f64;
    Place::Share(nearest(&levels, part).map_or(part, share))
}

fn nearest(levels: &[f64], place: f64) -> Option<usize> {
    let distance = |one: usize| (levels[one] - place).abs();
    (0..levels.len()).min_by(|&one, &other| distance(one).total_cmp(&distance(other)))
}

impl Observed {
    /// Returns a point with every input at its nearest level.
    pub fn snapped(&self, point: &[f64]) -> Vec<f64> {
        let snapped = |(axis, place): (usize, &f64)| {
            let levels = self.levels.get(axis).map_or(&[][..], Vec::as_slice);
            nearest(levels, *place).map_or(*place, |near| levels[near])
        };
        point.iter().enumerate().map(snapped).collect()
    }
}
