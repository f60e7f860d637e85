//! A scene as bytes.

use condyle_fem::Vec3;
use condyle_results::NeutralPose;
use serde::Serialize;

use super::{
    Scene, SceneBody, SceneCycle,
    arrays::{Arrays, range},
};
use crate::results::table::Table;

/// Triangles of the femur in a picture: with more, a processor does not draw thirty pictures a second.
const FEMUR_TRIANGLES: usize = 3000;
/// The same of the insert's walls and backside, which nothing is read from.
const SKIN_TRIANGLES: usize = 1200;

/// What is said of a scene beside its arrays.
#[derive(Serialize)]
struct Facts<'a> {
    updates: Vec<f64>,
    fields: Vec<&'a str>,
    cycles: Vec<CycleFacts>,
    neutral_pose: Option<NeutralPose>,
    has_femur: bool,
    tables: Vec<TableFacts<'a>>,
    missing: &'a [String],
}

#[derive(Serialize)]
struct CycleFacts {
    name: &'static str,
    cycles: f64,
    increments: usize,
    has_pressure: bool,
}

#[derive(Serialize)]
struct TableFacts<'a> {
    name: &'a str,
    columns: &'a [String],
}

impl Scene {
    /// The scene as the page's programs read it: a list of arrays, then the arrays, places and fields in 16 bits of
    /// their range.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut arrays = Arrays::default();
        self.add_insert(&mut arrays);
        let fields = self.add_fields(&mut arrays);
        if let Some(femur) = &self.femur {
            add_body(&mut arrays, "femur", &femur.coarser(FEMUR_TRIANGLES));
        }
        for cycle in &self.cycles {
            self.add_cycle(&mut arrays, cycle);
        }
        for (name, table) in &self.tables {
            add_table(&mut arrays, name, table);
        }
        arrays.to_bytes(&self.facts(fields))
    }

    fn facts<'a>(&'a self, fields: Vec<&'a str>) -> Facts<'a> {
        let of_cycle = |cycle: &SceneCycle| CycleFacts {
            name: cycle.name,
            cycles: cycle.cycles,
            increments: cycle.percents.len(),
            has_pressure: cycle.pressures.iter().any(|pressed| !pressed.is_empty()),
        };
        let of_table = |(name, table): &'a (&'static str, Table)| TableFacts {
            name,
            columns: table.names(),
        };
        Facts {
            updates: self.updates.iter().map(|update| update.cycles).collect(),
            fields,
            cycles: self.cycles.iter().map(of_cycle).collect(),
            neutral_pose: self.neutral_pose,
            has_femur: self.femur.is_some(),
            tables: self.tables.iter().map(of_table).collect(),
            missing: &self.missing,
        }
    }

    fn add_insert(&self, arrays: &mut Arrays) {
        let (Some(insert), Some(first)) = (&self.insert, self.updates.first()) else {
            return;
        };
        arrays.whole("surface.quads", insert.articulating.quads.as_flattened());
        add_body(arrays, "skin", &insert.skin.coarser(SKIN_TRIANGLES));
        add_places(arrays, "surface.nodes", &first.nodes);
        let moved = |update: usize| {
            let nodes = self.updates[update].nodes.iter().zip(&first.nodes);
            nodes.flat_map(|(now, unworn)| <[f64; 3]>::from(now - unworn))
        };
        let all = 0..self.updates.len();
        let of_all = range(all.clone().flat_map(moved));
        for update in all {
            arrays.quantised(format!("surface.moved.{update}"), moved(update), of_all);
        }
    }

    /// Adds the fields that every update has, and gives their names.
    fn add_fields(&self, arrays: &mut Arrays) -> Vec<&str> {
        let Some(last) = self.updates.last() else {
            return Vec::new();
        };
        let names = last.fields.iter().map(|(name, _)| name.as_str());
        let mut kept = Vec::new();
        for name in names.filter(|name| *name != "articulating") {
            let of_update = |(_, values): &(String, Vec<f64>)| values.clone();
            let found = self.updates.iter().map(|update| {
                let own = update.fields.iter().find(|(known, _)| known == name);
                own.map(of_update)
            });
            let Some(found) = found.collect::<Option<Vec<_>>>() else {
                continue;
            };
            let of_all = range(found.iter().flatten().copied());
            for (update, values) in found.iter().enumerate() {
                let values = values.iter().copied();
                arrays.quantised(format!("field.{name}.{update}"), values, of_all);
            }
            kept.push(name);
        }
        kept
    }

    fn add_cycle(&self, arrays: &mut Arrays, cycle: &SceneCycle) {
        let name = cycle.name;
        arrays.exact(format!("cycle.{name}.percents"), cycle.percents.clone());
        let poses = cycle.poses.iter().flatten().copied();
        arrays.exact(format!("cycle.{name}.poses"), poses);
        let Some(insert) = &self.insert else {
            return;
        };
        let place = |node: u32| insert.articulating.nodes.binary_search(&node).ok();
        let (mut starts, mut nodes, mut pressures) = (vec![0], Vec::new(), Vec::new());
        for pressed in &cycle.pressures {
            for &(node, pressure_mpa) in pressed {
                if let Some(node) = place(node) {
                    nodes.push(node as u32);
                    pressures.push(pressure_mpa);
                }
            }
            starts.push(nodes.len() as u32);
        }
        arrays.whole(format!("cycle.{name}.starts"), &starts);
        arrays.whole(format!("cycle.{name}.nodes"), &nodes);
        let [_, highest] = range(pressures.iter().copied());
        let pressures = pressures.iter().copied();
        arrays.quantised(
            format!("cycle.{name}.pressure_mpa"),
            pressures,
            [0.0, highest],
        );
    }
}

fn add_body(arrays: &mut Arrays, name: &str, body: &SceneBody) {
    add_places(arrays, &format!("{name}.nodes"), &body.nodes);
    arrays.whole(format!("{name}.triangles"), body.triangles.as_flattened());
}

fn add_places(arrays: &mut Arrays, name: &str, nodes: &[Vec3]) {
    let values = nodes.iter().flat_map(|node| <[f64; 3]>::from(*node));
    arrays.quantised(name, values.clone(), range(values));
}

fn add_table(arrays: &mut Arrays, name: &str, table: &Table) {
    for column in table.names() {
        let values = table.column(column).unwrap_or_default().iter().copied();
        arrays.exact(format!("table.{name}.{column}"), values);
    }
}
