//! What of plastic strain the next contact goes on from.

use condyle_fem::{PlasticPoint, Strain, Stress};

use super::{POINTS, Points};
use crate::contact::memory::{ContactState, StateField};

/// The field of the contact's state that holds plastic strains; of every element that has yielded its number, the
/// largest flow of its Gauss points in the last cycle, and of each point strain, backstress, MPa, and accumulated
/// strain.
pub(in super::super) const PLASTIC_FIELD: &str = "plastic_strain_and_backstress_mpa";

/// Numbers of a Gauss point.
const OF_POINT: usize = 13;
/// Numbers of an element.
const OF_ELEMENT: usize = 2 + POINTS * OF_POINT;

/// Plastic strains, and what flowed in the last cycle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in super::super) struct Remembered {
    pub points: Points,
    /// Of every element the most that accumulated at one of its Gauss points in the last cycle.
    pub flow_in_cycle: std::collections::BTreeMap<u32, f64>,
}

impl Remembered {
    /// What a state says; nothing where it says nothing of plastic strain.
    pub fn of(state: &ContactState) -> Self {
        let mut remembered = Self::default();
        let field = state
            .fields
            .iter()
            .find(|field| field.name == PLASTIC_FIELD);
        let values = field.map_or(&[][..], |field| &field.values);
        for numbers in values.chunks_exact(OF_ELEMENT) {
            let element = numbers[0] as u32;
            let point = |p: usize| point_of(&numbers[2 + p * OF_POINT..][..OF_POINT]);
            remembered
                .points
                .insert(element, std::array::from_fn(point));
            remembered.flow_in_cycle.insert(element, numbers[1]);
        }
        remembered
    }

    /// The field that says it; none where nothing has yielded.
    pub fn field(&self) -> Option<StateField> {
        if self.points.is_empty() {
            return None;
        }
        let values = self.points.iter().flat_map(|(element, points)| {
            let flow = self.flow_in_cycle.get(element).copied().unwrap_or_default();
            let own = [f64::from(*element), flow];
            own.into_iter().chain(points.iter().flat_map(numbers_of))
        });
        Some(StateField {
            name: PLASTIC_FIELD.to_owned(),
            values: values.collect(),
        })
    }
}

fn point_of(numbers: &[f64]) -> PlasticPoint {
    PlasticPoint {
        strain: Strain(std::array::from_fn(|i| numbers[i])),
        backstress: Stress(std::array::from_fn(|i| numbers[6 + i])),
        accumulated: numbers[12],
    }
}

fn numbers_of(point: &PlasticPoint) -> impl Iterator<Item = f64> {
    let (strain, backstress) = (point.strain.0, point.backstress.0);
    let tensors = strain.into_iter().chain(backstress);
    tensors.chain([point.accumulated])
}
