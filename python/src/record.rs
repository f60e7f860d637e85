//! The data of a run, recorded in memory or read from a folder.

use std::collections::BTreeMap;

use condyle::Vec3;
use condyle::evolve::March;
use condyle::geometry::TriangleMesh;
use condyle_case::case::Side;
use condyle_fem::HexMesh;
use condyle_lab::RunKeeper;
use condyle_results::{
    InsertFields, femur_on_side, femur_pose_csv, kinematics_csv, kinematics_file, wear_csv,
};
use numpy::{Element, IntoPyArray, PyArrayMethods, ndarray::IntoDimension};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

/// The data of a run, with the insert at every update.
#[derive(Default)]
pub struct Record {
    /// The text of `case.toml`.
    pub case: String,
    /// The text of `summary.json`; none before the run is done.
    pub summary: Option<String>,
    /// The texts of the CSV files by their names without the ending.
    pub tables: BTreeMap<String, String>,
    /// The femur at neutral, in the insert frame.
    pub femur: TriangleMesh,
    pub hexes: Vec<[u32; 8]>,
    /// Marks the nodes of the articulating surface.
    pub articulating: Vec<bool>,
    /// Number of updates, the unworn insert included.
    pub updates: usize,
    /// Positions of the nodes, update after update, mm.
    pub points: Vec<f64>,
    /// Fields at the nodes by name.
    pub fields: BTreeMap<String, Field>,
}

/// A field at the nodes, update after update.
#[derive(Default)]
pub struct Field {
    /// Numbers of a node: 1 of a scalar, 3 of a vector.
    components: usize,
    values: Vec<f64>,
}

impl Field {
    /// Appends NaN for the nodes of updates that have no such field: the unworn insert has no stress.
    fn fill(&mut self, nodes: usize) {
        self.values.resize(nodes * self.components, f64::NAN);
    }
}

impl Record {
    /// Appends the insert of the next update.
    pub fn push_insert<'a>(
        &mut self,
        mesh: &HexMesh,
        articulating: Vec<bool>,
        fields: impl Iterator<Item = (&'a str, &'a [f64])>,
    ) {
        let nodes = articulating.len();
        if self.updates == 0 {
            self.hexes = mesh.hexes.to_vec();
        }
        self.articulating = articulating;
        let positions = mesh.nodes.iter().flat_map(|node| [node.x, node.y, node.z]);
        self.points.extend(positions);
        for (name, values) in fields {
            let field = self.fields.entry(name.to_owned()).or_default();
            field.components = values.len() / nodes.max(1);
            field.fill(self.updates * nodes);
            field.values.extend_from_slice(values);
        }
        self.updates += 1;
    }

    /// Converts the record to the dictionary `RawRun` of `_raw.py`.
    pub fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let (updates, nodes) = (self.updates, self.articulating.len());
        let fields = PyDict::new(py);
        for (name, mut field) in self.fields {
            field.fill(updates * nodes);
            let values = match field.components {
                1 => array(py, field.values, [updates, nodes])?,
                components => array(py, field.values, [updates, nodes, components])?,
            };
            fields.set_item(name, values)?;
        }
        // In single precision as in femur.vtu, so that a run is the same from memory and from its folder.
        let single = |vertex: &Vec3| vertex.map(|x| x as f32).into();
        let vertices: Vec<[f32; 3]> = self.femur.vertices.iter().map(single).collect();
        let entries = [
            ("case", self.case.into_pyobject(py)?.into_any()),
            ("summary", self.summary.into_pyobject(py)?),
            ("tables", self.tables.into_pyobject(py)?.into_any()),
            ("points_mm", array(py, self.points, [updates, nodes, 3])?),
            ("hexes", rows(py, self.hexes)?),
            ("articulating", array(py, self.articulating, [nodes])?),
            ("fields", fields.into_any()),
            ("femur_points_mm", rows(py, vertices)?),
            ("femur_triangles", rows(py, self.femur.triangles)?),
        ];
        entries.into_py_dict(py)
    }
}

/// Moves a vector into an array of NumPy with the given shape, without a copy.
pub fn array<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    shape: impl IntoDimension,
) -> PyResult<Bound<'_, PyAny>> {
    let flat = values.into_pyarray(py);
    Ok(flat.reshape(shape)?.into_any())
}

fn rows<T: Element, const N: usize>(
    py: Python<'_>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'_, PyAny>> {
    let shape = [rows.len(), N];
    array(py, rows.into_flattened(), shape)
}

/// Records in memory what the command writes into a folder.
pub struct Recorder {
    pub side: Side,
    /// Also record the insert and its fields.
    pub keeps_fields: bool,
    pub record: Record,
}

impl Recorder {
    fn push_insert(&mut self, march: &March) {
        if !self.keeps_fields {
            return;
        }
        let fields = InsertFields::of(march, self.side);
        let articulating = fields.articulating.iter().map(|&mark| mark == 1).collect();
        let scalars = fields.scalars.iter();
        let scalars = scalars.map(|(name, values)| (*name, values.as_slice()));
        let vectors = fields.vectors.iter();
        let vectors = vectors.map(|(name, values)| (*name, values.as_flattened()));
        self.record
            .push_insert(&fields.mesh, articulating, scalars.chain(vectors));
    }
}

impl RunKeeper for Recorder {
    fn settled(&mut self, march: &March, femur: &TriangleMesh) {
        self.record.femur = femur_on_side(femur, &march.neutral_pose(), self.side);
        self.push_insert(march);
    }

    fn updated(&mut self, march: &March) {
        // The fields after the last update are those of the final cycle, which comes next.
        if !march.is_worn() || march.is_done() {
            self.push_insert(march);
        }
        if !march.is_done() {
            return;
        }
        let tables = &mut self.record.tables;
        tables.insert("wear".into(), wear_csv(&march.state().updates));
        tables.insert("femur_pose".into(), femur_pose_csv(march, self.side));
        for (number, activity) in march.test().activities.iter().enumerate() {
            let name = kinematics_file(number, &activity.name);
            let text = kinematics_csv(march, number);
            tables.insert(name.trim_end_matches(".csv").to_owned(), text);
        }
    }
}
