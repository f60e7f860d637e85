//! An element whose material may yield, by itself: its flow under displacements of its nodes.

use crate::{
    elastic::{Elastic, Strain},
    element::{Modes, POINTS, Stiffness},
    mean_stress::{mean_over, mean_strain},
    plasticity::{ElasticPlastic, PlasticPoint},
    solid::ElasticSolid,
    stress::Stress,
    vector::Vec3,
};

/// What makes the mean stress of an element of displacements of its nodes.
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
    /// What makes the mean stress of an element.
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
    /// What the Gauss points remember after a flow from `before` under displacements of the nodes, if the modes of
    /// the element are in balance with the plastic strains of `trial`.
    ///
    /// Where that is what comes out, it is the flow of the element.
    pub fn flow(
        &self,
        solid: &ElasticSolid,
        material: &ElasticPlastic,
        nodes: &[Vec3; 8],
        [trial, before]: [&[PlasticPoint; POINTS]; 2],
    ) -> [PlasticPoint; POINTS] {
        let element = &solid.elements()[self.number];
        let pull = self.pull(solid, &trial.map(|point| point.strain));
        let strains = element.strains(nodes, &self.stiffness.modes(nodes, &pull));
        std::array::from_fn(|p| material.respond(&strains[p], &before[p]).point)
    }

    /// The largest part of the yield stress that is used up at a Gauss point, more than 1 where it will flow: under
    /// displacements of the nodes, with the plastic strains remembered.
    pub fn use_of_yield(
        &self,
        solid: &ElasticSolid,
        material: &ElasticPlastic,
        nodes: &[Vec3; 8],
        before: &[PlasticPoint; POINTS],
    ) -> f64 {
        let element = &solid.elements()[self.number];
        let pull = self.pull(solid, &before.map(|point| point.strain));
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

    /// Mean of eigenstrains over the element.
    pub fn mean(&self, solid: &ElasticSolid, eigenstrains: &[Strain; POINTS]) -> Strain {
        mean_over(&solid.elements()[self.number], eigenstrains)
    }

    fn pull(&self, solid: &ElasticSolid, eigenstrains: &[Strain; POINTS]) -> Modes {
        let elastic = solid.elastic();
        let stresses = eigenstrains.map(|strain| elastic.stress(&strain));
        solid.elements()[self.number].forces(&stresses).1
    }
}

impl Strain {
    /// The difference to another strain.
    pub fn since(&self, before: &Self) -> Self {
        self.less(before)
    }

    /// Equivalent strain, $\sqrt{2/3\thinspace e : e}$, of a strain without change of volume.
    pub fn equivalent(&self) -> f64 {
        let [x, y, z, shears @ ..] = self.0;
        let shears = shears.iter().map(|shear| shear * shear).sum::<f64>();
        (2.0 / 3.0 * (x * x + y * y + z * z + 2.0 * shears)).sqrt()
    }
}
