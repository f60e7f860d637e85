//! An elastic solid with supports: displacements under forces.

use thiserror::Error;

use crate::{
    Vec3,
    elastic::{Elastic, ElasticError},
    element::{Element, ElementMean},
    mesh::HexMesh,
    sparse::{Dissection, Factor, Rhs},
};

/// A mesh of an elastic material, held at some nodes, with its stiffness factorised.
///
/// Displacements are small: they are proportional to forces, and loads act on the undeformed mesh.
pub struct ElasticSolid {
    mesh: HexMesh,
    elastic: Elastic,
    /// Axes along which each node cannot move.
    held: Vec<[bool; 3]>,
    means: Vec<ElementMean>,
    pub(crate) factor: Factor,
}

/// A solid that cannot be solved.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SolidError {
    /// The elastic constants are impossible.
    #[error(transparent)]
    Elastic(#[from] ElasticError),
    /// An element or a support names a node that the mesh does not have.
    #[error("{item} names node {node}, but the mesh has {nodes} nodes, numbered from 0")]
    NoSuchNode {
        item: String,
        node: u32,
        nodes: usize,
    },
    /// An element is flat or folded over.
    #[error("element {element} around ({:.4}, {:.4}, {:.4}) is flat or inverted; order its corners as in VTK, and make its volume positive everywhere", place.x, place.y, place.z)]
    Inverted { element: usize, place: Vec3 },
    /// No node is held.
    #[error("nothing holds the solid: hold some nodes, such as its backside")]
    NotHeld,
    /// A part moves as a rigid body.
    #[error("a part of the solid can move without force, as around node {node} at ({:.4}, {:.4}, {:.4}): hold three of its nodes that are not in a line, or join it to what is held", place.x, place.y, place.z)]
    Loose { node: u32, place: Vec3 },
}

impl ElasticSolid {
    /// Returns a solid whose nodes `held` cannot move in any direction, as on a bonded backside.
    ///
    /// Nodes of no element count as held.
    ///
    /// # Errors
    /// [`SolidError`]: impossible elastic constants, an element that is flat, inverted or names a missing node, or a part
    /// that is not held.
    pub fn new(
        mesh: &HexMesh,
        elastic: Elastic,
        held: impl IntoIterator<Item = u32>,
    ) -> Result<Self, SolidError> {
        let held = held.into_iter().map(|node| (node, [true; 3]));
        Self::with_supports(mesh, elastic, held)
    }

    /// Returns a solid whose nodes cannot move along some axes, as on a plane of symmetry; a node that occurs more
    /// than once is held along all of its axes.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_supports(
        mesh: &HexMesh,
        elastic: Elastic,
        supports: impl IntoIterator<Item = (u32, [bool; 3])>,
    ) -> Result<Self, SolidError> {
        let elastic = elastic.checked()?;
        let held = checked_supports(mesh, supports)?;
        let mean = |element: usize| {
            let corners = mesh.corners(element);
            let checked = Element::new(&corners).ok_or_else(|| SolidError::Inverted {
                element,
                place: corners.iter().sum::<Vec3>() / 8.0,
            });
            checked.map(|element| ElementMean {
                gradients: element.mean_gradients(),
                elastic,
            })
        };
        let means = (0..mesh.hexes.len()).map(mean).collect::<Result<_, _>>()?;
        let dissection = Dissection::new(mesh, &held);
        let stiffness = |element| element_of(mesh, element).stiffness(&elastic).condensed();
        let factor = Factor::new(&mesh.hexes, &held, dissection, stiffness);
        let factor = factor.map_err(|node| SolidError::Loose {
            node,
            place: mesh.nodes[node as usize],
        })?;
        Ok(Self {
            mesh: mesh.clone(),
            elastic,
            held,
            means,
            factor,
        })
    }

    /// Returns the mesh as it was factorised.
    pub fn mesh(&self) -> &HexMesh {
        &self.mesh
    }

    /// Returns the elastic constants.
    pub fn elastic(&self) -> Elastic {
        self.elastic
    }

    /// Returns the bytes of the factor, which takes most of the memory.
    pub fn bytes(&self) -> usize {
        size_of::<f64>() * self.factor.len()
    }

    /// Returns the displacement of all nodes under forces on nodes; a node may come more than once.
    ///
    /// The support carries a force along a held direction.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn displacements(&self, forces: &[(u32, Vec3)]) -> Vec<Vec3> {
        let mut all = vec![Vec3::zeros(); self.mesh.nodes.len()];
        for &(node, force) in forces {
            all[node as usize] += force;
        }
        self.displacements_by(&all)
    }

    /// Returns the displacement of all nodes under a force on every node.
    pub(crate) fn displacements_by(&self, forces: &[Vec3]) -> Vec<Vec3> {
        let order = &self.factor.dissection.order;
        let mut x = Rhs::<1>::new(self.factor.freedoms());
        let mut loaded = Vec::new();
        for (place, &node) in order.iter().enumerate() {
            let force = self.felt(node, forces[node as usize]);
            if force != Vec3::zeros() {
                loaded.push(place as u32);
            }
            for (i, force) in force.iter().enumerate() {
                *x.at_mut(3 * place + i, 0) = *force;
            }
        }
        let loaded = self.factor.paths(loaded.into_iter());
        let x_only = std::slice::from_mut(&mut x);
        self.factor.forward_some(x_only, &[loaded]);
        self.factor.backward_all(x_only);
        let mut displacements = vec![Vec3::zeros(); forces.len()];
        for (place, &node) in order.iter().enumerate() {
            displacements[node as usize] = Vec3::from_fn(|i, _| x.at(3 * place + i, 0));
        }
        displacements
    }

    /// Returns the part of a force on a node that its support does not carry.
    pub(crate) fn felt(&self, node: u32, force: Vec3) -> Vec3 {
        let held = self.held[node as usize];
        Vec3::from_fn(|i, _| if held[i] { 0.0 } else { force[i] })
    }

    /// Returns the operator from displacements to the mean stress of an element.
    ///
    /// # Panics
    /// If there is no such element.
    pub fn element_mean(&self, element: usize) -> &ElementMean {
        &self.means[element]
    }

    pub(crate) fn element(&self, element: usize) -> Element {
        element_of(&self.mesh, element)
    }
}

/// Returns an element of a mesh that was checked.
///
/// It is computed whenever it is needed: an element has four kilobytes, more than the factor for each.
fn element_of(mesh: &HexMesh, element: usize) -> Element {
    Element::new(&mesh.corners(element)).expect("a checked element is not inverted")
}

pub(crate) fn moved(hex: &[u32; 8], displacements: &[Vec3]) -> [Vec3; 8] {
    hex.map(|node| displacements[node as usize])
}

/// Returns the axes along which each node is held, if all nodes exist and some node is held.
fn checked_supports(
    mesh: &HexMesh,
    supports: impl IntoIterator<Item = (u32, [bool; 3])>,
) -> Result<Vec<[bool; 3]>, SolidError> {
    let nodes = mesh.nodes.len();
    for (element, hex) in mesh.hexes.iter().enumerate() {
        if let Some(&node) = hex.iter().find(|&&node| node as usize >= nodes) {
            let item = format!("element {element}");
            return Err(SolidError::NoSuchNode { item, node, nodes });
        }
    }
    let mut held = vec![[false; 3]; nodes];
    for (node, axes) in supports {
        let held = held.get_mut(node as usize).ok_or_else(|| {
            let item = "a support".to_owned();
            SolidError::NoSuchNode { item, node, nodes }
        })?;
        for (held, axis) in held.iter_mut().zip(axes) {
            *held |= axis;
        }
    }
    if held.iter().flatten().any(|is_held| *is_held) {
        Ok(held)
    } else {
        Err(SolidError::NotHeld)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::flat;
    use crate::tests::{between_planes, block, distorted, nodes_where, standing, traction};

    #[test]
    fn verify_tension_of_a_distorted_block() {
        for v in [0.0, 0.3, 0.46, 0.49] {
            let mesh = distorted([3, 4, 3]);
            let solid = between_planes(&mesh, Elastic::new(463.0, v).unwrap());
            let forces = traction(&mesh, |p| p.y == 4.0, Vec3::new(0.0, 20.0, 0.0));
            let displacements = solid.displacements(&forces);
            let strain = 20.0 / 463.0;
            for (node, u) in mesh.nodes.iter().zip(&displacements) {
                let exact = Vec3::new(-v * node.x, node.y, -v * node.z) * strain;
                assert!((u - exact).norm() < 1e-12, "{u} {exact}");
            }
            for stress in solid.stresses(&displacements, &Default::default()) {
                assert!((stress.0[1] - 20.0).abs() < 1e-10 && stress.0[0].abs() < 1e-10);
            }
        }
    }

    #[test]
    fn verify_beam_of_one_element_through_the_depth() {
        // A cantilever ten times as long as deep, as wide as deep, under a force at its end: Timoshenko's
        // F L^3/(3 E I) + 6 F L/(5 G A).
        let mut mesh = block([10, 1, 1]);
        for v in [0.0, 0.3] {
            for node in &mut mesh.nodes {
                node.x = node.x.clamp(0.0, 10.0);
            }
            let elastic = Elastic::new(1000.0, v).unwrap();
            let supports = nodes_where(&mesh, |p| p.x == 0.0).into_iter().map(|n| {
                let at = mesh.nodes[n as usize];
                (n, [true, at.y == 0.0, at.z == 0.0])
            });
            let solid =
                ElasticSolid::with_supports(&mesh, elastic, supports.collect::<Vec<_>>()).unwrap();
            let forces = traction(&mesh, |p| p.x == 10.0, Vec3::new(0.0, 0.0, 1.0));
            let tip = nodes_where(&mesh, |p| p.x == 10.0)[0];
            let sag = solid.displacements(&forces)[tip as usize].z;
            let shear_area = 5.0 / 6.0 * elastic.shear_modulus();
            let exact = 1000.0 / (3.0 * 1000.0 / 12.0) + 10.0 / shear_area;
            assert!((sag / exact - 1.0).abs() < 0.01, "{v}: {sag} {exact}");
        }
    }

    #[test]
    fn what_cannot_be_solved_is_named() {
        let mesh = block([2, 2, 2]);
        let elastic = Elastic::new(463.0, 0.46).unwrap();
        let error = |mesh: &HexMesh, held: &[u32]| {
            let solid = ElasticSolid::new(mesh, elastic, held.iter().copied());
            solid.err().expect("an error").to_string()
        };
        assert!(error(&mesh, &[]).starts_with("nothing holds the solid"));
        assert!(error(&mesh, &[0, 99]).contains("node 99"));
        // A solid that turns about two nodes.
        assert!(error(&mesh, &[0, 1]).contains("can move without force"));
        let mut flat = mesh.clone();
        flat.nodes[26] = Vec3::new(1.2, 1.2, 1.2);
        flat.nodes[13] = Vec3::new(1.8, 1.8, 1.8);
        assert!(error(&flat, &[0, 1, 3]).contains("is flat or inverted"));
        let cut = HexMesh {
            nodes: mesh.nodes[..20].to_vec(),
            hexes: mesh.hexes.clone(),
        };
        assert!(error(&cut, &[0, 1, 3]).contains("names node"));
        let apart = two_blocks();
        assert!(error(&apart, &[0, 1, 3]).contains("join it to what is held"));
        let none = Elastic {
            youngs_modulus: 1.0,
            poissons_ratio: 0.5,
        };
        let solid = ElasticSolid::new(&mesh, none, [0, 1, 3]);
        assert!(
            solid
                .err()
                .expect("an error")
                .to_string()
                .contains("incompressible")
        );
    }

    fn two_blocks() -> HexMesh {
        let mesh = block([1, 1, 1]);
        let far = mesh.nodes.iter().map(|p| p + Vec3::repeat(5.0));
        let nodes: Vec<Vec3> = mesh.nodes.iter().copied().chain(far).collect();
        let hexes = [mesh.hexes[0], mesh.hexes[0].map(|n| n + 8)];
        HexMesh {
            nodes,
            hexes: hexes.into(),
        }
    }

    #[test]
    fn every_motion_of_a_solid_needs_its_force() {
        // Forces by stiffness times displacements, against those that were given.
        let solid = standing([5, 4, 3]);
        let (mesh, elastic) = (solid.mesh(), solid.elastic());
        let held = nodes_where(mesh, |p| p.z == 0.0);
        let given: Vec<(u32, Vec3)> = (0..mesh.nodes.len() as u32)
            .map(|n| (n, Vec3::new(f64::from(n).sin(), f64::from(n).cos(), 0.3)))
            .collect();
        let displacements = solid.displacements(&given);
        let mut forces = vec![Vec3::zeros(); mesh.nodes.len()];
        for (number, hex) in mesh.hexes.iter().enumerate() {
            let stiffness = solid.element(number).stiffness(&elastic).condensed();
            let f = stiffness * flat(&moved(hex, &displacements));
            for (corner, &node) in hex.iter().enumerate() {
                forces[node as usize] +=
                    Vec3::new(f[3 * corner], f[3 * corner + 1], f[3 * corner + 2]);
            }
        }
        for (node, given) in given {
            if !held.contains(&node) {
                assert!((forces[node as usize] - given).norm() < 1e-10);
            }
        }
    }
}
