//! Checks of the curves that drive the machine: whether they are plausible motions, and whether increments and splines follow them.

use condyle::machine::{
    Axis, Drive, Interpolation, JointIndex, JointKind, Machine, TestedJoint, Waveform, extremes,
    knee::{KNEE, VV},
};
use condyle_results::{PlausibilityWarning, joint_range};

use super::finished::{Finished, SolvedCycle, percent_of, warning};

/// Smallest plausible ranges of prescribed motions; our choice: the smallest of a standard are 4 degrees, on a disc, and 3 mm, and in
/// radians and m, those of a hip and a knee are 0.75 and 0.005.
const MIN_TURN_DEG: f64 = 2.0;
const MIN_STROKE_MM: f64 = 0.1;
/// The same of a prescribed AP motion of a joint, which in cm is 0.5.
const MIN_AP_STROKE_MM: f64 = 1.0;
/// Largest excess of the path of a prescribed motion over that of the smoothed motion, %; our choice: noise of 6 % changed the mass of
/// a knee by 12 %.
const MAX_NOISE_PERCENT: f64 = 3.0;
/// Reversals of a curve in a cycle beyond which it may be noisy: those of the eight harmonics of which motions and loads of joints
/// consist. White noise reverses at two thirds of its samples.
const MAX_REVERSALS: usize = 2 * 8;
/// Knots from one reversal to the next from which a reversal is a stroke of the machine; the noise that matters has fewer.
const KNOTS_OF_A_STROKE: usize = 6;
/// Samples of a cycle at which a curve is examined for noise.
const NOISE_SAMPLINGS: [usize; 5] = [40, 60, 100, 200, 500];
/// Largest error of the path of a motion or the peak of a load by the ends of increments, %; our choice: the preset waveforms have at
/// most 0.1 % at 200 increments and 3.5 % at 50, and a jump within an increment has tens.
const MAX_MISSED_PERCENT: f64 = 5.0;
/// Largest distance by which a spline may leave the range of its samples, % of that range; our choice: that of measured loads and
/// motions is 2 % at most, and that of a step from one sample to the next 10 % or more.
const MAX_OVERSHOOT_PERCENT: f64 = 5.0;

/// Warns of prescribed motions so small that their unit is probably not degrees or mm: each once.
pub(crate) fn motions(finished: &Finished<'_>) -> Vec<PlausibilityWarning> {
    let small = |index| {
        let mut cycles = finished.cycles();
        cycles.find_map(|cycle| small_motion(finished, &cycle, index))
    };
    JointIndex::ALL.into_iter().filter_map(small).collect()
}

fn small_motion(
    finished: &Finished<'_>,
    cycle: &SolvedCycle<'_>,
    index: JointIndex,
) -> Option<PlausibilityWarning> {
    let machine = finished.machine(cycle);
    let description = machine.mechanism.joint(index);
    // Heights and varus are small in any unit.
    let is_along_y = matches!(description.axis, Axis::Along([0.0, _, 0.0]));
    let is_varus = *machine.mechanism == KNEE && index == VV;
    let is_prescribed = matches!(machine.joint(index).drive, Drive::Prescribed(_));
    let range = joint_range(cycle.rows, machine.mechanism, index);
    // A constant curve varies by round-off.
    if is_along_y || is_varus || !is_prescribed || range <= 1e-6 {
        return None;
    }
    let is_ap_of_joint = matches!(description.axis, Axis::Along([_, 0.0, 0.0]))
        && machine.mechanism.tests != TestedJoint::Specimen;
    let (least, unit, advice) = match description.kind() {
        JointKind::Rotation => (
            MIN_TURN_DEG,
            "degrees",
            "Write rotations in degrees: a waveform in radians needs scale = 57.2958.",
        ),
        JointKind::Translation => (
            if is_ap_of_joint {
                MIN_AP_STROKE_MM
            } else {
                MIN_STROKE_MM
            },
            "mm",
            "Write translations in mm: a waveform in m needs scale = 1000, and one in cm scale = 10.",
        ),
    };
    let of_activity = finished.activity_in_words(cycle);
    let message = format!(
        "the prescribed motion {} is {range:.2} {unit} in the {} cycle{of_activity}; that of a machine is at least {least} {unit}",
        description.symbol, cycle.name
    );
    let value = (range, least, unit);
    (range < least).then(|| warning("motion_small", value, message, advice))
}

/// Warns of noise in a prescribed motion, or in a load that moves a joint: each joint once. Noise of the pressing load hardly moves the joint.
pub(crate) fn noise(finished: &Finished<'_>) -> Vec<PlausibilityWarning> {
    let limit = Limit {
        check: "motion_noisy",
        most_percent: MAX_NOISE_PERCENT,
        advice: "Filter it: low_pass_harmonics = 8 in the table of its waveform.",
    };
    of_each_joint(finished, limit, |machine, index, _, joint| {
        let (kind, waveform) = match &machine.joint(index).drive {
            Drive::Prescribed(waveform) => ("prescribed motion", waveform),
            Drive::Loaded(waveform) if machine.pressing_joint() != Some(index) => {
                ("load", waveform)
            }
            _ => return None,
        };
        let percent = noise_percent(waveform);
        let message = format!(
            "the {kind} of {joint} is noisy: its curve is {percent:.0} % longer than the smoothed curve, and noise wears"
        );
        Some((percent, message))
    })
}

/// Returns the largest excess of the path of a waveform over that of the smoothed waveform, %, at several samplings of the cycle; 0 if
/// it reverses seldom.
///
/// Noise has the spacing of the samples of its file, which is seldom that of the increments.
fn noise_percent(waveform: &Waveform) -> f64 {
    let [low, high] = waveform.range();
    let knots: Vec<f64> = waveform.knots().iter().map(|knot| knot.value).collect();
    // A constant curve varies by round-off, a spline rings at a step of its knots, and strokes with several knots each are none.
    let is_even = high - low <= 1e-9 * high.max(-low);
    if is_even || reversals(&knots) <= MAX_REVERSALS.max(knots.len() / KNOTS_OF_A_STROKE) {
        return 0.0;
    }
    let excess = NOISE_SAMPLINGS.map(|count| {
        let values: Vec<f64> = sampled(waveform, count).collect();
        // Smoothing shortens the path of a curve with corners, too, which has few.
        match reversals(&values) > MAX_REVERSALS {
            true => excess_percent(&values[..count]),
            false => 0.0,
        }
    });
    excess.into_iter().fold(0.0, f64::max)
}

/// Returns the number of times that the rise of some values becomes a fall, or a fall a rise; equal values are neither.
fn reversals(values: &[f64]) -> usize {
    let steps = values.windows(2).map(|two| two[1] - two[0]);
    let rises: Vec<bool> = steps
        .filter(|step| *step != 0.0)
        .map(|step| step > 0.0)
        .collect();
    rises.windows(2).filter(|two| two[0] != two[1]).count()
}

/// Returns the excess of the path of periodic values over that of the smoothed values, %.
fn excess_percent(values: &[f64]) -> f64 {
    // The smoothing polynomial of second degree by Savitzky and Golay: it keeps curves, and removes most of the noise.
    const WEIGHTS: [f64; 7] = [-2.0, 3.0, 6.0, 7.0, 6.0, 3.0, -2.0];
    let at = |place: usize| values[place % values.len()];
    let smooth = |place: usize| {
        let weighted = WEIGHTS.iter().enumerate();
        let sum: f64 = weighted
            .map(|(next, weight)| weight * at(place + next))
            .sum();
        sum / WEIGHTS.iter().sum::<f64>()
    };
    let path = |value: &dyn Fn(usize) -> f64| -> f64 {
        let steps = (0..values.len()).map(|place| (value(place + 1) - value(place)).abs());
        steps.sum()
    };
    100.0 * (path(&at) / path(&smooth).max(f64::MIN_POSITIVE) - 1.0)
}

/// A check of waveforms, its limit, and what to do beyond it.
#[derive(Clone, Copy)]
struct Limit {
    check: &'static str,
    most_percent: f64,
    advice: &'static str,
}

/// Returns the first warning of each joint; `percent_and_message` gets its machine, its index, the number of increments of the cycle,
/// and its name in words.
fn of_each_joint(
    finished: &Finished<'_>,
    limit: Limit,
    percent_and_message: impl Fn(&Machine, JointIndex, usize, &str) -> Option<(f64, String)>,
) -> Vec<PlausibilityWarning> {
    let of_cycle = |index: JointIndex, cycle: SolvedCycle<'_>| {
        let machine = finished.machine(&cycle);
        let symbol = machine.mechanism.joint(index).symbol;
        let joint = format!("`{symbol}`{}", finished.activity_in_words(&cycle));
        let (percent, message) = percent_and_message(machine, index, cycle.rows.len(), &joint)?;
        let value = (percent, limit.most_percent, "%");
        (percent > limit.most_percent).then(|| warning(limit.check, value, message, limit.advice))
    };
    // The last cycle has the same waveforms.
    let of_joint = |index| {
        let mut cycles = finished.first_cycles();
        cycles.find_map(|cycle| of_cycle(index, cycle))
    };
    JointIndex::ALL.into_iter().filter_map(of_joint).collect()
}

/// Warns of a waveform whose jumps or peaks lie between the increments: each joint once.
///
/// Slip is the rate at the end of an increment times its duration, so a jump between two ends has no slip, and one at an end too much.
pub(crate) fn coarse_increments(finished: &Finished<'_>) -> Vec<PlausibilityWarning> {
    let limit = Limit {
        check: "increments_coarse",
        most_percent: MAX_MISSED_PERCENT,
        advice: "Use more increments, interpolation = \"spline\" for samples, or a waveform whose jumps take several increments.",
    };
    of_each_joint(finished, limit, |machine, index, count, joint| {
        let kind = machine.mechanism.joint(index).kind();
        let (of, percent) = match &machine.joint(index).drive {
            Drive::Locked(_) => return None,
            Drive::Prescribed(waveform) => ("path", missed_path(waveform, kind, count)),
            Drive::Loaded(waveform) => ("peak", missed_peak(waveform, count)),
        };
        let message =
            format!("the increments resolve the {of} of {joint} with an error of {percent:.1} %");
        Some((percent, message))
    })
}

/// Warns of a spline that leaves the range of its samples, as it does at a step: each joint once.
pub(crate) fn overshoots(finished: &Finished<'_>) -> Vec<PlausibilityWarning> {
    let limit = Limit {
        check: "waveform_overshoots",
        most_percent: MAX_OVERSHOOT_PERCENT,
        advice: "Write interpolation = \"half-cosine\" in the table of its waveform, or give more samples where it changes fast.",
    };
    of_each_joint(finished, limit, |machine, index, _, joint| {
        let (Drive::Prescribed(waveform) | Drive::Loaded(waveform)) = &machine.joint(index).drive
        else {
            return None;
        };
        let percent = overshoot_percent(waveform);
        let message = format!(
            "the curve of {joint} leaves the range of its samples by {percent:.0} % of it: a spline overshoots at steps"
        );
        Some((percent, message))
    })
}

/// Returns the distance by which a waveform leaves the range of its knots, % of that range; 0 for noise, which [`noise`] reports.
fn overshoot_percent(waveform: &Waveform) -> f64 {
    if waveform.interpolation() == Interpolation::HalfCosine {
        return 0.0;
    }
    if noise_percent(waveform) > MAX_NOISE_PERCENT {
        return 0.0;
    }
    let knots = waveform.knots().iter().map(|knot| knot.value);
    let ([low, high], [lowest, highest]) = (extremes(knots), waveform.range());
    percent_of((low - lowest).max(highest - high), high - low)
}

/// Instants of each increment at which a waveform is compared with its values at the ends of increments.
const FINE: usize = 20;

/// Returns the values of a waveform at equal steps of a cycle, both ends included.
fn sampled(waveform: &Waveform, count: usize) -> impl Iterator<Item = f64> + '_ {
    (0..=count).map(move |place| waveform.at(place as f64 / count as f64).0)
}

/// Returns the error of the path of a motion by its rates at the ends of increments, %.
fn missed_path(waveform: &Waveform, kind: JointKind, increments: usize) -> f64 {
    let fine: Vec<f64> = sampled(waveform, FINE * increments).collect();
    let step = |pair: &[f64]| match (kind, pair[1] - pair[0]) {
        (JointKind::Translation, step) => step.abs(),
        // A turn that goes on through the end of the cycle returns there to its first value.
        (JointKind::Rotation, step) => step.sin().atan2(step.cos()).abs(),
    };
    let path: f64 = fine.windows(2).map(step).sum();
    // A constant curve varies by round-off.
    if path < 1e-6 {
        return 0.0;
    }
    let rates = (0..increments).map(|place| waveform.at(place as f64 / increments as f64).1.abs());
    let by_rates = rates.sum::<f64>() / increments as f64;
    100.0 * (by_rates / path - 1.0).abs()
}

/// Returns the part of the largest load by which the ends of increments miss the highest or the lowest load, %.
fn missed_peak(waveform: &Waveform, increments: usize) -> f64 {
    let [low, high] = waveform.range();
    let [low_here, high_here] = extremes(sampled(waveform, increments));
    percent_of((low_here - low).max(high - high_here), high.max(-low))
}

#[cfg(test)]
mod tests {
    use condyle::machine::Knot;

    use super::*;

    #[test]
    fn jumps_and_peaks_within_an_increment_are_missed() {
        let waveform = |knots: &[(f64, f64)], interpolation| {
            let knots = knots
                .iter()
                .map(|&(percent, value)| Knot { percent, value });
            Waveform::new(knots.collect(), interpolation).unwrap()
        };
        let (slides, turns) = (JointKind::Translation, JointKind::Rotation);
        let jumps = [(0.0, 0.0), (49.99, 0.0), (50.0, 8.0), (99.99, 8.0)];
        let jumps = waveform(&jumps, Interpolation::HalfCosine);
        assert!(missed_path(&jumps, slides, 200) > 99.0);
        let smooth = waveform(&[(0.0, 0.0), (50.0, 0.5)], Interpolation::HalfCosine);
        assert!(missed_path(&smooth, slides, 200) < 0.1);
        let whole_turn = Waveform::turning(0.0, std::f64::consts::TAU);
        assert!(missed_path(&whole_turn, turns, 200) < 1e-6);
        let spike = [(0.0, 10.0), (50.05, 10.0), (50.2, 100.0), (50.45, 10.0)];
        let spike = waveform(&spike, Interpolation::HalfCosine);
        assert!(missed_peak(&spike, 200) > 80.0 && missed_peak(&smooth, 200) < 1e-9);
    }

    #[test]
    fn verify_the_overshoot_of_a_spline_at_a_step() {
        let curve = |value: fn(f64) -> f64, interpolation| {
            let knot = |place: u32| {
                let percent = 5.0 * f64::from(place);
                let value = value(percent);
                Knot { percent, value }
            };
            Waveform::new((0..20).map(knot).collect(), interpolation).unwrap()
        };
        let step: fn(f64) -> f64 = |percent| f64::from(u8::from(percent < 50.0));
        // At an infinite step, the slopes at the knots are 3/(3 + sqrt 3), times -0.268 from knot to knot.
        let overshoot = overshoot_percent(&curve(step, Interpolation::Spline));
        assert!((overshoot - 10.78).abs() < 0.05, "{overshoot}");
        assert_eq!(
            overshoot_percent(&curve(step, Interpolation::HalfCosine)),
            0.0
        );
        let sine = |percent: f64| (0.02 * std::f64::consts::PI * percent).sin();
        assert!(overshoot_percent(&curve(sine, Interpolation::Spline)) < 1.0);
    }

    #[test]
    fn noise_is_found_at_the_spacing_of_its_samples() {
        // A fixed sequence in place of a random one: its sign changes at two thirds of the samples.
        let noise =
            |place: usize| ((place * place * 7919 + place * 104_729) % 1000) as f64 / 500.0 - 1.0;
        let motion = |count: usize, noise_mm: f64| {
            let knot = |place| {
                let percent = 100.0 * place as f64 / count as f64;
                let turn = 0.02 * std::f64::consts::PI * percent;
                let value = 2.0 * turn.sin() + 0.5 * (3.0 * turn).cos() + noise_mm * noise(place);
                Knot { percent, value }
            };
            let knots = (0..count).map(knot).collect();
            noise_percent(&Waveform::new(knots, Interpolation::Spline).unwrap())
        };
        for count in [40, 60, 100, 200, 500] {
            assert_eq!(motion(count, 0.0), 0.0);
            let percent = motion(count, 0.4);
            assert!(percent > MAX_NOISE_PERCENT, "{count} samples: {percent} %");
        }
        let curve = |count: usize, value: &dyn Fn(usize) -> f64| {
            let percent = |place| 100.0 * place as f64 / count as f64;
            let knot = |place| Knot {
                percent: percent(place),
                value: value(place),
            };
            noise_percent(
                &Waveform::new((0..count).map(knot).collect(), Interpolation::Spline).unwrap(),
            )
        };
        // Samples that are held for two, and a machine of many strokes.
        assert!(curve(200, &|place| noise(place / 2)) > MAX_NOISE_PERCENT);
        for strokes in 9..=12 {
            let turn = std::f64::consts::TAU * f64::from(strokes) / 200.0;
            assert_eq!(curve(200, &|place| (turn * place as f64).sin()), 0.0);
        }
    }
}
