//! Strain that needs no stress, such as plastic strain, in an elastic solid.
//!
//! Its forces on the nodes move the solid as any others do, with the same stiffness, and the stress is
//! that of the strain without it (Eshelby; Mura 1987).

use std::collections::BTreeMap;

use nalgebra::Matrix3;

use crate::{
    Vec3,
    elastic::Elastic,
    element::{Element, Modes, POINTS, Stiffness},
    material::Material,
    solid::{ElasticSolid, moved},
    stress::{Strain, Stress},
};

impl ElasticSolid {
    /// Forces on the eight nodes of an element by eigenstrains at its Gauss points, in the order of its corners.
    ///
    /// The displacements under them are those of the eigenstrains.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn eigenstrain_forces(&self, element: usize, eigenstrains: &[Strain; POINTS]) -> [Vec3; 8] {
        let (element, elastic) = (&self.elements()[element], self.elastic());
        let stresses = eigenstrains.map(|strain| elastic.stress(&strain));
        let (nodes, modes) = element.forces(&stresses);
        let passed_on = element.stiffness(&elastic).passed_on(&modes);
        std::array::from_fn(|node| nodes[node] - passed_on[node])
    }

    /// Stress at the Gauss points of an element under displacements of its eight nodes and eigenstrains.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn element_stresses(
        &self,
        element: usize,
        displacements: &[Vec3; 8],
        eigenstrains: &[Strain; POINTS],
    ) -> [Stress; POINTS] {
        let element = &self.elements()[element];
        element.stresses(&self.elastic(), displacements, eigenstrains)
    }

    /// Displacements of all nodes by eigenstrains of some elements, and the stresses that stay in those.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn relaxed(
        &self,
        eigenstrains: &[(usize, [Strain; POINTS])],
    ) -> (Vec<Vec3>, Vec<[Stress; POINTS]>) {
        let mut forces = vec![Vec3::zeros(); self.mesh().nodes.len()];
        for (element, eigenstrains) in eigenstrains {
            let own = self.eigenstrain_forces(*element, eigenstrains);
            for (&node, force) in self.mesh().hexes[*element].iter().zip(own) {
                forces[node as usize] += force;
            }
        }
        let displacements = self.displacements_by(&forces);
        let stresses = eigenstrains.iter().map(|(element, eigenstrains)| {
            let nodes = moved(&self.mesh().hexes[*element], &displacements);
            self.element_stresses(*element, &nodes, eigenstrains)
        });
        let stresses = stresses.collect();
        (displacements, stresses)
    }
}

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
    Strain::from_gradient(&gradient)
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

/// The operator from the displacements of an element's nodes to its mean stress.
#[derive(Clone, Debug)]
pub struct ElementMean {
    gradients: [Vec3; 8],
    elastic: Elastic,
}

/// An element whose material may yield, with the stiffness of its modes.
pub struct YieldingElement {
    number: usize,
    stiffness: Stiffness,
}

impl ElementMean {
    /// Mean stress under displacements of the nodes, and a mean eigenstrain.
    pub fn stress(&self, nodes: &[Vec3; 8], eigenstrain: &Strain) -> Stress {
        let strain = mean_strain(&self.gradients, nodes);
        self.elastic.stress(&strain.less(eigenstrain))
    }
}

impl ElasticSolid {
    /// Returns the operator from displacements to the mean stress of an element.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn element_mean(&self, element: usize) -> ElementMean {
        ElementMean {
            gradients: self.elements()[element].mean_gradients(),
            elastic: self.elastic(),
        }
    }

    /// An element by itself.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn yielding_element(&self, element: usize) -> YieldingElement {
        YieldingElement {
            number: element,
            stiffness: self.elements()[element].stiffness(&self.elastic()),
        }
    }
}

impl YieldingElement {
    /// Returns the internal variables after a flow from `before` under displacements of the nodes, if the modes of
    /// the element are in balance with the plastic strains of `trial`.
    ///
    /// The flow of the element is the fixed point: a result equal to `trial`.
    pub fn flow<M: Material>(
        &self,
        solid: &ElasticSolid,
        material: &M,
        nodes: &[Vec3; 8],
        [trial, before]: [&[M::Point; POINTS]; 2],
    ) -> [M::Point; POINTS] {
        let element = &solid.elements()[self.number];
        let pull = self.pull(solid, &trial.map(|point| M::eigenstrain(&point)));
        let strains = element.strains(nodes, &self.stiffness.modes(nodes, &pull));
        std::array::from_fn(|p| material.respond(&strains[p], &before[p]).point)
    }

    /// The largest part of the yield stress that is used up at a Gauss point, more than 1 where it will flow: under
    /// displacements of the nodes, with the plastic strains remembered.
    pub fn use_of_yield<M: Material>(
        &self,
        solid: &ElasticSolid,
        material: &M,
        nodes: &[Vec3; 8],
        before: &[M::Point; POINTS],
    ) -> f64 {
        let element = &solid.elements()[self.number];
        let pull = self.pull(solid, &before.map(|point| M::eigenstrain(&point)));
        let strains = element.strains(nodes, &self.stiffness.modes(nodes, &pull));
        let used = strains.iter().zip(before);
        used.map(|(strain, before)| material.use_of_yield(strain, before))
            .fold(0.0, f64::max)
    }

    /// Forces on the nodes by eigenstrains, as [`ElasticSolid::eigenstrain_forces`].
    pub fn forces(&self, solid: &ElasticSolid, eigenstrains: &[Strain; POINTS]) -> [Vec3; 8] {
        let element = &solid.elements()[self.number];
        let elastic = solid.elastic();
        let (nodes, modes) = element.forces(&eigenstrains.map(|strain| elastic.stress(&strain)));
        let passed_on = self.stiffness.passed_on(&modes);
        std::array::from_fn(|node| nodes[node] - passed_on[node])
    }

    fn pull(&self, solid: &ElasticSolid, eigenstrains: &[Strain; POINTS]) -> Modes {
        let elastic = solid.elastic();
        let stresses = eigenstrains.map(|strain| elastic.stress(&strain));
        solid.elements()[self.number].forces(&stresses).1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elastic, solid::tests::distorted};

    /// A block that is held at one corner and against turning, so that it is free to swell.
    fn free() -> ElasticSolid {
        let mesh = distorted([4, 3, 3]);
        let supports = [
            (0, [true; 3]),
            (4, [false, true, true]),
            (15, [false, false, true]),
        ];
        ElasticSolid::with_supports(&mesh, Elastic::new(463.0, 0.46).unwrap(), supports).unwrap()
    }

    #[test]
    fn verify_uniform_eigenstrain_leaves_no_stress() {
        let solid = free();
        let eigenstrain = Strain([0.01, -0.02, 0.03, 0.0, 0.0, 0.0]);
        let all: Vec<_> = (0..36)
            .map(|element| (element, [eigenstrain; POINTS]))
            .collect();
        let (displacements, stresses) = solid.relaxed(&all);
        for (node, u) in solid.mesh().nodes.iter().zip(&displacements) {
            let exact = Vec3::new(0.01 * node.x, -0.02 * node.y, 0.03 * node.z);
            assert!((u - exact).norm() < 1e-12, "{u} {exact}");
        }
        let largest = stresses
            .iter()
            .flatten()
            .map(Stress::norm)
            .fold(0.0, f64::max);
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
        let (displacements, _) = solid.relaxed(&[(17, eigenstrains)]);
        let (node, force) = (75, Vec3::new(0.3, -0.8, 0.4));
        let by_force = solid.displacements(&[(node, force)]);
        let stresses = solid.gauss_stresses(&by_force)[17];
        let volumes = solid.elements()[17].volumes();
        let works = (0..POINTS).map(|p| volumes[p] * stresses[p].dot(&Stress(eigenstrains[p].0)));
        let work = force.dot(&displacements[node as usize]);
        assert!((works.sum::<f64>() - work).abs() < 1e-15, "{work}");
    }

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
