//! The insert in hexahedra.

use condyle::Vec3;
use condyle::geometry::{self, GenericInsertShape, Meshing, flat_insert, insert_from_shell};
use condyle_fem::HexMesh;

use super::super::contents::Case;
use super::super::heading::Side;
use super::super::insert::{HexahedralInsert, Insert, MeshInsert};
use super::body_size::check_points;
use super::error::{BuildError, BuildWarning};
use super::lie::{check_lie, check_lie_of_hexahedra};
use super::meshes::{Faces, Placing, shell};
use super::wrong_axes::Body;
use crate::mesh::{HexFile, read_hexahedra};

/// Length and width of the flat block, mm, about those of the generic insert.
const FLAT_SIZE_MM: (f64, f64) = (46.0, 72.0);

impl Case {
    /// The insert of this case in a mesh of twice the edge.
    ///
    /// # Errors
    /// In words: an insert that is read as hexahedra, or that has no such mesh.
    pub fn coarser_insert(&self) -> Result<geometry::Insert, String> {
        let mut coarser = self.insert.clone();
        match &mut coarser {
            Insert::Generic(insert) => insert.edge_mm *= 2.0,
            Insert::Flat(insert) => insert.edge_mm *= 2.0,
            Insert::Mesh(insert) => insert.edge_mm *= 2.0,
            Insert::Hexahedra(_) => {
                return Err("an insert read as hexahedra has no coarser mesh".to_owned());
            }
        }
        let built = coarser.build(self.heading.side, &mut Vec::new());
        built.map_err(|why| why.to_string())
    }
}

impl Insert {
    pub(super) fn build(
        &self,
        side: Side,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<geometry::Insert, BuildError> {
        Ok(match self {
            Self::Generic(insert) => GenericInsertShape {
                sagittal_radius_mm: insert.sagittal_radius_mm,
                coronal_radius_mm: insert.coronal_radius_mm,
                spacing_mm: insert.spacing_mm,
                thickness_mm: insert.thickness_mm,
            }
            .insert(meshing(insert.edge_mm, insert.layers))?,
            Self::Flat(insert) => flat_insert(
                FLAT_SIZE_MM,
                insert.thickness_mm,
                meshing(insert.edge_mm, insert.layers),
            )?,
            Self::Mesh(insert) => from_mesh(insert, side, warnings)?,
            Self::Hexahedra(insert) => from_hexahedra(insert, side, warnings)?,
        })
    }
}

fn meshing(edge_mm: f64, layers: u64) -> Meshing {
    let layers = layers as usize;
    Meshing { edge_mm, layers }
}

fn from_mesh(
    insert: &MeshInsert,
    side: Side,
    warnings: &mut Vec<BuildWarning>,
) -> Result<geometry::Insert, BuildError> {
    let placing = Placing::new(insert.length_unit, &insert.axes, side)?;
    let path = insert.file.path();
    let shell = shell(&insert.file, &placing, Faces::Up, warnings)?;
    let file = || path.to_path_buf();
    if shell.closed && insert.thickness_mm.is_some() {
        return Err(BuildError::ThicknessOfClosed { file: file() });
    }
    check_lie(Body::Insert, &insert.file, &shell.mesh, &placing, warnings)?;
    let meshing = meshing(insert.edge_mm, insert.layers);
    insert_from_shell(&shell.mesh, shell.closed, insert.thickness_mm, meshing).map_err(|source| {
        BuildError::ShellInsert {
            file: file(),
            source,
        }
    })
}

fn from_hexahedra(
    insert: &HexahedralInsert,
    side: Side,
    warnings: &mut Vec<BuildWarning>,
) -> Result<geometry::Insert, BuildError> {
    let placing = Placing::new(insert.length_unit, &insert.axes, side)?;
    let path = insert.file.path();
    let mut file = read_hexahedra(insert.file.files(), path)?;
    place(&mut file, &placing);
    check_points(path, &file.mesh.nodes, insert.length_unit)?;
    check_lie_of_hexahedra(&insert.file, &file.mesh, &placing, warnings)?;
    let surface = |key, name: &Option<String>, up: f64| match name {
        Some(name) => named(&file, key, name, insert),
        None => Ok(facing(&file.mesh, up)),
    };
    let articulating = surface("articulating_surface", &insert.articulating_surface, 1.0)?;
    let backside = surface("backside", &insert.backside, -1.0)?;
    Ok(geometry::Insert::new(file.mesh, &articulating, &backside)?)
}

/// Moves nodes into the frame; where that mirrors, turns hexahedra and faces the right way again.
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
        None => Err(BuildError::NoSurface {
            file: insert.file.path().to_path_buf(),
            key,
            name: name.to_owned(),
            names: file
                .surfaces
                .iter()
                .map(|surface| surface.name.clone())
                .collect(),
        }),
    }
}

/// A face counts as seen from above or below if it leans by less than 60 degrees.
const LEAST_COSINE: f64 = 0.5;

/// The faces of the boundary that look up (`up` 1) or down (-1).
fn facing(mesh: &HexMesh, up: f64) -> Vec<[u32; 4]> {
    let upward = |quad: &[u32; 4]| {
        let [a, b, c, d]: [Vec3; 4] = quad.map(|node| mesh.nodes[node as usize]);
        let normal = (c - a).cross(&(d - b));
        up * normal.y > LEAST_COSINE * normal.norm()
    };
    mesh.boundary_quads().into_iter().filter(upward).collect()
}
