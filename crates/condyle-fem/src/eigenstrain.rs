//! Strain that needs no stress, such as plastic strain, in an elastic solid.
//!
//! Its forces on the nodes move the solid as any others do, with the same stiffness, and the stress is
//! that of the strain without it (Eshelby; Mura 1987).

use crate::{
    elastic::Strain,
    element::POINTS,
    solid::{ElasticSolid, moved},
    stress::Stress,
    vector::Vec3,
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
}
