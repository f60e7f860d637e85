//! The balance of an elastic-plastic solid by the method of initial stress on all of its elements.
//!
//! The plain reference of the fast solution: every iteration solves the whole solid under the forces of the plastic
//! strains, and returns the stress of every Gauss point to the yield surface.

use condyle_fem::{
    ElasticPlastic, ElasticSolid, Hardening, PlasticPoint, Strain, Vec3, YieldingElement,
};
use nalgebra::{DMatrix, DVector};

/// The internal variables at the Gauss points of an element.
pub(crate) type Points = [PlasticPoint; 8];

/// Change of plastic strain in an iteration at which the balance counts as found: about 1e-10 of the strain at yield.
const BALANCED: f64 = 1e-12;

/// Near the limit load a hundred iterations are needed; beyond it there is no balance.
const MAX_ITERATIONS: usize = 500;

/// Earlier iterations that the mixing remembers.
const MIXED: usize = 10;

/// Numbers of strain in an element.
const STRAINS: usize = 48;

pub(crate) struct InitialStress {
    pub(crate) solid: ElasticSolid,
    material: ElasticPlastic,
    elements: Vec<YieldingElement>,
}

impl InitialStress {
    pub(crate) fn new(solid: ElasticSolid, hardening: Hardening) -> Self {
        let elements = 0..solid.mesh().hexes.len();
        Self {
            elements: elements.map(|e| solid.yielding_element(e)).collect(),
            material: ElasticPlastic {
                elastic: solid.elastic(),
                hardening,
            },
            solid,
        }
    }

    pub(crate) fn unloaded(&self) -> Vec<Points> {
        vec![Points::default(); self.elements.len()]
    }

    /// Returns the displacements of all nodes and the internal variables in balance with forces, from the variables
    /// `before`; none if the material cannot carry the forces.
    pub(crate) fn solve(
        &self,
        forces: &[(u32, Vec3)],
        before: &[Points],
    ) -> Option<(Vec<Vec3>, Vec<Points>)> {
        let mut tried = strains(before);
        // Differences of successive residuals, and of successive results.
        let mut differences: Vec<[DVector<f64>; 2]> = Vec::new();
        let mut last: Option<[DVector<f64>; 2]> = None;
        for _ in 0..MAX_ITERATIONS {
            let mut all = forces.to_vec();
            all.extend(self.forces(&tried));
            let displacements = self.solid.displacements(&all);
            let points = self.flow(&displacements, &tried, before);
            let found = strains(&points);
            let residual = &found - &tried;
            if residual.amax() <= BALANCED {
                return Some((displacements, points));
            }
            if let Some([last_residual, last_found]) = last.take() {
                differences.push([&residual - last_residual, &found - last_found]);
                if differences.len() > MIXED {
                    differences.remove(0);
                }
            }
            // Anderson's mixing: the sum of differences that cancels the most of the residual.
            let columns = |k: usize| -> Vec<DVector<f64>> {
                differences.iter().map(|pair| pair[k].clone()).collect()
            };
            tried.clone_from(&found);
            if !differences.is_empty() {
                let [by_residual, by_found] = [0, 1].map(|k| DMatrix::from_columns(&columns(k)));
                let gram = by_residual.tr_mul(&by_residual);
                let cut = 1e-14 * gram.norm();
                let inverse = gram.pseudo_inverse(cut).ok()?;
                tried -= by_found * (inverse * by_residual.tr_mul(&residual));
            }
            last = Some([residual, found]);
        }
        None
    }

    fn forces(&self, strains: &DVector<f64>) -> Vec<(u32, Vec3)> {
        let hexes = self.solid.mesh().hexes.iter().enumerate();
        let forces = hexes.flat_map(|(e, hex)| {
            let forces = self.elements[e].forces(&own_strains(strains, e));
            hex.iter().copied().zip(forces)
        });
        forces.collect()
    }

    fn flow(&self, displacements: &[Vec3], tried: &DVector<f64>, before: &[Points]) -> Vec<Points> {
        let hexes = self.solid.mesh().hexes.iter().enumerate();
        let flow = |(e, hex): (usize, &[u32; 8])| {
            let nodes = hex.map(|node| displacements[node as usize]);
            let (own, mut trial) = (own_strains(tried, e), before[e]);
            for (point, strain) in trial.iter_mut().zip(own) {
                point.strain = strain;
            }
            let element = &self.elements[e];
            element.flow(&self.material, &nodes, [&trial, &before[e]])
        };
        hexes.map(flow).collect()
    }
}

fn strains(points: &[Points]) -> DVector<f64> {
    let strains = points.iter().flatten().flat_map(|point| point.strain.0);
    DVector::from_iterator(STRAINS * points.len(), strains)
}

fn own_strains(strains: &DVector<f64>, element: usize) -> [Strain; 8] {
    let first = STRAINS * element;
    std::array::from_fn(|p| Strain(std::array::from_fn(|i| strains[first + 6 * p + i])))
}
