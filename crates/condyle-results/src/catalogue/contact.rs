//! Contact at the surface.


use condyle::evolve::CyclePeaks;

use super::finished::{FinishedRun, largest};
use super::{Scalar, scalar::scalars};

scalars! { "Contact";
    /// Highest contact pressure. Anywhere on the surface, also between nodes, at any instant of any solved cycle.
    PEAK_PRESSURE_MPA = Scalar::new("peak_pressure_mpa", "peak pressure", 1, |run| peak_pressure(run).1.peak_pressure_mpa)
        .headline()
        .estimated()
        .in_cycle("peak_pressure_cycle");

    /// Cycles before the cycle with the peak pressure. 0 is the first cycle.
    PEAK_PRESSURE_CYCLE = Scalar::new("peak_pressure_cycle", "cycles before the peak pressure", 0, |run| peak_pressure(run).0)
        .listed();

    /// Peak pressure of the first cycle. On the unworn insert.
    FIRST_CYCLE_PEAK_PRESSURE_MPA = Scalar::new("first_cycle_peak_pressure_mpa", "peak pressure in the first cycle", 1, |run| run.first.peaks.peak_pressure_mpa)
        .continued();

    /// Peak pressure of the last cycle. On the worn insert.
    LAST_CYCLE_PEAK_PRESSURE_MPA = Scalar::new("last_cycle_peak_pressure_mpa", "peak pressure in the last cycle", 1, |run| run.final_cycle.peak_pressure_mpa)
        .continued();

    /// Error of the peak pressure of the fitted pressure law. Largest difference from the deformable insert in stance.
    PRESSURE_LAW_PEAK_ERROR_PERCENT = Scalar::sometimes("pressure_law_peak_error_percent", "peak error of the pressure law", 1, |run| run.facts.pressure_law_peak_error_percent)
        .exact();

    /// Largest contact area. At any instant of any solved cycle, all regions together.
    PEAK_CONTACT_AREA_MM2 = Scalar::new("peak_contact_area_mm2", "largest contact area", 0, |run| largest_area(run).1.contact_area_mm2)
        .headline()
        .estimated()
        .in_cycle("peak_contact_area_cycle");

    /// Cycles before the cycle with the largest contact area. 0 is the first cycle.
    PEAK_CONTACT_AREA_CYCLE = Scalar::new("peak_contact_area_cycle", "cycles before the largest area", 0, |run| largest_area(run).0)
        .listed();

    /// Largest contact area of the first cycle. On the unworn insert.
    FIRST_CYCLE_CONTACT_AREA_MM2 = Scalar::new("first_cycle_contact_area_mm2", "largest contact area in the first cycle", 0, |run| run.first.peaks.contact_area_mm2)
        .printed()
        .continued();

    /// Largest contact area of the last cycle. On the worn insert.
    LAST_CYCLE_CONTACT_AREA_MM2 = Scalar::new("last_cycle_contact_area_mm2", "largest contact area in the last cycle", 0, |run| run.final_cycle.contact_area_mm2)
        .printed()
        .continued();
}

fn peak_pressure(run: &FinishedRun<'_>) -> (f64, CyclePeaks) {
    largest(run.peaks(), |peaks| peaks.peak_pressure_mpa).expect("a run has a final cycle")
}

fn largest_area(run: &FinishedRun<'_>) -> (f64, CyclePeaks) {
    largest(run.peaks(), |peaks| peaks.contact_area_mm2).expect("a run has a final cycle")
}
