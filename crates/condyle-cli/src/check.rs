//! `condyle check`.

use condyle_lab::{BodyFacts, EdgeFacts, InsertFacts, Preview};
use condyle_results::{Directions, Side, TestedJoint};

use crate::{
    arguments::Check,
    output::{self, Done, Lines},
};

pub fn check(arguments: &Check) -> Done {
    let threads = usize::from(arguments.threads);
    let preview = Preview::of(&arguments.case, &arguments.changes.set, threads)?;
    output::warn(preview.warnings.iter().chain(&preview.doubts));
    if let Some(path) = &arguments.picture {
        output::write_file(path, preview.picture_svg().as_bytes(), arguments.force)?;
    }
    if arguments.print {
        return output::print(&preview.case.to_toml());
    }
    if arguments.json {
        return output::print(&output::json(&preview));
    }
    let mut lines = Lines::default();
    for (name, value) in rows(&preview) {
        lines.line(format!("{name:<28}{value}"));
    }
    if let Some(path) = &arguments.picture {
        lines.line(format!("{:<28}{}", "picture", path.display()));
    }
    let case = arguments.case.display();
    lines.line(match preview.doubts.len() {
        0 => format!("{case}: the case is good"),
        _ => format!("{case}: the case starts, but see the warnings"),
    });
    output::print(lines.text())
}

/// A name and its value.
type Row = (&'static str, String);

fn rows(preview: &Preview) -> Vec<Row> {
    let (at_rest, expected) = (&preview.at_rest, &preview.expected);
    let flexed = at_rest.flexion_deg.zip(at_rest.vv_deg);
    let flexed = flexed.map(|(flexion, vv)| format!("flexion {flexion:.1} deg, VV {vv:.2} deg"));
    let load_n = at_rest.axial_force_n;
    let load = match at_rest.medial_load_share {
        Some(share) => format!("{:.0} % of {load_n:.0} N medial", 100.0 * share),
        None => format!("{load_n:.0} N"),
    };
    let pressed = format!(
        "{:.0} mm2, up to {:.1} MPa, {load}",
        at_rest.contact_area_mm2, at_rest.peak_pressure_mpa
    );
    let duration = match expected.time_s {
        seconds if seconds < 100.0 => format!("{seconds:.1} s"),
        seconds => format!("{:.0} min", seconds / 60.0),
    };
    let needs = format!(
        "about {duration} and {:.0} MB of {:.0} MB",
        expected.memory_mb, expected.memory_allowed_mb
    );
    let (names, [counterface, bearing]) = (preview.directions(), preview.joint.bodies());
    let centre = from_origin(at_rest.flexion_axis_mm, names);
    let mut rows = rows_of_body(counterface, &preview.femur, names);
    rows.extend(preview.axes.iter().map(|axes| ("  axes", axes.clone())));
    rows.extend(rows_of_body(bearing, &preview.insert.body, names));
    rows.extend(rows_of_insert(&preview.insert, names));
    rows.extend(match flexed {
        Some(flexed) => vec![("settled", flexed), ("  flexion axis from origin", centre)],
        None => vec![("settled", centre)],
    });
    rows.push(("  contact", pressed));
    if preview.femur.file.is_some() {
        let deviation = format!("{:.4} mm where they touch", at_rest.femur_deviation_mm);
        rows.push(("  smooth field to triangles", deviation));
    }
    rows.push(("a run needs", needs));
    rows
}

fn rows_of_body(name: &'static str, body: &BodyFacts, names: Directions) -> Vec<Row> {
    let triangles = body.triangles.map(|count| format!(", {count} triangles"));
    let source = match &body.file {
        Some(file) => format!("{file}{}", triangles.unwrap_or_default()),
        None => body.shape.to_owned(),
    };
    let [along, up, across] = body.size_mm;
    let size = format!("{along:.1} x {up:.1} x {across:.1} mm");
    let axes = match names.joint {
        TestedJoint::Specimen => "  size x, y, z",
        _ => "  size AP, SI, ML",
    };
    let mut rows = vec![(name, source), (axes, size)];
    if let Some(EdgeFacts { edge_mm, slivers }) = &body.edges {
        let [shortest, median, longest] = edge_mm;
        let edges =
            format!("{shortest:.2} to {longest:.2} mm, median {median:.2} mm; {slivers} slivers");
        rows.push(("  edges of triangles", edges));
    }
    if body.file.is_some() {
        let defects = match body.defects.len() {
            0 => "none".to_owned(),
            count => format!("{count}, listed above"),
        };
        rows.push(("  defects found", defects));
    }
    rows
}

fn rows_of_insert(insert: &InsertFacts, names: Directions) -> Vec<Row> {
    let mesh = format!(
        "{} hexahedra, {} surface nodes, worst quality {:.3}",
        insert.hexahedra, insert.surface_nodes, insert.worst_quality
    );
    let mut rows = vec![("  mesh", mesh)];
    if let Some([medial, lateral]) = insert.dish_thickness_mm {
        let thickness = format!("{medial:.2} mm medial, {lateral:.2} mm lateral at the thinnest");
        rows.push(("  thickness over the dishes", thickness));
    }
    let least = format!("{:.2} mm at the thinnest", insert.least_thickness_mm);
    rows.push(("  thickness inside the rim", least));
    if let Some(middle) = insert.dishes_middle_mm {
        rows.push(("  dish middle from origin", from_origin(middle, names)));
    }
    rows
}

fn from_origin(place: [f64; 3], names: Directions) -> String {
    // Places are those of the right joint that is computed: +z is lateral on both sides.
    let names = Directions {
        side: Side::Right,
        ..names
    };
    let [left, right] = names.along_z();
    let along_y = match names.joint {
        TestedJoint::Knee => ["superior", "inferior"],
        // The bearing lies below its counterface, which is upside down in a hip.
        _ => ["above", "below"],
    };
    let directions = [names.along_x(), along_y, [right, left]];
    let parts = place.into_iter().zip(directions);
    let parts = parts.map(|(value, [plus, minus])| {
        let direction = if value < 0.0 { minus } else { plus }.to_lowercase();
        format!("{:.1} mm {direction}", value.abs())
    });
    parts.collect::<Vec<_>>().join(", ")
}
