//! A hexahedral mesh while it is read, and the checked result with its named surfaces.

use std::{
    cell::OnceCell,
    collections::{HashMap, HashSet},
    fmt::Display,
    path::Path,
};

use condyle_fem::{HEX_FACES, HexMesh};
use indexmap::IndexMap;

use super::{error::MeshFileError, text::At};
use crate::{
    Vec3,
    triangle_mesh::{TriangleMesh, bounds},
};

/// Distance of two nodes at the same place, relative to the diagonal of the mesh: exports round to six digits or so.
const SAME_PLACE: f64 = 1e-5;
/// A direction along which no usual mesh has planes of nodes.
const OBLIQUE: Vec3 = Vec3::new(0.613, 0.371, 0.697);

pub(crate) struct HexDraft<'a> {
    path: &'a Path,
    nodes: Vec<Vec3>,
    node_of_label: HashMap<u64, usize>,
    pub(crate) hexes: Vec<DraftHex>,
    hex_of_label: HashMap<u64, usize>,
    /// Number of hexahedra that have each face, counted on first use.
    uses_of_quad: OnceCell<HashMap<[u64; 4], usize>>,
    surfaces: NamedLists<DraftQuad>,
}

type DraftQuad = (Option<usize>, [u64; 4]);

/// One hexahedron by the labels of its nodes, in VTK order.
pub(crate) struct DraftHex {
    nodes: [u64; 8],
    label: u64,
    line: Option<usize>,
}

impl DraftHex {
    /// Returns the six faces by the labels of their nodes, facing outwards, S1 to S6 of Abaqus.
    pub(crate) fn quads(&self) -> [[u64; 4]; 6] {
        HEX_FACES.map(|face| face.map(|corner| self.nodes[corner]))
    }
}

/// Lists in the order of the file, each with its name as first written, by the name in capitals.
pub(crate) type NamedLists<T> = IndexMap<String, (String, Vec<T>)>;

/// Returns the list of a name in any case, which starts empty.
pub(crate) fn list_of<'l, T>(lists: &'l mut NamedLists<T>, name: &str) -> &'l mut Vec<T> {
    let list = lists.entry(name.to_ascii_uppercase());
    &mut list.or_insert_with(|| (name.to_owned(), Vec::new())).1
}

impl<'a> HexDraft<'a> {
    pub(crate) fn new(path: &'a Path) -> Self {
        Self {
            path,
            nodes: Vec::new(),
            node_of_label: HashMap::new(),
            hexes: Vec::new(),
            hex_of_label: HashMap::new(),
            uses_of_quad: OnceCell::new(),
            surfaces: NamedLists::default(),
        }
    }

    fn at(&self, line: Option<usize>) -> At<'a> {
        let path = self.path;
        At { path, line }
    }

    pub(crate) fn node(
        &mut self,
        at: At,
        label: u64,
        point: [f64; 3],
    ) -> Result<(), MeshFileError> {
        let position = at.position(format_args!("node {label}"), point)?;
        if self.node_of_label.insert(label, self.nodes.len()).is_some() {
            return Err(at.error(format!(
                "node {label} is given twice; number each node once"
            )));
        }
        self.nodes.push(position);
        Ok(())
    }

    pub(crate) fn hex(&mut self, at: At, label: u64, nodes: [u64; 8]) -> Result<(), MeshFileError> {
        if self.hex_of_label.insert(label, self.hexes.len()).is_some() {
            let problem = format!("element {label} is given twice; number each element once");
            return Err(at.error(problem));
        }
        self.uses_of_quad.take();
        let line = at.line;
        self.hexes.push(DraftHex { nodes, label, line });
        Ok(())
    }

    pub(crate) fn labelled_hex(&self, label: u64) -> Option<&DraftHex> {
        Some(&self.hexes[*self.hex_of_label.get(&label)?])
    }

    /// Adds a face, turned either way, to the surface of that name.
    pub(crate) fn quad(&mut self, surface: &str, at: At, nodes: [u64; 4]) {
        list_of(&mut self.surfaces, surface).push((at.line, nodes));
    }

    /// Returns the faces of these hexahedra that no other hexahedron of the mesh shares.
    pub(crate) fn free_quads<'h>(
        &self,
        hexes: impl IntoIterator<Item = &'h DraftHex>,
    ) -> Vec<[u64; 4]> {
        let uses = self.uses_of_quad.get_or_init(|| {
            let mut uses = HashMap::new();
            for quad in self.hexes.iter().flat_map(DraftHex::quads) {
                *uses.entry(sorted(quad)).or_default() += 1;
            }
            uses
        });
        let quads = hexes.into_iter().flat_map(DraftHex::quads);
        quads.filter(|&quad| uses[&sorted(quad)] == 1).collect()
    }

    /// Returns the mesh with its surfaces, if it can be computed with.
    pub(crate) fn finish(self) -> Result<HexFile, MeshFileError> {
        if self.hexes.is_empty() {
            let problem = "holds no hexahedra; export the volume mesh with 8-node hexahedra";
            return Err(At::file(self.path).error(problem));
        }
        let (mesh, kept) = self.mesh()?;
        for (hex, quality) in self.hexes.iter().zip(mesh.qualities()) {
            if quality <= 0.0 {
                return Err(self.at(hex.line).error(format!(
                    "hexahedron {} is inverted or flat (scaled Jacobian {quality:.3}); \
                     check its node order, or mesh again",
                    hex.label
                )));
            }
        }
        self.refuse_coincident_nodes(&mesh, &kept)?;
        let bodies = bodies(&mesh);
        if bodies > 1 {
            return Err(At::file(self.path).error(format!(
                "holds {bodies} bodies that share no nodes; export the insert alone, with its elements connected"
            )));
        }
        let number = |label: &u64| kept[*self.node_of_label.get(label)?];
        let surfaces = self.outward_surfaces(&mesh, number)?;
        Ok(HexFile { mesh, surfaces })
    }

    /// Returns the mesh without nodes that no hexahedron uses, and the number in it of each node of the file.
    fn mesh(&self) -> Result<(HexMesh, Vec<Option<u32>>), MeshFileError> {
        let mut used = vec![false; self.nodes.len()];
        let mut hexes = Vec::with_capacity(self.hexes.len());
        for hex in &self.hexes {
            let mut numbers = [0; 8];
            for (number, &label) in numbers.iter_mut().zip(&hex.nodes) {
                *number = *self.node_of_label.get(&label).ok_or_else(|| {
                    let element = format_args!("element {}", hex.label);
                    self.at(hex.line)
                        .no_such_vertex(element, label.cast_signed(), "otherwise")
                })?;
                used[*number] = true;
            }
            hexes.push(numbers);
        }
        let mut nodes = Vec::new();
        let mut kept = vec![None; self.nodes.len()];
        for (index, position) in self.nodes.iter().enumerate().filter(|&(i, _)| used[i]) {
            kept[index] = Some(nodes.len() as u32);
            nodes.push(*position);
        }
        let hexes = hexes.iter();
        let hexes = hexes.map(|hex| hex.map(|node| kept[node].unwrap_or_default()));
        let hexes = hexes.collect();
        Ok((HexMesh { nodes, hexes }, kept))
    }

    /// Refuses nodes at the same place: there the mesh is cut, and both sides of the cut would count as its surface.
    fn refuse_coincident_nodes(
        &self,
        mesh: &HexMesh,
        kept: &[Option<u32>],
    ) -> Result<(), MeshFileError> {
        let (low, high) = bounds(&mesh.nodes);
        let within = SAME_PLACE * (high - low).norm();
        // Along an oblique direction the planes of a mesh do not coincide, so that few nodes are neighbours.
        let along = |node: u32| mesh.nodes[node as usize].dot(&OBLIQUE);
        let mut order: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
        order.sort_by(|&one, &other| along(one).total_cmp(&along(other)));
        let distance =
            |[one, other]: [u32; 2]| (mesh.nodes[one as usize] - mesh.nodes[other as usize]).norm();
        let pairs = order.iter().enumerate().flat_map(|(place, &one)| {
            let after = order[place + 1..].iter().map(move |&other| [one, other]);
            after.take_while(|&[one, other]| along(other) - along(one) <= within)
        });
        let mut pairs = pairs.filter(|&pair| distance(pair) <= within);
        let Some(pair) = pairs.next() else {
            return Ok(());
        };
        let label = |node: u32| {
            let mut labels = self.node_of_label.iter();
            labels.find_map(|(label, &index)| (kept[index] == Some(node)).then_some(*label))
        };
        let [one, other] = pair.map(|node| label(node).unwrap_or_default());
        let (one, other, count) = (one.min(other), one.max(other), 1 + pairs.count());
        Err(At::file(self.path).error(format!(
            "node {other} lies at the place of node {one} (pairs of such nodes: {count}), which cuts the mesh there; merge \
             coincident nodes, and export the insert alone"
        )))
    }

    /// Returns the surfaces with each quad once, as the mesh's boundary has it.
    fn outward_surfaces(
        &self,
        mesh: &HexMesh,
        number: impl Fn(&u64) -> Option<u32>,
    ) -> Result<Vec<NamedSurface>, MeshFileError> {
        let boundary = mesh.boundary_quads().into_iter();
        let outward: HashMap<_, _> = boundary.map(|quad| (sorted(quad), quad)).collect();
        let surface = |(name, members): &(String, Vec<DraftQuad>)| {
            let mut quads = Vec::with_capacity(members.len());
            let mut seen = HashSet::new();
            for (line, labels) in members {
                let quad = labels
                    .each_ref()
                    .map(|label| number(label).unwrap_or(u32::MAX));
                let quad = outward.get(&sorted(quad)).ok_or_else(|| {
                    self.at(*line).error(format!(
                        "a face of surface {name:?} is not on the outside of the hexahedra; \
                         choose the surface on the boundary of the mesh"
                    ))
                })?;
                if seen.insert(*quad) {
                    quads.push(*quad);
                }
            }
            let name = name.clone();
            Ok(NamedSurface { name, quads })
        };
        self.surfaces.values().map(surface).collect()
    }
}

/// Returns the number of bodies that share no nodes.
fn bodies(mesh: &HexMesh) -> usize {
    let mut parent: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    let mut count = mesh.nodes.len();
    for [first, others @ ..] in mesh.hexes.iter() {
        for other in others {
            let [one, other] = [*first, *other].map(|node| root(&mut parent, node));
            count -= usize::from(one != other);
            parent[other as usize] = one;
        }
    }
    count
}

/// Returns the node at the root of a tree of connected nodes, and halves the path to it, which keeps the trees flat.
fn root(parent: &mut [u32], mut node: u32) -> u32 {
    while parent[node as usize] != node {
        let above = parent[parent[node as usize] as usize];
        parent[node as usize] = above;
        node = above;
    }
    node
}

pub(crate) fn sorted<T: Ord>(mut quad: [T; 4]) -> [T; 4] {
    quad.sort_unstable();
    quad
}

/// Error of a volume element that is not an 8-node hexahedron; `names`: of other kinds by their numbers.
pub(crate) fn not_hexahedron(
    at: At,
    element: u64,
    kind: impl Display,
    names: &[(i64, &str)],
) -> MeshFileError {
    let kind = kind.to_string();
    let name = names.iter().find(|(number, _)| number.to_string() == kind);
    let name = name.map_or_else(String::new, |(_, name)| format!(" ({name})"));
    at.error(format!(
        "element {element} is of type {kind}{name}; only 8-node hexahedra can be read, \
         so mesh the insert with those"
    ))
}

/// A hexahedral mesh from a file, with its named surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct HexFile {
    /// The hexahedra and their nodes, in the file's unit and axes and in its order; nodes that no
    /// hexahedron uses are left out.
    pub mesh: HexMesh,
    /// Named parts of the boundary, in the order of the file.
    pub surfaces: Vec<NamedSurface>,
}

impl HexFile {
    /// Returns the boundary of the hexahedra as triangles, facing outwards.
    pub fn mesh_of_boundary(&self) -> TriangleMesh {
        TriangleMesh::of_quads(self.mesh.nodes.clone(), self.mesh.boundary_quads())
    }

    /// Returns the surface of that name; case is ignored.
    pub fn surface(&self, name: &str) -> Option<&NamedSurface> {
        let mut surfaces = self.surfaces.iter();
        surfaces.find(|surface| surface.name.eq_ignore_ascii_case(name))
    }
}

/// A named part of the boundary of a hexahedral mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedSurface {
    /// Name as written in the file.
    pub name: String,
    /// Node numbers from 0, anticlockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
}
