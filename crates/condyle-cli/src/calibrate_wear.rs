//! `condyle calibrate-wear`.

use std::process::ExitCode;

use condyle_lab::measured::{
    CalibrateError, CalibratedTest, Calibration, CalibrationRequest, Interval, Prediction, Trial,
    calibrate,
};

use crate::{
    arguments::CalibrateWear,
    compare, exit,
    output::{self, Lines},
    standard_error::tell,
};

pub fn calibrate_wear(arguments: &CalibrateWear) -> ExitCode {
    match calibrated(arguments) {
        Ok(calibration) if arguments.json => output::print(&output::json(&calibration)),
        Ok(calibration) => output::print(table(&calibration).text()),
        Err(error) => fail(&error),
    }
}

fn calibrated(arguments: &CalibrateWear) -> Result<Calibration, CalibrateError> {
    let request = CalibrationRequest {
        tests: CalibrationRequest::pairs(&arguments.tests)?,
        constants: arguments.constant.clone(),
        predict: arguments.predict.clone(),
    };
    let mut tried = |trial: &Trial| {
        tell(format_args!("{}", in_words(trial)));
    };
    calibrate(&request, &mut tried)
}

fn in_words(trial: &Trial) -> String {
    let each = |values: &[f64], digits: &dyn Fn(f64) -> String| -> String {
        let words: Vec<String> = values.iter().map(|&value| digits(value)).collect();
        words.join(", ")
    };
    let constants = each(&trial.constants, &|value| format!("{value:.4e}"));
    let rates = each(&trial.mg_per_million_cycles, &|rate| format!("{rate:.3}"));
    format!("{constants}: {rates} mg per million cycles")
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
    let ends = |interval, text: &dyn Fn(f64) -> String| {
        ends(calibration.confidence_percent, interval, text)
    };
    for test in &calibration.tests {
        add_test(
            &mut lines,
            test,
            &ends(test.interval_mg_per_million_cycles, &|end| {
                format!("{end:.3}")
            }),
        );
    }
    if let Some(times) = &calibration.times_as_much {
        let interval = ends(times.interval, &|end| format!("{end:.4}"));
        let first = &calibration.tests[0].results.display();
        let (law, value) = (calibration.law, times.value);
        lines.line(format_args!(
            "{law} wears {value:.4} times as much as in {first}{interval}"
        ));
    }
    for constant in &calibration.constants {
        let interval = ends(constant.found.interval, &|end| format!("{end:.4e}"));
        let (name, value, was) = (constant.name, constant.found.value, constant.run_with);
        lines.line(format_args!(
            "{name} {value:.4e}{interval}; the run had {was:.4e}"
        ));
    }
    if let Some(scatter) = calibration.scatter_percent {
        let freedom = calibration.degrees_of_freedom;
        lines.line(format_args!(
            "specimens scatter by {scatter:.1} % around it, {freedom} degrees of freedom"
        ));
    }
    if let Some(why) = calibration.without_interval {
        lines.line(format_args!("no interval: {why}"));
    }
    for prediction in &calibration.predictions {
        add_prediction(
            &mut lines,
            prediction,
            &ends(prediction.interval_mg, &|end| format!("{end:.2}")),
        );
    }
    for constant in &calibration.constants {
        let (name, value) = (constant.name, constant.found.value);
        lines.line(format_args!("for the case: [wear] {name} = {value:.4e}"));
    }
    lines
}

fn add_test(lines: &mut Lines, test: &CalibratedTest, interval: &str) {
    let (measured, fitted) = (
        test.measured_mg_per_million_cycles,
        test.fitted_mg_per_million_cycles,
    );
    lines.line(format_args!(
        "{}: measured rate ({}) {measured:.3} mg per million cycles{interval}; fitted {fitted:.3}, {:+.1} %",
        test.results.display(),
        test.measured_by,
        test.fitted_above_measured_percent
    ));
}

fn add_prediction(lines: &mut Lines, prediction: &Prediction, interval: &str) {
    let (mass, millions) = (prediction.mass_loss_mg, prediction.cycles / 1e6);
    lines.line(format_args!(
        "{} would lose {mass:.2} mg in {millions} million cycles{interval}",
        prediction.case.display()
    ));
}

fn ends(confidence: f64, interval: Option<Interval>, text: &dyn Fn(f64) -> String) -> String {
    interval.map_or_else(
        || ", without an interval".to_owned(),
        |ends| {
            let [low, high] = [text(ends.low), text(ends.high)];
            format!(", {confidence} % interval {low} to {high}")
        },
    )
}
