//! Hexahedral meshes and finite elements, independent of knees.
//!
//! Lengths are in the unit of the mesh, and forces and moduli in consistent units; condyle uses millimetre, newton
//! and MPa.
//!
//! A block of polyethylene that is held below, under a force on a node of its top:
//!
//! ```
//! use condyle_fem::{Elastic, ElasticSolid, HexMesh, Vec3};
//!
//! let corners = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]];
//! let layer = |z: f64| corners.map(|[x, y]| Vec3::new(x, y, z));
//! let mesh = HexMesh {
//!     nodes: [layer(0.0), layer(1.0)].concat(),
//!     hexes: vec![[0, 1, 2, 3, 4, 5, 6, 7]].into(),
//! };
//! let polyethylene = Elastic::new(463.0, 0.46)?;
//! let solid = ElasticSolid::new(&mesh, polyethylene, 0..4)?;
//!
//! let down = Vec3::new(0.0, 0.0, -1.0);
//! let displacements = solid.displacements(&[(6, down * 10.0)]);
//! assert!(displacements[6].z < 0.0 && displacements[0].norm() == 0.0);
//!
//! // The same along the forces on two nodes, computed once for all loads.
//! let forces = solid.half_solved(&[(6, down), (7, down)]);
//! let compliance = forces.moved_along(&forces);
//! assert!((compliance[0] * 10.0 - displacements[6].dot(&down)).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod compliance;
mod eigenstrain;
mod elastic;
mod element;
mod mesh;
mod plastic;
mod solid;
mod sparse;
mod support;
#[cfg(test)]
mod tests;

pub use compliance::HalfSolved;
pub use eigenstrain::YieldingElement;
pub use elastic::{Elastic, ElasticError, Strain, Stress};
pub use element::ElementMean;
pub use mesh::{HEX_EDGES, HEX_FACES, HexMesh, numbered, trilinear_volume, volume_below};
pub use plastic::{
    ElasticPlastic, Hardening, HardeningError, Material, MaterialPoint, PlasticPoint,
};
pub use solid::{ElasticSolid, SolidError};
pub use support::MovedSupports;

/// A point or a vector in space.
pub type Vec3 = nalgebra::Vector3<f64>;
