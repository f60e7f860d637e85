//! The tibial insert: a hexahedral mesh, its articulating surface, and how it wears away.

pub(super) mod error;
mod from_surface;
mod thickness;
mod unworn;

use std::{fmt, sync::Arc};

use condyle_fem::{HexMesh, volume_below};

use self::{error::InsertError, unworn::UnwornInsert};
use super::{
    articulating_surface::ArticulatingSurface, faces_around::FacesAround, node_blocks::NodeBlock,
    surface_regions::SurfaceRegions,
};
use crate::Vec3;

/// A wall that leans farther than 60 degrees from the normal at its rim is no way down for it.
const MIN_COSINE_OF_WALL: f64 = 0.5;

/// A tibial insert, unworn or worn.
///
/// Clones share what wear does not change; a clone costs the positions of the nodes, and two
/// numbers a surface node.
#[derive(Clone)]
pub struct Insert {
    unworn: Arc<UnwornInsert>,
    regions: Arc<SurfaceRegions>,
    rim_along_walls: bool,
    mesh: HexMesh,
    /// Depth worn so far: the thickness is computed from it anew, so that an insert worn step by
    /// step and one restored have the same to the last bit.
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
    /// An insert from its mesh, the quads of its articulating surface facing out, and those of
    /// its backside; its regions are the sides of a knee.
    ///
    /// # Errors
    /// An empty mesh or surface, an inverted element, or a node without thickness below it.
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
            rim_along_walls: false,
            unworn: Arc::new(unworn),
            mesh,
        })
    }

    /// The same insert with its surface in other regions: called `names`, a node in that whose
    /// number `region_of` gives for its unworn position, mm.
    ///
    /// # Panics
    /// As [`SurfaceRegions::split`].
    pub fn split_into(self, names: &[&str], region_of: impl Fn(&Vec3) -> usize) -> Self {
        let positions = self.unworn.surface_positions();
        let regions = SurfaceRegions::split(names, positions, region_of);
        Self {
            regions: Arc::new(regions),
            ..self
        }
    }

    /// The regions of the articulating surface.
    pub fn regions(&self) -> &SurfaceRegions {
        &self.regions
    }

    /// The hexahedra.
    pub fn mesh(&self) -> &HexMesh {
        &self.mesh
    }

    /// Volume of the mesh as it is now, mm3: what its boundary encloses.
    pub fn volume_mm3(&self) -> f64 {
        // Near the mesh, so that the cones are small and few digits are lost.
        let origin = self.mesh.nodes[self.unworn.boundary[0][0] as usize];
        let corners = |quad: &[u32; 4]| quad.map(|node| self.mesh.nodes[node as usize] - origin);
        let quads = self.unworn.boundary.iter();
        quads.map(|quad| volume_below(&corners(quad))).sum()
    }

    /// Mesh nodes of the articulating surface, ascending; the order of every array a surface node.
    pub fn surface_nodes(&self) -> &[u32] {
        &self.unworn.surface_nodes
    }

    /// Mesh nodes of the backside, ascending.
    pub fn backside_nodes(&self) -> &[u32] {
        &self.unworn.backside_nodes
    }

    /// Positions of all mesh nodes before any wear, mm.
    pub fn unworn_nodes(&self) -> &[Vec3] {
        &self.unworn.nodes
    }

    /// Faces of the articulating surface, in numbers of surface nodes, facing out.
    pub fn surface_faces(&self) -> &[[u32; 4]] {
        &self.unworn.faces
    }

    /// The faces of the articulating surface around each of its nodes.
    pub fn faces_around(&self) -> &FacesAround {
        &self.unworn.faces_around
    }

    /// The surface nodes in blocks: each once, those of a block near one another.
    pub fn node_blocks(&self) -> &[NodeBlock] {
        &self.unworn.node_blocks
    }

    /// Area of a surface node's share before any wear, mm2.
    pub fn unworn_share_mm2(&self, node: usize) -> f64 {
        self.unworn.share_mm2[node]
    }

    /// Thickness of the insert below each surface node along its normal, mm.
    pub fn thickness_mm(&self) -> &[f64] {
        &self.thickness_mm
    }

    /// The articulating surface as it is now.
    pub fn surface(&self) -> ArticulatingSurface {
        self.surface_at(&self.mesh.nodes)
    }

    /// The articulating surface with the mesh nodes elsewhere, mm.
    pub fn surface_at(&self, mesh_nodes: &[Vec3]) -> ArticulatingSurface {
        let nodes = self.surface_nodes().iter();
        let positions = nodes.map(|&node| mesh_nodes[node as usize]).collect();
        ArticulatingSurface::new(positions, &self.unworn.faces_around)
    }

    /// The same insert whose rim wears down along its side wall, as far as the surface goes down by its depth.
    ///
    /// A rim that goes along its normal leans out of the body over the wall below it, or into it, and so changes the volume
    /// otherwise than depth times area.
    pub fn with_rim_along_walls(self) -> Self {
        Self {
            rim_along_walls: true,
            ..self
        }
    }

    /// Moves every surface node inwards along its normal, and the mesh below after it; one on the rim along its wall, if
    /// the insert is [made so](Self::with_rim_along_walls).
    ///
    /// `depth_mm`: one a surface node, 0 or more. The thickness shrinks by as much.
    pub fn wear_down(&mut self, surface: &ArticulatingSurface, depth_mm: &[f64]) {
        let mut displacement = self.as_before(surface, depth_mm);
        for (i, &node) in self.unworn.surface_nodes.iter().enumerate() {
            displacement[node as usize] = -self.outwards(i, &surface.normals[i]) * depth_mm[i];
            self.worn_mm[i] += depth_mm[i];
        }
        self.find_thickness();
        self.unworn.follower.follow(&mut displacement);
        for (node, step) in self.mesh.nodes.iter_mut().zip(&displacement) {
            *node += step;
        }
    }

    /// How far and where a surface node goes if the surface around it rises by a unit.
    fn outwards(&self, node: usize, normal: &Vec3) -> Vec3 {
        let wall = self.unworn.walls[node].filter(|_| self.rim_along_walls);
        let wall = wall.filter(|wall| wall.dot(normal) > MIN_COSINE_OF_WALL);
        wall.map_or(*normal, |wall| wall / wall.dot(normal))
    }

    /// How every mesh node moves if the mesh goes on as it has come so far, in proportion to the
    /// depth: nearly how it will, so that the inside is found in few iterations.
    fn as_before(&self, surface: &ArticulatingSurface, depth_mm: &[f64]) -> Vec<Vec3> {
        let moved = |node: usize| self.mesh.nodes[node] - self.unworn.nodes[node];
        let (mut along, mut whole) = (0.0, 0.0);
        for (i, &node) in self.unworn.surface_nodes.iter().enumerate() {
            let so_far = moved(node as usize);
            along -= so_far.dot(&surface.normals[i]) * depth_mm[i];
            whole += so_far.norm_squared();
        }
        let share = if whole > 0.0 { along / whole } else { 0.0 };
        let nodes = 0..self.mesh.nodes.len();
        nodes.map(|node| moved(node) * share).collect()
    }

    /// Puts a worn insert back to a stored state: all mesh nodes, and the depth worn so far at
    /// each surface node.
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

    /// The lowest point of the dishes, mm: the lowest surface node that none of its neighbours
    /// lies below, the rim left out.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Meshing, flat_insert};

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
    fn verify_a_sloping_surface_that_wears_to_its_rim_loses_depth_times_area() {
        let sloping = block().mesh().clone();
        let slope = |node: &Vec3| Vec3::new(node.x, node.y + 0.3 * node.x, node.z);
        let nodes = sloping.nodes.iter().map(slope).collect();
        let mesh = HexMesh { nodes, ..sloping };
        let top = block().surface_nodes().to_vec();
        let quads = mesh.boundary_quads();
        let on_top = |quad: &[u32; 4]| quad.iter().all(|node| top.contains(node));
        let (above, rest): (Vec<[u32; 4]>, Vec<[u32; 4]>) = quads.into_iter().partition(on_top);
        let insert = Insert::new(mesh, &above, &rest).unwrap();
        let mut insert = insert.with_rim_along_walls();
        let (surface, before) = (insert.surface(), insert.volume_mm3());
        insert.wear_down(&surface, &vec![0.1; surface.positions.len()]);
        let lost = (before - insert.volume_mm3()) / (0.1 * surface.area_mm2());
        assert!((lost - 1.0).abs() < 1e-9, "{lost}");
    }

    #[test]
    fn regions_are_the_sides_of_a_knee_unless_said_otherwise() {
        let insert = block();
        let positions = insert.surface().positions;
        for (node, position) in positions.iter().enumerate() {
            assert_eq!(
                insert.regions().of_node(node),
                usize::from(position.z >= 0.0)
            );
        }
        let halves = insert.split_into(&["front", "back"], |at| usize::from(at.x < 0.0));
        assert_eq!(halves.regions().number_of("back"), Some(1));
        for (node, position) in positions.iter().enumerate() {
            assert_eq!(
                halves.regions().of_node(node),
                usize::from(position.x < 0.0)
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
}
