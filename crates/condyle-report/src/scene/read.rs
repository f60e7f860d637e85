//! A scene read from a results folder.

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use condyle_mesh::formats::{VtuFile, parse_vtu_triangles, read_vtu_points};
use condyle_results::{KeptCycle, catalogue::UPDATES, check_file, cycle_pressure_file};

use super::{Scene, SceneBody, SceneCycle};
use crate::{
    error::ReportError,
    results::{
        contents::Results,
        read::{meshes, table, without_folder},
        table::Table,
    },
};

/// Point data that is 1 on nodes of the articulating surface.
const ARTICULATING: &str = "articulating";

/// Files that only what moves needs, and what is so without each.
const MOVING_FILES: [(&str, &str); 4] = [
    ("femur.vtu", "the femur is not shown"),
    ("femur_pose.csv", "nothing moves through the cycle"),
    (
        "cycle_first_pressure.csv",
        "the first cycle has no pressures",
    ),
    ("cycle_last_pressure.csv", "the last cycle has no pressures"),
];

/// Increments of a cycle by the text of their percent.
type ByPercent = BTreeMap<u64, usize>;

impl Scene {
    /// What a results folder has to show; what is missing, damaged or of another version is left out, and told.
    pub fn read(folder: &Path, results: &Results) -> Self {
        let mut scene = of_meshes(folder, results);
        scene.femur = femur(folder, &mut scene.missing);
        let summary = results.summary.as_ref();
        scene.neutral_pose = summary.and_then(|summary| summary.neutral_pose);
        scene.cycles = cycles(folder, &mut scene.missing);
        let is_gone = |(name, _): &&(&str, &str)| !folder.join(name).exists();
        let gone = MOVING_FILES.iter().filter(is_gone);
        scene
            .missing
            .extend(gone.map(|(name, without)| format!("{name} is not in the folder: {without}.")));
        let tables = [
            ("wear", &results.wear),
            ("kinematics", &results.kinematics),
            ("measured_wear", &results.measured_wear),
            ("measured_kinematics", &results.measured_kinematics),
        ];
        let tables = tables.into_iter();
        scene.tables = tables
            .filter_map(|(name, table)| Some((name, table.clone()?)))
            .collect();
        scene.missing = (scene.missing.iter())
            .map(|why| without_folder(why, folder))
            .collect();
        scene
    }
}

/// The insert at every update that can be read.
fn of_meshes(folder: &Path, results: &Results) -> Scene {
    let wear = results.wear.as_ref();
    let cycles = wear
        .and_then(|wear| wear.column("cycles"))
        .unwrap_or_default();
    let mut scene = Scene::default();
    let meshes = meshes(folder).unwrap_or_default();
    let not_there = not_there(&meshes, results);
    for (update, path) in meshes {
        let cycles = match update.checked_sub(1) {
            None => 0.0,
            Some(row) => cycles.get(row as usize).copied().unwrap_or(f64::NAN),
        };
        if let Err(why) = add_mesh(&mut scene, cycles, &path) {
            scene.missing.push(why);
        }
    }
    scene.missing.extend(not_there);
    scene
}

/// Updates without a mesh, where others have one: up to the last that the summary tells of.
fn not_there(meshes: &[(u32, PathBuf)], results: &Results) -> Option<String> {
    let (last, _) = meshes.last()?;
    let summary = results.summary.as_ref();
    let told = summary.and_then(|summary| summary.get(&UPDATES));
    let all = 0..=told.map_or(*last, |updates| updates as u32).max(*last);
    let is_there = |update: &u32| meshes.iter().any(|(there, _)| there == update);
    let gone: Vec<String> = all
        .filter(|update| !is_there(update))
        .map(|update| format!("insert_{update:04}.vtu"))
        .collect();
    let (first, rest) = gone.split_first()?;
    Some(match rest {
        [] => format!("{first} is not in the folder."),
        [.., last] => format!(
            "{} files from {first} to {last} are not in the folder.",
            gone.len()
        ),
    })
}

/// Adds the mesh of an update, or says why not.
fn add_mesh(scene: &mut Scene, cycles: f64, path: &Path) -> Result<(), String> {
    let file = read_mesh(path).map_err(|error| error.to_string())?;
    if scene.insert.is_none() {
        let marks = file.values(ARTICULATING);
        let begun = marks.and_then(|marks| Scene::of_insert(&file.mesh, marks));
        let missing = std::mem::take(&mut scene.missing);
        *scene = begun.ok_or_else(|| without(path, "has no articulating surface"))?;
        scene.missing = missing;
    }
    let fields = file.point_data.iter();
    let fields = fields.map(|(name, values)| (name.as_str(), values.as_slice()));
    if scene.add_update(cycles, &file.mesh.nodes, fields) {
        return Ok(());
    }
    Err(without(
        path,
        "is of another insert than the file before it",
    ))
}

fn without(path: &Path, why: &str) -> String {
    format!("{} {why}, and is left out.", path.display())
}

fn read_mesh(path: &Path) -> Result<VtuFile, ReportError> {
    check_file(path)?;
    Ok(read_vtu_points(path)?)
}

fn femur(folder: &Path, missing: &mut Vec<String>) -> Option<SceneBody> {
    let path = folder.join("femur.vtu");
    let bytes = fs::read(&path).ok()?;
    let checked = check_file(&path).map_err(ReportError::from);
    let read = checked.and_then(|()| Ok(parse_vtu_triangles(&path, &bytes)?));
    match read {
        Ok(mesh) => Some(SceneBody {
            nodes: mesh.vertices,
            triangles: mesh.triangles,
        }),
        Err(error) => {
            missing.push(error.to_string());
            None
        }
    }
}

/// The cycles of `femur_pose.csv`, with their pressures where the folder has them.
fn cycles(folder: &Path, missing: &mut Vec<String>) -> Vec<SceneCycle> {
    let Some(poses) = read_table(&folder.join("femur_pose.csv"), missing) else {
        return Vec::new();
    };
    let mut cycles = SceneCycle::of_poses(&poses);
    for (cycle, kept) in cycles.iter_mut().zip(KeptCycle::BOTH) {
        let file: PathBuf = folder.join(cycle_pressure_file(kept));
        if let Some(pressures) = read_table(&file, missing) {
            cycle.add_pressures(&pressures);
        }
    }
    cycles
}

fn read_table(path: &Path, missing: &mut Vec<String>) -> Option<Table> {
    table(path).unwrap_or_else(|error| {
        missing.push(error.to_string());
        None
    })
}

impl SceneCycle {
    /// The cycles whose poses a table like `femur_pose.csv` has, the first and the last.
    pub fn of_poses(poses: &Table) -> Vec<Self> {
        let columns: Option<Vec<&[f64]>> = poses
            .names()
            .iter()
            .map(|name| poses.column(name))
            .collect();
        let Some([cycles, percents, numbers @ ..]) = columns.as_deref() else {
            return Vec::new();
        };
        let mut found: Vec<Self> = Vec::new();
        for row in 0..poses.rows() {
            let Ok(pose) =
                <[f64; 12]>::try_from(numbers.iter().map(|column| column[row]).collect::<Vec<_>>())
            else {
                return Vec::new();
            };
            if found.last().is_none_or(|last| last.cycles != cycles[row]) {
                found.push(Self {
                    name: if found.is_empty() { "first" } else { "last" },
                    cycles: cycles[row],
                    ..Self::default()
                });
            }
            if let Some(last) = found.last_mut() {
                last.percents.push(percents[row]);
                last.poses.push(pose);
            }
        }
        found.truncate(2);
        found
    }

    /// Adds the pressures of a table like `cycle_last_pressure.csv`; what names no increment is left out.
    pub fn add_pressures(&mut self, table: &Table) {
        let column = |name| table.column(name).unwrap_or_default();
        let (percents, nodes) = (column("percent"), column("node"));
        let by_percent: ByPercent = (self.percents.iter().enumerate())
            .map(|(increment, percent)| (percent.to_bits(), increment))
            .collect();
        self.pressures = vec![Vec::new(); self.percents.len()];
        let rows = percents.iter().zip(nodes).zip(column("pressure_mpa"));
        for ((percent, node), pressure_mpa) in rows {
            if let Some(&increment) = by_percent.get(&percent.to_bits()) {
                self.pressures[increment].push((*node as u32, *pressure_mpa));
            }
        }
    }
}
