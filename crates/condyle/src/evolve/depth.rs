//! The depth of the surface by wear and by creep.

use serde::{Deserialize, Serialize};

/// Depths at every surface node along the inward normal; the surface is lowered by their sum.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Depths {
    /// Depth of wear, mm.
    pub wear_mm: Vec<f64>,
    /// Depth of creep, which displaces material and loses none, mm; none if the insert does not creep.
    pub creep_mm: Option<Vec<f64>>,
}

impl Depths {
    /// Creates the depths after wear alone.
    pub(super) fn by_wear(wear_mm: Vec<f64>) -> Self {
        let creep_mm = None;
        Self { wear_mm, creep_mm }
    }

    /// Returns the sum at every surface node, mm.
    pub fn total_mm(&self) -> Vec<f64> {
        let mut total_mm = self.wear_mm.clone();
        add(&mut total_mm, self.creep_mm.as_deref().unwrap_or_default());
        total_mm
    }

    /// Adds the depths of a step.
    pub(super) fn add(&mut self, step: &Self) {
        add(&mut self.wear_mm, &step.wear_mm);
        match (&mut self.creep_mm, &step.creep_mm) {
            (Some(own), Some(more)) => add(own, more),
            (Some(_), None) => (),
            (own, more) => own.clone_from(more),
        }
    }
}

fn add(sum: &mut [f64], more: &[f64]) {
    sum.iter_mut()
        .zip(more)
        .for_each(|(sum, more)| *sum += more);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wear_and_creep_of_steps_add_up() {
        let wear = Depths::by_wear(vec![1.0, 2.0]);
        let step = Depths {
            creep_mm: Some(vec![0.5, 0.0]),
            ..wear.clone()
        };
        assert_eq!(step.total_mm(), [1.5, 2.0]);
        let mut depths = Depths::by_wear(vec![0.0; 2]);
        depths.add(&step);
        depths.add(&wear);
        assert_eq!(depths.wear_mm, [2.0, 4.0]);
        assert_eq!(depths.total_mm(), [2.5, 4.0]);
        assert_eq!(depths.creep_mm, Some(vec![0.5, 0.0]));
    }
}
