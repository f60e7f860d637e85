//! `condyle calibrate`.

use std::{fs, io, path::Path, process::ExitCode};

use condyle_lab::pressure_law::{CalibrateRequest, CalibratedLaw, calibrate as fit};

use crate::{
    arguments::Calibrate,
    exit,
    output::{self, Lines},
    standard_error::tell,
};

pub fn calibrate(arguments: &Calibrate) -> ExitCode {
    let out = &arguments.out;
    if let Err(error) = fs::create_dir(out) {
        return exit::fail(unwritten(out, &error), exit::BAD_INPUT);
    }
    let request = CalibrateRequest {
        case: arguments.case.clone(),
        changes: arguments.changes.set.clone(),
        held_out: arguments.hold_out.clone(),
    };
    match fit(&request, &mut |what| tell(format_args!("solving: {what}"))) {
        Ok(law) => keep_and_print(&law, arguments),
        Err(error) => {
            // Nothing is in it.
            let _ = fs::remove_dir(out);
            exit::fail_run(&error)
        }
    }
}

fn keep_and_print(law: &CalibratedLaw, arguments: &Calibrate) -> ExitCode {
    let out = &arguments.out;
    if let Err(error) = keep(law, out) {
        return exit::fail(unwritten(out, &error), exit::BAD_INPUT);
    }
    if arguments.json {
        return output::print(&output::json(law));
    }
    let mut lines = Lines::default();
    lines.line(format_args!("{}", law.table_of_left().trim_end()));
    lines.line(format_args!(
        "the peak pressure is off by {} % at most in stance, first cycle and last, which every run with the table says",
        law.peak_error_percent
    ));
    lines.line(format_args!(
        "more in {}; run {}",
        out.join(PAGE).display(),
        out.join(CASE).display()
    ));
    output::print(lines.text())
}

const PAGE: &str = "calibration.md";
const CASE: &str = "case.toml";

fn keep(law: &CalibratedLaw, out: &Path) -> io::Result<()> {
    let files = [
        ("pressure_table.csv", law.to_csv()),
        (CASE, law.case.to_toml_in(out)),
        (PAGE, law.markdown()),
        ("calibration.json", output::json(law)),
    ];
    files
        .iter()
        .try_for_each(|(name, text)| fs::write(out.join(name), text))
}

fn unwritten(out: &Path, error: &io::Error) -> String {
    format!("{} cannot be written: {error}", out.display())
}
