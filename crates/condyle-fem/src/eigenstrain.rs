//! Stress-free strain, such as plastic strain, in an elastic solid.
//!
//! An eigenstrain acts through forces on the nodes, with unchanged stiffness; the stress follows from the strain less
//! the eigenstrain (Eshelby; Mura 1987).

use std::collections::BTreeMap;

use crate::{
    Vec3,
    elastic::{Elastic, Strain, Stress},
    element::{Element, Modes, POINTS, Stiffness},
    plastic::{Material, MaterialPoint},
    solid::{ElasticSolid, moved},
};

impl ElasticSolid {
    /// Returns the mean stress of every element under displacements of the nodes: that of its centre, where stress is
    /// most exact.
    ///
    /// `eigenstrains`: those at the Gauss points of some elements; the displacements must include their effect.
    ///
    /// # Panics
    /// If there are fewer displacements than nodes.
    pub fn stresses(
        &self,
        displacements: &[Vec3],
        eigenstrains: &BTreeMap<usize, [Strain; POINTS]>,
    ) -> Vec<Stress> {
        let hexes = self.mesh().hexes.iter().enumerate();
        let stress = |(number, hex): (usize, &[u32; 8])| {
            let mut mean = Strain::default();
            if let Some(strains) = eigenstrains.get(&number) {
                let volumes = self.element(number).volumes();
                let volume: f64 = volumes.iter().sum();
                for (part, strain) in volumes.iter().zip(strains) {
                    mean = mean.plus(part / volume, &Stress(strain.0));
                }
            }
            let operator = self.element_mean(number);
            operator.stress(&moved(hex, displacements), &mean)
        };
        hexes.map(stress).collect()
    }

    /// Returns an element by itself.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn yielding_element(&self, element: usize) -> YieldingElement {
        let (element, elastic) = (self.element(element), self.elastic());
        YieldingElement {
            stiffness: element.stiffness(&elastic),
            elastic,
            element,
        }
    }
}

/// An element whose material may yield, with the stiffness of its modes.
pub struct YieldingElement {
    element: Element,
    elastic: Elastic,
    stiffness: Stiffness,
}

impl YieldingElement {
    /// Returns the internal variables after a flow from `before` under displacements of the nodes, if the modes of
    /// the element are in balance with the plastic strains of `trial`.
    ///
    /// The flow of the element is the fixed point: a result equal to `trial`.
    pub fn flow<M: Material>(
        &self,
        material: &M,
        nodes: &[Vec3; 8],
        [trial, before]: [&[M::Point; POINTS]; 2],
    ) -> [M::Point; POINTS] {
        let strains = self.strains(nodes, &trial.map(|point| point.eigenstrain()));
        std::array::from_fn(|p| material.flow(&strains[p], &before[p]))
    }

    /// Returns the largest ratio of stress to yield stress at a Gauss point, more than 1 if it will flow: under
    /// displacements of the nodes, with the plastic strains kept.
    pub fn use_of_yield<M: Material>(
        &self,
        material: &M,
        nodes: &[Vec3; 8],
        before: &[M::Point; POINTS],
    ) -> f64 {
        let strains = self.strains(nodes, &before.map(|point| point.eigenstrain()));
        let used = strains.iter().zip(before);
        used.map(|(strain, before)| material.use_of_yield(strain, before))
            .fold(0.0, f64::max)
    }

    /// Returns the forces on the eight nodes of the element by eigenstrains at its Gauss points, in the order of its
    /// corners: the displacements under them are those of the eigenstrains.
    pub fn forces(&self, eigenstrains: &[Strain; POINTS]) -> [Vec3; 8] {
        let (nodes, pull) = self.pull(eigenstrains);
        let passed_on = self.stiffness.passed_on(&pull);
        std::array::from_fn(|node| nodes[node] - passed_on[node])
    }

    fn strains(&self, nodes: &[Vec3; 8], eigenstrains: &[Strain; POINTS]) -> [Strain; POINTS] {
        let (_, pull) = self.pull(eigenstrains);
        let modes = self.stiffness.modes(nodes, &pull);
        self.element.strains(nodes, &modes)
    }

    fn pull(&self, eigenstrains: &[Strain; POINTS]) -> ([Vec3; 8], Modes) {
        let stresses = eigenstrains.map(|strain| self.elastic.stress(&strain));
        self.element.forces(&stresses)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{distorted, standing};

    /// Returns a block that is held at one corner and against turning, so that it is free to swell.
    fn free() -> ElasticSolid {
        let mesh = distorted([4, 3, 3]);
        let supports = [
            (0, [true; 3]),
            (4, [false, true, true]),
            (15, [false, false, true]),
        ];
        ElasticSolid::with_supports(&mesh, Elastic::new(463.0, 0.46).unwrap(), supports).unwrap()
    }

    /// Displacements of all nodes by eigenstrains of some elements.
    fn relaxed(solid: &ElasticSolid, eigenstrains: &[(usize, [Strain; POINTS])]) -> Vec<Vec3> {
        let forces = eigenstrains.iter().flat_map(|(element, eigenstrains)| {
            let own = solid.yielding_element(*element).forces(eigenstrains);
            solid.mesh().hexes[*element].into_iter().zip(own)
        });
        solid.displacements(&forces.collect::<Vec<_>>())
    }

    #[test]
    fn verify_uniform_eigenstrain_leaves_no_stress() {
        let solid = free();
        let eigenstrain = Strain([0.01, -0.02, 0.03, 0.0, 0.0, 0.0]);
        let all: Vec<_> = (0..36)
            .map(|element| (element, [eigenstrain; POINTS]))
            .collect();
        let displacements = relaxed(&solid, &all);
        for (node, u) in solid.mesh().nodes.iter().zip(&displacements) {
            let exact = Vec3::new(0.01 * node.x, -0.02 * node.y, 0.03 * node.z);
            assert!((u - exact).norm() < 1e-12, "{u} {exact}");
        }
        let elastic = solid.elastic();
        let hexes = solid.mesh().hexes.iter().enumerate();
        let stresses = hexes.flat_map(|(element, hex)| {
            solid.element(element).stresses(
                &elastic,
                &moved(hex, &displacements),
                &[eigenstrain; POINTS],
            )
        });
        let largest = stresses.map(|stress| stress.norm()).fold(0.0, f64::max);
        assert!(largest < 1e-10, "{largest}");
    }

    #[test]
    fn verify_reciprocity_of_eigenstrain_and_force() {
        // A force's work on the displacement by an eigenstrain is that of the force's stress on the eigenstrain.
        let solid = free();
        let eigenstrains: [Strain; POINTS] = std::array::from_fn(|p| {
            Strain(std::array::from_fn(|i| {
                0.01 * ((3 * i + 7 * p) as f64).sin()
            }))
        });
        let displacements = relaxed(&solid, &[(17, eigenstrains)]);
        let (node, force) = (75, Vec3::new(0.3, -0.8, 0.4));
        let by_force = solid.displacements(&[(node, force)]);
        let nodes = moved(&solid.mesh().hexes[17], &by_force);
        let none = [Strain::default(); POINTS];
        let stresses = solid.element(17).stresses(&solid.elastic(), &nodes, &none);
        let volumes = solid.element(17).volumes();
        let works = (0..POINTS).map(|p| volumes[p] * stresses[p].dot(&Stress(eigenstrains[p].0)));
        let work = force.dot(&displacements[node as usize]);
        assert!((works.sum::<f64>() - work).abs() < 1e-15, "{work}");
    }

    #[test]
    fn the_mean_of_an_element_is_that_of_its_gauss_points() {
        let solid = standing([4, 3, 3]);
        let displacements = solid.displacements(&[(75, Vec3::new(3.0, -8.0, 4.0))]);
        let eigenstrain = |p: usize| Strain(std::array::from_fn(|i| ((i + 5 * p) as f64).sin()));
        let eigenstrains: [Strain; POINTS] = std::array::from_fn(eigenstrain);
        let means = solid.stresses(&displacements, &BTreeMap::from([(7, eigenstrains)]));
        for (number, hex) in solid.mesh().hexes.iter().enumerate() {
            let own = if number == 7 {
                eigenstrains
            } else {
                Default::default()
            };
            let nodes = moved(hex, &displacements);
            let element = solid.element(number);
            let stresses = element.stresses(&solid.elastic(), &nodes, &own);
            let volumes = element.volumes();
            let volume: f64 = volumes.iter().sum();
            for i in 0..6 {
                let sum = (0..POINTS).map(|p| volumes[p] / volume * stresses[p].0[i]);
                let apart = sum.sum::<f64>() - means[number].0[i];
                assert!(apart.abs() < 1e-9, "{number} {i} {apart}");
            }
        }
    }
}
