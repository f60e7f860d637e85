//! The depth of the surface by cause.

use serde::{Deserialize, Serialize};

/// The depth of a surface by one cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthField {
    /// Name of the cause, such as `wear`.
    pub name: String,
    /// True if the material is lost, as by wear, and false if it is only displaced.
    pub loses_mass: bool,
    /// Depth at every surface node along the inward normal, mm.
    pub depth_mm: Vec<f64>,
}

impl DepthField {
    /// Name of the depth by wear.
    pub const WEAR: &'static str = "wear";

    /// Name of the depth by creep.
    pub const CREEP: &'static str = "creep";

    pub(super) fn creep(depth_mm: Vec<f64>) -> Self {
        Self {
            name: Self::CREEP.to_owned(),
            loses_mass: false,
            depth_mm,
        }
    }

    pub(super) fn wear(depth_mm: Vec<f64>) -> Self {
        Self {
            name: Self::WEAR.to_owned(),
            loses_mass: true,
            depth_mm,
        }
    }
}

/// The depths of all causes; the surface is lowered by their sum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DepthFields {
    node_count: usize,
    fields: Vec<DepthField>,
}

impl Default for DepthFields {
    fn default() -> Self {
        Self::none(0)
    }
}

impl DepthFields {
    /// Creates the depths of an unworn surface of `node_count` nodes.
    pub(super) fn none(node_count: usize) -> Self {
        let fields = vec![DepthField::wear(vec![0.0; node_count])];
        Self { node_count, fields }
    }

    /// Returns the depth of every cause, wear first.
    pub fn fields(&self) -> &[DepthField] {
        &self.fields
    }

    /// Returns the depth of wear at every surface node, mm.
    pub fn wear_mm(&self) -> &[f64] {
        &self.fields[0].depth_mm
    }

    /// Returns the depth of creep at every surface node, mm; none if the insert does not creep.
    pub fn creep_mm(&self) -> Option<&[f64]> {
        let mut fields = self.fields.iter();
        let creep = fields.find(|field| field.name == DepthField::CREEP)?;
        Some(&creep.depth_mm)
    }

    /// Returns the sum of all causes at every surface node, mm.
    pub fn total_mm(&self) -> Vec<f64> {
        sum_mm(&self.fields, self.node_count)
    }

    /// Adds the depths of a step, cause by cause; a new cause starts with it.
    pub(super) fn add(&mut self, step: &[DepthField]) {
        for taken in step {
            match self.fields.iter_mut().find(|own| own.name == taken.name) {
                Some(own) => {
                    let depths = own.depth_mm.iter_mut().zip(&taken.depth_mm);
                    depths.for_each(|(own, taken)| *own += taken);
                }
                None => self.fields.push(taken.clone()),
            }
        }
    }
}

/// Returns the sum of some fields at every node, mm.
pub(super) fn sum_mm<'a>(
    fields: impl IntoIterator<Item = &'a DepthField>,
    node_count: usize,
) -> Vec<f64> {
    let mut sum = vec![0.0; node_count];
    for field in fields {
        let depths = sum.iter_mut().zip(&field.depth_mm);
        depths.for_each(|(sum, depth)| *sum += depth);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_that_loses_no_mass_moves_the_surface_alone() {
        let creep = DepthField::creep(vec![0.5, 0.0]);
        let step = [DepthField::wear(vec![1.0, 2.0]), creep];
        assert_eq!(sum_mm(&step, 2), [1.5, 2.0]);
        let lost = step.iter().filter(|field| field.loses_mass);
        assert_eq!(sum_mm(lost, 2), [1.0, 2.0]);

        let mut depths = DepthFields::none(2);
        depths.add(&step);
        depths.add(&step[..1]);
        assert_eq!(depths.wear_mm(), [2.0, 4.0]);
        assert_eq!(depths.total_mm(), [2.5, 4.0]);
        assert_eq!(depths.creep_mm(), Some([0.5, 0.0].as_slice()));
        assert_eq!(depths.fields().len(), 2);
    }
}
