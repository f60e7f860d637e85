//! `condyle calibrate-wear`.

use std::process::ExitCode;

use condyle_lab::measured::{CalibrateError, Calibration, Trial, calibrate};

use crate::{
    arguments::CalibrateWear,
    compare, exit,
    output::{self, Lines},
    standard_error::tell,
};

pub fn calibrate_wear(arguments: &CalibrateWear) -> ExitCode {
    let mut tried = |trial: &Trial| {
        tell(format_args!(
            "{:.4e} mm3/(N m): {:.3} mg per million cycles",
            trial.wear_factor_mm3_per_nm, trial.mg_per_million_cycles
        ));
    };
    match calibrate(&arguments.results, &arguments.measured, &mut tried) {
        Ok(calibration) if arguments.json => output::print(&output::json(&calibration)),
        Ok(calibration) => output::print(table(&calibration).text()),
        Err(error) => fail(&error),
    }
}

fn fail(error: &CalibrateError) -> ExitCode {
    match error {
        CalibrateError::Compare(error) => compare::fail(error),
        CalibrateError::Case(in_case) => exit::fail_case(in_case),
        other if other.is_physics() => exit::fail(other, exit::PHYSICS),
        other => exit::fail(other, exit::BAD_INPUT),
    }
}

fn table(calibration: &Calibration) -> Lines {
    let mut lines = Lines::default();
    let rate = calibration.measured_mg_per_million_cycles;
    lines.line(format_args!(
        "measured rate ({})  {rate:.3} mg per million cycles{}",
        calibration.measured_by,
        ends(
            calibration,
            calibration.interval_mg_per_million_cycles,
            |end| format!("{end:.3}")
        )
    ));
    lines.line(format_args!(
        "wear factor  {:.4e} mm3/(N m){}; the run had {:.4e}",
        calibration.wear_factor_mm3_per_nm,
        ends(
            calibration,
            calibration.wear_factor_interval_mm3_per_nm,
            |end| format!("{end:.4e}")
        ),
        calibration.run_with_mm3_per_nm,
    ));
    lines.line(format_args!(
        "for the case: [wear] wear_factor_mm3_per_nm = {:.4e}",
        calibration.wear_factor_mm3_per_nm
    ));
    lines
}

fn ends(
    calibration: &Calibration,
    interval: Option<condyle_lab::measured::Interval>,
    text: impl Fn(f64) -> String,
) -> String {
    let confidence = calibration.confidence_percent;
    interval.map_or_else(
        || ", without an interval".to_owned(),
        |ends| {
            format!(
                ", {confidence} % interval {} to {}",
                text(ends.low),
                text(ends.high)
            )
        },
    )
}
