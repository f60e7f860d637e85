//! Mean stress of elements.

use std::collections::BTreeMap;

use nalgebra::Matrix3;

use crate::{
    elastic::Strain,
    element::{Element, POINTS},
    solid::{ElasticSolid, moved},
    stress::Stress,
    vector::Vec3,
};

impl ElasticSolid {
    /// Mean stress of every element under displacements of the nodes: that of its centre, where stress is
    /// most exact.
    ///
    /// # Panics
    /// If there are fewer displacements than nodes.
    pub fn stresses(&self, displacements: &[Vec3]) -> Vec<Stress> {
        self.stresses_with(displacements, &BTreeMap::new())
    }

    /// The same where some elements have eigenstrains at their Gauss points, and the displacements are those
    /// under them too.
    ///
    /// # Panics
    /// If there are fewer displacements than nodes.
    pub fn stresses_with(
        &self,
        displacements: &[Vec3],
        eigenstrains: &BTreeMap<usize, [Strain; POINTS]>,
    ) -> Vec<Stress> {
        let hexes = self.mesh().hexes.iter().zip(self.elements()).enumerate();
        let stress = |(number, (hex, element)): (usize, (&[u32; 8], &Element))| {
            let strain = mean_strain(&element.mean_gradients(), &moved(hex, displacements));
            let own = eigenstrains.get(&number);
            let own = own.map_or_else(Strain::default, |own| mean_over(element, own));
            self.elastic().stress(&strain.less(&own))
        };
        hexes.map(stress).collect()
    }
}

/// Mean strain of an element, to which its incompatible modes add nothing.
pub(crate) fn mean_strain(gradients: &[Vec3; 8], nodes: &[Vec3; 8]) -> Strain {
    let mut gradient = Matrix3::zeros();
    for (node, by) in nodes.iter().zip(gradients) {
        gradient += node * by.transpose();
    }
    Strain::of_gradient(&gradient)
}

/// Mean over the volume of strains at the Gauss points.
pub(crate) fn mean_over(element: &Element, strains: &[Strain; POINTS]) -> Strain {
    let volumes = element.volumes();
    let volume: f64 = volumes.iter().sum();
    let mut mean = Strain::default();
    for (part, strain) in volumes.iter().zip(strains) {
        mean = mean.plus(part / volume, &Stress(strain.0));
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elastic, solid::tests::distorted};

    #[test]
    fn the_mean_of_an_element_is_that_of_its_gauss_points() {
        let mesh = distorted([4, 3, 3]);
        let held = (0..20).filter(|&n| mesh.nodes[n as usize].z == 0.0);
        let elastic = Elastic::new(463.0, 0.46).unwrap();
        let solid = ElasticSolid::new(&mesh, elastic, held).unwrap();
        let displacements = solid.displacements(&[(75, Vec3::new(3.0, -8.0, 4.0))]);
        let eigenstrain = |p: usize| Strain(std::array::from_fn(|i| ((i + 5 * p) as f64).sin()));
        let eigenstrains: [Strain; POINTS] = std::array::from_fn(eigenstrain);
        let means = solid.stresses_with(&displacements, &BTreeMap::from([(7, eigenstrains)]));
        for (number, hex) in mesh.hexes.iter().enumerate() {
            let own = if number == 7 {
                eigenstrains
            } else {
                Default::default()
            };
            let stresses = solid.element_stresses(number, &moved(hex, &displacements), &own);
            let volumes = solid.elements()[number].volumes();
            let volume: f64 = volumes.iter().sum();
            for i in 0..6 {
                let sum = (0..POINTS).map(|p| volumes[p] / volume * stresses[p].0[i]);
                let apart = sum.sum::<f64>() - means[number].0[i];
                assert!(apart.abs() < 1e-9, "{number} {i} {apart}");
            }
        }
    }
}
