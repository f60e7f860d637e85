//! A scene as bytes.

use condyle_mesh::{PICTURE_DEVIATION_MM, TriangleMesh, Vec3, coarser, split_at_creases};
use serde_json::{Value, json};

use super::{Scene, SceneCycle, SceneUpdate};
use crate::figure::{Curve, Panel, finite_range};
use crate::maps;
use crate::number::in_words;
use crate::results::ARTICULATING;

impl Scene {
    /// Encodes the scene as the page's programs read it; places and fields have 16 bits of their range.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut arrays = Arrays::default();
        self.add_insert(&mut arrays);
        let fields = self.add_fields(&mut arrays);
        if let Some(femur) = &self.femur {
            add_body(&mut arrays, "femur", femur);
        }
        for cycle in &self.cycles {
            self.add_cycle(&mut arrays, cycle);
        }
        for panel in &self.charts {
            for (number, curve) in panel.curves.iter().enumerate() {
                let name = |axis| format!("chart.{}.{number}.{axis}", panel.id);
                arrays.exact(&name('x'), curve.points.iter().map(|point| point.0));
                arrays.exact(&name('y'), curve.points.iter().map(|point| point.1));
            }
        }
        let updates: Vec<f64> = self.updates.iter().map(|update| update.cycles).collect();
        let of_cycle = |cycle: &SceneCycle| {
            json!({
                "name": cycle.name,
                "cycles": cycle.cycles,
                "increments": cycle.percents.len(),
                "has_pressure": cycle.pressures.iter().any(|pressed| !pressed.is_empty()),
            })
        };
        let cycles: Vec<Value> = self.cycles.iter().map(of_cycle).collect();
        let charts: Vec<Value> = self.charts.iter().map(chart).collect();
        let directions = [self.directions.along_x(), self.directions.along_z()].concat();
        arrays.to_bytes(&json!({
            "title": self.title,
            "directions": directions,
            "has_sides": self.directions.is_knee(),
            "updates": updates,
            "fields": fields,
            "cycles": cycles,
            "neutral_pose": self.neutral_pose,
            "has_femur": self.femur.is_some(),
            "counterface": self.directions.joint.bodies()[0],
            "charts": charts,
            "missing": self.missing,
        }))
    }

    fn add_insert(&self, arrays: &mut Arrays) {
        let (Some(insert), Some(first)) = (&self.insert, self.updates.first()) else {
            return;
        };
        arrays.whole("surface.quads", insert.articulating.quads.as_flattened());
        add_body(arrays, "skin", &insert.skin);
        add_places(arrays, "surface.nodes", &first.nodes);
        let moved = |update: usize| {
            let nodes = self.updates[update].nodes.iter().zip(&first.nodes);
            nodes.flat_map(|(now, unworn)| <[f64; 3]>::from(now - unworn))
        };
        let all = 0..self.updates.len();
        let of_all = range(all.clone().flat_map(moved));
        for update in all {
            arrays.quantised(&format!("surface.moved.{update}"), moved(update), of_all);
        }
    }

    /// Adds the fields of the last update, and returns their names, labels and units.
    fn add_fields(&self, arrays: &mut Arrays) -> Vec<Value> {
        let fields = self.updates.last().map(|last| last.fields.as_slice());
        let mut kept = Vec::new();
        for (name, last) in fields.unwrap_or_default() {
            if name == ARTICULATING {
                continue;
            }
            // The unworn insert has no stress yet.
            let of_update = |update: &SceneUpdate| {
                let mut fields = update.fields.iter();
                let found = fields.find(|(known, _)| known == name);
                found.map_or_else(|| vec![0.0; last.len()], |(_, values)| values.clone())
            };
            let found: Vec<_> = self.updates.iter().map(of_update).collect();
            // One range for all updates: the colours keep their meaning from one to the next.
            let of_all = range(found.iter().flatten().copied());
            for (update, values) in found.into_iter().enumerate() {
                let name = format!("field.{name}.{update}");
                arrays.quantised(&name, values.into_iter(), of_all);
            }
            let (label, unit) = in_words(name);
            let colours = maps::colours(name);
            kept.push(json!({ "name": name, "label": label, "unit": unit, "colours": colours }));
        }
        kept
    }

    fn add_cycle(&self, arrays: &mut Arrays, cycle: &SceneCycle) {
        let name = |array: &str| format!("cycle.{}.{array}", cycle.name);
        arrays.exact(&name("percents"), cycle.percents.iter().copied());
        arrays.exact(&name("poses"), cycle.poses.iter().flatten().copied());
        let Some(insert) = &self.insert else {
            return;
        };
        let (mut starts, mut nodes, mut pressures) = (vec![0], Vec::new(), Vec::new());
        for pressed in &cycle.pressures {
            for (node, pressure_mpa) in pressed {
                if let Ok(place) = insert.articulating.nodes.binary_search(node) {
                    nodes.push(place as u32);
                    pressures.push(*pressure_mpa);
                }
            }
            starts.push(nodes.len() as u32);
        }
        arrays.whole(&name("starts"), &starts);
        arrays.whole(&name("nodes"), &nodes);
        let [_, highest] = range(pressures.iter().copied());
        arrays.quantised(&name("pressure_mpa"), pressures.into_iter(), [0.0, highest]);
    }
}

fn chart(panel: &Panel) -> Value {
    let curve = |curve: &Curve| json!({ "name": curve.name, "style": curve.class, "has_dots": curve.has_dots });
    let curves: Vec<Value> = panel.curves.iter().map(curve).collect();
    json!({
        "id": panel.id,
        "group": panel.group,
        "title": panel.title,
        "unit": panel.unit,
        "positive": panel.positive,
        "from_zero": panel.from_zero,
        "min_span": panel.min_span,
        "x_title": panel.x_title,
        "cycles_per_x": panel.cycles_per_x,
        "curves": curves,
    })
}

fn add_body(arrays: &mut Arrays, name: &str, body: &TriangleMesh) {
    /// Cosine of 50 degrees: triangles within the deviation of a rounded surface meet at less, edges of an implant at more.
    const MIN_COSINE: f64 = 0.643;
    let body = split_at_creases(&coarser(body, PICTURE_DEVIATION_MM), MIN_COSINE);
    add_places(arrays, &format!("{name}.nodes"), &body.vertices);
    let triangles = body.triangles.as_flattened();
    arrays.whole(&format!("{name}.triangles"), triangles);
}

fn add_places(arrays: &mut Arrays, name: &str, nodes: &[Vec3]) {
    let values = nodes.iter().flat_map(|node| <[f64; 3]>::from(*node));
    arrays.quantised(name, values.clone(), range(values));
}

/// Returns the smallest and largest finite value; 0 twice where there is none.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    finite_range(values).unwrap_or_default().into()
}

const LEVELS: f64 = 65535.0;

#[derive(Debug, Default)]
struct Arrays {
    /// For each array: name, kind, offset from the start of the first array in bytes, length, and the values of the
    /// quantised numbers 0 and 65535.
    entries: Vec<Value>,
    bytes: Vec<u8>,
}

impl Arrays {
    /// Adds whole numbers, in 16 bits where they fit.
    fn whole(&mut self, name: &str, values: &[u32]) {
        let narrow: Option<Vec<u16>> = values.iter().map(|&value| value.try_into().ok()).collect();
        if let Some(values) = narrow {
            let bytes = values.into_iter().flat_map(u16::to_le_bytes);
            self.add(name, "u16", 2, bytes.collect(), None);
        } else {
            let bytes = values.iter().flat_map(|value| value.to_le_bytes());
            self.add(name, "u32", 4, bytes.collect(), None);
        }
    }

    fn exact(&mut self, name: &str, values: impl Iterator<Item = f64>) {
        let bytes = values.flat_map(f64::to_le_bytes);
        self.add(name, "f64", 8, bytes.collect(), None);
    }

    /// Adds numbers in 16 bits of their range; values that are not finite become the lower end.
    fn quantised(&mut self, name: &str, values: impl Iterator<Item = f64>, range: [f64; 2]) {
        let [low, high] = range;
        // A constant field has no span to divide by.
        let span = (high - low).max(f64::MIN_POSITIVE);
        let level = |value: f64| (((value - low) / span).clamp(0.0, 1.0) * LEVELS).round() as u16;
        let bytes = values.flat_map(|value| level(value).to_le_bytes());
        self.add(name, "q16", 2, bytes.collect(), Some(range));
    }

    fn add(
        &mut self,
        name: &str,
        kind: &'static str,
        width: usize,
        bytes: Vec<u8>,
        range: Option<[f64; 2]>,
    ) {
        let (offset, length) = (self.bytes.len(), bytes.len() / width);
        let entry = json!({ "name": name, "kind": kind, "offset": offset, "length": length, "range": range });
        self.entries.push(entry);
        self.bytes.extend(bytes);
        // Typed arrays of JavaScript must start at a multiple of their width.
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
    }

    /// Encodes eight bytes with the length of a header, the header as JSON with `facts` and the list, and the arrays.
    fn to_bytes(&self, facts: &Value) -> Vec<u8> {
        let head = json!({ "facts": facts, "arrays": self.entries });
        let mut head = head.to_string().into_bytes();
        head.resize(head.len().next_multiple_of(8), b' ');
        let mut bytes = (head.len() as u64).to_le_bytes().to_vec();
        bytes.append(&mut head);
        bytes.extend_from_slice(&self.bytes);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_has_the_offset_of_each_array() {
        let mut arrays = Arrays::default();
        arrays.whole("faces", &[1, 2, 3]);
        arrays.quantised("depth", [0.0, 0.5, 1.0, f64::NAN].into_iter(), [0.0, 1.0]);
        arrays.exact("cycles", [2.5].into_iter());
        arrays.whole("many", &[70_000]);
        let bytes = arrays.to_bytes(&json!("facts"));
        let head = u64::from_le_bytes(bytes[..8].try_into().expect("eight bytes")) as usize;
        let list: Value = serde_json::from_slice(&bytes[8..8 + head]).expect("the list is JSON");
        let data = &bytes[8 + head..];
        let begin = |at: usize| list["arrays"][at]["offset"].as_u64().expect("is listed") as usize;
        assert_eq!(data[begin(0)..][..6], [1, 0, 2, 0, 3, 0]);
        assert_eq!(data[begin(1)..][..8], [0, 0, 0, 128, 255, 255, 0, 0]);
        assert_eq!(data[begin(2)..][..8], 2.5_f64.to_le_bytes());
        assert_eq!(list["arrays"][3]["kind"], "u32");
        assert_eq!(bytes.len() % 8, 0);
    }
}
