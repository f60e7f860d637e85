//! A hexahedral mesh as its reader builds it, and the checked result with its named surfaces and nodes.

use std::{
    cell::OnceCell,
    collections::{HashMap, HashSet},
    path::Path,
};

use condyle_fem::{HEX_FACES, HexMesh};

use super::error::{FileLine, MeshFileError};
use crate::Vec3;

/// Nodes, elements and sets by the labels of the file.
pub(crate) struct HexDraft<'a> {
    path: &'a Path,
    nodes: Vec<Vec3>,
    node_of_label: HashMap<u64, usize>,
    hexes: Vec<DraftHex>,
    hex_of_label: HashMap<u64, usize>,
    /// How many hexahedra have each face, counted when it is first asked for.
    uses_of_quad: OnceCell<HashMap<[u64; 4], usize>>,
    surfaces: DraftSets<(Option<usize>, [u64; 4])>,
    node_sets: DraftSets<u64>,
}

/// One hexahedron by the labels of its nodes, in VTK order.
pub(crate) struct DraftHex {
    pub(crate) label: u64,
    pub(crate) line: Option<usize>,
    pub(crate) nodes: [u64; 8],
}

impl DraftHex {
    /// The six faces by the labels of their nodes, facing outwards, S1 to S6 of Abaqus.
    pub(crate) fn quads(&self) -> [[u64; 4]; 6] {
        HEX_FACES.map(|face| face.map(|corner| self.nodes[corner]))
    }
}

/// Sets in the order of the file.
struct DraftSets<T> {
    sets: Vec<DraftSet<T>>,
    /// By the name in capitals, since names do not know their case.
    set_of_name: HashMap<String, usize>,
}

struct DraftSet<T> {
    name: String,
    members: Vec<T>,
}

impl<T> DraftSets<T> {
    fn new() -> Self {
        Self {
            sets: Vec::new(),
            set_of_name: HashMap::new(),
        }
    }

    /// Members of the set of that name, which is begun where there is none.
    fn members(&mut self, name: &str) -> &mut Vec<T> {
        let next = self.sets.len();
        let known = self.set_of_name.entry(name.to_ascii_uppercase());
        let index = *known.or_insert(next);
        if index == next {
            self.sets.push(DraftSet {
                name: name.to_string(),
                members: Vec::new(),
            });
        }
        &mut self.sets[index].members
    }
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
            surfaces: DraftSets::new(),
            node_sets: DraftSets::new(),
        }
    }

    pub(crate) fn node(
        &mut self,
        line: Option<usize>,
        label: u64,
        position: [f64; 3],
    ) -> Result<(), MeshFileError> {
        let at = FileLine::new(self.path, line);
        if position.iter().any(|coordinate| !coordinate.is_finite()) {
            let what = format!("node {label}");
            return Err(MeshFileError::NonFinite { at, what });
        }
        if self.node_of_label.insert(label, self.nodes.len()).is_some() {
            return Err(at.error(format!(
                "node {label} is given twice; number each node once"
            )));
        }
        self.nodes.push(Vec3::from(position));
        Ok(())
    }

    pub(crate) fn hex(&mut self, hex: DraftHex) -> Result<(), MeshFileError> {
        if self
            .hex_of_label
            .insert(hex.label, self.hexes.len())
            .is_some()
        {
            let what = format!(
                "element {} is given twice; number each element once",
                hex.label
            );
            return Err(FileLine::new(self.path, hex.line).error(what));
        }
        self.uses_of_quad.take();
        self.hexes.push(hex);
        Ok(())
    }

    pub(crate) fn hexes(&self) -> &[DraftHex] {
        &self.hexes
    }

    pub(crate) fn labelled_hex(&self, label: u64) -> Option<&DraftHex> {
        Some(&self.hexes[*self.hex_of_label.get(&label)?])
    }

    /// Adds a face, in any sense of turning, to the surface of that name.
    pub(crate) fn quad(&mut self, surface: &str, line: Option<usize>, nodes: [u64; 4]) {
        self.surfaces.members(surface).push((line, nodes));
    }

    /// Adds nodes to the set of that name.
    pub(crate) fn set_nodes(&mut self, set: &str, nodes: impl IntoIterator<Item = u64>) {
        self.node_sets.members(set).extend(nodes);
    }

    /// Faces of these hexahedra that no other hexahedron of the mesh shares.
    pub(crate) fn free_quads<'h>(
        &self,
        hexes: impl IntoIterator<Item = &'h DraftHex>,
    ) -> Vec<[u64; 4]> {
        let uses = self.uses_of_quad.get_or_init(|| self.count_quads());
        let quads = hexes.into_iter().flat_map(DraftHex::quads);
        quads.filter(|&quad| uses[&sorted(quad)] == 1).collect()
    }

    fn count_quads(&self) -> HashMap<[u64; 4], usize> {
        let mut uses = HashMap::new();
        for quad in self.hexes.iter().flat_map(DraftHex::quads) {
            *uses.entry(sorted(quad)).or_default() += 1;
        }
        uses
    }

    /// The mesh with its sets; an error for whatever cannot be calculated with.
    pub(crate) fn finish(self) -> Result<HexFile, MeshFileError> {
        if self.hexes.is_empty() {
            let path = self.path.to_path_buf();
            return Err(MeshFileError::NoHexahedra { path });
        }
        let full = self.all_nodes()?;
        self.check_shapes(&full)?;
        let (mesh, kept) = without_unused_nodes(&full);
        let number = |label: &u64| kept[*self.node_of_label.get(label)?];
        let node_sets = self.node_sets.sets.iter().map(|set| {
            let mut nodes: Vec<u32> = set.members.iter().filter_map(number).collect();
            nodes.sort_unstable();
            nodes.dedup();
            NamedNodes {
                name: set.name.clone(),
                nodes,
            }
        });
        let node_sets = node_sets.filter(|set| !set.nodes.is_empty()).collect();
        let surfaces = self.outward_surfaces(&mesh, number)?;
        Ok(HexFile {
            mesh,
            surfaces,
            node_sets,
        })
    }

    fn all_nodes(&self) -> Result<HexMesh, MeshFileError> {
        let mut hexes = Vec::with_capacity(self.hexes.len());
        for hex in &self.hexes {
            let mut numbers = [0; 8];
            for (number, label) in numbers.iter_mut().zip(&hex.nodes) {
                let node = self.node_of_label.get(label);
                *number = *node.ok_or_else(|| self.no_such_node(hex, *label))? as u32;
            }
            hexes.push(numbers);
        }
        let nodes = self.nodes.clone();
        let hexes = hexes.into();
        Ok(HexMesh { nodes, hexes })
    }

    fn no_such_node(&self, hex: &DraftHex, label: u64) -> MeshFileError {
        MeshFileError::IndexOutOfRange {
            at: FileLine::new(self.path, hex.line),
            what: format!("element {}", hex.label),
            index: label.cast_signed(),
            numbering: "otherwise".to_string(),
        }
    }

    fn check_shapes(&self, mesh: &HexMesh) -> Result<(), MeshFileError> {
        for (hex, quality) in self.hexes.iter().zip(mesh.qualities()) {
            if quality <= 0.0 {
                let at = FileLine::new(self.path, hex.line);
                return Err(MeshFileError::Inverted {
                    at,
                    element: hex.label,
                    quality,
                });
            }
        }
        Ok(())
    }

    fn outward_surfaces(
        &self,
        mesh: &HexMesh,
        number: impl Fn(&u64) -> Option<u32>,
    ) -> Result<Vec<NamedSurface>, MeshFileError> {
        let outward: HashMap<[u32; 4], [u32; 4]> = mesh
            .boundary_quads()
            .into_iter()
            .map(|quad| (sorted(quad), quad))
            .collect();
        let mut surfaces = Vec::new();
        for set in &self.surfaces.sets {
            let name = set.name.clone();
            let mut quads = Vec::with_capacity(set.members.len());
            let mut seen = HashSet::new();
            for (line, labels) in &set.members {
                let key = labels
                    .each_ref()
                    .map(|label| number(label).unwrap_or(u32::MAX));
                let quad = outward.get(&sorted(key)).ok_or_else(|| {
                    let at = FileLine::new(self.path, *line);
                    MeshFileError::NotOnBoundary {
                        at,
                        surface: name.clone(),
                    }
                })?;
                if seen.insert(*quad) {
                    quads.push(*quad);
                }
            }
            surfaces.push(NamedSurface { name, quads });
        }
        Ok(surfaces)
    }
}

/// The mesh without nodes that no hexahedron uses, and the new number of each old node.
fn without_unused_nodes(full: &HexMesh) -> (HexMesh, Vec<Option<u32>>) {
    let mut used = vec![false; full.nodes.len()];
    for &node in full.hexes.as_flattened() {
        used[node as usize] = true;
    }
    let mut nodes = Vec::new();
    let mut kept = vec![None; full.nodes.len()];
    for (index, position) in full
        .nodes
        .iter()
        .enumerate()
        .filter(|&(index, _)| used[index])
    {
        kept[index] = Some(nodes.len() as u32);
        nodes.push(*position);
    }
    let renumber = |node: u32| kept[node as usize].unwrap_or_default();
    let hexes = full.hexes.iter().map(|hex| hex.map(renumber)).collect();
    (HexMesh { nodes, hexes }, kept)
}

fn sorted<T: Ord>(mut quad: [T; 4]) -> [T; 4] {
    quad.sort_unstable();
    quad
}

/// A hexahedral mesh as a file gives it, with its named surfaces and node sets.
#[derive(Clone, Debug, PartialEq)]
pub struct HexFile {
    /// The hexahedra and their nodes, in the file's unit and axes and in its order; nodes that no
    /// hexahedron uses are left out.
    pub mesh: HexMesh,
    /// Named parts of the boundary, in the order of the file.
    pub surfaces: Vec<NamedSurface>,
    /// Named sets of nodes, in the order of the file.
    pub node_sets: Vec<NamedNodes>,
}

impl HexFile {
    /// The surface of that name, in whatever case the letters are.
    pub fn surface(&self, name: &str) -> Option<&NamedSurface> {
        self.surfaces
            .iter()
            .find(|surface| surface.name.eq_ignore_ascii_case(name))
    }

    /// The node set of that name, in whatever case the letters are.
    pub fn node_set(&self, name: &str) -> Option<&NamedNodes> {
        self.node_sets
            .iter()
            .find(|set| set.name.eq_ignore_ascii_case(name))
    }
}

/// A part of the boundary of a hexahedral mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedSurface {
    /// Name as written in the file.
    pub name: String,
    /// Node numbers from 0, anticlockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
}

/// A set of nodes of a hexahedral mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedNodes {
    /// Name as written in the file.
    pub name: String,
    /// Node numbers from 0, rising, each once.
    pub nodes: Vec<u32>,
}
