//! `condyle calibrate` and `condyle calibrate-wear`.

use std::{
    fs,
    io::{self, ErrorKind},
    path::{Path, PathBuf},
};

use condyle_lab::{
    measured::{Calibration, Interval, Trial, calibrate as find_constants},
    pressure_law::{CalibratedLaw, calibrate as fit},
};
use condyle_results::replace_file;

use crate::{
    arguments::{Calibrate, CalibrateWear},
    output::{self, Done, Lines, Unwritten, note},
};

const PAGE: &str = "calibration.md";
const CASE: &str = "case.toml";

pub fn calibrate(arguments: &Calibrate) -> Done {
    let out = &arguments.out;
    let folder = part_folder(out, arguments.force)?;
    let (case, changes, held_out) = (&arguments.case, &arguments.changes.set, &arguments.hold_out);
    let law = fit(case, changes, held_out, &mut |step| {
        note(format_args!("solving: {step}"));
    })?;
    let written = write(&law, &folder).and_then(|()| match folder == *out {
        true => Ok(()),
        false => fs::rename(&folder, out),
    });
    written.map_err(|error| Unwritten::new(out, &error))?;
    if arguments.json {
        return output::print(&output::json(&law));
    }
    let mut lines = Lines::default();
    lines.line(law.table_of_left().trim_end());
    lines.line(format!("with the table, the peak pressure in stance differs by up to {} % from the deformable insert, \
                        in the first and the last cycle; every run with the table reports this",
        law.peak_error_percent));
    let (page, case) = (out.join(PAGE), out.join(CASE));
    lines.line(format!(
        "more in {}; run {}",
        page.display(),
        case.display()
    ));
    output::print(lines.text())
}

/// Returns the folder into which a law is written before it gets the name `out`: the folder itself if it is to be
/// replaced.
fn part_folder(out: &Path, force: bool) -> Result<PathBuf, Unwritten> {
    let is_there = out.symlink_metadata().is_ok();
    if is_there && force {
        return Ok(out.to_owned());
    }
    let folder = part_of(out);
    // A folder that cannot be made is reported before the long search; a killed search leaves none.
    let made = match is_there {
        true => Err(ErrorKind::AlreadyExists.into()),
        // A killed command left it: it is used again.
        false if folder.is_dir() => Ok(()),
        false => fs::create_dir(&folder).and_then(|()| fs::remove_dir(&folder)),
    };
    made.map_err(|error| Unwritten::new(out, &error))?;
    Ok(folder)
}

fn part_of(out: &Path) -> PathBuf {
    let mut name = out.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    out.with_file_name(name)
}

fn write(law: &CalibratedLaw, folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    for (name, text) in [
        ("pressure_table.csv", law.to_csv()),
        (CASE, law.case.to_toml_in(folder)),
        (PAGE, law.markdown()),
        ("calibration.json", output::json(law)),
    ] {
        replace_file(&folder.join(name), text.as_bytes())?;
    }
    Ok(())
}

pub fn calibrate_wear(arguments: &CalibrateWear) -> Done {
    let (tests, constants, predicted) = (&arguments.tests, &arguments.constant, &arguments.predict);
    let calibration = find_constants(tests, constants, predicted, &mut |trial: &Trial| {
        let constants = listed(&trial.constants, |value| format!("{value:.4e}"));
        let rates = listed(&trial.mg_per_million_cycles, |rate| format!("{rate:.3}"));
        note(format_args!("{constants}: {rates} mg per million cycles"));
    })?;
    if arguments.json {
        return output::print(&output::json(&calibration));
    }
    output::print(table(&calibration).text())
}

fn listed(values: &[f64], text: fn(f64) -> String) -> String {
    let texts: Vec<String> = values.iter().map(|&value| text(value)).collect();
    texts.join(", ")
}

fn table(calibration: &Calibration) -> Lines {
    let mut lines = Lines::default();
    let (law, confidence) = (calibration.law, calibration.confidence_percent);
    let ends = |interval: Option<Interval>, text: fn(f64) -> String| match interval {
        Some(Interval { low, high }) => {
            format!(", {confidence} % interval {} to {}", text(low), text(high))
        }
        None => ", without an interval".to_owned(),
    };
    for test in &calibration.tests {
        let interval = ends(test.interval_mg_per_million_cycles, |end| {
            format!("{end:.3}")
        });
        lines.line(format!(
            "{}: measured rate ({}) {:.3} mg per million cycles{interval}; fitted {:.3}, {:+.1} %",
            test.results.display(),
            test.measured_by,
            test.measured_mg_per_million_cycles,
            test.fitted_mg_per_million_cycles,
            (10.0 * test.fitted_above_measured_percent).round() / 10.0 + 0.0 // -0 is 0.
        ));
        lines.notes(&test.remarks);
    }
    if let Some(times) = &calibration.times_as_much {
        let interval = ends(times.interval, |end| format!("{end:.4}"));
        let (first, value) = (calibration.tests[0].results.display(), times.value);
        lines.line(format!(
            "{law} wears {value:.4} times as much as in {first}{interval}"
        ));
    }
    for constant in &calibration.constants {
        let interval = ends(constant.found.interval, |end| format!("{end:.4e}"));
        let (name, value, was) = (constant.name, constant.found.value, constant.run_with);
        lines.line(format!(
            "{name} {value:.4e}{interval}; the run had {was:.4e}"
        ));
    }
    if let Some(scatter) = calibration.scatter_percent {
        let freedom = calibration.degrees_of_freedom;
        lines.line(format!(
            "specimens scatter by {scatter:.1} % around it, {freedom} degrees of freedom"
        ));
    }
    if let Some(why) = calibration.without_interval {
        lines.line(format!("no interval: {why}"));
    }
    for prediction in &calibration.predictions {
        let interval = ends(prediction.interval_mg, |end| format!("{end:.2}"));
        let (mass, millions) = (prediction.mass_loss_mg, prediction.cycles / 1e6);
        let case = prediction.case.display();
        lines.line(format!(
            "{case} would lose {mass:.2} mg in {millions} million cycles{interval}"
        ));
    }
    for constant in &calibration.constants {
        let (name, value) = (constant.name, constant.found.value);
        lines.line(format!("for the case: [wear] {name} = {value:.4e}"));
    }
    lines
}
