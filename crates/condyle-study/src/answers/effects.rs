//! How outputs go with inputs, of any design.

use condyle_case::study::{Design, Input};
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{
    answers::spread::{Named, is_of_sample, mean, standard_deviation},
    chance::Numbers,
    design::Walk,
    error::StudyError,
    plan::Plan,
    store::{Column, Store},
};

/// Slices of an input's values, each with as many tests.
const SLICES: usize = 10;
/// Orders of chance that tell what an input that does nothing would span.
const SHUFFLES: u64 = 200;
/// Of their chance: the span is the same whenever it is found.
const SEED: u64 = 19_540_601;

/// How an output goes with an input.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// The output.
    pub output: &'static str,
    /// The key of the input.
    pub input: String,
    /// What the input is called.
    pub name: String,
    /// Correlation of ranks (Spearman 1904); of words, none.
    pub rank_correlation: Option<f64>,
    /// Mean value of the input in each slice or at each level, and mean of the output there.
    pub means: Vec<(f64, f64)>,
    /// The levels, where they are words.
    pub words: Vec<String>,
    /// What the means of the output span, in its unit.
    pub span: f64,
    /// What those of an input that does nothing would span at most in 95 of 100 such studies; none where the tests are no
    /// sample.
    pub span_by_chance: Option<f64>,
    /// The value of the input and of the output in each test, for a picture; of many tests, some.
    #[serde(skip)]
    pub points: Vec<(f64, f64)>,
}

/// Points of a scatter at most: more fill a picture, and its file.
const MAX_POINTS: usize = 400;

pub(crate) fn all(
    plan: &Plan,
    store: &Store,
    outputs: &[Named<'_, Scalar>],
) -> Result<Vec<Effect>, StudyError> {
    let mut effects = Vec::new();
    for (place, input) in plan.study().inputs.iter().enumerate() {
        let column = store.column(plan, &input.key)?;
        effects.extend(outputs.iter().map(|output| {
            let pairs = pairs(plan, place, &column, &output.column);
            Effect::of(output.of, input, &column, pairs, is_of_sample(plan, 0))
        }));
    }
    Ok(effects)
}

/// The value of an input and of an output in each test that tells of both. Of tests one at a time, those in which another
/// input is moved tell nothing.
fn pairs(plan: &Plan, place: usize, input: &Column, output: &Column) -> Vec<(f64, f64)> {
    let is_one_at_a_time = matches!(plan.study().design, Design::OneAtATime(_));
    let tells = |row: usize| {
        let moved = || plan.test(row as u64).map(|test| test.values);
        !is_one_at_a_time
            || moved()
                .is_some_and(|values| values[place].is_some() || values.iter().all(Option::is_none))
    };
    let both = input
        .values
        .iter()
        .copied()
        .zip(output.values.iter().copied());
    let known = both
        .enumerate()
        .filter(|(_, (x, y))| x.is_finite() && y.is_finite());
    known
        .filter(|(row, _)| tells(*row))
        .map(|(_, pair)| pair)
        .collect()
}

impl Effect {
    fn of(
        output: &Scalar,
        input: &Input,
        column: &Column,
        mut pairs: Vec<(f64, f64)>,
        is_sample: bool,
    ) -> Self {
        let every = pairs.len().div_ceil(MAX_POINTS).max(1);
        let points = pairs.iter().copied().step_by(every).collect();
        let correlation = rank_correlation(&pairs);
        pairs.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
        let slices = slices(&pairs);
        let means: Vec<(f64, f64)> = slices.iter().map(|slice| means(slice)).collect();
        let span = span(means.iter().map(|mean| mean.1));
        Self {
            output: output.key,
            input: input.key.clone(),
            name: input.name.clone(),
            rank_correlation: correlation.filter(|_| column.words.is_empty()),
            words: column.words.clone(),
            span,
            span_by_chance: is_sample.then(|| span_by_chance(&slices)),
            points,
            means,
        }
    }
}

/// The pairs at each value of few, and in slices of many; `sorted` by the input.
fn slices(sorted: &[(f64, f64)]) -> Vec<&[(f64, f64)]> {
    let by_value: Vec<&[(f64, f64)]> = sorted.chunk_by(|one, other| one.0 == other.0).collect();
    if by_value.len() <= SLICES {
        by_value
    } else {
        sorted.chunks(sorted.len().div_ceil(SLICES)).collect()
    }
}

/// Mean of the input and of the output.
fn means(slice: &[(f64, f64)]) -> (f64, f64) {
    let (x, y): (Vec<f64>, Vec<f64>) = slice.iter().copied().unzip();
    (mean(&x), mean(&y))
}

/// From the least to the most; 0 of nothing.
fn span(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    (high - low).max(0.0)
}

/// What the means of the output in these slices would span if the output did not know of the input: of its values in
/// orders of chance, the span that 95 of 100 stay below (a test by permutation).
fn span_by_chance(slices: &[&[(f64, f64)]]) -> f64 {
    let values: Vec<f64> = slices.concat().into_iter().map(|pair| pair.1).collect();
    let spans = (0..SHUFFLES).map(|number| {
        let mut order: Vec<usize> = (0..values.len()).collect();
        Numbers::of_one(SEED, number).shuffle(&mut order);
        let mut rest = order.as_slice();
        span(slices.iter().map(|slice| {
            let (own, others) = rest.split_at(slice.len());
            rest = others;
            own.iter().map(|&place| values[place]).sum::<f64>() / own.len() as f64
        }))
    });
    let mut spans: Vec<f64> = spans.collect();
    spans.sort_by(f64::total_cmp);
    spans[spans.len() * 95 / 100]
}

/// Pearson's correlation of ranks; none of less than three tests, and where either stays the same.
fn rank_correlation(pairs: &[(f64, f64)]) -> Option<f64> {
    let (x, y): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let (x, y) = (ranks(&x), ranks(&y));
    let (mean_x, mean_y) = (mean(&x), mean(&y));
    let [mut both, mut of_x, mut of_y] = [0.0; 3];
    for (x, y) in x.iter().zip(&y) {
        let (x, y) = (x - mean_x, y - mean_y);
        both += x * y;
        of_x += x * x;
        of_y += y * y;
    }
    (pairs.len() > 2 && of_x > 0.0 && of_y > 0.0).then(|| both / (of_x * of_y).sqrt())
}

/// The rank of each value; equal ones share the middle of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&one, &other| values[one].total_cmp(&values[other]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for equal in order.chunk_by(|&one, &other| values[one] == values[other]) {
        let rank = first as f64 + (equal.len() as f64 - 1.0) / 2.0;
        equal.iter().for_each(|&place| ranks[place] = rank);
        first += equal.len();
    }
    ranks
}

/// How an output changes when an input goes from its low end to its high one, by walks (Morris 1991; Campolongo et al.
/// 2007), in the unit of the output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Elementary {
    /// The output.
    pub output: &'static str,
    /// The key of the input.
    pub input: String,
    /// Mean of the effects.
    pub mu: f64,
    /// Mean of their magnitudes.
    pub mu_star: f64,
    /// Their standard deviation: large where the input is not linear, or acts together with others.
    pub sigma: f64,
    /// Half of the 95 % interval of `mu_star`.
    pub mu_star_half_interval: f64,
    /// Walks that tell of it.
    pub walks: usize,
}

pub(crate) fn all_elementary(plan: &Plan, outputs: &[Named<'_, Scalar>]) -> Vec<Elementary> {
    let study = plan.study();
    let Design::Morris(keys) = &study.design else {
        return Vec::new();
    };
    let inputs = study.inputs.len();
    let walk = |number| Walk::new(number, inputs, keys.levels, keys.seed);
    let mut all = Vec::new();
    for output in outputs {
        let effects = effects(inputs, &walk, &output.column.values);
        let told = study.inputs.iter().zip(effects);
        all.extend(
            told.map(|(input, effects)| Elementary::of(output.of.key, &input.key, &effects)),
        );
    }
    all
}

/// The effects of every input, one a walk; steps from or to a test that failed tell nothing.
fn effects(inputs: usize, walk: &dyn Fn(u64) -> Walk, values: &[f64]) -> Vec<Vec<f64>> {
    let mut effects = vec![Vec::new(); inputs];
    for (number, tests) in (0..).zip(values.chunks_exact(inputs + 1)) {
        let walk = walk(number);
        for step in 0..inputs {
            let (input, part) = walk.step(step);
            let effect = (tests[step + 1] - tests[step]) / part;
            if effect.is_finite() {
                effects[input].push(effect);
            }
        }
    }
    effects
}

impl Elementary {
    fn of(output: &'static str, input: &str, effects: &[f64]) -> Self {
        let magnitudes: Vec<f64> = effects.iter().map(|effect| effect.abs()).collect();
        let count = effects.len();
        Self {
            output,
            input: input.to_owned(),
            mu: mean(effects),
            mu_star: mean(&magnitudes),
            sigma: standard_deviation(effects),
            mu_star_half_interval: 1.96 * standard_deviation(&magnitudes)
                / (count.max(1) as f64).sqrt(),
            walks: count,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{design::morris_places, distribution::Place};

    #[test]
    fn verify_ranks_and_their_correlation() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [2.5, 0.0, 2.5, 1.0]);
        let cubes: Vec<(f64, f64)> = (-5..6)
            .map(|x| (f64::from(x), f64::from(x).powi(3)))
            .collect();
        assert!((rank_correlation(&cubes).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(
            rank_correlation(&[(1.0, 2.0), (2.0, 2.0), (3.0, 2.0)]),
            None
        );
    }

    #[test]
    fn verify_means_of_levels_and_of_slices() {
        let all = |pairs: &[(f64, f64)]| -> Vec<(f64, f64)> {
            slices(pairs).into_iter().map(means).collect()
        };
        assert_eq!(
            all(&[(1.0, 2.0), (1.0, 4.0), (2.0, 5.0)]),
            [(1.0, 3.0), (2.0, 5.0)]
        );
        let line: Vec<(f64, f64)> = (0..100)
            .map(|x| (f64::from(x), 2.0 * f64::from(x)))
            .collect();
        let means = all(&line);
        assert_eq!((means.len(), means[0]), (10, (4.5, 9.0)));
    }

    #[test]
    fn verify_what_an_input_that_does_nothing_spans() {
        // Ten means of 40 numbers of chance, each with a standard deviation of root(1/12/40) = 0.0456: the range of ten
        // normal numbers stays below 4.47 of theirs in 95 of 100 (Pearson and Hartley 1954).
        let mut numbers = Numbers::of(7);
        let pairs: Vec<(f64, f64)> = (0..400).map(|x| (f64::from(x), numbers.share())).collect();
        let by_chance = span_by_chance(&slices(&pairs));
        assert!(
            (by_chance / (4.47 * 0.0456) - 1.0).abs() < 0.1,
            "{by_chance}"
        );
    }

    #[test]
    fn verify_effects_of_a_plane_are_its_slopes_and_those_of_a_product_scatter() {
        let (inputs, levels, seed) = (3, 4, 5);
        let value = |row| {
            let x: Vec<f64> = morris_places(row, inputs, levels, seed)
                .into_iter()
                .map(|place| match place {
                    Place::Along(part) => part,
                    _ => f64::NAN,
                })
                .collect();
            2.0 * x[0] + 3.0 * x[1] * x[2]
        };
        let values: Vec<f64> = (0..400).map(value).collect();
        let effects = effects(
            inputs,
            &|number| Walk::new(number, inputs, levels, seed),
            &values,
        );
        let [plane, product, _] = [0, 1, 2].map(|input| Elementary::of("y", "x", &effects[input]));
        assert!((plane.mu - 2.0).abs() < 1e-12 && plane.sigma < 1e-12);
        // 3 x2 where x2 is 0, 1/3, 2/3 or 1: mean 1.5, standard deviation sqrt(5) / 2.
        assert!((product.mu_star - 1.5).abs() < 0.3 && (product.sigma - 1.118).abs() < 0.2);
        assert_eq!(plane.walks, 100);
    }
}
