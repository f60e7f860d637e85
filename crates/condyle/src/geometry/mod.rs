//! Shapes, meshes, and the distance to a surface.
//!
//! In the order of the data's path:
//!
//! 1. **Input is a shape or a triangle mesh.** [`TriangleMesh`] holds the content of a file;
//!    [`condyle_mesh::repair`] checks that it is a surface, and orients it.
//!    [`CurvedMesh`] interprets its facets as samples of a curved surface.
//! 2. **The counterface becomes a surface** that gives gap, normal and curvature at any point, a
//!    [`SurfaceSample`], and bounds on the curvature around it. [`Counterface`] is one of several:
//!    [`GenericFemur`] of pieces of [`Torus`], the same rotated and shifted ([`PlacedFemur`]), a ball, a
//!    [`Cylinder`], or the [`SmoothField`] of a mesh: gaps at the nodes of a grid and a
//!    spline through them.
//! 3. **The insert becomes hexahedra**: from dimensions ([`GenericInsertShape`]), from a surface
//!    ([`Insert::from_surface`]), both in [`condyle_mesh::columns`], or read from a file.
//!    [`Insert`] holds them, worn or not, with the data that wear does not change, such as its [`SurfaceRegions`].
//!    Its [`Dishes`] are the lowest places on either side.
//! 4. **The contact uses the present surface**: [`ArticulatingSurface`], with the
//!    [`Share`] of every node.
//!
//! Bodies are cheap to clone: clones and threads share large arrays.

mod articulating_surface;
mod connectivity;
mod construct;
mod counterface;
mod cup_mesh;
mod generic_femur;
mod generic_insert;
mod insert;
mod landmarks;
mod round_bearing;
mod smooth_field;
mod surface_sample;
#[cfg(test)]
mod tests;
mod torus;

pub(crate) use connectivity::{FacesAround, NodeBlock};
pub(crate) use surface_sample::{CurvatureBounds, MAX_GAP_SLOPE};

pub use condyle_mesh::{CurvedMesh, TriangleMesh, bounds, columns::Meshing};

pub use articulating_surface::{ArticulatingSurface, Share};
pub use construct::Underside;
pub use counterface::Counterface;
pub use cup_mesh::UnrolledCup;
pub use generic_femur::{GenericFemur, GenericFemurShape, PlacedFemur};
pub use generic_insert::{GenericInsertShape, flat_insert};
pub use insert::{Insert, InsertError, SurfaceRegions};
pub use landmarks::{Dishes, FittedArc};
pub use round_bearing::{CupShape, TroughShape, cup_mounting, pin};
pub use smooth_field::SmoothField;
pub use surface_sample::{Curvature, SurfaceSample};
pub use torus::{Cylinder, Torus};
