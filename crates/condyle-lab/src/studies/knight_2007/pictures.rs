//! Depth and volume over the test, coarse intervals against fine ones.

use condyle_report::{Plot, plots_svg};

use super::{
    error::StudyError,
    ran::{Ran, TableOf, reference},
};

/// Updates of the runs that are shown against the finest.
const SHOWN: [usize; 2] = [5, 10];

/// Depth over cycles at two intervals, volume, and volume in displacement control, each against 40 updates.
pub(super) fn depth_svg(force: &[Ran], displacement: &[Ran]) -> Result<String, StudyError> {
    let finest = &force[force.len() - 1];
    let held = reference(displacement);
    let mut plots = Vec::new();
    for ran in force.iter().filter(|ran| SHOWN.contains(&ran.updates)) {
        let title = format!("Deepest wear, {}", updates_of(ran));
        plots.push(plot(title, "mm", "max_depth_mm", ran, finest)?);
    }
    let named = [
        ("Volume loss, force control", &force[0]),
        ("Volume loss, displacement control", held),
    ];
    for (title, ran) in named {
        let title = format!("{title}, {}", updates_of(ran));
        plots.push(plot(title, "mm\u{b3}", "volume_loss_mm3", ran, finest)?);
    }
    let reference = updates_of(finest);
    let keys = [reference.as_str(), "as titled"];
    Ok(plots_svg("Wear over the test", &plots, keys))
}

fn updates_of(ran: &Ran) -> String {
    match ran.updates {
        1 => "1 update".to_owned(),
        updates => format!("{updates} updates"),
    }
}

fn plot(
    title: String,
    unit: &str,
    column: &'static str,
    ran: &Ran,
    finest: &Ran,
) -> Result<Plot, StudyError> {
    Ok(Plot {
        title,
        unit: unit.to_owned(),
        x_title: "million cycles",
        x_marks: Vec::new(),
        from_zero: true,
        least_span: f64::MIN_POSITIVE,
        reference: points(finest, column)?,
        line: points(ran, column)?,
    })
}

/// (million cycles, value), from nothing worn at the start.
fn points(ran: &Ran, column: &'static str) -> Result<Vec<(f64, f64)>, StudyError> {
    let cycles = ran.column(TableOf::Wear, "cycles")?;
    let values = ran.column(TableOf::Wear, column)?;
    let after = cycles
        .iter()
        .map(|cycles| cycles / 1e6)
        .zip(values.iter().copied());
    Ok([(0.0, 0.0)].into_iter().chain(after).collect())
}
