//! A scene read from a results folder.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use condyle_mesh::{TriangleMesh, formats::parse_vtu_triangles};
use condyle_results::{KeptCycle, catalogue::UPDATES, check_file, cycle_pressure_file};

use super::{Scene, SceneCycle, SceneInsert};
use crate::charts;
use crate::error::ReportError;
use crate::results::{
    ARTICULATING, CaseFacts, Results, Table, meshes, read_mesh, table, without_folder,
};

/// Files that only the 3-D view needs, and the consequence of the lack of each.
const MOVING_FILES: [(&str, &str); 4] = [
    ("femur.vtu", "the femur is not shown"),
    ("femur_pose.csv", "the bodies do not move through the cycle"),
    (
        "cycle_first_pressure.csv",
        "the first cycle has no pressures",
    ),
    ("cycle_last_pressure.csv", "the last cycle has no pressures"),
];

impl Scene {
    /// Reads the scene of a results folder; parts that are missing, damaged or from another version are omitted and
    /// listed in `missing`.
    pub fn read(folder: &Path, results: &Results) -> Self {
        let wear = results.wear.as_ref();
        let cycles = wear
            .and_then(|wear| wear.column("cycles"))
            .unwrap_or_default();
        let mut scene = Self::default();
        let meshes = meshes(folder).unwrap_or_default();
        let gone = not_there(&meshes, results);
        for (update, path) in meshes {
            // Row 0 of wear.csv is the first update; the unworn insert has no row.
            let cycles = match update.checked_sub(1) {
                None => 0.0,
                Some(row) => cycles.get(row as usize).copied().unwrap_or(f64::NAN),
            };
            if let Err(why) = add_mesh(&mut scene, cycles, &path) {
                scene.missing.push(why);
            }
        }
        scene.missing.extend(gone);
        scene.femur = femur(folder, &mut scene.missing);
        let summary = results.summary.as_ref();
        scene.neutral_pose = summary.and_then(|summary| summary.neutral_pose);
        scene.cycles = kept_cycles(folder, &mut scene.missing);
        scene.charts = charts::all(results);
        scene.directions = results.directions();
        let facts = results.case.as_deref().map(CaseFacts::of);
        scene.title = facts.and_then(|facts| facts.title).unwrap_or_default();
        for (name, without) in MOVING_FILES {
            if !folder.join(name).exists() {
                let why = format!("{name} is not in the folder: {without}.");
                scene.missing.push(why);
            }
        }
        for why in &mut scene.missing {
            *why = without_folder(why, folder);
        }
        scene
    }
}

/// Returns the meshes that are missing, up to the last update that the summary states.
fn not_there(meshes: &[(u32, PathBuf)], results: &Results) -> Option<String> {
    let (last, _) = meshes.last()?;
    let summary = results.summary.as_ref();
    let stated = summary.and_then(|summary| summary.get(&UPDATES));
    let last = stated.map_or(*last, |updates| (updates as u32).max(*last));
    let is_gone = |update: &u32| meshes.iter().all(|(there, _)| there != update);
    let gone: Vec<u32> = (0..=last).filter(is_gone).collect();
    let name = |update: &u32| format!("insert_{update:04}.vtu");
    let first = name(gone.first()?);
    Some(match gone.as_slice() {
        [.., last] if gone.len() > 1 => {
            let (count, last) = (gone.len(), name(last));
            format!("{count} files from {first} to {last} are not in the folder.")
        }
        _ => format!("{first} is not in the folder."),
    })
}

/// Adds the mesh of an update, or returns the reason why it cannot be added.
fn add_mesh(scene: &mut Scene, cycles: f64, path: &Path) -> Result<(), String> {
    let left_out = |why: &str| format!("{} {why}, and is left out.", path.display());
    let file = read_mesh(path).map_err(|error| error.to_string())?;
    let marks = file.values(ARTICULATING);
    let first = || SceneInsert::new(&file.mesh, marks?);
    let insert = scene.insert.take().or_else(first);
    let insert = insert.ok_or_else(|| left_out("has no articulating surface"))?;
    let update = scene.insert.insert(insert).update(cycles, &file);
    let other = "has another mesh than the insert before it";
    scene.updates.push(update.ok_or_else(|| left_out(other))?);
    Ok(())
}

fn femur(folder: &Path, missing: &mut Vec<String>) -> Option<TriangleMesh> {
    let path = folder.join("femur.vtu");
    let bytes = fs::read(&path).ok()?;
    let checked = check_file(&path).map_err(ReportError::from);
    let read = checked.and_then(|()| Ok(parse_vtu_triangles(&path, &bytes)?));
    or_missing(read.map(Some), missing)
}

/// Returns the cycles of `femur_pose.csv`, with their pressures where the folder has them.
fn kept_cycles(folder: &Path, missing: &mut Vec<String>) -> Vec<SceneCycle> {
    let mut read = |name: &str| or_missing(table(&folder.join(name)), missing);
    let poses = read("femur_pose.csv");
    let mut cycles = poses.map_or_else(Vec::new, |poses| SceneCycle::of_poses(&poses));
    for (cycle, kept) in cycles.iter_mut().zip(KeptCycle::BOTH) {
        if let Some(pressures) = read(&cycle_pressure_file(kept)) {
            cycle.add_pressures(&pressures);
        }
    }
    cycles
}

fn or_missing<T>(read: Result<Option<T>, ReportError>, missing: &mut Vec<String>) -> Option<T> {
    read.unwrap_or_else(|error| {
        missing.push(error.to_string());
        None
    })
}

impl SceneCycle {
    /// Makes the first and the last cycle of a table like `femur_pose.csv`; none if it has other columns.
    fn of_poses(poses: &Table) -> Vec<Self> {
        let names = poses.names().iter();
        let columns: Option<Vec<&[f64]>> = names.map(|name| poses.column(name)).collect();
        let Some([cycles, percents, numbers @ ..]) = columns.as_deref() else {
            return Vec::new();
        };
        let Ok(numbers) = <[&[f64]; 12]>::try_from(numbers) else {
            return Vec::new();
        };
        let rows = Vec::from_iter(0..poses.rows());
        let of_rows = |(rows, name): (&[usize], &'static str)| Self {
            name,
            cycles: cycles[rows[0]],
            percents: rows.iter().map(|&row| percents[row]).collect(),
            poses: rows
                .iter()
                .map(|&row| numbers.map(|column| column[row]))
                .collect(),
            pressures: Vec::new(),
        };
        let parts = rows.chunk_by(|&one, &next| cycles[one] == cycles[next]);
        parts.zip(["first", "last"]).map(of_rows).collect()
    }

    /// Adds the pressures of a table like `cycle_last_pressure.csv`; rows of unknown increments are omitted.
    fn add_pressures(&mut self, table: &Table) {
        let column = |name| table.column(name).unwrap_or_default();
        // Both files write the same percent with the same digits: its bits are a key.
        let increments = self.percents.iter().map(|percent| percent.to_bits());
        let increments: BTreeMap<u64, usize> = increments.zip(0..).collect();
        self.pressures = vec![Vec::new(); self.percents.len()];
        let rows = column("percent").iter().zip(column("node"));
        for ((percent, node), pressure_mpa) in rows.zip(column("pressure_mpa")) {
            if let Some(&increment) = increments.get(&percent.to_bits()) {
                self.pressures[increment].push((*node as u32, *pressure_mpa));
            }
        }
    }
}
