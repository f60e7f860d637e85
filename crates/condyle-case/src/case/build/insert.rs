//! The insert in hexahedra.

use std::collections::BTreeSet;

use condyle::Vec3;
use condyle::geometry::{self, GenericInsertShape, Meshing, flat_insert};
use condyle_fem::HexMesh;
use condyle_mesh::repair::CheckedMesh;

use super::super::contents::Case;
use super::super::frame::Side;
use super::super::insert::{
    FlatInsert, GenericInsert, HexahedralInsert, Insert, InsertPlacement, InsertShape, MeshInsert,
};
use super::super::run_options::Limits;
use super::error::{Body, BuildError, BuildWarning, MeshFault, MeshRemark};
use super::meshes::{Placing, ShellOf, shell};
use super::orientation_check::off_centre;
use super::orientation_check::{check_orientation, check_orientation_of_hexahedra};
use super::rigid_motion::{middle_of_mesh, middle_of_points};
use super::size::check_points;
use super::tray::without_tray;
use condyle_mesh::formats::{HexFile, parse_surface, read_hexahedra, surface_bytes};

/// Length and width of the flat block, mm, about those of the generic insert.
const FLAT_SIZE_MM: (f64, f64) = (46.0, 72.0);

impl Case {
    /// Returns the insert of this case in a mesh with twice the edge length.
    ///
    /// # Errors
    /// In words: an insert that is read as hexahedra, or that has no such mesh.
    pub fn coarser_insert(&self) -> Result<geometry::Insert, String> {
        let mut coarser = self.insert.clone();
        match &mut coarser.shape {
            InsertShape::Generic(insert) => insert.edge_mm *= 2.0,
            InsertShape::Flat(insert) => insert.edge_mm *= 2.0,
            InsertShape::Mesh(insert) => insert.edge_mm *= 2.0,
            InsertShape::Hexahedra(_) => {
                return Err("an insert read as hexahedra has no coarser mesh".to_owned());
            }
        }
        let built = self.built_insert(&coarser, &mut Vec::new());
        built.map_err(|why| why.to_string())
    }

    /// Returns the number of triangles in the file of its insert, if there is one.
    pub fn insert_triangle_count(&self) -> Option<usize> {
        let InsertShape::Mesh(insert) = &self.insert.shape else {
            return None;
        };
        let path = insert.file.path();
        let bytes = surface_bytes(insert.file.files(), path).ok()?;
        let mesh = parse_surface(path, &bytes).ok()?;
        Some(mesh.triangles.len())
    }

    pub(super) fn built_insert(
        &self,
        insert: &Insert,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<geometry::Insert, BuildError> {
        let placement = &insert.placement;
        let around = Surroundings {
            placement,
            side: self.heading.side,
            limits: &self.limits,
        };
        let built = insert.build(around, warnings)?;
        // With a stray piece the positions of the dishes are unreliable.
        let is_whole = !warnings.iter().any(|warning| {
            let BuildWarning::Mesh { remark, .. } = warning else {
                return false;
            };
            matches!(remark, MeshRemark::StrayPiece(_))
        });
        if let Some(file) = insert.file().filter(|_| is_whole) {
            warnings.extend(off_centre(file, placement, &built));
        }
        Ok(built)
    }
}

/// Settings of the case that an insert is built with.
#[derive(Clone, Copy)]
struct Surroundings<'a> {
    placement: &'a InsertPlacement,
    side: Side,
    limits: &'a Limits,
}

impl Insert {
    fn build(
        &self,
        around: Surroundings<'_>,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<geometry::Insert, BuildError> {
        match &self.shape {
            InsertShape::Generic(insert) => generic(insert, around),
            InsertShape::Flat(insert) => flat(insert, around.limits),
            InsertShape::Mesh(insert) => from_mesh(insert, around, warnings),
            InsertShape::Hexahedra(insert) => from_hexahedra(insert, around, warnings),
        }
    }
}

fn meshing(edge_mm: f64, layers: u64) -> Meshing {
    let layers = layers as usize;
    Meshing { edge_mm, layers }
}

/// Rejects a mesh of hexahedra that would not fit into memory before it is created; `size_mm` is its length and
/// width.
fn check_node_count(
    (length_mm, width_mm): (f64, f64),
    meshing: Meshing,
    limits: &Limits,
) -> Result<(), BuildError> {
    let points = |length_mm: f64| (length_mm / meshing.edge_mm).round().max(1.0) + 1.0;
    let nodes = points(length_mm) * points(width_mm) * (meshing.layers as f64 + 1.0);
    check_nodes(nodes, limits)
}

fn check_nodes(nodes: f64, limits: &Limits) -> Result<(), BuildError> {
    let (most, memory_gb) = (limits.most(Limits::BYTES_OF_INSERT_NODE), limits.memory_gb);
    if nodes <= most as f64 {
        return Ok(());
    }
    Err(BuildError::Conflict {
        table: "insert",
        keys: &["edge_mm", "layers", "file", "length_unit"],
        message: format!(
            "the insert would have {nodes:.0} nodes, and more than {most} take more than the {memory_gb} GB that [limits] \
             memory_gb allows; use a larger edge_mm or fewer layers, check length_unit, or allow more"
        ),
    })
}

fn flat(insert: &FlatInsert, limits: &Limits) -> Result<geometry::Insert, BuildError> {
    let meshing = meshing(insert.edge_mm, insert.layers);
    check_node_count(FLAT_SIZE_MM, meshing, limits)?;
    Ok(flat_insert(FLAT_SIZE_MM, insert.thickness_mm, meshing)?)
}

fn generic(
    insert: &GenericInsert,
    around: Surroundings<'_>,
) -> Result<geometry::Insert, BuildError> {
    let shape = GenericInsertShape {
        sagittal_radius_mm: insert.sagittal_radius_mm,
        coronal_radius_mm: insert.coronal_radius_mm,
        spacing_mm: insert.spacing_mm,
        thickness_mm: insert.thickness_mm,
    };
    let meshing = meshing(insert.edge_mm, insert.layers);
    check_node_count(GenericInsertShape::SIZE_MM, meshing, around.limits)?;
    // Its dishes have their middle at its origin.
    Ok(match around.placement.motion(Vec3::zeros) {
        Some(motion) => shape.insert_moved(meshing, |point| motion.point(point))?,
        None => shape.insert(meshing)?,
    })
}

fn from_mesh(
    insert: &MeshInsert,
    around: Surroundings<'_>,
    warnings: &mut Vec<BuildWarning>,
) -> Result<geometry::Insert, BuildError> {
    let placing = Placing::new(insert.length_unit, &insert.axes, around.side)?;
    let path = insert.file.path();
    let mut shell = shell(
        &insert.file,
        &placing,
        ShellOf::insert(insert.clip_below_mm),
        warnings,
    )?;
    if shell.closed && insert.thickness_mm.is_some() {
        return Err(BuildError::mesh(path, MeshFault::ThicknessOfClosed));
    }
    check_orientation(Body::Insert, &insert.file, &shell.mesh, &placing, warnings)?;
    if shell.closed && insert.clip_below_mm.is_none() {
        shell = insert_alone(insert, shell, &placing, warnings)?;
    }
    let mesh = match around.placement.motion(|| middle_of_mesh(&shell.mesh)) {
        Some(motion) => motion.mesh(shell.mesh),
        None => shell.mesh,
    };
    let meshing = meshing(insert.edge_mm, insert.layers);
    let (low, high) = mesh.bounds();
    check_node_count((high.x - low.x, high.z - low.z), meshing, around.limits)?;
    let built = geometry::Insert::over_holes(&mesh, shell.closed, insert.thickness_mm, meshing);
    let (built, holes) =
        built.map_err(|error| BuildError::mesh(path, MeshFault::ShellInsert(error)))?;
    if !holes.is_empty() {
        let remark = MeshRemark::Bridged {
            holes,
            beside_mm: meshing.edge_mm,
        };
        warnings.push(BuildWarning::mesh(&insert.file, remark));
    }
    Ok(built)
}

/// Removes a tray that is in the same file; the orientation of the remaining insert is checked again.
fn insert_alone(
    insert: &MeshInsert,
    shell: CheckedMesh,
    placing: &Placing,
    warnings: &mut Vec<BuildWarning>,
) -> Result<CheckedMesh, BuildError> {
    let count = shell.mesh.triangles.len();
    let alone = without_tray(&insert.file, shell, warnings)?;
    if alone.mesh.triangles.len() != count {
        check_orientation(Body::Insert, &insert.file, &alone.mesh, placing, warnings)?;
    }
    Ok(alone)
}

fn from_hexahedra(
    insert: &HexahedralInsert,
    around: Surroundings<'_>,
    warnings: &mut Vec<BuildWarning>,
) -> Result<geometry::Insert, BuildError> {
    let placing = Placing::new(insert.length_unit, &insert.axes, around.side)?;
    let path = insert.file.path();
    let mut file = read_hexahedra(insert.file.files(), path)?;
    place(&mut file, &placing);
    check_points(path, &file.mesh.nodes, insert.length_unit)?;
    check_nodes(file.mesh.nodes.len() as f64, around.limits)?;
    check_orientation_of_hexahedra(&insert.file, &file.mesh, &placing, warnings)?;
    let surface = |key, name: &Option<String>, up: f64| match name {
        Some(name) => named(&file, key, name, insert),
        None => Ok(facing(&file.mesh, up)),
    };
    let articulating = surface("articulating_surface", &insert.articulating_surface, 1.0)?;
    let backside = surface("backside", &insert.backside, -1.0)?;
    let middle = || middle_of_points(&corners(&file.mesh, &articulating));
    if let Some(motion) = around.placement.motion(middle) {
        let nodes = file.mesh.nodes.iter_mut();
        nodes.for_each(|node| *node = motion.point(node));
    }
    Ok(geometry::Insert::new(file.mesh, &articulating, &backside)?)
}

fn corners(mesh: &HexMesh, quads: &[[u32; 4]]) -> Vec<Vec3> {
    let nodes: BTreeSet<u32> = quads.iter().flatten().copied().collect();
    let nodes = nodes.into_iter();
    nodes.map(|node| mesh.nodes[node as usize]).collect()
}

/// Moves nodes into the frame, and restores the orientation of hexahedra and faces if that mirrors.
fn place(file: &mut HexFile, placing: &Placing) {
    let nodes = &mut file.mesh.nodes;
    nodes
        .iter_mut()
        .for_each(|node| *node = placing.point(node));
    if placing.mirrors {
        let swapped = |[a, b, c, d, e, f, g, h]: [u32; 8]| [e, f, g, h, a, b, c, d];
        file.mesh.hexes = file.mesh.hexes.iter().copied().map(swapped).collect();
        let quads = file
            .surfaces
            .iter_mut()
            .flat_map(|surface| &mut surface.quads);
        quads.for_each(|quad| quad.reverse());
    }
}

fn named(
    file: &HexFile,
    key: &'static str,
    name: &str,
    insert: &HexahedralInsert,
) -> Result<Vec<[u32; 4]>, BuildError> {
    match file.surface(name) {
        Some(surface) => Ok(surface.quads.clone()),
        None => {
            let names = file.surfaces.iter().map(|surface| surface.name.clone());
            let fault = MeshFault::NoSurface {
                key,
                name: name.to_owned(),
                names: names.collect(),
            };
            Err(BuildError::mesh(insert.file.path(), fault))
        }
    }
}

/// A face counts as seen from above or below if it leans by less than 60 degrees.
const MIN_COSINE: f64 = 0.5;

/// Returns the faces of the boundary that face up (`up` 1) or down (-1).
fn facing(mesh: &HexMesh, up: f64) -> Vec<[u32; 4]> {
    let upward = |quad: &[u32; 4]| {
        let [a, b, c, d]: [Vec3; 4] = quad.map(|node| mesh.nodes[node as usize]);
        let normal = (c - a).cross(&(d - b));
        up * normal.y > MIN_COSINE * normal.norm()
    };
    mesh.boundary_quads().into_iter().filter(upward).collect()
}
