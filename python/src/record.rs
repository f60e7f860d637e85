//! What is known of a run, whether it was kept in memory or in a folder.

use condyle::{Vec3, geometry::TriangleMesh};
use condyle_fem::HexMesh;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::table::Table;

/// What is known of a run.
#[derive(Default)]
pub struct Record {
    /// `case.toml`.
    pub case: String,
    /// `summary.json`, of a run that is done.
    pub summary: Option<String>,
    /// Each with the name of its file, without the ending.
    pub tables: Vec<(String, Table)>,
    pub insert: InsertRecord,
    /// The femur at neutral, in the insert frame.
    pub femur: TriangleMesh,
}

/// The insert at every update.
#[derive(Default)]
pub struct InsertRecord {
    pub hexes: Vec<[u32; 8]>,
    /// Nodes of the articulating surface.
    pub articulating: Vec<bool>,
    /// How many updates there are, the unworn insert with them.
    pub updates: usize,
    /// Places of the nodes, update after update, mm.
    points: Vec<f64>,
    scalars: Vec<(String, Vec<f64>)>,
    vectors: Vec<(String, Vec<f64>)>,
}

impl InsertRecord {
    /// Keeps the insert of the next update.
    pub fn push<'a>(
        &mut self,
        mesh: &HexMesh,
        scalars: impl Iterator<Item = (&'a str, &'a [f64])>,
        vectors: impl Iterator<Item = (&'a str, &'a [[f64; 3]])>,
    ) {
        if self.updates == 0 {
            self.hexes = mesh.hexes.to_vec();
        }
        let places = mesh.nodes.iter().flat_map(|node| [node.x, node.y, node.z]);
        self.points.extend(places);
        for (name, values) in scalars {
            named(&mut self.scalars, name).extend_from_slice(values);
        }
        for (name, values) in vectors {
            named(&mut self.vectors, name).extend_from_slice(values.as_flattened());
        }
        self.updates += 1;
    }

    fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let (updates, nodes) = (self.updates, self.articulating.len());
        let fields = PyDict::new(py);
        for (name, values) in self.scalars {
            fields.set_item(name, array(py, values, [updates, nodes])?)?;
        }
        for (name, values) in self.vectors {
            fields.set_item(name, array(py, values, [updates, nodes, 3])?)?;
        }
        let insert = PyDict::new(py);
        insert.set_item("points_mm", array(py, self.points, [updates, nodes, 3])?)?;
        insert.set_item("hexes", rows(py, self.hexes)?)?;
        insert.set_item("articulating", array(py, self.articulating, [nodes])?)?;
        insert.set_item("fields", fields)?;
        Ok(insert)
    }
}

/// The array of that name, put there if it is not.
fn named<'a>(arrays: &'a mut Vec<(String, Vec<f64>)>, name: &str) -> &'a mut Vec<f64> {
    let place = arrays.iter().position(|(known, _)| known == name);
    let place = place.unwrap_or_else(|| {
        arrays.push((name.to_owned(), Vec::new()));
        arrays.len() - 1
    });
    &mut arrays[place].1
}

fn rows<const N: usize>(py: Python<'_>, rows: Vec<[u32; N]>) -> PyResult<Bound<'_, PyAny>> {
    let shape = [rows.len(), N];
    array(py, rows.into_flattened(), shape)
}

impl Record {
    /// As the dictionary that `_condyle.pyi` describes.
    pub fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let tables = PyDict::new(py);
        for (name, table) in self.tables {
            tables.set_item(name, table.into_python(py)?)?;
        }
        let vertices = self.femur.vertices.iter();
        // As femur.vtu has them, so that a run is the same from memory and from its folder.
        let single = |place: &Vec3| [place.x as f32, place.y as f32, place.z as f32];
        let vertices: Vec<f32> = vertices.flat_map(single).collect();
        let shape = [vertices.len() / 3, 3];
        let all = PyDict::new(py);
        all.set_item("case", self.case)?;
        all.set_item("summary", self.summary)?;
        all.set_item("tables", tables)?;
        all.set_item("insert", self.insert.into_python(py)?)?;
        all.set_item("femur_points_mm", array(py, vertices, shape)?)?;
        all.set_item("femur_triangles", rows(py, self.femur.triangles)?)?;
        Ok(all)
    }
}
