//! An open surface of triangles, asked for the place that belongs to a point.

use condyle::Vec3;
use condyle::geometry::{CurvedMesh, TriangleMesh};
use condyle_report::SurfaceFields;
use rstar::{AABB, PointDistance, RTree, RTreeObject};

/// Shares of a triangle smaller than this are none: the place is on its opposite edge.
const ON_EDGE: f64 = 1e-9;

/// A surface with a search tree over its triangles.
pub(super) struct Sheet<'a> {
    mesh: &'a TriangleMesh,
    curved: CurvedMesh<'a>,
    tree: RTree<Facet>,
    is_border: Vec<bool>,
}

/// The place of a surface that belongs to a point.
pub(super) struct Foot {
    /// Corners of the triangle.
    pub corners: [u32; 3],
    /// Share of each corner, adding to 1.
    pub weights: [f64; 3],
    /// Position on the curved surface, mm.
    pub point: Vec3,
    /// Outward unit normal there.
    pub normal: Vec3,
    /// Distance of the point above the surface, negative below it, mm.
    pub height_mm: f64,
    /// Whether the place is on the border, so that the point may lie beyond it.
    pub on_border: bool,
}

impl Foot {
    /// A field at the place, from its values at the nodes.
    pub fn value(&self, field: &[f64]) -> f64 {
        let at = |i: usize| self.weights[i] * field[self.corners[i] as usize];
        at(0) + at(1) + at(2)
    }
}

/// A flat triangle of the tree.
struct Facet {
    number: usize,
    corners: [Vec3; 3],
}

impl RTreeObject for Facet {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        let corners = self.corners.map(<[f64; 3]>::from);
        AABB::from_points(corners.iter())
    }
}

impl PointDistance for Facet {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        CurvedMesh::distance2_to_triangle(&self.corners, &Vec3::from(*point))
    }
}

impl<'a> Sheet<'a> {
    pub fn new(mesh: &'a TriangleMesh) -> Self {
        let facet = |number: usize| Facet {
            number,
            corners: mesh.corners(number),
        };
        Self {
            mesh,
            curved: CurvedMesh::new(mesh),
            tree: RTree::bulk_load((0..mesh.triangles.len()).map(facet).collect()),
            is_border: borders(mesh),
        }
    }

    /// The place that belongs to a point; none for a surface without triangles.
    pub fn foot(&self, point: &Vec3) -> Option<Foot> {
        let nearest = self.tree.nearest_neighbor([point.x, point.y, point.z])?;
        let corners = self.mesh.triangles[nearest.number];
        let foot = self.curved.foot(nearest.number, point);
        let held_by_border =
            |i: usize| foot.weights[i] < ON_EDGE || self.is_border[corners[i] as usize];
        Some(Foot {
            corners,
            weights: foot.weights,
            point: foot.point,
            normal: foot.normal,
            height_mm: (point - foot.point).dot(&foot.normal),
            on_border: (0..3).all(held_by_border),
        })
    }

    /// Whether a node is on the border.
    pub fn is_border(&self, node: usize) -> bool {
        self.is_border[node]
    }
}

/// The triangles of a surface of quads.
pub(super) fn triangulated(surface: &SurfaceFields) -> TriangleMesh {
    TriangleMesh::of_quads(surface.nodes.clone(), surface.quads.iter().copied())
}

/// Which nodes have an edge of a single triangle.
fn borders(mesh: &TriangleMesh) -> Vec<bool> {
    let edge = |a: u32, b: u32| (a.min(b), a.max(b));
    let edges = |&[a, b, c]: &[u32; 3]| [edge(a, b), edge(b, c), edge(c, a)];
    let mut all: Vec<_> = mesh.triangles.iter().flat_map(edges).collect();
    all.sort_unstable();
    let mut is_border = vec![false; mesh.vertices.len()];
    for same in all.chunk_by(|one, other| one == other) {
        if let &[(a, b)] = same {
            is_border[a as usize] = true;
            is_border[b as usize] = true;
        }
    }
    is_border
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A piece of a ball of radius 30 mm about the origin, as quads of about 1.5 mm.
    fn dome() -> SurfaceFields {
        const ACROSS: u32 = 13;
        let at = |i: u32| 0.05 * (f64::from(i) - 6.0);
        let node = |i: u32, j: u32| 30.0 * Vec3::new(at(i), 1.0, at(j)).normalize();
        let nodes = (0..ACROSS)
            .flat_map(|i| (0..ACROSS).map(move |j| node(i, j)))
            .collect();
        let number = |i: u32, j: u32| i * ACROSS + j;
        let quad = |i, j| {
            [
                number(i, j),
                number(i, j + 1),
                number(i + 1, j + 1),
                number(i + 1, j),
            ]
        };
        let quads = (0..ACROSS - 1)
            .flat_map(|i| (0..ACROSS - 1).map(move |j| quad(i, j)))
            .collect();
        SurfaceFields {
            nodes,
            quads,
            fields: Vec::new(),
        }
    }

    #[test]
    fn verify_heights_over_a_ball_are_those_over_the_ball_and_not_over_its_facets() {
        let mesh = triangulated(&dome());
        let sheet = Sheet::new(&mesh);
        for (x, z, height) in [(0.7, 0.6, 0.3), (-2.1, 3.3, -0.2), (4.05, 1.1, 0.0)] {
            let point = (30.0 + height) * Vec3::new(x, 30.0, z).normalize();
            let foot = sheet.foot(&point).unwrap();
            // The facets lie up to 0.02 mm inside the ball.
            assert!((foot.height_mm - height).abs() < 5e-4, "{}", foot.height_mm);
            assert!(!foot.on_border && foot.normal.dot(&point.normalize()) > 0.999_99);
        }
    }

    #[test]
    fn a_point_beyond_the_rim_is_known_by_its_foot_on_the_border() {
        let mesh = triangulated(&dome());
        let sheet = Sheet::new(&mesh);
        let beyond = 30.0 * Vec3::new(0.5, 1.0, 0.0).normalize();
        assert!(sheet.foot(&beyond).unwrap().on_border);
        assert!(sheet.is_border(0) && !sheet.is_border(6 * 13 + 6));
    }

    #[test]
    fn a_field_is_linear_over_a_triangle() {
        let surface = dome();
        let heights: Vec<f64> = surface.nodes.iter().map(|node| node.y).collect();
        let mesh = triangulated(&surface);
        let foot = Sheet::new(&mesh).foot(&surface.nodes[40]).unwrap();
        assert!((foot.value(&heights) - heights[40]).abs() < 1e-9);
    }
}
