//! An elastic-plastic solid under loads.
//!
//! Newton's method with the consistent tangent. Only some elements yield, so the tangent is the elastic
//! stiffness less a few element matrices, and no new factorisation is made: its equations are solved by
//! conjugate gradients with the elastic factor as preconditioner. Every one of their steps is one of the
//! method of initial stress (Zienkiewicz, Valliappan and King 1969), and they end after about as many as there are distinct
//! stiffnesses among what yields.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::{
    Vec3,
    element::{Modes, NodalStiffness, POINTS, Stiffness, flat},
    material::{Material, MaterialPoint, Response},
    plastic::{ElasticPlastic, Hardening, PlasticPoint},
    solid::{ElasticSolid, moved},
    stress::Stress,
};

/// Residual force at which the solid counts as balanced, as part of the forces of loads, elements and plastic strains
/// on nodes.
const BALANCED: f64 = 1e-9;

/// Maximum number of Newton iterations; the number of correct digits doubles near the solution, so that further
/// iterations are of no use.
const MAX_ITERATIONS: usize = 40;

/// Part of the energy of the residual at which the equations of a Newton step count as solved: near the solution,
/// Newton's method then gains four digits per step.
const SOLVED: f64 = 1e-8;

/// Maximum number of steps of conjugate gradients for a Newton step.
const MAX_GRADIENT_STEPS: usize = 200;

/// A solid whose material yields; by default by von Mises.
pub struct PlasticSolid<M = ElasticPlastic> {
    solid: ElasticSolid,
    material: M,
    stiffnesses: Vec<Stiffness>,
}

/// The internal variables at every Gauss point of a solid, eight per element in the order of its corners.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlasticState<P = PlasticPoint> {
    /// The points of every element.
    pub elements: Vec<[P; POINTS]>,
}

/// A solid in balance under a load.
#[derive(Clone, Debug)]
pub struct PlasticSolution<P = PlasticPoint> {
    /// Displacement of every node from the mesh of the solid.
    pub displacements: Vec<Vec3>,
    /// The internal variables if the load is accepted; the next load starts from them.
    pub state: PlasticState<P>,
    /// Stress at the Gauss points of every element.
    pub stresses: Vec<[Stress; POINTS]>,
    /// Newton iterations.
    pub iterations: usize,
    /// Solutions with the elastic factor.
    pub solves: usize,
}

/// Reason why a load has no solution.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum PlasticError {
    /// Newton's method does not converge.
    #[error(
        "the solid finds no balance: after {iterations} iterations {left:.1e} of its forces is left over; apply the load in smaller increments, and ask whether it is more than the material can carry"
    )]
    NoBalance {
        /// Iterations done.
        iterations: usize,
        /// Residual force, as part of the forces of the elements.
        left: f64,
    },
    /// The state belongs to another mesh.
    #[error("the state has {found} elements, but the mesh has {elements}")]
    WrongState {
        /// Elements of the state.
        found: usize,
        /// Elements of the mesh.
        elements: usize,
    },
}

impl<P: Copy + Default> PlasticState<P> {
    /// Returns the state of a mesh that has never yielded.
    pub fn unloaded(elements: usize) -> Self {
        Self {
            elements: vec![[P::default(); POINTS]; elements],
        }
    }
}

/// Forces inside a solid, and the elements that soften.
struct Balance<P> {
    /// Force of the elements on each node.
    internal: Vec<Vec3>,
    /// Sum of the squares of the forces of elements on nodes.
    size2: f64,
    /// Forces on the modes of every element.
    modal: Vec<Modes>,
    responses: Vec<[Response<P>; POINTS]>,
    yielding: Vec<Yielding>,
}

struct Yielding {
    element: usize,
    stiffness: Stiffness,
    /// The elastic stiffness of its nodes less the present one.
    lost: NodalStiffness,
}

impl PlasticSolid {
    /// Returns a solid that yields by von Mises.
    pub fn new(solid: ElasticSolid, hardening: Hardening) -> Self {
        let elastic = solid.elastic();
        Self::with_material(solid, ElasticPlastic { elastic, hardening })
    }
}

impl<M: Material> PlasticSolid<M> {
    /// Returns a solid of a material with the elastic constants of `solid`.
    pub fn with_material(solid: ElasticSolid, material: M) -> Self {
        let elastic = solid.elastic();
        let elements = solid.elements().iter();
        Self {
            stiffnesses: elements
                .map(|element| element.stiffness(&elastic))
                .collect(),
            material,
            solid,
        }
    }

    /// Returns the solid as if it did not yield.
    pub fn elastic_solid(&self) -> &ElasticSolid {
        &self.solid
    }

    /// Finds the balance under all forces that act, from the state `before`; a node may come more than once.
    ///
    /// The state is not changed: a caller that accepts the load continues from the state in the solution.
    ///
    /// # Errors
    /// If no balance is found, or the state belongs to another mesh.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn solve(
        &self,
        forces: &[(u32, Vec3)],
        before: &PlasticState<M::Point>,
    ) -> Result<PlasticSolution<M::Point>, PlasticError> {
        let (found, elements) = (before.elements.len(), self.stiffnesses.len());
        if found != elements {
            return Err(PlasticError::WrongState { found, elements });
        }
        let mut external = vec![Vec3::zeros(); self.solid.mesh().nodes.len()];
        for &(node, force) in forces {
            external[node as usize] += self.solid.felt(node, force);
        }
        let (mut displacements, mut modes, size2) = self.predicted(&external, before);
        let (mut solves, mut left) = (1, f64::INFINITY);
        for iterations in 0..MAX_ITERATIONS {
            let balance = self.balance(&displacements, &modes, before);
            let residual = self.residual(&external, &balance);
            // The larger scale: without load there is no stress, but rounding of the plastic forces remains.
            let size = balance.size2.max(size2).sqrt();
            let modal2: f64 = balance.modal.iter().map(Modes::norm_squared).sum();
            left = dot(&residual, &residual).sqrt().max(modal2.sqrt()) / size;
            if size == 0.0 || left <= BALANCED {
                return Ok(solution(displacements, &balance, iterations, solves));
            }
            let (step, more) = self.newton_step(residual, &balance.yielding);
            solves += more;
            let mut yielding = balance.yielding.iter().peekable();
            for (e, hex) in self.solid.mesh().hexes.iter().enumerate() {
                let softened = yielding.next_if(|yielding| yielding.element == e);
                let stiffness = softened.map_or(&self.stiffnesses[e], |y| &y.stiffness);
                modes[e] += stiffness.modes(&moved(hex, &step), &-balance.modal[e]);
            }
            for (displacement, step) in displacements.iter_mut().zip(&step) {
                *displacement += step;
            }
        }
        Err(PlasticError::NoBalance {
            iterations: MAX_ITERATIONS,
            left,
        })
    }

    /// Returns the start of Newton's method: displacements and modes if nothing more yields, and the sum of the
    /// squares of the forces, those of plastic strains too, as a scale where no stress is left.
    fn predicted(
        &self,
        external: &[Vec3],
        before: &PlasticState<M::Point>,
    ) -> (Vec<Vec3>, Vec<Modes>, f64) {
        let elastic = self.material.elastic();
        let mut forces = external.to_vec();
        let mut size2 = dot(external, external);
        let mut pulls = Vec::with_capacity(self.stiffnesses.len());
        for (e, points) in before.elements.iter().enumerate() {
            let stresses = points.map(|point| elastic.stress(&point.eigenstrain()));
            let (nodes, pull) = self.solid.elements()[e].forces(&stresses);
            let passed_on = self.stiffnesses[e].passed_on(&pull);
            for (corner, &node) in self.solid.mesh().hexes[e].iter().enumerate() {
                forces[node as usize] += nodes[corner] - passed_on[corner];
                size2 += nodes[corner].norm_squared();
            }
            pulls.push(pull);
        }
        let displacements = self.solid.displacements_by(&forces);
        let hexes = self.solid.mesh().hexes.iter().zip(&pulls);
        let modes = hexes
            .zip(&self.stiffnesses)
            .map(|((hex, pull), stiffness)| stiffness.modes(&moved(hex, &displacements), pull));
        let modes = modes.collect();
        (displacements, modes, size2)
    }

    fn balance(
        &self,
        displacements: &[Vec3],
        modes: &[Modes],
        before: &PlasticState<M::Point>,
    ) -> Balance<M::Point> {
        let mut balance = Balance {
            internal: vec![Vec3::zeros(); displacements.len()],
            size2: 0.0,
            modal: Vec::with_capacity(modes.len()),
            responses: Vec::with_capacity(modes.len()),
            yielding: Vec::new(),
        };
        for (e, hex) in self.solid.mesh().hexes.iter().enumerate() {
            let strains = self.solid.elements()[e].strains(&moved(hex, displacements), &modes[e]);
            let points = &before.elements[e];
            let responses: [Response<M::Point>; POINTS] =
                std::array::from_fn(|p| self.material.respond(&strains[p], &points[p]));
            let (nodes, modal) = self.solid.elements()[e].forces(&responses.map(|r| r.stress));
            let yielding = self.yielding(e, &responses);
            let stiffness = yielding
                .as_ref()
                .map_or(&self.stiffnesses[e], |y| &y.stiffness);
            let passed_on = stiffness.passed_on(&modal);
            for (corner, &node) in hex.iter().enumerate() {
                balance.internal[node as usize] += nodes[corner] - passed_on[corner];
                balance.size2 += nodes[corner].norm_squared();
            }
            balance.modal.push(modal);
            balance.responses.push(responses);
            balance.yielding.extend(yielding);
        }
        balance
    }

    fn yielding(
        &self,
        element: usize,
        responses: &[Response<M::Point>; POINTS],
    ) -> Option<Yielding> {
        let softenings = responses.map(|response| response.softening);
        if softenings.iter().all(Option::is_none) {
            return None;
        }
        let elastic = self.material.elastic();
        let stiffness = self.solid.elements()[element].softened(&elastic, &softenings);
        Some(Yielding {
            element,
            lost: self.stiffnesses[element].condensed() - stiffness.condensed(),
            stiffness,
        })
    }

    fn residual(&self, external: &[Vec3], balance: &Balance<M::Point>) -> Vec<Vec3> {
        let nodes = external.iter().zip(&balance.internal).enumerate();
        nodes
            .map(|(node, (external, internal))| self.solid.felt(node as u32, external - internal))
            .collect()
    }

    /// Returns the displacements that remove the residual, and the number of solutions with the elastic factor.
    fn newton_step(&self, mut residual: Vec<Vec3>, yielding: &[Yielding]) -> (Vec<Vec3>, usize) {
        let mut direction = self.solid.displacements_by(&residual);
        if yielding.is_empty() {
            return (direction, 1);
        }
        // The elastic forces of the direction are updated with it, so that they need not be computed.
        let mut elastic_forces = residual.clone();
        let mut energy = dot(&residual, &direction);
        let enough = SOLVED * energy;
        let mut step = vec![Vec3::zeros(); residual.len()];
        for solves in 1..=MAX_GRADIENT_STEPS {
            // The forces of the direction with the tangent: the elastic ones less those that yielding elements lose.
            let mut forces = elastic_forces.clone();
            for yielding in yielding {
                let hex = &self.solid.mesh().hexes[yielding.element];
                let lost = yielding.lost * flat(&moved(hex, &direction));
                for (corner, &node) in hex.iter().enumerate() {
                    let lost = lost.fixed_rows::<3>(3 * corner).into_owned();
                    forces[node as usize] -= self.solid.felt(node, lost);
                }
            }
            let length = energy / dot(&direction, &forces);
            // Beyond the limit load the tangent is singular: the step so far is the best there is.
            if !(length > 0.0 && length.is_finite()) {
                return (step, solves);
            }
            add(&mut step, length, &direction);
            add(&mut residual, -length, &forces);
            let preconditioned = self.solid.displacements_by(&residual);
            let next = dot(&residual, &preconditioned);
            if next <= enough {
                return (step, solves + 1);
            }
            turn(&mut direction, next / energy, &preconditioned);
            turn(&mut elastic_forces, next / energy, &residual);
            energy = next;
        }
        (step, MAX_GRADIENT_STEPS + 1)
    }
}

fn solution<P: Copy>(
    displacements: Vec<Vec3>,
    balance: &Balance<P>,
    iterations: usize,
    solves: usize,
) -> PlasticSolution<P> {
    let responses = balance.responses.iter();
    PlasticSolution {
        displacements,
        state: PlasticState {
            elements: responses
                .clone()
                .map(|points| points.map(|p| p.point))
                .collect(),
        },
        stresses: responses.map(|points| points.map(|p| p.stress)).collect(),
        iterations,
        solves,
    }
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

fn add(to: &mut [Vec3], factor: f64, from: &[Vec3]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += from * factor;
    }
}

/// Replaces a direction of search by a share of itself and another one.
fn turn(direction: &mut [Vec3], keep: f64, other: &[Vec3]) {
    for (direction, other) in direction.iter_mut().zip(other) {
        *direction = *direction * keep + other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{between_planes, distorted, material, traction};

    fn block(kinematic: f64) -> PlasticSolid {
        let material = material(kinematic);
        let solid = between_planes(&distorted([3, 4, 3]), material.elastic);
        PlasticSolid::new(solid, material.hardening)
    }

    fn pull(solid: &PlasticSolid, stress: f64) -> Vec<(u32, Vec3)> {
        let mesh = solid.elastic_solid().mesh();
        traction(mesh, |p| p.y == 4.0, Vec3::new(0.0, stress, 0.0))
    }

    fn strain(solved: &PlasticSolution, solid: &PlasticSolid) -> f64 {
        let nodes = solid.elastic_solid().mesh().nodes.iter();
        let (top, _) = nodes.enumerate().find(|(_, p)| p.y == 4.0).unwrap();
        solved.displacements[top].y / 4.0
    }

    #[test]
    fn verify_uniaxial_cycle_with_bauschinger_effect() {
        // 14 MPa at yield, then 300 MPa of isotropic and 60 MPa of kinematic modulus.
        let solid = block(60.0);
        let unloaded = PlasticState::unloaded(36);
        let up = solid.solve(&pull(&solid, 18.0), &unloaded).unwrap();
        let forth = 4.0 / 360.0;
        assert!((strain(&up, &solid) - (18.0 / 571.6 + forth)).abs() < 1e-9);
        let rest = solid.solve(&[], &up.state).unwrap();
        assert!((strain(&rest, &solid) - forth).abs() < 1e-9);
        // Backwards it yields at -(14 + 300 forth - 60 forth), before the 18 MPa that it bore forwards.
        let first_yield = 14.0 + 240.0 * forth;
        let almost = solid
            .solve(&pull(&solid, -first_yield + 0.01), &rest.state)
            .unwrap();
        assert_eq!(almost.state, rest.state);
        let down = solid.solve(&pull(&solid, -18.0), &rest.state).unwrap();
        let back = (18.0 - first_yield) / 360.0;
        assert!((strain(&down, &solid) - (forth - back - 18.0 / 571.6)).abs() < 1e-9);
        let accumulated = down.state.elements[7][3].accumulated;
        assert!((accumulated - forth - back).abs() < 1e-9);
    }

    #[test]
    fn a_load_that_nothing_bears_is_an_error_and_leaves_the_state() {
        let elastic = material(0.0).elastic;
        let solid = between_planes(&distorted([3, 4, 3]), elastic);
        let solid = PlasticSolid::new(solid, Hardening::perfectly_plastic(14.0).unwrap());
        let unloaded = PlasticState::unloaded(36);
        assert!(solid.solve(&pull(&solid, 13.9), &unloaded).is_ok());
        let error = solid.solve(&pull(&solid, 14.5), &unloaded).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("more than the material can carry"),
            "{error}"
        );
        let wrong = solid.solve(&[], &PlasticState::unloaded(35)).unwrap_err();
        assert_eq!(
            wrong.to_string(),
            "the state has 35 elements, but the mesh has 36"
        );
    }

    #[test]
    fn newton_doubles_its_digits_where_some_elements_yield() {
        let material = material(0.0);
        let mesh = distorted([6, 6, 3]);
        let held = (0..49)
            .filter(|&n| mesh.nodes[n].z == 0.0)
            .map(|n| n as u32);
        let solid = ElasticSolid::new(&mesh, material.elastic, held).unwrap();
        let solid = PlasticSolid::new(solid, material.hardening);
        let pressed = |p: &Vec3| p.z == 3.0 && p.x > 1.5 && p.x < 4.5 && p.y > 1.5 && p.y < 4.5;
        let forces = traction(&mesh, pressed, Vec3::new(0.0, 0.0, -60.0));
        let solved = solid.solve(&forces, &PlasticState::unloaded(108)).unwrap();
        let yielded = solved
            .state
            .elements
            .iter()
            .flatten()
            .filter(|p| p.accumulated > 0.0)
            .count();
        assert!(yielded > 50, "{yielded}");
        assert!(
            solved.iterations <= 8,
            "{} {}",
            solved.iterations,
            solved.solves
        );
    }
}
