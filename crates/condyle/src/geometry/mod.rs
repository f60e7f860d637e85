//! Shapes, meshes, and the distance to a surface.
//!
//! In the order of the data's path:
//!
//! 1. **A shape or a triangle mesh comes in.** [`TriangleMesh`] is what a file holds;
//!    [`condyle_mesh::repair`] checks that it is a surface, and turns it the right way.
//!    [`CurvedMesh`] reads its facets as samples of a curved surface.
//! 2. **The femur becomes a surface** that gives gap, normal and curvature at any point, a
//!    [`SurfaceSample`], and [`CurvatureBounds`] around it. [`FemoralSurface`] is one of several:
//!    [`GenericFemur`] of pieces of [`Torus`], the same turned ([`PlacedFemur`]), one ball, one
//!    [`Cylinder`], or the [`SmoothField`] of a mesh, which is gaps at the nodes of a grid and a
//!    spline through them.
//! 3. **The insert becomes hexahedra**: of measures ([`GenericInsertShape`]), of a surface
//!    ([`Insert::from_surface`]), both in [`condyle_mesh::columns`], or read from a file.
//!    [`Insert`] holds them, worn or not, with what does not wear: [`SurfaceRegions`],
//!    [`FacesAround`] its nodes, and the nodes in [`NodeBlock`]s. Its [`Dishes`] say where it is
//!    lowest on either side.
//! 4. **The contact asks for the surface as it is now**: [`ArticulatingSurface`], with the
//!    [`Share`] of it that each node stands for.
//!
//! Bodies are cheap to clone, and what is large is shared between clones and threads.

mod articulating_surface;
mod construct;
mod curvature_bounds;
mod cylinder;
mod dishes;
mod faces_around;
mod femoral_surface;
mod generic_femur;
mod generic_insert;
mod insert;
mod node_blocks;
mod placed_femur;
mod posterior_arc;
mod share;
mod smooth_field;
mod surface_regions;
mod surface_sample;
mod torus;

pub use condyle_mesh::{CurvedMesh, TriangleMesh, bounds, columns::Meshing};

pub use articulating_surface::ArticulatingSurface;
pub use construct::Underside;
pub use curvature_bounds::{CurvatureBounds, MAX_GAP_SLOPE};
pub use cylinder::Cylinder;
pub use dishes::Dishes;
pub use faces_around::FacesAround;
pub use femoral_surface::FemoralSurface;
pub use generic_femur::{GenericFemur, GenericFemurShape};
pub use generic_insert::{GenericInsertShape, flat_insert};
pub use insert::{Insert, error::InsertError};
pub use node_blocks::NodeBlock;
pub use placed_femur::PlacedFemur;
pub use posterior_arc::posterior_arc_centre_mm;
pub use share::Share;
pub use smooth_field::SmoothField;
pub use surface_regions::SurfaceRegions;
pub use surface_sample::{Curvature, SurfaceSample};
pub use torus::Torus;
