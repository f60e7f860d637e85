//! Checks of the machine: whether it reaches its loads, and whether its springs stay within their travel.

use condyle::machine::{
    CycleRow, Drive, JointIndex, JointKind, Machine, Spring, TestedJoint, Waveform,
    knee::{AP, IE, IS, KNEE, ML, VV},
};
use condyle_results::{PlausibilityWarning, joint_range};

use super::finished::{Finished, SolvedCycle, warning};

/// A load of the machine, and the accuracy with which it must be reached.
#[derive(Clone, Copy)]
struct Applied {
    joint: JointIndex,
    name: &'static str,
    /// Largest unbalanced part at which the load counts as reached, relative to the largest load.
    within: f64,
    /// Largest part of a cycle in which it may be missed, %.
    most_percent: f64,
}

/// Our choices: inertia hardly affects the axial force, but it affects the others when friction releases.
const APPLIED: [Applied; 3] = [
    Applied {
        joint: IS,
        name: "axial force",
        within: 0.1,
        most_percent: 5.0,
    },
    Applied {
        joint: AP,
        name: "AP force",
        within: 0.3,
        most_percent: 10.0,
    },
    Applied {
        joint: IE,
        name: "IE torque",
        within: 0.3,
        most_percent: 10.0,
    },
];
/// Largest plausible motion of a spring beyond its free play, mm; our choice, since the model's springs have
/// unlimited travel.
const FARTHEST_MM: f64 = 10.0;

/// Smallest plausible peak of the axial force on a joint, N; our choice: the smallest of a standard is 150 N, on the disc of a neck,
/// and the largest one in kN is 3.
const MIN_PEAK_LOAD_N: f64 = 10.0;
/// Smallest sliding speed over the slip tolerance; our choice: friction then has 98 % of its full value.
const MIN_SPEED_OVER_TOLERANCE: f64 = 5.0;
/// Path in a cycle below which a surface that is only pressed counts as not sliding, mm; our choice.
const MIN_PATH_MM: f64 = 0.01;
/// Smallest plausible peak of the axial force on specimens, N; our choice: pins are pressed by tens to hundreds of newtons.
const MIN_PEAK_LOAD_OF_SPECIMENS_N: f64 = 1.0;

/// A load of the machine that contact and springs do not balance.
struct Missed {
    percent: f64,
    /// Largest missed part of the load, N or N mm.
    most: f64,
    load: f64,
}

/// Warns of an axial load so small in an activity that its unit is probably not N.
pub(crate) fn load_small(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let tests = finished.march.test().machine().mechanism.tests;
    let peak_n = |cycle: SolvedCycle<'_>| {
        let machine = finished.machine(&cycle);
        let pressing = machine
            .pressing_joint()
            .map(|joint| &machine.joint(joint).drive);
        let force_n = |row: &CycleRow| match pressing {
            // Inertia can multiply a small load.
            Some(Drive::Loaded(waveform)) => load(waveform, row).abs(),
            _ => row.axial_force_n,
        };
        let peak_n = cycle.rows.iter().map(force_n).fold(0.0, f64::max);
        (peak_n, finished.activity_in_words(&cycle))
    };
    let peaks_n = finished.cycles().map(peak_n);
    let (peak_n, of_activity) = peaks_n.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let (tested, least_n) = match tests {
        TestedJoint::Specimen => ("specimen", MIN_PEAK_LOAD_OF_SPECIMENS_N),
        _ => ("joint", MIN_PEAK_LOAD_N),
    };
    let message = format!(
        "the largest axial load{of_activity} is {peak_n:.1} N; that of a {tested} is at least {least_n:.0} N"
    );
    let advice = "Write loads in N: a waveform in kN needs scale = 1000.";
    let value = (peak_n, least_n, "N");
    (peak_n < least_n).then(|| warning("load_small", value, message, advice))
}

/// Warns of sliding that is not fast compared with the slip tolerance, below which friction is small. Once it has vanished, the error
/// estimate, which doubles the tolerance, changes nothing more.
pub(crate) fn slides_slowly(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let test = finished.march.test();
    let tolerance_mm_per_s = test.contact.slip_tolerance_mm_per_s()?;
    let slips_mm = finished.march.fields().sliding_distance_mm.iter();
    let mean_mm = slips_mm.copied().fold(0.0, f64::max);
    // A slow activity counts by itself: its wear would be that of the tolerance, however far the others slide.
    let slow = finished.first_cycles().filter_map(|cycle| {
        let own = &finished.march.state().activities[cycle.activity];
        let path_mm = match test.activities.len() {
            1 => mean_mm,
            _ => own.wear.longest_path_mm,
        };
        let cycle_s = 1.0 / finished.machine(&cycle).frequency_hz;
        let least_mm = MIN_SPEED_OVER_TOLERANCE * tolerance_mm_per_s * cycle_s;
        let is_slow = path_mm > MIN_PATH_MM && path_mm < least_mm;
        is_slow.then_some((path_mm, least_mm, cycle_s, cycle))
    });
    let slowest = slow.min_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)));
    let (path_mm, least_mm, cycle_s, cycle) = slowest?;
    let of_activity = finished.activity_in_words(&cycle);
    let message = format!(
        "the longest path under pressure{of_activity} is {path_mm:.3} mm in a cycle of {cycle_s:.2} s; at least {least_mm:.3} mm is acceptable, since \
         friction has 71 % of its full value at slip_tolerance_mm_per_s = {tolerance_mm_per_s}, and less at lower speeds"
    );
    let advice = "Take a smaller slip_tolerance_mm_per_s, and compare both runs.";
    let value = (path_mm, least_mm, "mm");
    Some(warning("slides_slowly", value, message, advice))
}

pub(crate) fn not_reached(finished: &Finished<'_>) -> Vec<PlausibilityWarning> {
    let machine = finished.march.test().machine();
    let pressing = machine.pressing_joint().map(|joint| Applied {
        joint,
        ..APPLIED[0]
    });
    let of_knee = if *machine.mechanism == KNEE {
        &APPLIED[1..]
    } else {
        &[]
    };
    let missed = pressing.iter().chain(of_knee).filter_map(|applied| {
        let cycles = finished.cycles();
        let missed = cycles.filter_map(|cycle| {
            let missed = missed(finished.machine(&cycle), &cycle, applied)?;
            Some((missed, cycle))
        });
        let (worst, cycle) = missed.max_by(|a, b| a.0.percent.total_cmp(&b.0.percent))?;
        let (per_unit, unit) = match machine.mechanism.joint(applied.joint).kind() {
            JointKind::Rotation => (1000.0, "N m"),
            JointKind::Translation => (1.0, "N"),
        };
        let (most, load) = (worst.most / per_unit, worst.load / per_unit);
        let (percent, name) = (worst.percent, applied.name);
        let cycle = finished.cycle_in_words(&cycle);
        let within_percent = 100.0 * applied.within;
        let message = format!(
            "for {percent:.0} % of the {cycle}, more than {within_percent:.0} % of the {name} is not balanced by contact and \
                springs: up to {most:.1} {unit} of {load:.1} {unit}, which inertia and damping carry"
        );
        let advice = "The counterface leaves the insert, or inertia or damping dominates its motion: check the load for jumps, the \
                    frequency, and the inertia and damping of the machine.";
        let value = (percent, applied.most_percent, "%");
        (percent > applied.most_percent)
            .then(|| warning("load_not_reached", value, message, advice))
    });
    missed.collect()
}

/// Returns the part of a load that is missed in a cycle; none for a joint without a load.
fn missed(machine: &Machine, cycle: &SolvedCycle<'_>, applied: &Applied) -> Option<Missed> {
    let joint = applied.joint;
    let Drive::Loaded(waveform) = &machine.joint(joint).drive else {
        return None;
    };
    let loads = || cycle.rows.iter().map(|row| load(waveform, row).abs());
    let largest = loads().fold(0.0, f64::max);
    let missed: Vec<f64> = (0..cycle.rows.len())
        .map(|row| missing(machine, cycle.rows, row, joint, waveform).abs())
        .collect();
    let beyond = missed
        .iter()
        .filter(|missed| **missed > applied.within * largest);
    (largest > 0.0).then(|| Missed {
        percent: 100.0 * beyond.count() as f64 / cycle.rows.len() as f64,
        most: missed.iter().copied().fold(0.0, f64::max),
        load: largest,
    })
}

fn load(waveform: &Waveform, row: &CycleRow) -> f64 {
    waveform.at(row.percent / 100.0).0
}

/// Returns the difference between a load and the force of contact and springs, N or N mm: for the axial force the part that the
/// contact does not carry, for other loads the part that inertia and damping take, M a + C v.
fn missing(
    machine: &Machine,
    rows: &[CycleRow],
    row: usize,
    index: JointIndex,
    waveform: &Waveform,
) -> f64 {
    if machine.pressing_joint() == Some(index) && is_balanced_by_contact(machine, index) {
        return load(waveform, &rows[row]).abs() - rows[row].axial_force_n;
    }
    let (count, joint) = (rows.len(), machine.joint(index));
    let at = |row: usize| index.of(&rows[row % count].positions);
    let (before, now, after) = (at(row + count - 1), at(row), at(row + 1));
    // Central differences over the periodic cycle.
    let per_s = machine.frequency_hz * count as f64;
    let rate = (after - before) / 2.0 * per_s;
    let acceleration = (after - 2.0 * now + before) * per_s * per_s;
    joint.inertia * acceleration + joint.damping * rate
}

/// Returns whether the force of the contact along y alone balances the load of the pressing joint: no ligament or spring
/// acts on it, and no rotation before the joint tilts the line of the load. Those of a knee tilt it by a few degrees only.
fn is_balanced_by_contact(machine: &Machine, pressing: JointIndex) -> bool {
    let before = &machine.mechanism.joints[..pressing.place()];
    let is_tilted = before
        .iter()
        .any(|joint| joint.kind() == JointKind::Rotation);
    let is_sprung = machine
        .springs
        .iter()
        .any(|spring| spring.along == pressing);
    machine.ligaments.is_empty() && !is_sprung && (!is_tilted || *machine.mechanism == KNEE)
}

/// Largest excess of the contact force over the load, % of the largest load; our choice: inertia causes 3 % at most in sound tests.
const MAX_IMPACT_PERCENT: f64 = 20.0;

/// Warns of a counterface that left the insert and hits it: the contact force exceeds the load.
pub(crate) fn impact(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let hits = finished.cycles().filter_map(|cycle| {
        let machine = finished.machine(&cycle);
        let joint = machine.pressing_joint()?;
        let Drive::Loaded(waveform) = &machine.joint(joint).drive else {
            return None;
        };
        if !is_balanced_by_contact(machine, joint) {
            return None;
        }
        let loads = || cycle.rows.iter().map(|row| load(waveform, row).abs());
        let excess = cycle.rows.iter().zip(loads());
        let excess = excess.map(|(row, load_n)| (row.axial_force_n - load_n, row));
        let (excess_n, row) = excess.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let percent = 100.0 * excess_n / loads().fold(f64::MIN_POSITIVE, f64::max);
        Some((percent, row, cycle))
    });
    let (percent, row, cycle) = hits.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let message = format!(
        "at {:.0} % of the {}, the contact force is {:.0} N, which exceeds the load by {percent:.0} % of the largest load",
        row.percent,
        finished.cycle_in_words(&cycle),
        row.axial_force_n
    );
    let advice = "The counterface leaves the insert and hits it: check whether the load is near or below zero, or jumps.";
    let value = (percent, MAX_IMPACT_PERCENT, "%");
    (percent > MAX_IMPACT_PERCENT).then(|| warning("impact", value, message, advice))
}

/// Pull of a spring beyond its free play.
#[derive(Clone, Copy)]
struct Pulled {
    beyond_mm: f64,
    force_n: f64,
    at_percent: f64,
}

/// Warns of a spring deflected farther beyond its free play than a machine permits.
pub(crate) fn springs_far(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let pulled = finished.cycles().flat_map(|cycle| {
        let machine = finished.machine(&cycle);
        let springs = machine.springs.iter();
        // A spring has no effect on a prescribed motion, and the limit is a length.
        let springs = springs.filter(|spring| {
            let joint = machine.joint(spring.along);
            joint.is_loaded() && joint.description.kind() == JointKind::Translation
        });
        springs
            .flat_map(|spring| {
                cycle
                    .rows
                    .iter()
                    .map(move |row| (pulled(spring, row), cycle))
            })
            .collect::<Vec<_>>()
    });
    let held = pulled.filter(|(pulled, _)| pulled.force_n > 0.0);
    let farthest = held.max_by(|a, b| a.0.beyond_mm.total_cmp(&b.0.beyond_mm));
    let (farthest, cycle) = farthest.filter(|(farthest, _)| farthest.beyond_mm > FARTHEST_MM)?;
    Some(far(farthest, &finished.cycle_in_words(&cycle)))
}

fn pulled(spring: &Spring, row: &CycleRow) -> Pulled {
    let turn = spring.about.of(&row.positions);
    let moved_mm = spring.along.of(&row.positions) + spring.offset_mm * turn.sin();
    Pulled {
        beyond_mm: (moved_mm - spring.rest).abs() - spring.free_play,
        force_n: spring.force(moved_mm).0.abs(),
        at_percent: row.percent,
    }
}

fn far(pulled: Pulled, cycle: &str) -> PlausibilityWarning {
    let Pulled {
        beyond_mm,
        force_n,
        at_percent,
    } = pulled;
    let message = format!(
        "a spring is deflected {beyond_mm:.1} mm beyond its free play and exerts {force_n:.0} N, at {at_percent:.0} % of the \
            {cycle}; springs of the model have no stop, those of a machine reach theirs after about {FARTHEST_MM:.0} mm"
    );
    let advice = "Check the loads and their signs, and the stiffness and free play of the springs.";
    let value = (beyond_mm, FARTHEST_MM, "mm");
    warning("springs_far", value, message, advice)
}

/// A freedom, and an upper bound of the motion of knees along it in walking and stairs, in the unit of files.
type MostMotion = (JointIndex, f64);

/// Our choices, with a margin.
const MOST: [MostMotion; 5] = [(AP, 25.0), (IE, 35.0), (ML, 10.0), (VV, 8.0), (IS, 10.0)];
/// Part of the load below which a side counts as lifted off.
const LIFTED: f64 = 0.01;
/// Part of the largest load below which a lift has no meaning.
const LITTLE_LOAD: f64 = 0.1;
/// Largest part of a cycle during which one side may be lifted off, %; our choice.
const MAX_LIFTED_PERCENT: f64 = 5.0;

/// Warns of large ranges of the freedoms: that of the first or the last cycle, whichever is larger.
pub(crate) fn ranges(finished: &Finished<'_>) -> Vec<PlausibilityWarning> {
    if *finished.march.test().machine().mechanism != KNEE {
        return Vec::new();
    }
    let beyond = MOST.iter().filter_map(|&limit| range(finished, limit));
    beyond.collect()
}

fn range(finished: &Finished<'_>, (joint, most): MostMotion) -> Option<PlausibilityWarning> {
    let moved = finished
        .cycles()
        .map(|cycle| (joint_range(cycle.rows, &KNEE, joint), cycle));
    let (range, cycle) = moved.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let cycle = finished.cycle_in_words(&cycle);
    let description = KNEE.joint(joint);
    let unit = match description.kind().unit() {
        "deg" => "degrees",
        unit => unit,
    };
    let message = format!(
        "{} moves by {range:.1} {unit} in the {cycle}; the limit is {most:.0}",
        description.symbol
    );
    let advice = "Check the loads, the springs and their free play, and whether the dishes constrain the counterface.";
    let (check, value) = (format!("{}_range", description.name), (range, most, unit));
    (range > most).then(|| warning(&check, value, message, advice))
}

/// Warns if one side carries no load while the joint is loaded.
pub(crate) fn lift_off(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    if finished.march.test().machine().mechanism.regions.is_empty() {
        return None;
    }
    let lifted = finished
        .cycles()
        .map(|cycle| (lifted_percent(&cycle), cycle));
    let most = lifted.max_by(|a, b| a.0.total_cmp(&b.0));
    let (percent, cycle) = most.filter(|(percent, _)| *percent > MAX_LIFTED_PERCENT)?;
    let cycle = finished.cycle_in_words(&cycle);
    let message = format!(
        "for {percent:.0} % of the {cycle} one side carries no load while the joint is loaded; up to \
            {MAX_LIFTED_PERCENT:.0} % is acceptable"
    );
    let advice = "Check vv_axis_medial_mm, which divides the load between the sides, start_mm, and whether both bodies are of \
                    the same side.";
    let value = (percent, MAX_LIFTED_PERCENT, "%");
    Some(warning("lift_off", value, message, advice))
}

fn lifted_percent(cycle: &SolvedCycle<'_>) -> f64 {
    let largest = cycle
        .rows
        .iter()
        .map(|row| row.axial_force_n)
        .fold(0.0, f64::max);
    cycle.percent_of_rows(|row| {
        let sides = &row.region_force_n[..KNEE.regions.len()];
        let least = sides.iter().copied().fold(f64::INFINITY, f64::min);
        row.axial_force_n > LITTLE_LOAD * largest && least < LIFTED * row.axial_force_n
    })
}

#[cfg(test)]
mod loads_tests {
    use super::*;

    fn row(percent: f64, axial_force_n: f64, ap_mm: f64) -> CycleRow {
        let mut positions = [0.0; 6];
        positions[AP.place()] = ap_mm;
        CycleRow {
            percent,
            positions,
            axial_force_n,
            contact_area_mm2: 0.0,
            peak_pressure_mpa: 0.0,
            region_force_n: Default::default(),
        }
    }

    fn loaded(index: JointIndex, load: f64) -> Machine {
        let mut machine = Machine::new(&KNEE);
        let joint = machine.joint_mut(index);
        joint.drive = Drive::Loaded(Waveform::constant(load));
        (joint.inertia, joint.damping) = (0.005, 0.0);
        machine
    }

    #[test]
    fn verify_what_inertia_takes_of_a_load() {
        // AP = sin(2 pi t) mm: of it M w^2 = 0.005 x 39.5 N is taken at most.
        let count = 400;
        let turn = std::f64::consts::TAU;
        let at = |k: usize| (k + 1) as f64 / f64::from(count);
        let rows: Vec<_> = (0..400)
            .map(|k| row(100.0 * at(k), 0.0, (turn * at(k)).sin()))
            .collect();
        let cycle = SolvedCycle {
            name: "first",
            activity: 0,
            rows: &rows,
        };
        let machine = loaded(AP, 0.5);
        let missed = missed(&machine, &cycle, &APPLIED[1]).expect("AP is loaded");
        assert!((missed.most / (0.005 * turn * turn) - 1.0).abs() < 1e-3);
        // |sin| > 0.15/0.197 for 45 % of the cycle.
        let most = 0.5 * APPLIED[1].within;
        let expected = 100.0 * (1.0 - 2.0 / std::f64::consts::PI * (most / missed.most).asin());
        assert!(
            (missed.percent - expected).abs() < 1.0,
            "{}",
            missed.percent
        );
    }

    #[test]
    fn a_femur_in_the_air_misses_its_load_and_one_that_is_pressed_does_not() {
        let rows = [row(50.0, 0.0, 0.0), row(100.0, 1000.0, 0.0)];
        let cycle = |rows| SolvedCycle {
            name: "first",
            activity: 0,
            rows,
        };
        let machine = loaded(IS, -1000.0);
        let in_the_air = missed(&machine, &cycle(&rows), &APPLIED[0]).expect("it is loaded");
        assert_eq!((in_the_air.percent, in_the_air.most), (50.0, 1000.0));
        let pressed = missed(&machine, &cycle(&rows[1..]), &APPLIED[0]).expect("it is loaded");
        assert_eq!(pressed.percent, 0.0);
        assert!(
            missed(&machine, &cycle(&rows), &APPLIED[1]).is_none(),
            "AP is locked"
        );
    }

    #[test]
    fn a_spring_is_as_far_as_its_point_has_moved() {
        let spring = Spring {
            along: AP,
            about: IE,
            offset_mm: 28.0,
            positive_stiffness: 7.24,
            negative_stiffness: 33.8,
            free_play: 2.5,
            rest: 0.0,
        };
        let pulled = pulled(&spring, &row(10.0, 0.0, 14.0));
        assert_eq!(pulled.beyond_mm, 11.5);
        assert!((pulled.force_n - 83.26).abs() < 1e-9);
        assert!(
            far(pulled, "first cycle")
                .message
                .contains("11.5 mm beyond its free play")
        );
    }
}

#[cfg(test)]
mod motions_tests {
    use super::*;

    fn row(medial_n: f64, lateral_n: f64) -> CycleRow {
        let region_force_n = [medial_n, lateral_n];
        CycleRow {
            percent: 0.0,
            positions: [0.0; 6],
            axial_force_n: medial_n + lateral_n,
            contact_area_mm2: 0.0,
            peak_pressure_mpa: 0.0,
            region_force_n,
        }
    }

    #[test]
    fn a_side_is_lifted_where_it_carries_nothing_under_load() {
        // Both carry; one does not; one does not, and the joint is hardly loaded.
        let rows = [
            row(600.0, 400.0),
            row(1000.0, 0.0),
            row(0.0, 50.0),
            row(1.0, 999.0),
        ];
        let cycle = SolvedCycle {
            name: "first",
            activity: 0,
            rows: &rows,
        };
        assert_eq!(lifted_percent(&cycle), 50.0);
    }
}
