//! The prediction of a laboratory's result: the uncertainty of the wear law and of laboratories, evaluated on a run.
//!
//! `posterior.csv` has draws of the constants of the law `power-law` and of a laboratory's own factor, from the fit to
//! measured pins, hips and knees that the book documents. Every draw is evaluated on the run's own histories.

use std::sync::LazyLock;

use condyle::{evolve::March, machine::TestedJoint, wear::FamilyConstants};
use serde::{Deserialize, Serialize};

use super::{
    catalogue::{MASS_LOSS_MG, MAX_DEPTH_MM, Scalar},
    error_estimate::ErrorEstimate,
    statistics::quantile,
};

/// Word of the law that is calibrated.
pub const CALIBRATED_LAW: &str = "power-law";
/// Deviation of the logarithm of the mass due to the scatter of a simulator's inputs: that of the default knee, by
/// `condyle uncertainty`, as the book states it.
const INPUTS_LOG_SD: f64 = 0.08;
/// Deviation of the logarithm of the wear of cross-linked over conventional polyethylene, from [haider2012]: 0.14 to 0.27 in knees
/// of two designs, taken as two deviations.
const CROSS_LINKING_LOG_SD: f64 = 0.16;
/// Factor by which the logistic function is within 0.01 of the normal distribution.
const LOGISTIC: f64 = 1.702;
/// The wear of conventional inserts in force-controlled knee simulators [haider-garvin2008]; [reinders2014] found 8.0 +/- 0.9.
const MEASURED_KNEES: &str = "measured on knee simulators: 8.1 +/- 2.6 mg/Mc";
/// The wear of conventional cups of 28 mm (not read) on a machine of ISO 14242-1 in two lubricants [kaddick2001].
const MEASURED_HIPS: &str = "measured on hip simulators of ISO 14242-1: 22 and 27 mg/Mc";
/// 90 % of a normal distribution are within this many deviations.
const DEVIATIONS_OF_90_PERCENT: f64 = 1.645;
/// Pressure that the factors of the draws refer to, MPa.
const REFERENCE_PRESSURE_MPA: f64 = 1.1;
/// Factor either way above which an interval, without the scatter of laboratories, is too wide for a conclusion.
pub const MAX_FACTOR_OF_RUN: f64 = 2.5;
/// The [`Source`] that is the same for every run.
const LABORATORY: &str = "laboratory";
/// The [`Source`] that only cross-linked polyethylene has.
const CROSS_LINKING: &str = "cross-linking";
/// The [`Source`] that only runs with an estimate of their error have.
const DISCRETISATION: &str = "discretisation";

/// Comparisons take every fifth draw: a probability to 1 %, in a fifth of the lines of `summary.json`.
const COMPARED: usize = 5;

/// A draw of the posterior.
#[derive(Clone, Copy, Debug)]
struct Draw {
    law: FamilyConstants,
    /// Wear in a laboratory over that by the law.
    laboratory: f64,
}

static DRAWS: LazyLock<Vec<Draw>> = LazyLock::new(|| {
    let rows = include_str!("posterior.csv").lines();
    let rows = rows.filter(|row| row.starts_with(|first: char| first.is_ascii_digit()));
    let draw = |row: &str| {
        let values: Vec<f64> = row
            .split(',')
            .map(|value| value.parse().expect("is a number"))
            .collect();
        let &[
            circle_factor_mm3_per_nm,
            pressure_exponent,
            cross_shear_saturation,
            line_factor_ratio,
            laboratory,
        ] = values.as_slice()
        else {
            panic!("posterior.csv has five columns: {row}");
        };
        Draw {
            law: FamilyConstants {
                circle_factor_mm3_per_nm,
                reference_pressure_mpa: REFERENCE_PRESSURE_MPA,
                pressure_exponent,
                cross_shear_saturation,
                line_factor_ratio,
            },
            laboratory,
        }
    };
    rows.map(draw).collect()
});

/// The median and the interval that contains the result of 90 % of laboratories.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// 5 % of laboratories find less.
    pub low: f64,
    /// Half of them find less.
    pub median: f64,
    /// 5 % find more.
    pub high: f64,
}

/// A reason why laboratories find something else than the median.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// `law`, `laboratory`, `inputs`, `cross-linking` or `discretisation`.
    pub source: String,
    /// 90 % of laboratories are within this factor, either way, by this reason alone.
    pub factor: f64,
}

/// The results that laboratories would find for the test of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// True if the run's law is the calibrated one with its default constants, so that the interval is that of the run.
    pub is_of_run: bool,
    /// Mass worn, mg.
    pub mass_loss_mg: Interval,
    /// Deepest wear, mm.
    pub max_depth_mm: Interval,
    /// Rates that laboratories have weighed on conventional joints of this kind, in words; none for others, and if none are known.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub measured: Option<String>,
    /// Contributions to the interval of the mass, the largest first.
    pub sources: Vec<Source>,
    /// Mass by the law of every fifth draw of `posterior.csv`, without the laboratory's own factor, mg: in a comparison of
    /// two designs that factor cancels.
    pub mass_loss_mg_by_draw: Vec<f64>,
}

impl Prediction {
    /// Returns the prediction for a finished march: `constants` are those of its law if that is of the calibrated family, and
    /// `times` its wear over that of conventional polyethylene. None unless the march summed the family.
    pub fn new(
        march: &March,
        error: Option<&ErrorEstimate>,
        constants: Option<FamilyConstants>,
        is_of_run: bool,
        times: f64,
    ) -> Option<Self> {
        let (masses, depths) = by_draw(march, constants, times)?;
        let laboratories: Vec<f64> = DRAWS.iter().map(|draw| draw.laboratory).collect();
        let error_percent = |scalar: &Scalar| {
            error
                .and_then(|error| error.get(scalar))
                .map_or(0.0, |error| error.percent.total)
        };
        let mut sources = vec![
            Source::new("law", half_width(&masses)),
            Source::new(LABORATORY, half_width(&laboratories)),
            Source::new("inputs", DEVIATIONS_OF_90_PERCENT * INPUTS_LOG_SD),
        ];
        if error.is_some() {
            let error_log = (0.01 * error_percent(&MASS_LOSS_MG)).ln_1p();
            sources.push(Source::new(DISCRETISATION, error_log));
        }
        // Conventional polyethylene wears exactly once as much as itself.
        let is_cross_linked = times != 1.0;
        let log_sd = f64::from(is_cross_linked) * CROSS_LINKING_LOG_SD;
        let material_log = DEVIATIONS_OF_90_PERCENT * log_sd;
        if is_cross_linked {
            sources.push(Source::new(CROSS_LINKING, material_log));
        }
        sources.sort_by(|a, b| b.factor.total_cmp(&a.factor));
        let interval = |values: &[f64], scalar| {
            let both: Vec<f64> = values
                .iter()
                .zip(&laboratories)
                .map(|(a, b)| a * b)
                .collect();
            let error_log = (0.01 * error_percent(scalar)).ln_1p();
            Interval::of(&both, error_log.hypot(material_log))
        };
        Some(Self {
            is_of_run,
            measured: match march.test().machine().mechanism.tests {
                // All of these were conventional.
                _ if is_cross_linked => None,
                TestedJoint::Knee => Some(MEASURED_KNEES.to_owned()),
                TestedJoint::Hip => Some(MEASURED_HIPS.to_owned()),
                _ => None,
            },
            mass_loss_mg: interval(&masses, &MASS_LOSS_MG),
            max_depth_mm: interval(&depths, &MAX_DEPTH_MM),
            sources,
            mass_loss_mg_by_draw: masses
                .iter()
                .step_by(COMPARED)
                .map(|mass| rounded(*mass))
                .collect(),
        })
    }

    /// Returns the interval of a number; none unless it is predicted.
    pub fn interval(&self, scalar: &Scalar) -> Option<Interval> {
        let intervals = [
            (&MASS_LOSS_MG, self.mass_loss_mg),
            (&MAX_DEPTH_MM, self.max_depth_mm),
        ];
        let found = intervals
            .into_iter()
            .find(|(predicted, _)| *predicted == scalar);
        found.map(|(_, interval)| interval)
    }

    /// Returns the part of laboratories in which this design wears less than another, 0 to 1: the same draws of the law for
    /// both, with the laboratory's factor cancelled, the scatter of inputs between their tests, both discretisation errors, and the
    /// scatter of each cross-linking unless both inserts are of one polyethylene. None if the draws differ in number.
    pub fn part_below(&self, other: &Self, is_same_polyethylene: bool) -> Option<f64> {
        let pairs = self.mass_loss_mg_by_draw.iter();
        let pairs = pairs.zip(&other.mass_loss_mg_by_draw);
        let mut log_sd = INPUTS_LOG_SD;
        for Source { source, factor } in self.sources.iter().chain(&other.sources) {
            let is_own = match source.as_str() {
                DISCRETISATION => true,
                CROSS_LINKING => !is_same_polyethylene,
                _ => false,
            };
            if is_own {
                log_sd = log_sd.hypot(factor.ln() / DEVIATIONS_OF_90_PERCENT);
            }
        }
        let below = pairs.map(|(own, other)| {
            // Half of the variance of inputs is that of set-ups and differs between the two tests; the rest is that of the
            // machine and cancels. So the difference of the two has the variance of one.
            let deviations = (other / own).ln() / log_sd;
            1.0 / (1.0 + (-LOGISTIC * deviations).exp())
        });
        let count = self.mass_loss_mg_by_draw.len();
        (count == other.mass_loss_mg_by_draw.len() && count > 0)
            .then(|| below.sum::<f64>() / count as f64)
    }

    /// Returns whether the discretisation error of the run is estimated.
    pub fn has_discretisation(&self) -> bool {
        self.sources.iter().any(|own| own.source == DISCRETISATION)
    }

    /// Returns the sources of the interval and their factors in words, after the sign `times`. A run without an estimate of its
    /// error lacks that source, which may be the largest: with 30 increments, half of the mass of the default knee.
    pub fn sources_in_words(&self, times: char) -> String {
        let sources = self.sources.iter();
        let mut words: Vec<String> = sources
            .map(|source| format!("{} {times} {:.2}", source.source, source.factor))
            .collect();
        if !self.has_discretisation() {
            words.push(format!(
                "without {DISCRETISATION}, whose error is not estimated"
            ));
        }
        words.join(", ")
    }

    /// Returns the factor within which the mass is known without the laboratory's part, which is the same for every run.
    pub fn factor_of_run(&self) -> f64 {
        let own = self.sources.iter().filter(|own| own.source != LABORATORY);
        let square: f64 = own.map(|own| own.factor.ln().powi(2)).sum();
        square.sqrt().exp()
    }
}

/// Returns mass and deepest wear by the law of every draw, without the laboratory's factor.
fn by_draw(
    march: &March,
    constants: Option<FamilyConstants>,
    times: f64,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let reference = constants.unwrap_or(DRAWS[0].law);
    let laws: Vec<_> = std::iter::once(reference)
        .chain(DRAWS.iter().map(|draw| draw.law))
        .collect();
    let worn = march.state().law_family.as_ref()?.volumes_and_depths(&laws);
    let (&(reference_mm3, reference_mm), worn) = worn.split_first()?;
    if reference_mm3 <= 0.0 {
        return None;
    }
    // The run's own law follows the change of its surface within an interval; the sum of the family does not.
    let last = march.state().updates.last()?;
    let (of_mass, of_depth) = match constants {
        Some(_) => (
            last.mass_loss_mg / reference_mm3,
            last.max_depth_mm / reference_mm,
        ),
        None => (march.test().density_mg_per_mm3 * times, times),
    };
    let worn = worn.iter();
    Some(
        worn.map(|(volume_mm3, depth_mm)| (of_mass * volume_mm3, of_depth * depth_mm))
            .unzip(),
    )
}

impl Source {
    fn new(source: &str, half_width_log: f64) -> Self {
        Self {
            source: source.to_owned(),
            factor: half_width_log.exp(),
        }
    }
}

impl Interval {
    /// Returns the interval of these values of laboratories, widened by the scatter of inputs and by that of material and
    /// discretisation, which are independent of them: half-widths in the logarithm add as squares.
    fn of(values: &[f64], other_log: f64) -> Self {
        let [low, median, high] = quantiles(values);
        let own = (DEVIATIONS_OF_90_PERCENT * INPUTS_LOG_SD).hypot(other_log);
        let widened = |end: f64| (end / median).ln().hypot(own).exp();
        Self {
            low: median / widened(low),
            median,
            high: median * widened(high),
        }
    }
}

/// Returns the 5 %, 50 % and 95 % quantiles.
fn quantiles(values: &[f64]) -> [f64; 3] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0.05, 0.5, 0.95].map(|share| quantile(&sorted, share))
}

/// Returns half the width of the 90 % interval of the logarithm.
fn half_width(values: &[f64]) -> f64 {
    let [low, _, high] = quantiles(values);
    0.5 * (high / low).ln()
}

/// Rounds to four digits: more would fill `summary.json` with noise.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_an_interval_adds_independent_scatter_as_squares() {
        // Evenly spaced logarithms from -1 to 1: 90 % are within 0.9.
        let values: Vec<f64> = (0..=200)
            .map(|i| (0.01 * f64::from(i) - 1.0).exp())
            .collect();
        let narrow = Interval::of(&values, 0.0);
        let expected = (0.9_f64.powi(2) + (1.645 * INPUTS_LOG_SD).powi(2)).sqrt();
        assert!((narrow.median - 1.0).abs() < 1e-12);
        assert!((narrow.high.ln() - expected).abs() < 1e-3, "{narrow:?}");
        assert!((narrow.low.ln() + expected).abs() < 1e-3, "{narrow:?}");
        assert!(Interval::of(&values, 0.5).high > narrow.high);
    }

    #[test]
    fn verify_the_laboratory_cancels_between_designs() {
        let prediction = |masses: &[f64]| Prediction {
            is_of_run: true,
            mass_loss_mg: Interval::of(masses, 0.0),
            max_depth_mm: Interval::of(masses, 0.0),
            measured: None,
            sources: Vec::new(),
            mass_loss_mg_by_draw: masses.to_vec(),
        };
        let (one, two) = (
            prediction(&[1.0, 2.0, 4.0, 8.0]),
            prediction(&[3.0, 6.0, 12.0, 4.0]),
        );
        let near = |found: Option<f64>, exact: f64| (found.unwrap() - exact).abs() < 1e-3;
        let below = |one: &Prediction, two: &Prediction| one.part_below(two, true);
        assert!(near(below(&one, &two), 0.75) && near(below(&two, &one), 0.25));
        // Of equal designs, either wears less in half of the laboratories.
        assert!(near(below(&one, &one), 0.5));
        // One deviation of the difference of two tests.
        let part = below(&prediction(&[1.0]), &prediction(&[INPUTS_LOG_SD.exp()]));
        assert!((part.unwrap() - 0.841).abs() < 0.01);
        assert_eq!(below(&one, &prediction(&[1.0])), None);
        // The factor of cross-linking cancels between inserts of one polyethylene only; discretisation errors never do.
        let with = |source: &str, log_sd: f64| {
            let sources = vec![Source::new(source, DEVIATIONS_OF_90_PERCENT * log_sd)];
            move |masses: &[f64]| Prediction {
                sources: sources.clone(),
                ..prediction(masses)
            }
        };
        let cross_linked = with(CROSS_LINKING, CROSS_LINKING_LOG_SD);
        let coarse = with(DISCRETISATION, 0.1);
        let at_one_deviation = |one: &dyn Fn(&[f64]) -> Prediction,
                                two: &dyn Fn(&[f64]) -> Prediction,
                                log_sd: f64,
                                is_same_polyethylene: bool| {
            let part = one(&[1.0]).part_below(&two(&[log_sd.exp()]), is_same_polyethylene);
            assert!((part.unwrap() - 0.841).abs() < 0.01);
        };
        let with_one_log = INPUTS_LOG_SD.hypot(CROSS_LINKING_LOG_SD);
        at_one_deviation(&cross_linked, &prediction, with_one_log, false);
        at_one_deviation(&cross_linked, &cross_linked, INPUTS_LOG_SD, true);
        let with_both_log = with_one_log.hypot(CROSS_LINKING_LOG_SD);
        at_one_deviation(&cross_linked, &cross_linked, with_both_log, false);
        let with_errors_log = INPUTS_LOG_SD.hypot(0.1).hypot(0.1);
        at_one_deviation(&coarse, &coarse, with_errors_log, true);
    }

    #[test]
    fn sources_state_that_the_discretisation_is_missing() {
        let mut prediction = Prediction {
            is_of_run: true,
            mass_loss_mg: Interval::of(&[1.0], 0.0),
            max_depth_mm: Interval::of(&[1.0], 0.0),
            measured: None,
            sources: vec![Source::new(LABORATORY, 1.0)],
            mass_loss_mg_by_draw: Vec::new(),
        };
        let words = "laboratory x 2.72, without discretisation, whose error is not estimated";
        assert_eq!(prediction.sources_in_words('x'), words);
        prediction.sources.push(Source::new(DISCRETISATION, 0.0));
        let words = "laboratory x 2.72, discretisation x 1.00";
        assert_eq!(prediction.sources_in_words('x'), words);
    }

    #[test]
    fn the_posterior_has_500_plausible_draws() {
        assert_eq!(DRAWS.len(), 500);
        for draw in DRAWS.iter() {
            let law = draw.law;
            assert!((0.0..=1.0).contains(&law.pressure_exponent), "{law:?}");
            assert!(
                (0.002..=0.5).contains(&law.cross_shear_saturation),
                "{law:?}"
            );
            assert!((0.0..=1.0).contains(&law.line_factor_ratio), "{law:?}");
            assert!(draw.laboratory > 0.0 && law.circle_factor_mm3_per_nm > 0.0);
        }
    }
}
