//! Reading a run from the folder that the command wrote.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use condyle_mesh::formats::{parse_vtu_triangles, read_pvd, read_vtu_points};
use condyle_results::check_file;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::bad_input;
use crate::record::Record;

/// The name of the array that marks the articulating surface.
const ARTICULATING: &str = "articulating";

/// The run in the folder `path`, in the form of `run_in_memory`.
#[pyfunction]
pub fn read_folder(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    py.detach(|| read(&path, true))?.into_python(py)
}

/// Reads the run in `folder`, without the fields at the nodes if they are not kept.
pub fn read(folder: &Path, keeps_fields: bool) -> PyResult<Record> {
    let Some(case) = text(&folder.join("case.toml"))? else {
        return Err(bad_input(format!(
            "{}: the folder holds no run: there is no case.toml; give the folder of `condyle run --out`",
            folder.display()
        )));
    };
    let mut record = Record {
        case,
        summary: text(&folder.join("summary.json"))?,
        tables: tables(folder)?,
        ..Record::default()
    };
    let femur = folder.join("femur.vtu");
    if let Ok(bytes) = fs::read(&femur) {
        record.femur = parse_vtu_triangles(&femur, &bytes).map_err(bad_input)?;
    }
    let updates = read_pvd(folder.join("insert.pvd")).map_err(bad_input)?;
    for (_, path) in updates.into_iter().filter(|_| keeps_fields) {
        check_file(&path).map_err(bad_input)?;
        let file = read_vtu_points(&path).map_err(bad_input)?;
        let marks = file.values(ARTICULATING).unwrap_or_default();
        let articulating = marks.iter().map(|&mark| mark == 1.0).collect();
        let scalars = file.point_data.iter();
        let scalars = scalars.map(|(name, values)| (name.as_str(), values.as_slice()));
        let scalars = scalars.filter(|(name, _)| *name != ARTICULATING);
        let vectors = file.point_vectors.iter();
        let vectors = vectors.map(|(name, values)| (name.as_str(), values.as_flattened()));
        record.push_insert(&file.mesh, articulating, scalars.chain(vectors));
    }
    Ok(record)
}

/// The texts of `wear.csv`, `femur_pose.csv` and the kinematics of every activity.
fn tables(folder: &Path) -> PyResult<BTreeMap<String, String>> {
    let mut tables = BTreeMap::new();
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let unreadable = |error| bad_input(format!("{}: {error}", folder.display()));
    for entry in entries.map_err(unreadable)? {
        let file = entry.file_name().to_string_lossy().into_owned();
        let Some(name) = file.strip_suffix(".csv") else {
            continue;
        };
        if ["wear", "femur_pose"].contains(&name) || name.starts_with("kinematics") {
            let text = text(&entry.path())?.unwrap_or_default();
            tables.insert(name.to_owned(), text);
        }
    }
    Ok(tables)
}

/// The text of a file; none if it does not exist.
fn text(path: &Path) -> PyResult<Option<String>> {
    match fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(bad_input(format!("{}: {error}", path.display()))),
    }
}
