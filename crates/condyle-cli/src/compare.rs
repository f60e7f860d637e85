//! `condyle compare`.

use std::path::PathBuf;
use std::process::ExitCode;

use condyle_lab::measured::{
    CompareError, Comparison, Errors, GravimetricComparison, Interval, KinematicsComparison,
    NodeDepths, Rate, SurfaceComparison, SurfaceErrors, compare as study,
};

use crate::{arguments::Compare, exit};

pub fn compare(arguments: &Compare) -> ExitCode {
    let comparison = match study(&arguments.results, &arguments.measured) {
        Ok(comparison) => comparison,
        Err(error) => return fail(&error),
    };
    let out = arguments.out.clone();
    let written = match comparison.write(&out.unwrap_or_else(|| default_folder(arguments))) {
        Ok(written) => written,
        Err(error) => return fail(&error),
    };
    if arguments.json {
        print!("{}", comparison.json());
    } else {
        print_tables(&comparison);
        let files = written.iter().map(|path| path.display().to_string());
        println!("wrote {}", files.collect::<Vec<_>>().join(", "));
    }
    ExitCode::SUCCESS
}

/// `compare` in the results folder.
fn default_folder(arguments: &Compare) -> PathBuf {
    arguments.results.join("compare")
}

/// Prints why no comparison could be made, and gives the exit code.
pub fn fail(error: &CompareError) -> ExitCode {
    match error {
        CompareError::Measured(in_file) => exit::fail_case(in_file),
        other => exit::fail(other, exit::BAD_INPUT),
    }
}

fn print_tables(comparison: &Comparison) {
    if let Some(kinematics) = &comparison.kinematics {
        print_kinematics(kinematics);
    }
    if let Some(gravimetric) = &comparison.gravimetric {
        print_gravimetric(gravimetric);
    }
    if let Some(surface) = &comparison.surface {
        print_surface(surface);
    }
}

fn print_kinematics(kinematics: &KinematicsComparison) {
    let aligned = match kinematics.align {
        "mean" => "; the mean difference is taken out of the errors",
        _ => "",
    };
    println!(
        "Kinematics, {} cycle: predicted minus measured{aligned}",
        kinematics.cycle
    );
    println!(
        "{:<28}{:>10}{:>10}{:>10}{:>8}{:>10}",
        "", "mean abs", "rms", "largest", "at %", "mean"
    );
    for column in &kinematics.columns {
        let mean = format!("{:>10.3}", column.mean_difference);
        println!("{:<28}{}{mean}", column.column, errors(&column.errors));
        for phase in &column.phases {
            let (start, end) = (phase.start_percent, phase.end_percent);
            let name = format!("  {} {start}-{end} %", phase.phase);
            let text = phase.errors.as_ref().map(errors);
            println!(
                "{name:<28}{}",
                text.unwrap_or_else(|| "      not measured".to_owned())
            );
        }
        if column.compared < column.instants {
            let (compared, all) = (column.compared, column.instants);
            println!("  measured at {compared} of {all} instants");
        }
    }
    println!();
}

fn errors(errors: &Errors) -> String {
    let Errors {
        mean_absolute,
        rms,
        largest,
        largest_at_percent,
    } = errors;
    format!("{mean_absolute:>10.3}{rms:>10.3}{largest:>10.3}{largest_at_percent:>8.1}")
}

fn print_gravimetric(gravimetric: &GravimetricComparison) {
    println!("Wear by weighing, {}", soak(gravimetric.soak_controls));
    println!(
        "{:<28}{:>12}  {:>19}{:>10}",
        "",
        "mg/10^6",
        format!("{} % interval", gravimetric.confidence_percent),
        "R2"
    );
    let all = gravimetric.specimens.iter();
    all.chain([
        &gravimetric.all,
        &gravimetric.mean_of_specimens,
        &gravimetric.predicted,
    ])
    .for_each(print_rate);
    println!(
        "predicted is {:+.1} % of the measured rate, the line through all weighings",
        gravimetric.predicted_above_measured_percent
    );
    let range = &gravimetric.range_of_specimens_mg_per_million_cycles;
    println!(
        "the prediction is {} the range of the specimens, {}",
        inside(gravimetric.inside_range_of_specimens),
        interval(range)
    );
    println!(
        "  {} the interval of the line through all weighings",
        inside(gravimetric.inside_interval_of_weighings)
    );
    if let Some(is_inside) = gravimetric.inside_interval_of_specimens {
        println!(
            "  {} the interval of the mean of the specimens",
            inside(is_inside)
        );
    }
    let after = gravimetric.weighings.iter();
    let missed = after.filter(|weighing| weighing.in_line && weighing.predicted_loss_mg.is_none());
    match missed.count() {
        0 => {}
        count => println!(
            "note: the run ends before {count} of the weighings, which the prediction's line leaves out"
        ),
    }
    println!();
}

fn soak(controls: usize) -> String {
    match controls {
        0 => "not corrected: there is no soak control".to_owned(),
        1 => "corrected by one soak control".to_owned(),
        count => format!("corrected by the mean of {count} soak controls"),
    }
}

fn print_rate(rate: &Rate) {
    let ends = rate.interval_mg_per_million_cycles;
    let ends = ends.as_ref().map_or_else(|| "-".to_owned(), interval);
    let r_squared = rate
        .r_squared
        .map_or_else(String::new, |r| format!("{r:.4}"));
    let (name, value) = (&rate.name, rate.mg_per_million_cycles);
    println!("{name:<28}{value:>12.3}  {ends:>19}{r_squared:>10}");
}

fn interval(interval: &Interval) -> String {
    format!("{:.3} to {:.3}", interval.low, interval.high)
}

fn inside(is_inside: bool) -> &'static str {
    if is_inside { "inside" } else { "OUTSIDE" }
}

fn print_surface(surface: &SurfaceComparison) {
    let registration = &surface.registration;
    println!("Worn surface: scanned minus predicted depth, mm");
    println!(
        "  laid on with a turn of {:.3} deg and a shift of {:.3} mm; {} points fitted, {:.4} mm rms left, uncertain by {:.4} mm",
        registration.angle_deg,
        registration.shift_mm,
        registration.points,
        registration.residual_rms_mm,
        registration.weakest_standard_error_mm,
    );
    println!(
        "{:<28}{:>10}{:>10}{:>10}{:>12}",
        "", "mean", "mean abs", "rms", "area mm2"
    );
    print_errors("everywhere", &surface.everywhere);
    if let Some(scars) = &surface.in_scars {
        print_errors("in the scars", scars);
    }
    print_place("worst difference", &surface.worst);
    print_place("deepest predicted", &surface.deepest_predicted);
    print_place("deepest scanned", &surface.deepest_scanned);
    println!(
        "volume over the area scanned: {:.2} mm3 scanned, {:.2} mm3 predicted",
        surface.scanned_volume_mm3, surface.predicted_volume_mm3
    );
    for note in &surface.notes {
        println!("note: {note}");
    }
    println!();
}

fn print_errors(name: &str, errors: &SurfaceErrors) {
    let SurfaceErrors {
        mean_mm,
        mean_absolute_mm,
        rms_mm,
        area_mm2,
    } = errors;
    println!("{name:<28}{mean_mm:>10.4}{mean_absolute_mm:>10.4}{rms_mm:>10.4}{area_mm2:>12.0}");
}

fn print_place(name: &str, place: &NodeDepths) {
    let NodeDepths {
        x_mm,
        z_mm,
        predicted_mm,
        scanned_mm,
        difference_mm,
        ..
    } = place;
    println!(
        "{name:<28}{difference_mm:>+10.4} at x {x_mm:.1}, z {z_mm:.1} (scanned {scanned_mm:.4}, predicted {predicted_mm:.4})"
    );
}
