//! `condyle check`.

use std::{fs, process::ExitCode};

use condyle_lab::{AtRest, BodyFacts, Expected, InsertFacts, Preview};

use crate::{
    arguments::Check,
    exit,
    output::{self, Lines},
    standard_error::tell,
};

pub fn check(arguments: &Check) -> ExitCode {
    let threads = usize::from(arguments.threads);
    let preview = match Preview::of(&arguments.case, &arguments.changes.set, threads) {
        Ok(preview) => preview,
        Err(error) => return exit::fail_run(&error),
    };
    let warnings = preview.warnings.iter();
    warnings.for_each(|warning| tell(format_args!("warning: {warning}")));
    if let Some(path) = &arguments.picture
        && let Err(error) = fs::write(path, preview.picture_svg())
    {
        let said = format!("{}: {error}; choose another name or folder", path.display());
        return exit::fail(said, exit::BAD_INPUT);
    }
    if arguments.print {
        output::print(&preview.case.to_toml())
    } else if arguments.json {
        output::print(&output::json(&preview))
    } else {
        output::print(&in_words(arguments, &preview))
    }
}

/// A name and its value.
type Row = (&'static str, String);

fn in_words(arguments: &Check, preview: &Preview) -> String {
    let mut lines = Lines::default();
    let parts = [
        rows_of_femur(&preview.femur),
        rows_of_insert(&preview.insert),
        rows_at_rest(&preview.at_rest),
        rows_of_run(&preview.expected),
    ];
    for (what, value) in parts.into_iter().flatten() {
        lines.line(format_args!("{what:<28}{value}"));
    }
    if let Some(path) = &arguments.picture {
        let row = format!("{:<28}{}", "picture", path.display());
        lines.line(row);
    }
    lines.line(format_args!(
        "{}: the case is good",
        arguments.case.display()
    ));
    lines.text().to_owned()
}

fn rows_of_femur(femur: &BodyFacts) -> Vec<Row> {
    let of = named(femur.shape, femur.file.as_ref(), femur.triangles);
    let mut rows = vec![("femur", of), ("  size AP, SI, ML", size(femur.size_mm))];
    rows.extend(row_of_defects(femur.file.is_some(), &femur.defects));
    rows
}

fn rows_of_insert(insert: &InsertFacts) -> Vec<Row> {
    let body = &insert.body;
    let of = named(body.shape, body.file.as_ref(), body.triangles);
    let mut rows = vec![("insert", of), ("  size AP, SI, ML", size(body.size_mm))];
    rows.extend(row_of_defects(body.file.is_some(), &body.defects));
    let mesh = format!(
        "{} hexahedra, {} surface nodes, worst quality {:.3}",
        insert.hexahedra, insert.surface_nodes, insert.worst_quality
    );
    rows.push(("  mesh", mesh));
    if let Some([medial, lateral]) = insert.dish_thickness_mm {
        let thickness = format!("{medial:.2} mm medial, {lateral:.2} mm lateral at the thinnest");
        rows.push(("  thickness over the dishes", thickness));
    }
    if let Some(middle) = insert.dishes_middle_mm {
        rows.push(("  dish middle from origin", from_origin(middle)));
    }
    rows
}

fn named(shape: &str, file: Option<&String>, triangles: Option<usize>) -> String {
    let triangles = triangles.map_or(String::new(), |count| format!(", {count} triangles"));
    match file {
        Some(file) => format!("{file}{triangles}"),
        None => shape.to_owned(),
    }
}

fn size([along, up, across]: [f64; 3]) -> String {
    format!("{along:.1} x {up:.1} x {across:.1} mm")
}

fn row_of_defects(has_file: bool, defects: &[String]) -> Option<Row> {
    let said = match defects.len() {
        0 => "none".to_owned(),
        1 => "1, told above".to_owned(),
        count => format!("{count}, told above"),
    };
    has_file.then_some(("  defects found", said))
}

fn from_origin([along, up, across]: [f64; 3]) -> String {
    let signed = |value: f64, plus: &'static str, minus: &'static str| {
        let word = if value < 0.0 { minus } else { plus };
        format!("{:.1} mm {word}", value.abs())
    };
    format!(
        "{}, {}, {}",
        signed(along, "anterior", "posterior"),
        signed(up, "superior", "inferior"),
        signed(across, "lateral", "medial")
    )
}

fn rows_at_rest(at_rest: &AtRest) -> Vec<Row> {
    let flexed = format!(
        "flexion {:.1} deg, VV {:.2} deg",
        at_rest.flexion_deg, at_rest.vv_deg
    );
    let pressed = format!(
        "{:.0} mm2, up to {:.1} MPa, {:.0} % of {:.0} N medial",
        at_rest.contact_area_mm2,
        at_rest.peak_pressure_mpa,
        100.0 * at_rest.medial_load_share,
        at_rest.axial_force_n
    );
    vec![
        ("settled", flexed),
        (
            "  flexion axis from origin",
            from_origin(at_rest.flexion_axis_mm),
        ),
        ("  contact", pressed),
    ]
}

fn rows_of_run(expected: &Expected) -> Vec<Row> {
    let needs = format!(
        "about {} and {:.0} MB of {:.0} MB",
        duration(expected.time_s),
        expected.memory_mb,
        expected.memory_allowed_mb
    );
    vec![("a run needs", needs)]
}

fn duration(seconds: f64) -> String {
    if seconds < 100.0 {
        format!("{seconds:.1} s")
    } else {
        format!("{:.0} min", seconds / 60.0)
    }
}
