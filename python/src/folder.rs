//! A run read from the folder that the command wrote.

use std::fs;
use std::path::{Path, PathBuf};

use condyle_mesh::formats::{VtuFile, parse_vtu_triangles, read_pvd, read_vtu_points};
use condyle_results::check_file;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::bad_input;
use crate::record::{InsertRecord, Record};
use crate::table::Table;

/// The run in the folder `path`, as `run_in_memory` gives one.
#[pyfunction]
pub fn read_folder(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    py.detach(|| read(&path))?.into_python(py)
}

/// The run in `folder`.
pub fn read(folder: &Path) -> PyResult<Record> {
    let case = text(&folder.join("case.toml"))?;
    let Some(case) = case else {
        let said = format!(
            "{}: the folder holds no run: there is no case.toml; give the folder of `condyle run --out`",
            folder.display()
        );
        return Err(bad_input(&said));
    };
    let femur = folder.join("femur.vtu");
    let femur = match fs::read(&femur) {
        Ok(bytes) => parse_vtu_triangles(&femur, &bytes).map_err(|error| bad_input(&error))?,
        Err(_) => Default::default(),
    };
    Ok(Record {
        case,
        summary: text(&folder.join("summary.json"))?,
        tables: tables(folder)?,
        insert: insert(folder)?,
        femur,
    })
}

fn insert(folder: &Path) -> PyResult<InsertRecord> {
    let mut insert = InsertRecord::default();
    let series = read_pvd(folder.join("insert.pvd")).map_err(|error| bad_input(&error))?;
    for (_, path) in series {
        check_file(&path).map_err(|error| bad_input(&error))?;
        let file = read_vtu_points(&path).map_err(|error| bad_input(&error))?;
        push(&mut insert, &file);
    }
    Ok(insert)
}

fn push(insert: &mut InsertRecord, file: &VtuFile) {
    let marks = file.values(ARTICULATING).unwrap_or_default();
    insert.articulating = marks.iter().map(|&mark| mark == 1.0).collect();
    let scalars = file
        .point_data
        .iter()
        .filter(|(name, _)| name != ARTICULATING);
    insert.push(
        &file.mesh,
        scalars.map(|(name, values)| (name.as_str(), values.as_slice())),
        file.point_vectors
            .iter()
            .map(|(name, values)| (name.as_str(), values.as_slice())),
    );
}

/// The array that marks the articulating surface.
const ARTICULATING: &str = "articulating";

/// `wear.csv`, `femur_pose.csv`, and the motions of every activity.
fn tables(folder: &Path) -> PyResult<Vec<(String, Table)>> {
    let refused = |error| bad_input(&format!("{}: {error}", folder.display()));
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(refused)? {
        let name = entry
            .map_err(refused)?
            .file_name()
            .to_string_lossy()
            .into_owned();
        if let Some(name) = name.strip_suffix(".csv") {
            names.push(name.to_owned());
        }
    }
    names.retain(|name| {
        ["wear", "femur_pose"].contains(&name.as_str()) || name.starts_with("kinematics")
    });
    names.sort();
    let table = |name: String| Ok((name.clone(), table(&folder.join(name + ".csv"))?));
    names.into_iter().map(table).collect()
}

fn table(path: &Path) -> PyResult<Table> {
    let text = text(path)?.unwrap_or_default();
    Table::parse(&text).ok_or_else(|| {
        bad_input(&format!(
            "{}: this is not the table that a run writes; run the case anew",
            path.display()
        ))
    })
}

fn text(path: &Path) -> PyResult<Option<String>> {
    match fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(bad_input(&format!("{}: {error}", path.display()))),
    }
}
