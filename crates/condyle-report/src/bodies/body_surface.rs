//! A surface that is drawn.

use condyle_fem::Vec3;

/// A surface for a picture, in the insert frame: x anterior, y superior, z to the right, mm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodySurface {
    /// Positions of the vertices, mm.
    pub vertices: Vec<Vec3>,
    /// Numbers of the vertices of each triangle, facing either way.
    pub triangles: Vec<[u32; 3]>,
}
