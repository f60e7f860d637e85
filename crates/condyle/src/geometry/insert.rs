//! The insert: a hexahedral mesh, its articulating surface, and how it wears away.

mod unworn;

use std::{fmt, sync::Arc};

use condyle_fem::{HexMesh, volume_below};
use condyle_mesh::{
    TriangleMesh,
    columns::{ColumnError, Hole, Meshing, column_mesh},
};

pub use self::unworn::InsertError;
use self::unworn::UnwornInsert;
use super::{
    articulating_surface::ArticulatingSurface,
    connectivity::{FacesAround, NodeBlock},
};
use crate::Vec3;

/// A side wall that leans more than 60 degrees from the normal at its rim does not guide the rim.
const MIN_COSINE_OF_WALL: f64 = 0.5;

/// The bearing, unworn or worn: an insert, a cup, a pin.
///
/// Clones share the data that wear does not change; a clone copies the positions of the nodes, and two
/// numbers per surface node.
#[derive(Clone)]
pub struct Insert {
    unworn: Arc<UnwornInsert>,
    regions: Arc<SurfaceRegions>,
    mesh: HexMesh,
    /// Depth worn so far. The thickness is always computed from it, so that an insert worn step by
    /// step and a restored one agree to the last bit.
    worn_mm: Vec<f64>,
    thickness_mm: Vec<f64>,
}

impl fmt::Debug for Insert {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Insert")
            .field("hexahedra", &self.mesh.hexes.len())
            .field("surface_nodes", &self.worn_mm.len())
            .finish_non_exhaustive()
    }
}

impl Insert {
    /// Creates an insert from its mesh, the outward quads of its articulating surface, and those of its backside; its
    /// regions are its medial and its lateral side.
    ///
    /// The hexahedra are to stand in columns below the articulating surface: nodes outside of columns stay in place as it wears.
    ///
    /// # Errors
    /// An empty mesh or surface, an inverted element, a quad of the articulating surface that does not face out of the mesh, or a node
    /// without thickness below it.
    pub fn new(
        mesh: HexMesh,
        articulating: &[[u32; 4]],
        backside: &[[u32; 4]],
    ) -> Result<Self, InsertError> {
        let unworn = UnwornInsert::new(&mesh, articulating, backside)?;
        let regions = SurfaceRegions::medial_and_lateral(unworn.surface_positions());
        Ok(Self {
            worn_mm: vec![0.0; unworn.thickness_mm.len()],
            thickness_mm: unworn.thickness_mm.clone(),
            regions: Arc::new(regions),
            unworn: Arc::new(unworn),
            mesh,
        })
    }

    /// Returns the insert between the top and the bottom of a closed surface, or `thickness_mm` deep below an open one,
    /// in columns of hexahedra; see [`column_mesh`].
    ///
    /// # Errors
    /// The errors of [`column_mesh`] and [`Insert::new`], and a hole inside the outline.
    pub fn from_surface(
        surface: &TriangleMesh,
        is_closed: bool,
        thickness_mm: Option<f64>,
        meshing: Meshing,
    ) -> Result<Self, InsertError> {
        match Self::over_holes(surface, is_closed, thickness_mm, meshing)? {
            (insert, holes) if holes.is_empty() => Ok(insert),
            (_, holes) => Err(ColumnError::Holes { holes }.into()),
        }
    }

    /// As [`Insert::from_surface`], but meshes over holes inside the outline as if the surface around
    /// them continued smoothly, and returns these holes.
    ///
    /// # Errors
    /// As [`Insert::from_surface`], except for holes.
    pub fn over_holes(
        surface: &TriangleMesh,
        is_closed: bool,
        thickness_mm: Option<f64>,
        meshing: Meshing,
    ) -> Result<(Self, Vec<Hole>), InsertError> {
        let (columns, holes) = column_mesh(surface, is_closed, thickness_mm, meshing)?;
        let insert = Self::new(columns.mesh, &columns.articulating, &columns.backside)?;
        let insert = insert.compared_with_mesh(columns.mesh_error_mm, columns.void_mm);
        Ok((insert, holes))
    }

    /// Replaces the regions of the articulating surface by a single one, for a bearing without sides.
    pub fn with_one_region(self, name: &str) -> Self {
        let regions =
            SurfaceRegions::split(&[name], self.mesh.positions(self.surface_nodes()), |_| 0);
        Self {
            regions: Arc::new(regions),
            ..self
        }
    }

    /// Returns the regions of the articulating surface.
    pub fn regions(&self) -> &SurfaceRegions {
        &self.regions
    }

    /// Returns the hexahedral mesh.
    pub fn mesh(&self) -> &HexMesh {
        &self.mesh
    }

    /// Returns the present volume of the mesh, mm3, as enclosed by its boundary.
    pub fn volume_mm3(&self) -> f64 {
        // An origin near the mesh keeps the cones small, so that few digits cancel.
        let origin = self.mesh.nodes[self.unworn.boundary[0][0] as usize];
        let corners = |quad: &[u32; 4]| quad.map(|node| self.mesh.nodes[node as usize] - origin);
        let quads = self.unworn.boundary.iter();
        quads.map(|quad| volume_below(&corners(quad))).sum()
    }

    /// Returns the mesh nodes of the articulating surface, ascending: the order of arrays over surface nodes.
    pub fn surface_nodes(&self) -> &[u32] {
        &self.unworn.surface_nodes
    }

    /// Returns the mesh nodes of the backside, ascending.
    pub fn backside_nodes(&self) -> &[u32] {
        &self.unworn.backside_nodes
    }

    /// Returns the positions of all mesh nodes before any wear, mm.
    pub fn unworn_nodes(&self) -> &[Vec3] {
        &self.unworn.nodes
    }

    /// Returns the outward faces of the articulating surface, in numbers of surface nodes.
    pub fn surface_faces(&self) -> &[[u32; 4]] {
        &self.unworn.faces
    }

    pub(crate) fn faces_around(&self) -> &FacesAround {
        &self.unworn.faces_around
    }

    /// Returns the surface nodes in blocks of neighbours, each node once.
    pub(crate) fn node_blocks(&self) -> &[NodeBlock] {
        &self.unworn.node_blocks
    }

    /// Returns the area of a surface node's share before any wear, mm2.
    pub(crate) fn unworn_share_mm2(&self, node: usize) -> f64 {
        self.unworn.share_mm2[node]
    }

    /// Returns the thickness below each surface node along its normal, mm.
    pub fn thickness_mm(&self) -> &[f64] {
        &self.thickness_mm
    }

    /// Returns the error that the triangles of a mesh leave in the unworn surface at each surface node, mm; empty for a shape
    /// without triangles.
    pub fn mesh_error_mm(&self) -> &[f64] {
        &self.unworn.mesh_error_mm
    }

    /// Returns the height of the voids of a mesh below each surface node that the hexahedra fill, mm; empty for a shape without
    /// triangles.
    pub fn void_mm(&self) -> &[f64] {
        &self.unworn.void_mm
    }

    /// Returns the articulating surface in its present shape.
    pub fn surface(&self) -> ArticulatingSurface {
        self.surface_at(&self.mesh.nodes)
    }

    /// Returns the articulating surface with the mesh nodes at other positions, mm.
    pub(crate) fn surface_at(&self, mesh_nodes: &[Vec3]) -> ArticulatingSurface {
        let nodes = self.surface_nodes().iter();
        let positions = nodes.map(|&node| mesh_nodes[node as usize]).collect();
        ArticulatingSurface::new(positions, &self.unworn.faces_around)
    }

    /// Sets the error that the triangles of a mesh leave at every surface node, and the voids below, mm.
    pub(super) fn compared_with_mesh(mut self, error_mm: Vec<f64>, void_mm: Vec<f64>) -> Self {
        let unworn = Arc::get_mut(&mut self.unworn).expect("a new insert shares nothing");
        (unworn.mesh_error_mm, unworn.void_mm) = (error_mm, void_mm);
        self
    }

    /// Sets the thickness below every surface node, for a shape whose columns give it: at a rim, where the normal misses the
    /// backside, it cannot be measured.
    pub(super) fn with_thickness_mm(mut self, thickness_mm: Vec<f64>) -> Self {
        let unworn = Arc::get_mut(&mut self.unworn).expect("a new insert shares nothing");
        unworn.thickness_mm.clone_from(&thickness_mm);
        self.thickness_mm = thickness_mm;
        self
    }

    /// Moves every surface node inwards along its normal, or along its wall at the rim, and the mesh
    /// below with it.
    ///
    /// The nodes of a column move in proportion to their height, so that its hexahedra thin by the same ratio and do
    /// not invert before it is worn through.
    ///
    /// `depth_mm`: one per surface node, 0 or more. The thickness shrinks by as much.
    pub fn wear_down(&mut self, surface: &ArticulatingSurface, depth_mm: &[f64]) {
        let mut displacement = Vec::with_capacity(depth_mm.len());
        for (i, &node) in self.unworn.surface_nodes.iter().enumerate() {
            displacement.push(-self.outwards(i, &surface.normals[i]) * depth_mm[i]);
            self.mesh.nodes[node as usize] += displacement[i];
            self.worn_mm[i] += depth_mm[i];
        }
        for follower in &self.unworn.followers {
            let above = displacement[follower.surface_node as usize];
            self.mesh.nodes[follower.node as usize] += above * follower.part;
        }
        self.find_thickness();
    }

    /// Returns the displacement of a surface node for which the surface around it rises by a unit.
    ///
    /// The rim moves along the side wall below it: if it left the plane of the wall, the volume would change by another amount
    /// than depth times area.
    fn outwards(&self, node: usize, normal: &Vec3) -> Vec3 {
        let wall = self.unworn.walls[node].filter(|wall| wall.dot(normal) > MIN_COSINE_OF_WALL);
        wall.map_or(*normal, |wall| wall / wall.dot(normal))
    }

    /// Restores a stored state: all mesh nodes, and the depth worn so far at each surface node.
    pub fn restore(&mut self, mesh_nodes: Vec<Vec3>, worn_mm: &[f64]) {
        self.mesh.nodes = mesh_nodes;
        self.worn_mm.copy_from_slice(worn_mm);
        self.find_thickness();
    }

    fn find_thickness(&mut self) {
        let unworn_mm = self.unworn.thickness_mm.iter();
        for ((left, unworn), worn) in self
            .thickness_mm
            .iter_mut()
            .zip(unworn_mm)
            .zip(&self.worn_mm)
        {
            *left = unworn - worn;
        }
    }

    /// Returns the lowest point of the dishes, mm: the lowest surface node without a lower neighbour,
    /// the rim excluded.
    pub fn dish_low_point_mm(&self) -> Vec3 {
        let nodes: Vec<Vec3> = self.mesh.positions(self.surface_nodes()).collect();
        let is_bottom = |i: usize| {
            let faces = self.faces_around().of(i);
            let mut corners = faces.iter().flatten();
            faces.len() == 4 && corners.all(|&other| nodes[i].y <= nodes[other as usize].y)
        };
        let lower = |a: Vec3, b: Vec3| if b.y < a.y { b } else { a };
        let bottoms = (0..nodes.len()).filter(|&i| is_bottom(i));
        let lowest = bottoms.map(|i| nodes[i]).reduce(lower);
        let lowest = lowest.or_else(|| nodes.iter().copied().reduce(lower));
        lowest.unwrap_or_default()
    }
}

/// Named regions of the articulating surface, and the region of each surface node.
///
/// They are fixed when an insert is made: a worn node stays in its region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfaceRegions {
    names: Vec<String>,
    numbers: Vec<u8>,
}

impl SurfaceRegions {
    /// Regions called `names`; `region_of` gives the number of a node's region from its position in
    /// the insert frame, mm.
    ///
    /// # Panics
    /// If there is no name or more than 256, or a number has no name.
    pub fn split(
        names: &[&str],
        positions: impl IntoIterator<Item = Vec3>,
        region_of: impl Fn(&Vec3) -> usize,
    ) -> Self {
        assert!(
            (1..=256).contains(&names.len()),
            "a surface has 1 to 256 regions, not {}",
            names.len()
        );
        let number = |position: Vec3| {
            let region = region_of(&position);
            assert!(region < names.len(), "region {region} has no name");
            region as u8
        };
        Self {
            names: names.iter().copied().map(str::to_owned).collect(),
            numbers: positions.into_iter().map(number).collect(),
        }
    }

    /// Creates the regions of the two sides of a right joint, split at z = 0: 0 is medial, where z < 0, and 1 is
    /// lateral.
    pub(crate) fn medial_and_lateral(positions: impl IntoIterator<Item = Vec3>) -> Self {
        Self::split(&["medial", "lateral"], positions, |position| {
            usize::from(position.z >= 0.0)
        })
    }

    /// Returns the number of regions.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// Returns the names, in the order of the numbers.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the number of a surface node's region.
    pub fn of_node(&self, node: usize) -> usize {
        self.numbers[node].into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{GenericInsertShape, flat_insert};

    fn block() -> Insert {
        let meshing = Meshing {
            edge_mm: 1.0,
            layers: 2,
        };
        flat_insert((4.0, 6.0), 5.0, meshing).unwrap()
    }

    #[test]
    fn a_clone_wears_alone_and_shares_what_does_not_wear() {
        let unworn = block();
        let mut worn = unworn.clone();
        let surface = worn.surface();
        worn.wear_down(&surface, &vec![0.1; surface.positions.len()]);
        assert!(
            worn.thickness_mm()
                .iter()
                .all(|left| (left - 4.9).abs() < 1e-12)
        );
        assert!(unworn.thickness_mm().iter().all(|left| *left == 5.0));
        assert!(Arc::ptr_eq(&unworn.unworn, &worn.unworn));
        assert!(Arc::ptr_eq(&unworn.mesh.hexes, &worn.mesh.hexes));
    }

    #[test]
    fn quads_that_do_not_face_out_of_the_mesh_are_refused() {
        let mesh = block().mesh().clone();
        let is_at = |height_mm: f64| {
            let nodes = &mesh.nodes;
            move |quad: &[u32; 4]| quad.iter().all(|&node| nodes[node as usize].y == height_mm)
        };
        let lowest_mm = mesh
            .nodes
            .iter()
            .map(|node| node.y)
            .fold(f64::MAX, f64::min);
        let top = mesh.boundary_quads_where(is_at(0.0));
        let bottom = mesh.boundary_quads_where(is_at(lowest_mm));
        assert!(Insert::new(mesh.clone(), &top, &bottom).is_ok());
        let mut inwards = top.clone();
        inwards[3].reverse();
        let mut twice = top.clone();
        twice.push(top[0]);
        for (quads, quad) in [(inwards, 3), (twice, top.len())] {
            let error = Insert::new(mesh.clone(), &quads, &bottom).unwrap_err();
            assert_eq!(error, InsertError::NotOnBoundary { quad });
        }
    }

    #[test]
    fn verify_layers_of_any_thickness_thin_by_the_same_ratio() {
        let graded = Meshing {
            edge_mm: 0.5,
            layers: 3,
        };
        let mut insert = flat_insert((4.0, 6.0), 5.0, graded).unwrap();
        let surface = insert.surface();
        insert.wear_down(&surface, &vec![4.5; surface.positions.len()]);
        let bottom = insert.mesh().nodes[insert.backside_nodes()[0] as usize].y;
        for (node, unworn) in insert.mesh().nodes.iter().zip(insert.unworn_nodes()) {
            assert!((node.y - bottom - 0.1 * (unworn.y - bottom)).abs() < 1e-12);
        }
        assert!(insert.mesh().worst_quality() > 0.99);
    }

    #[test]
    fn verify_a_sloping_surface_that_wears_to_its_rim_loses_depth_times_area() {
        let sloping = block().mesh().clone();
        let slope = |node: &Vec3| Vec3::new(node.x, node.y + 0.3 * node.x, node.z);
        let nodes = sloping.nodes.iter().map(slope).collect();
        let mesh = HexMesh { nodes, ..sloping };
        let top = block().surface_nodes().to_vec();
        let quads = mesh.boundary_quads();
        let on_top = |quad: &[u32; 4]| quad.iter().all(|node| top.contains(node));
        let (above, rest): (Vec<[u32; 4]>, Vec<[u32; 4]>) = quads.into_iter().partition(on_top);
        let mut insert = Insert::new(mesh, &above, &rest).unwrap();
        let (surface, before) = (insert.surface(), insert.volume_mm3());
        insert.wear_down(&surface, &vec![0.1; surface.positions.len()]);
        let lost = (before - insert.volume_mm3()) / (0.1 * surface.area_mm2());
        assert!((lost - 1.0).abs() < 1e-9, "{lost}");
    }

    #[test]
    fn regions_are_the_sides_of_a_knee() {
        let insert = block();
        let positions = insert.surface().positions;
        for (node, position) in positions.iter().enumerate() {
            assert_eq!(
                insert.regions().of_node(node),
                usize::from(position.z >= 0.0)
            );
        }
    }

    #[test]
    fn a_worn_node_stays_in_its_region() {
        let mut insert = block();
        let before = insert.regions().clone();
        let surface = insert.surface();
        insert.wear_down(&surface, &vec![0.2; surface.positions.len()]);
        assert_eq!(insert.regions(), &before);
    }

    /// Returns the generic dish as an open surface of triangles, fine or coarse.
    fn dish(edge_mm: f64) -> TriangleMesh {
        let insert = GenericInsertShape::default()
            .insert(Meshing { edge_mm, layers: 1 })
            .unwrap();
        let surface = insert.surface();
        let cut = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
        TriangleMesh {
            vertices: surface.positions,
            triangles: insert
                .surface_faces()
                .iter()
                .flat_map(|&face| cut(face))
                .collect(),
        }
    }

    #[test]
    fn verify_volume_of_a_box() {
        let shell = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
        assert!((shell.signed_volume() - 4800.0).abs() < 1e-9);
        let insert = Insert::from_surface(
            &shell,
            true,
            None,
            Meshing {
                edge_mm: 1.0,
                layers: 3,
            },
        )
        .unwrap();
        assert!(
            (insert.mesh().volume() - 4800.0).abs() < 1e-6
                && (insert.volume_mm3() - 4800.0).abs() < 1e-6,
            "{}",
            insert.mesh().volume()
        );
        assert!(
            insert
                .thickness_mm()
                .iter()
                .all(|thickness| (thickness - 8.0).abs() < 1e-9)
        );
    }

    #[test]
    fn verify_heights_from_a_coarse_dish_are_those_of_the_dish() {
        let shape = GenericInsertShape::default();
        let meshing = Meshing {
            edge_mm: 0.77,
            layers: 1,
        };
        let insert = Insert::from_surface(&dish(2.0), false, Some(9.0), meshing).unwrap();
        for position in insert.surface().positions {
            let in_dish = position.x.abs() < 12.0 && (position.z.abs() - 23.0).abs() < 9.0;
            if in_dish {
                // The flat facets lie up to 25 micrometres off.
                let error = position.y - shape.height_mm(position.x, position.z);
                assert!(error.abs() < 1e-3, "{error} at {position}");
            }
        }
    }

    #[test]
    fn errors_say_what_to_give() {
        let meshing = Meshing::default();
        let open = Insert::from_surface(&dish(2.0), false, None, meshing)
            .err()
            .unwrap();
        assert!(open.to_string().contains("give thickness_mm"));
        let tiny = TriangleMesh::block(Vec3::zeros(), Vec3::new(0.02, 0.01, 0.03))
            .mapped(|v| v + Vec3::repeat(5.0));
        let huge = Meshing {
            edge_mm: 100.0,
            layers: 1,
        };
        match Insert::from_surface(&tiny, true, None, huge) {
            Err(error) => assert!(error.to_string().contains("smaller edge_mm"), "{error}"),
            Ok(insert) => assert_eq!(insert.mesh().hexes.len(), 1),
        }
        let nothing = Insert::from_surface(
            &TriangleMesh {
                vertices: vec![Vec3::zeros(); 3],
                triangles: vec![[0, 1, 2]],
            },
            true,
            None,
            meshing,
        );
        assert!(
            nothing
                .err()
                .unwrap()
                .to_string()
                .contains("smaller edge_mm")
        );
    }

    fn row() -> [Vec3; 4] {
        [-2.0, -1e-9, 0.0, 3.0].map(|z| Vec3::new(1.0, 5.0, z))
    }

    #[test]
    fn a_knee_is_split_at_its_middle() {
        let regions = SurfaceRegions::medial_and_lateral(row());
        assert_eq!(regions.names(), ["medial", "lateral"]);
        let of_nodes = [0, 1, 2, 3].map(|node| regions.of_node(node));
        assert_eq!(of_nodes, [0, 0, 1, 1]);
    }

    #[test]
    fn a_surface_may_be_one_region_or_many() {
        let cup = SurfaceRegions::split(&["cup"], row(), |_| 0);
        assert_eq!((cup.count(), cup.of_node(3)), (1, 0));
        let names = ["far medial", "middle", "far lateral"];
        let three = SurfaceRegions::split(&names, row(), |at| (at.z / 2.0).round() as usize);
        assert_eq!(three.of_node(3), 2);
    }

    #[test]
    #[should_panic(expected = "region 2 has no name")]
    fn every_region_has_a_name() {
        let _ = SurfaceRegions::split(&["one", "other"], row(), |_| 2);
    }
}
