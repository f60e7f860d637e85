//! Least squares of a model that takes seconds to evaluate, and the covariance of its parameters.

use condyle_case::case::{ConstantError, Wear};
use nalgebra::{DMatrix, DVector};

use crate::measured::{
    error::CalibrateError,
    gravimetric::{Observation, student},
};

/// The search ends when a step would change no rate by more than this part of it.
const SETTLED: f64 = 1e-3;
/// Largest number of steps; rates are nearly linear, and two or three suffice.
const MAX_STEPS: usize = 12;
/// A step changes no parameter by more than this factor.
const MAX_STEP_FACTOR: f64 = 5.0;
/// Step of the first differences, as a part of the parameter: well above the discretisation noise of a rate.
const DIFFERENCE: f64 = 0.05;
/// Smallest singular value of the slopes, relative to the largest, that determines the parameters.
const MIN_SINGULAR: f64 = 1e-6;

pub(crate) struct Start {
    pub(crate) at: Vec<f64>,
    /// Least and most of each parameter.
    pub(crate) limits: Vec<[f64; 2]>,
    /// True if rates are nearly proportional to the only parameter, so that the first slope needs no run.
    pub(crate) in_proportion: bool,
}

#[derive(Clone, Debug)]
pub(crate) struct Fit {
    pub(crate) at: Vec<f64>,
    pub(crate) rates: Vec<f64>,
    /// None without degrees of freedom.
    pub(crate) spread: Option<Spread>,
}

#[derive(Clone, Debug)]
pub(crate) struct Spread {
    /// Scatter of one observation of weight 1, as a part of its rate.
    pub(crate) scatter: f64,
    pub(crate) freedom: usize,
    /// Half the width of an interval, in standard errors.
    pub(crate) quantile: f64,
    pub(crate) covariance: DMatrix<f64>,
    /// Change of each parameter to either side by which slopes are found.
    pub(crate) half: Vec<f64>,
}

impl Spread {
    /// Half the interval of a quantity with these slopes in the parameters.
    pub(crate) fn half_interval(&self, slopes: &[f64]) -> f64 {
        let slopes = DVector::from_column_slice(slopes);
        self.quantile
            * (slopes.transpose() * &self.covariance * &slopes)[0]
                .max(0.0)
                .sqrt()
    }
}

/// The rates of the tests as a function of the parameters.
pub(crate) type Model<'a> = dyn FnMut(&[f64]) -> Result<Vec<f64>, CalibrateError> + 'a;

/// Finds the parameters that minimise the sum of weight (predicted / measured - 1)^2, by Gauss-Newton iteration with
/// Broyden's slopes.
///
/// The relative scatter is the same in all tests. It is pooled from the scatter of the specimens or weighings within each
/// test and from the residuals of the tests: a law that does not fit gets a wider interval.
pub(crate) fn fit(
    model: &mut Model<'_>,
    start: Start,
    observations: &[Observation],
    confidence: f64,
) -> Result<Fit, CalibrateError> {
    let mut search = Search::begin(model, start, observations)?;
    search.settle(model)?;
    let mut spread = search.spread(confidence)?;
    if let Some(rough) = spread {
        // Broyden's slopes are exact only along the steps made; these are across the interval itself.
        for (number, &half) in rough.half.iter().enumerate() {
            let slope = search.slope(model, number, [half; 2])?;
            search.slopes.set_column(number, &slope);
        }
        let fine = search.spread(confidence)?;
        spread = fine.map(|fine| Spread {
            half: rough.half,
            ..fine
        });
    }
    Ok(Fit {
        rates: search.rates,
        at: search.at,
        spread,
    })
}

struct Search<'a> {
    observations: &'a [Observation],
    limits: Vec<[f64; 2]>,
    at: Vec<f64>,
    rates: Vec<f64>,
    /// Slopes of the residuals in the parameters.
    slopes: DMatrix<f64>,
}

impl<'a> Search<'a> {
    fn begin(
        model: &mut Model<'_>,
        start: Start,
        observations: &'a [Observation],
    ) -> Result<Self, CalibrateError> {
        let (tests, constants) = (observations.len(), start.at.len());
        if tests < constants {
            let s = if tests == 1 { "" } else { "s" };
            return Err(CalibrateError::Unsuitable(format!(
                "{tests} measured rate{s} cannot determine {constants} constants; give as many tests as constants, or fewer \
                 --constant"
            )));
        }
        let rates = model(&start.at)?;
        let mut search = Self {
            observations,
            limits: start.limits,
            slopes: DMatrix::zeros(tests, constants),
            at: start.at,
            rates,
        };
        if start.in_proportion {
            let at = search.at[0];
            let slopes: Vec<f64> = search.rates.iter().map(|rate| rate / at).collect();
            let slope = search.weighed(&slopes);
            search.slopes.set_column(0, &slope);
            return Ok(search);
        }
        for number in 0..constants {
            let step = DIFFERENCE * size(search.at[number]);
            let slope = search.slope(model, number, [0.0, step])?;
            search.slopes.set_column(number, &slope);
        }
        Ok(search)
    }

    /// Returns rates, or their differences, relative to the measured ones, times the root of their weights.
    fn weighed(&self, rates: &[f64]) -> DVector<f64> {
        let all = rates.iter().zip(self.observations);
        let weighed = all.map(|(rate, of)| of.weight.sqrt() * rate / of.rate);
        DVector::from_iterator(rates.len(), weighed)
    }

    fn residuals(&self, rates: &[f64]) -> DVector<f64> {
        let off: Vec<f64> = rates
            .iter()
            .zip(self.observations)
            .map(|(rate, of)| rate - of.rate)
            .collect();
        self.weighed(&off)
    }

    /// Slope of the residuals in one parameter, from `below` it to `above` it, inside its limits.
    fn slope(
        &self,
        model: &mut Model<'_>,
        number: usize,
        [below, above]: [f64; 2],
    ) -> Result<DVector<f64>, CalibrateError> {
        let [least, most] = self.limits[number];
        let ends = [-below, above].map(|by| (self.at[number] + by).clamp(least, most));
        // At its upper limit a parameter can only decrease.
        let ends = if ends[0] == ends[1] {
            [ends[0] - above, ends[1]]
        } else {
            ends
        };
        let mut rates_at = |end: f64| {
            let mut at = self.at.clone();
            at[number] = end;
            if at == self.at {
                Ok(self.rates.clone())
            } else {
                model(&at)
            }
        };
        let [low, high] = [rates_at(ends[0])?, rates_at(ends[1])?];
        let slopes = low
            .iter()
            .zip(&high)
            .map(|(low, high)| (high - low) / (ends[1] - ends[0]));
        Ok(self.weighed(&slopes.collect::<Vec<_>>()))
    }

    /// Takes steps until a further step would change no rate.
    fn settle(&mut self, model: &mut Model<'_>) -> Result<(), CalibrateError> {
        let mut part = 1.0;
        let mut change = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let step = self.step()?;
            // The largest relative change of a rate.
            let changes = &self.slopes * &step;
            let changes = changes.iter().zip(self.observations);
            let changes = changes.map(|(change, of)| (change / of.weight.sqrt()).abs());
            change = changes.fold(0.0, f64::max);
            if change <= SETTLED {
                return Ok(());
            }
            let better = self.go(model, &(part * step))?;
            // After a step that was too long, half of the next; its slopes are better already.
            part = if better { 1.0 } else { 0.5 * part };
        }
        let left_percent = 100.0 * change;
        Err(CalibrateError::Unsuitable(format!(
            "after {MAX_STEPS} steps the rates would still change by {left_percent:.2} %; use more updates or increments in \
             the cases, or start from other constants"
        )))
    }

    fn step(&self) -> Result<DVector<f64>, CalibrateError> {
        let parts = self.slopes.clone().svd(true, true);
        let [most, least] = [parts.singular_values.max(), parts.singular_values.min()];
        // Rates without a slope in some direction would send the step to infinity.
        if least.is_nan() || least <= MIN_SINGULAR * most {
            return Err(undetermined());
        }
        let step = parts.solve(&-self.residuals(&self.rates), 0.0);
        step.map_err(|_| undetermined())
    }

    /// Tries a step, updates the slopes along it by Broyden's formula, and keeps it if it reduces the residuals.
    fn go(&mut self, model: &mut Model<'_>, step: &DVector<f64>) -> Result<bool, CalibrateError> {
        let at: Vec<f64> = (0..self.at.len())
            .map(|number| self.after(number, step[number]))
            .collect();
        let made = DVector::from_iterator(
            at.len(),
            at.iter().zip(&self.at).map(|(new, old)| new - old),
        );
        if made.norm() == 0.0 {
            return Ok(false);
        }
        let rates = model(&at)?;
        let (before, after) = (self.residuals(&self.rates), self.residuals(&rates));
        let missed = &after - &before - &self.slopes * &made;
        self.slopes += missed * made.transpose() / made.norm_squared();
        let better = after.norm() < before.norm();
        if better {
            (self.at, self.rates) = (at, rates);
        }
        Ok(better)
    }

    /// Returns a parameter after a step, shortened where it is too long or leaves the limits.
    fn after(&self, number: usize, step: f64) -> f64 {
        let (was, [least, most]) = (self.at[number], self.limits[number]);
        // A parameter keeps its sign: a law may have no value at the other one.
        let sign = was.signum();
        let cut = if was == 0.0 {
            step
        } else {
            let [shortest, longest] = [was.abs() / MAX_STEP_FACTOR, was.abs() * MAX_STEP_FACTOR];
            sign * (sign * (was + step)).clamp(shortest, longest)
        };
        cut.clamp(least, most)
    }

    /// Returns the uncertainty of the parameters by the present slopes.
    fn spread(&self, confidence: f64) -> Result<Option<Spread>, CalibrateError> {
        let within = |of: &Observation| of.squares / (of.rate * of.rate);
        let inside: f64 = self.observations.iter().map(within).sum();
        let between = self.residuals(&self.rates).norm_squared();
        let freedom =
            self.observations.iter().map(|of| of.freedom).sum::<usize>() + self.observations.len();
        let freedom = freedom - self.at.len();
        let Some(quantile) = student(confidence, freedom) else {
            return Ok(None);
        };
        let variance = (inside + between) / freedom as f64;
        let inverse = (self.slopes.transpose() * &self.slopes).try_inverse();
        let covariance = inverse.ok_or_else(undetermined)? * variance;
        let half = |number: usize| {
            let wide = quantile * covariance[(number, number)].sqrt();
            // Wide enough to exceed the noise of the rates, narrow enough for a straight slope.
            wide.clamp(0.01 * size(self.at[number]), 0.3 * size(self.at[number]))
        };
        Ok(Some(Spread {
            scatter: variance.sqrt(),
            freedom,
            quantile,
            half: (0..self.at.len()).map(half).collect(),
            covariance,
        }))
    }
}

/// Returns the error for constants whose effects on the rates cannot be separated.
fn undetermined() -> CalibrateError {
    let problem = "these tests do not determine the constants, which can change together without changing a rate; give \
                   tests that differ more in the quantities of the law, or fewer --constant";
    CalibrateError::Unsuitable(problem.to_owned())
}

/// Returns the scale of changes of a parameter; 1 for a parameter of 0.
fn size(parameter: f64) -> f64 {
    if parameter == 0.0 {
        1.0
    } else {
        parameter.abs()
    }
}

pub(crate) struct Free {
    pub(crate) law: Wear,
    free: Parameters,
}

enum Parameters {
    /// The amount of wear: one factor on the wear of every cycle.
    Level,
    /// These constants, by their places among all.
    Constants(Vec<usize>),
}

impl Free {
    /// Frees the constants with these names, or the amount of wear if there are none.
    pub(crate) fn new(law: Wear, names: &[String]) -> Result<Self, CalibrateError> {
        if names.is_empty() {
            let free = Parameters::Level;
            return Ok(Self { law, free });
        }
        let places: Result<Vec<_>, _> = names.iter().map(|name| place(&law, name)).collect();
        let free = Parameters::Constants(places?);
        Ok(Self { law, free })
    }

    /// Returns the start of the search: a parameter is a constant relative to its first value, or the relative amount
    /// of wear.
    pub(crate) fn start(&self) -> Start {
        let Parameters::Constants(places) = &self.free else {
            return Start {
                at: vec![1.0],
                limits: vec![[0.0, f64::INFINITY]],
                in_proportion: true,
            };
        };
        let parameters = self.law.kind().parameters;
        let limits = |&place: &usize| {
            [parameters[place].least, parameters[place].most].map(|end| end / self.unit(place))
        };
        Start {
            at: places
                .iter()
                .map(|&place| self.law.constants()[place] / self.unit(place))
                .collect(),
            limits: places.iter().map(limits).collect(),
            in_proportion: false,
        }
    }

    pub(crate) fn law(&self, at: &[f64]) -> Result<Wear, ConstantError> {
        match &self.free {
            Parameters::Level => self.law.scaled(at[0]),
            Parameters::Constants(places) => {
                let names = places
                    .iter()
                    .map(|&place| self.law.kind().parameters[place].name);
                let values = places
                    .iter()
                    .zip(at)
                    .map(|(&place, value)| value * self.unit(place));
                let mut named = names.zip(values);
                named.try_fold(self.law.clone(), |law, (name, value)| {
                    law.with_constant(name, value)
                })
            }
        }
    }

    /// Returns the constants at parameters that may lie beyond the limits of the law, each clamped to its limits.
    pub(crate) fn constants_near(&self, at: &[f64]) -> Vec<f64> {
        let constants = match &self.free {
            Parameters::Level => (self.law.kind().scaled)(self.law.constants(), at[0].max(0.0)),
            Parameters::Constants(places) => {
                let mut constants = self.law.constants().to_vec();
                for (&place, value) in places.iter().zip(at) {
                    constants[place] = value * self.unit(place);
                }
                constants
            }
        };
        let limits = constants.iter().zip(self.law.kind().parameters);
        let inside = limits.map(|(value, parameter)| value.clamp(parameter.least, parameter.most));
        inside.collect()
    }

    /// Returns whether the constant at `place` depends on the parameters.
    pub(crate) fn changes(&self, place: usize) -> bool {
        let own = self.law.constants();
        match &self.free {
            Parameters::Level => (self.law.kind().scaled)(own, 2.0)[place] != own[place],
            Parameters::Constants(places) => places.contains(&place),
        }
    }

    pub(crate) fn parameter_of(&self, place: usize) -> usize {
        match &self.free {
            Parameters::Level => 0,
            Parameters::Constants(places) => {
                places.iter().position(|&own| own == place).unwrap_or(0)
            }
        }
    }

    /// Returns whether the amount of wear is the parameter.
    pub(crate) fn is_level(&self) -> bool {
        matches!(self.free, Parameters::Level)
    }

    /// Returns the constant at a parameter of 1.
    fn unit(&self, place: usize) -> f64 {
        let size = self.law.constants()[place].abs();
        if size > 0.0 { size } else { 1.0 }
    }
}

fn place(law: &Wear, name: &str) -> Result<usize, CalibrateError> {
    let parameters = law.kind().parameters;
    let found = parameters
        .iter()
        .position(|parameter| parameter.name == name);
    found.ok_or_else(|| {
        let known = parameters.iter().map(|one| format!("`{}`", one.name));
        let (law, known) = (law.kind().word, known.collect::<Vec<_>>().join(", "));
        CalibrateError::Unsuitable(format!(
            "the wear law \"{law}\" has no constant `{name}`; it has {known}"
        ))
    })
}

/// Returns the constants of a law in the notation of a case.
pub(crate) fn in_words(law: &Wear) -> String {
    let parameters = law.kind().parameters.iter().zip(law.constants());
    let words: Vec<String> = parameters
        .map(|(parameter, value)| format!("{} = {value:.4e}", parameter.name))
        .collect();
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::{ContinuousCDF, Normal};

    /// Returns the next uniform random number between 0 and 1.
    fn uniform(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((*seed >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn normal(seed: &mut u64) -> f64 {
        Normal::standard().inverse_cdf(uniform(seed))
    }

    /// Specimens of a test that scatter by a part of the rate.
    fn specimens(rate: f64, part: f64, count: usize, seed: &mut u64) -> Observation {
        let rates: Vec<f64> = (0..count)
            .map(|_| rate * (1.0 + part * normal(seed)))
            .collect();
        let mean = rates.iter().sum::<f64>() / count as f64;
        Observation {
            rate: mean,
            weight: count as f64,
            squares: rates.iter().map(|rate| (rate - mean).powi(2)).sum(),
            freedom: count - 1,
        }
    }

    fn level(
        model: impl Fn(f64) -> Vec<f64>,
        observations: &[Observation],
    ) -> Result<Fit, CalibrateError> {
        let start = Start {
            at: vec![1.0],
            limits: vec![[1e-9, 1e9]],
            in_proportion: true,
        };
        fit(
            &mut |at: &[f64]| Ok(model(at[0])),
            start,
            observations,
            0.95,
        )
    }

    fn exact(rate: f64) -> Observation {
        Observation {
            rate,
            weight: 1.0,
            squares: 0.0,
            freedom: 0,
        }
    }

    #[test]
    fn verify_the_level_of_a_bent_curve_is_found_within_a_thousandth() {
        let bent = |level: f64| vec![4.0 * level + 0.2 * level * level];
        let found = level(bent, &[exact(bent(1.7)[0])]).unwrap();
        assert!((found.at[0] / 1.7 - 1.0).abs() < 1e-3, "{:?}", found.at);
        assert!(found.spread.is_none());
    }

    #[test]
    fn verify_two_constants_are_found_where_two_tests_tell_them() {
        let model = |at: &[f64]| {
            Ok(vec![
                3.0 * at[0] * (-0.5 * at[1]).exp(),
                2.0 * at[0] * (-0.1 * at[1]).exp(),
            ])
        };
        let truth = model(&[2.0, 0.6]).unwrap();
        let start = Start {
            at: vec![1.0, 1.0],
            limits: vec![[0.0, 100.0]; 2],
            in_proportion: false,
        };
        let found = fit(
            &mut { model },
            start,
            &[exact(truth[0]), exact(truth[1])],
            0.95,
        )
        .unwrap();
        assert!(
            (found.at[0] - 2.0).abs() < 0.01 && (found.at[1] - 0.6).abs() < 0.01,
            "{:?}",
            found.at
        );
    }

    #[test]
    fn verify_an_interval_holds_the_truth_as_often_as_it_says() {
        const TRUE_LEVEL: f64 = 1.4;
        const TIMES: usize = 4000;
        let model = |level: f64| vec![8.0 * level + 0.1 * level * level, 3.0 * level, 14.0 * level];
        let truth = model(TRUE_LEVEL);
        let mut seed = 7;
        let mut held = 0;
        for _ in 0..TIMES {
            let measured = [2, 4, 3].iter().zip(&truth);
            let measured: Vec<_> = measured
                .map(|(&count, rate)| specimens(*rate, 0.08, count, &mut seed))
                .collect();
            let found = level(model, &measured).unwrap();
            let spread = found.spread.unwrap();
            assert_eq!(spread.freedom, 8);
            held += usize::from((found.at[0] - TRUE_LEVEL).abs() <= spread.half_interval(&[1.0]));
        }
        // 95 % of 4000, give or take four standard errors.
        let part = held as f64 / TIMES as f64;
        assert!((part - 0.95).abs() < 0.014, "{part}");
    }

    #[test]
    fn verify_the_interval_of_one_test_is_that_of_the_mean_of_its_specimens() {
        let rates = [7.0, 8.0, 9.0];
        let of = Observation {
            rate: 8.0,
            weight: 3.0,
            squares: 2.0,
            freedom: 2,
        };
        let found = level(|level| vec![4.0 * level], &[of]).unwrap();
        let interval = crate::measured::gravimetric::mean_interval(&rates, 0.95).unwrap();
        let half = found.spread.unwrap().half_interval(&[1.0]);
        assert!((half - (interval.high - 8.0) / 4.0).abs() < 1e-9, "{half}");
    }

    #[test]
    fn a_law_that_does_not_fit_gets_a_wider_interval() {
        let of = |rate| Observation {
            rate,
            weight: 3.0,
            squares: 0.01 * rate * rate,
            freedom: 2,
        };
        let half = |second: f64| {
            let found = level(
                |level| vec![4.0 * level, 4.0 * level],
                &[of(4.0), of(second)],
            )
            .unwrap();
            found.spread.unwrap().half_interval(&[1.0])
        };
        assert!(half(8.0) > 3.0 * half(4.0));
    }

    #[test]
    fn what_cannot_be_told_is_refused() {
        let start = |count| Start {
            at: vec![1.0; count],
            limits: vec![[0.0, 10.0]; count],
            in_proportion: false,
        };
        let alike = |at: &[f64]| Ok(vec![at[0] * at[1], 2.0 * at[0] * at[1]]);
        let two = [exact(3.0), exact(5.0)];
        let error = fit(&mut { alike }, start(2), &two, 0.95).unwrap_err();
        assert_eq!(error.to_string(), undetermined().to_string());
        let error = fit(&mut { alike }, start(2), &two[..1], 0.95).unwrap_err();
        assert_eq!(
            error.to_string(),
            "1 measured rate cannot determine 2 constants; give as many tests as constants, or fewer --constant"
        );
        let mut seed = 3;
        let mut noise = |_: &[f64]| Ok(vec![1.0 + uniform(&mut seed)]);
        let error = fit(&mut noise, start(1), &two[1..], 0.95).unwrap_err();
        assert!(
            error.to_string().starts_with("after 12 steps")
                || error.to_string() == undetermined().to_string(),
            "{error}"
        );
    }
}
