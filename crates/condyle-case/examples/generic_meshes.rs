//! Writes the generic pair as meshes, femur.stl and insert.stl in mm, into the folder that is named.

use std::error::Error;
use std::fs::File;
use std::path::PathBuf;

use condyle::geometry::{
    GenericFemur, GenericFemurShape, GenericInsertShape, Meshing, TriangleMesh,
};
use condyle_mesh::formats::write_stl;

const EDGE_MM: f64 = 1.0;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    let folder = folder.ok_or("name a folder to write femur.stl and insert.stl into")?;
    let femur = GenericFemur::new(GenericFemurShape::default()).surface_mesh(EDGE_MM);
    write_stl(File::create(folder.join("femur.stl"))?, &femur)?;
    let (edge_mm, layers) = (EDGE_MM, 4);
    let insert = GenericInsertShape::default().insert(Meshing { edge_mm, layers })?;
    let mesh = insert.mesh();
    let shell = TriangleMesh::of_quads(mesh.nodes.clone(), mesh.boundary_quads());
    write_stl(File::create(folder.join("insert.stl"))?, &shell)?;
    Ok(())
}
