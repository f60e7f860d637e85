//! The state of an insert as it was made, which wear does not change.

use condyle_fem::{HEX_EDGES, HexMesh, numbered};
use condyle_mesh::{
    bounds,
    columns::{ColumnError, TooManyNodes},
    hit,
};
use thiserror::Error;

use crate::{
    Vec3,
    geometry::{
        articulating_surface::ArticulatingSurface,
        connectivity::{FacesAround, NodeBlock, node_blocks},
    },
};

/// The reason why a mesh does not form an insert.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum InsertError {
    /// No element or no articulating face.
    #[error("the insert has no {what}; define at least one")]
    Empty { what: &'static str },
    /// More nodes than the mesh can number.
    #[error(transparent)]
    TooManyNodes(#[from] TooManyNodes),
    /// A surface that cannot be meshed in columns.
    #[error(transparent)]
    Columns(#[from] ColumnError),
    /// A quad of a surface that is inside the mesh, faces in, or is listed twice.
    #[error(
        "quad {quad} of the articulating surface is not on the boundary of the mesh, faces into it, or is listed twice"
    )]
    NotOnBoundary { quad: usize },
    /// A hexahedron that is inverted or flat.
    #[error(
        "hexahedron {hex} of the insert is inverted or flat (scaled Jacobian {quality:.3}); repair the mesh or use a larger edge"
    )]
    BadElement { hex: usize, quality: f64 },
    /// A node of the articulating surface with no backside below it.
    #[error(
        "no part of the backside lies below the articulating surface at ({:.2}, {:.2}, {:.2}) mm; \
         check which surface is the backside",
        place_mm.x, place_mm.y, place_mm.z
    )]
    NoThickness { place_mm: Vec3 },
}

/// An insert before any wear: connectivity, positions and thickness.
pub(super) struct UnwornInsert {
    pub nodes: Vec<Vec3>,
    /// Quads around the mesh, facing out.
    pub boundary: Vec<[u32; 4]>,
    /// Mesh nodes of the articulating surface, ascending; surface node i is `surface_nodes[i]`.
    pub surface_nodes: Vec<u32>,
    /// Mesh nodes of the backside, ascending.
    pub backside_nodes: Vec<u32>,
    /// Faces of the articulating surface, in numbers of surface nodes.
    pub faces: Vec<[u32; 4]>,
    pub faces_around: FacesAround,
    pub node_blocks: Vec<NodeBlock>,
    pub share_mm2: Vec<f64>,
    pub thickness_mm: Vec<f64>,
    /// Empty for a shape without triangles, as are the voids.
    pub mesh_error_mm: Vec<f64>,
    pub void_mm: Vec<f64>,
    /// Unit direction of the side wall below each surface node on the rim, upwards.
    pub walls: Vec<Option<Vec3>>,
    pub followers: Vec<Follower>,
}

/// A node inside the mesh, which moves with the surface node at the top of its column.
pub(super) struct Follower {
    pub node: u32,
    pub surface_node: u32,
    /// The part of the displacement that it takes: its height above the bottom of the column over that of the surface node.
    pub part: f64,
}

impl UnwornInsert {
    pub fn new(
        mesh: &HexMesh,
        articulating: &[[u32; 4]],
        backside: &[[u32; 4]],
    ) -> Result<Self, InsertError> {
        let parts = [
            (mesh.hexes.len(), "hexahedra"),
            (articulating.len(), "articulating surface"),
            (backside.len(), "backside"),
        ];
        if let Some((_, what)) = parts.into_iter().find(|(count, _)| *count == 0) {
            return Err(InsertError::Empty { what });
        }
        // Checked before anything is computed: an inverted element has no thickness and no stiffness.
        let mut qualities = mesh.qualities().enumerate();
        if let Some((hex, quality)) = qualities.find(|(_, quality)| *quality <= 0.0) {
            return Err(InsertError::BadElement { hex, quality });
        }
        let boundary = mesh.boundary_quads();
        let mut left: Vec<Vec<[u32; 4]>> = vec![Vec::new(); mesh.nodes.len()];
        for quad in boundary.iter().copied().map(from_lowest) {
            left[quad[0] as usize].push(quad);
        }
        // Each is removed when it is found, so that one that is listed twice is not.
        let is_missing = |quad: [u32; 4]| {
            let left = left.get_mut(quad[0] as usize);
            let found = left.and_then(|left| {
                let place = left.iter().position(|other| *other == quad)?;
                Some(left.swap_remove(place))
            });
            found.is_none()
        };
        let mut quads = articulating.iter().copied().map(from_lowest);
        if let Some(quad) = quads.position(is_missing) {
            return Err(InsertError::NotOnBoundary { quad });
        }
        let (surface_nodes, faces) = numbered(articulating);
        let faces_around = FacesAround::new(surface_nodes.len(), &faces);
        let positions = mesh.positions(&surface_nodes).collect();
        let surface = ArticulatingSurface::new(positions, &faces_around);
        Ok(Self {
            share_mm2: surface.shares.iter().map(|share| share.area_mm2).collect(),
            thickness_mm: thickness_at_nodes(&surface, mesh, backside)?,
            mesh_error_mm: Vec::new(),
            void_mm: Vec::new(),
            walls: walls(mesh, &boundary, &surface_nodes),
            followers: followers(mesh, &surface_nodes),
            node_blocks: node_blocks(&faces, &faces_around),
            nodes: mesh.nodes.clone(),
            boundary,
            surface_nodes,
            backside_nodes: numbered(backside).0,
            faces,
            faces_around,
        })
    }

    pub fn surface_positions(&self) -> impl Iterator<Item = Vec3> {
        let nodes = self.surface_nodes.iter();
        nodes.map(|&node| self.nodes[node as usize])
    }
}

/// Returns a quad from its lowest node on, in the same direction.
fn from_lowest(mut quad: [u32; 4]) -> [u32; 4] {
    let lowest = (0..4).min_by_key(|&corner| quad[corner]);
    quad.rotate_left(lowest.unwrap_or_default());
    quad
}

/// Returns the direction of the boundary edge that leads down from each node of the articulating surface, if it has
/// exactly one.
fn walls(mesh: &HexMesh, boundary: &[[u32; 4]], surface_nodes: &[u32]) -> Vec<Option<Vec3>> {
    let number = |node: u32| surface_nodes.binary_search(&node).ok();
    let mut below: Vec<Vec<u32>> = vec![Vec::new(); surface_nodes.len()];
    for quad in boundary {
        for side in 0..4 {
            let ends = [quad[side], quad[(side + 1) % 4]];
            for [here, there] in [ends, [ends[1], ends[0]]] {
                if let (Some(here), None) = (number(here), number(there)) {
                    below[here].push(there);
                }
            }
        }
    }
    let direction = |(here, mut below): (usize, Vec<u32>)| {
        // An edge belongs to two quads, so that each end is found twice.
        below.sort_unstable();
        below.dedup();
        let place = |node: u32| mesh.nodes[node as usize];
        match below[..] {
            [only] => (place(surface_nodes[here]) - place(only)).try_normalize(0.0),
            _ => None,
        }
    };
    below.into_iter().enumerate().map(direction).collect()
}

/// Returns the nodes below the articulating surface that follow it, ascending.
///
/// Starting at the surface, every layer of hexahedra with a face on the nodes reached so far leads to the nodes at the
/// other ends of its edges.
fn followers(mesh: &HexMesh, surface_nodes: &[u32]) -> Vec<Follower> {
    let mut top: Vec<Option<u32>> = vec![None; mesh.nodes.len()];
    let mut depth_mm = vec![0.0; mesh.nodes.len()];
    for (i, &node) in surface_nodes.iter().enumerate() {
        top[node as usize] = Some(i as u32);
    }
    let mut front = surface_nodes.to_vec();
    let mut left: Vec<&[u32; 8]> = mesh.hexes.iter().collect();
    let mut column_mm = vec![0.0; surface_nodes.len()];
    while !front.is_empty() {
        let is_front = marked(&front, mesh.nodes.len());
        front.clear();
        left.retain(|hex| {
            let on_front = hex.map(|node| is_front[node as usize]);
            if on_front.iter().filter(|on_front| **on_front).count() != 4 {
                return true;
            }
            for [a, b] in HEX_EDGES.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]) {
                let (from, to) = (hex[a] as usize, hex[b] as usize);
                if let (true, false, None, Some(above)) =
                    (on_front[a], on_front[b], top[to], top[from])
                {
                    top[to] = Some(above);
                    depth_mm[to] = depth_mm[from] + (mesh.nodes[from] - mesh.nodes[to]).norm();
                    column_mm[above as usize] = depth_mm[to];
                    front.push(hex[b]);
                }
            }
            false
        });
    }
    let follower = |(node, (top, depth_mm)): (usize, (Option<u32>, f64))| {
        let surface_node = top?;
        let part = 1.0 - depth_mm / column_mm[surface_node as usize];
        (part > 0.0 && depth_mm > 0.0).then_some(Follower {
            node: node as u32,
            surface_node,
            part,
        })
    };
    let nodes = top.into_iter().zip(depth_mm).enumerate();
    nodes.filter_map(follower).collect()
}

/// Returns whether each of `count` nodes is one of `nodes`.
fn marked(nodes: &[u32], count: usize) -> Vec<bool> {
    let mut is_marked = vec![false; count];
    for &node in nodes {
        is_marked[node as usize] = true;
    }
    is_marked
}

/// Edge of the bins that sort the backside over the transverse plane, mm: about the edge of an element.
const BIN_MM: f64 = 2.0;

/// The triangles of the backside, sorted into square bins over the transverse plane.
struct Backside {
    triangles: Vec<[Vec3; 3]>,
    low: Vec3,
    counts: (usize, usize),
    bins: Vec<Vec<u32>>,
}

/// Largest ratio of the distance to the backside along a normal to that straight down: above a flat backside, the normal of a slope
/// of 60 degrees. A wall is steeper, and its normal meets the backside far away if at all.
const MAX_SLANT: f64 = 2.0;

/// Returns the distance from each node of a surface, against its normal, to the backside, mm.
///
/// On a wall, whose normal may meet the backside far away, and where the normal misses it (at the rim), the distance straight down
/// counts, and where that misses too, the nearest vertex of the backside.
fn thickness_at_nodes(
    surface: &ArticulatingSurface,
    mesh: &HexMesh,
    backside: &[[u32; 4]],
) -> Result<Vec<f64>, InsertError> {
    let backside = Backside::new(mesh, backside);
    let thickness = |(from, normal): (&Vec3, &Vec3)| {
        let down = || backside.distance_along(from, &-Vec3::y());
        let is_near = |along: &f64| down().is_none_or(|down| *along <= MAX_SLANT * down);
        let along_normal = backside.distance_along(from, &-normal);
        along_normal
            .filter(is_near)
            .or_else(down)
            .or_else(|| {
                let vertices = backside.triangles.iter().flatten();
                let distances = vertices.map(|vertex| (vertex - from).norm());
                distances
                    .min_by(f64::total_cmp)
                    .filter(|&distance| distance > 0.0)
            })
            .ok_or(InsertError::NoThickness { place_mm: *from })
    };
    let nodes = surface.positions.iter().zip(&surface.normals);
    nodes.map(thickness).collect()
}

impl Backside {
    fn new(mesh: &HexMesh, quads: &[[u32; 4]]) -> Self {
        let corners = |quad: &[u32; 4]| {
            let [a, b, c, d] = quad.map(|node| mesh.nodes[node as usize]);
            [[a, b, c], [a, c, d]]
        };
        let triangles: Vec<[Vec3; 3]> = quads.iter().flat_map(corners).collect();
        let (low, high) = bounds(triangles.as_flattened());
        let count = |length: f64| (length / BIN_MM) as usize + 1;
        let counts = (count(high.x - low.x), count(high.z - low.z));
        let mut sorted = Self {
            bins: vec![Vec::new(); counts.0 * counts.1],
            triangles,
            low,
            counts,
        };
        for index in 0..sorted.triangles.len() {
            let [a, b, c] = sorted.triangles[index];
            for bin in sorted.bins_between(&a.inf(&b).inf(&c), &a.sup(&b).sup(&c)) {
                sorted.bins[bin].push(index as u32);
            }
        }
        sorted
    }

    /// Returns the distance from a point along a unit direction to the first triangle hit.
    fn distance_along(&self, from: &Vec3, direction: &Vec3) -> Option<f64> {
        if direction.y >= 0.0 {
            return None;
        }
        // Below the lowest place of the backside there is nothing to hit: only the bins down to it are searched.
        let end = from + direction * ((self.low.y - from.y) / direction.y).max(0.0);
        let mut nearest: Option<f64> = None;
        for bin in self.bins_between(&from.inf(&end), &from.sup(&end)) {
            for &index in &self.bins[bin] {
                let distance = hit(&self.triangles[index as usize], from, direction);
                nearest = nearest.map_or(distance, |d| Some(distance.map_or(d, |e| d.min(e))));
            }
        }
        nearest
    }

    /// Bins covered by the box between two points.
    fn bins_between(&self, low: &Vec3, high: &Vec3) -> impl Iterator<Item = usize> + use<> {
        let place = |value: f64, origin: f64, count: usize| {
            (((value - origin) / BIN_MM).floor().max(0.0) as usize).min(count - 1)
        };
        let (nx, nz) = self.counts;
        let (x, z) = (
            place(low.x, self.low.x, nx)..=place(high.x, self.low.x, nx),
            place(low.z, self.low.z, nz)..=place(high.z, self.low.z, nz),
        );
        x.flat_map(move |i| z.clone().map(move |k| i * nz + k))
    }
}
