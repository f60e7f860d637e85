//! The effects of inputs on outputs.

use condyle_case::study::{Design, Input, Variation};
use condyle_lab::measured::student;
use serde::Serialize;

use crate::{
    answers::{
        data::{Data, OutputOfDesign},
        emulated::Emulated,
    },
    design::Walk,
    plan::designs,
    random::Random,
    search::ends,
    statistics::{extent, mean, rank_correlation, standard_deviation},
};

/// Slices of the values of an input, with equal numbers of tests.
const SLICES: usize = 10;
/// Random orders of the outputs, from which the span of an inactive input is found.
const SHUFFLES: u64 = 200;
/// Seed of these orders: answers are the same whenever they are computed.
const SEED: u64 = 19_540_601;
/// Points of a scatter plot: more would fill the picture and its file.
const MAX_POINTS: usize = 400;

/// The effect of an input on an output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Effect {
    pub output: &'static str,
    /// The name of the design, if the study compares designs: their effects may have opposite signs.
    pub design: Option<String>,
    pub input: String,
    pub name: String,
    /// Spearman's; none for words, and for tests that were chosen by those before them.
    pub rank_correlation: Option<f64>,
    /// Mean value of the input in each slice or at each level, and mean of the output there.
    pub means: Vec<(f64, f64)>,
    /// The levels, where they are words.
    pub words: Vec<String>,
    /// Mean of the output over all of them.
    pub mean: f64,
    /// Largest less smallest mean of the output, in its unit.
    pub span: f64,
    /// The 95th percentile of the span of an inactive input, or the span that may be an error of the emulator; none if the tests are
    /// not a random sample.
    pub span_by_chance: Option<f64>,
    /// True if the means are those of the predictions of an emulator.
    pub is_emulated: bool,
    /// Values of the input and the output in a subset of the tests, for a picture.
    #[serde(skip)]
    pub points: Vec<(f64, f64)>,
}

/// Returns the effects of every input on every output of each design: from its emulator, of which the tests in a slice are only a
/// noisy sample, where answers are computed from it.
pub(crate) fn effects(data: &Data<'_>, emulated: &[Emulated]) -> Vec<Effect> {
    let of_input = |place| {
        let outputs = data.outputs_of_designs();
        outputs.filter_map(move |own| effect(data, emulated, place, own))
    };
    (0..data.inputs.len()).flat_map(of_input).collect()
}

/// Returns the effect of the input at `place`; none if all tests that are done have one value of it: it is not known, and is not
/// zero.
fn effect(
    data: &Data<'_>,
    emulated: &[Emulated],
    place: usize,
    (output, values, design): OutputOfDesign<'_>,
) -> Option<Effect> {
    let study = data.plan.study();
    let (input, column) = (&study.inputs[place], &data.inputs[place]);
    let name = data.name_of(design);
    let tested = pairs(data, place, values, design);
    let mut emulated = emulated.iter();
    let own = emulated.find(|one| one.output == output.key && one.design == name);
    let predicted = own.and_then(|own| own.main_effects.get(place));
    // Equal inputs are sorted by the output, so that sums do not depend on the order of the tests.
    let mut pairs = predicted.map_or(&tested, |own| &own.means).clone();
    pairs.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let slices = slices(&pairs);
    let means: Vec<(f64, f64)> = slices.iter().map(|slice| means(slice)).collect();
    if means.len() < 2 {
        return None;
    }
    let span = span(means.iter().map(|mean| mean.1));
    let span_by_chance = match predicted {
        Some(own) => Some(own.error * span),
        None => data.is_sample().then(|| span_by_chance(&slices)),
    };
    let correlation = rank_correlation(&tested);
    let correlation = correlation.filter(|_| column.words.is_empty() && !data.plan.is_sequential());
    let most = (MAX_POINTS / designs(study)).max(1);
    let every = tested.len().div_ceil(most).max(1);
    Some(Effect {
        output: output.key,
        design: name,
        input: input.key.clone(),
        name: input.name.clone(),
        rank_correlation: correlation,
        words: column.words.clone(),
        mean: mean(&pairs.iter().map(|pair| pair.1).collect::<Vec<_>>()),
        span,
        span_by_chance,
        is_emulated: predicted.is_some(),
        means,
        points: tested.into_iter().step_by(every).collect(),
    })
}

/// Returns the values of an input and an output in each test of a design that is done: of a Saltelli design in its independent
/// points, since tests that depend on each other have less chance than as many independent ones. In a one-at-a-time design,
/// tests that change another input do not count.
fn pairs(data: &Data<'_>, place: usize, output: &[f64], design: usize) -> Vec<(f64, f64)> {
    let is_one_at_a_time = matches!(data.plan.study().design, Design::OneAtATime(_));
    let counts = |row: usize| {
        !is_one_at_a_time
            || data.plan.test(row as u64).is_some_and(|test| {
                test.values[place].is_some() || test.values.iter().all(Option::is_none)
            })
    };
    let tests = data.tests_of(design).filter(|test| counts(*test));
    let pairs = tests.map(|test| (data.inputs[place].values[test], output[test]));
    pairs
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect()
}

/// Returns the pairs at each value if there are few, otherwise in slices; `sorted` by the input.
fn slices(sorted: &[(f64, f64)]) -> Vec<&[(f64, f64)]> {
    let by_value: Vec<&[(f64, f64)]> = sorted.chunk_by(|one, other| one.0 == other.0).collect();
    if by_value.len() <= SLICES {
        by_value
    } else {
        let end = |slice: usize| slice * sorted.len() / SLICES;
        let slice = |slice: usize| &sorted[end(slice)..end(slice + 1)];
        (0..SLICES).map(slice).collect()
    }
}

fn means(slice: &[(f64, f64)]) -> (f64, f64) {
    let (x, y): (Vec<f64>, Vec<f64>) = slice.iter().copied().unzip();
    (mean(&x), mean(&y))
}

/// Returns the largest less smallest value; 0 for none.
fn span(values: impl Iterator<Item = f64>) -> f64 {
    let [low, high] = extent(values);
    (high - low).max(0.0)
}

/// Returns the 95th percentile of the span of the means of these slices if the output did not depend on the input, by
/// random permutations of the outputs.
fn span_by_chance(slices: &[&[(f64, f64)]]) -> f64 {
    let values: Vec<f64> = slices.concat().into_iter().map(|pair| pair.1).collect();
    let spans = (0..SHUFFLES).map(|number| {
        let mut order: Vec<usize> = (0..values.len()).collect();
        Random::stream(SEED, number).shuffle(&mut order);
        let mut rest = order.as_slice();
        span(slices.iter().map(|slice| {
            let (own, others) = rest.split_at(slice.len());
            rest = others;
            own.iter().map(|&place| values[place]).sum::<f64>() / own.len() as f64
        }))
    });
    let mut spans: Vec<f64> = spans.collect();
    spans.sort_by(f64::total_cmp);
    // One random order in twenty has a larger span.
    spans[spans.len() * 95 / 100]
}

/// The elementary effects of an input on an output over its range, by walks (Morris 1991; Campolongo et al. 2007), in the
/// unit of the output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Elementary {
    pub output: &'static str,
    pub input: String,
    pub mu: f64,
    pub mu_star: f64,
    /// Standard deviation: large for nonlinear effects and interactions.
    pub sigma: f64,
    /// Half of the 95 % interval of `mu_star`; none for a single walk.
    pub mu_star_half_interval: Option<f64>,
    pub walks: usize,
}

/// Returns the elementary effects of a Morris design, of inputs that have any; empty for other designs.
pub(crate) fn elementary_effects(data: &Data<'_>) -> Vec<Elementary> {
    let study = data.plan.study();
    let Design::Morris(keys) = &study.design else {
        return Vec::new();
    };
    let inputs = study.inputs.len();
    let walk = |number| Walk::new(number, inputs, keys.levels, keys.seed);
    let part = |input: usize, row: usize, step: f64| {
        let values = &data.inputs[input].values;
        part_of_range(&study.inputs[input], [values[row], values[row + 1]], step)
    };
    let mut all = Vec::new();
    for (output, values) in &data.outputs {
        let effects = of_walks(inputs, &walk, &part, values);
        let pairs = study.inputs.iter().zip(effects);
        // Without a step between two solved tests nothing is known of an input, not even that it has no effect.
        let pairs = pairs.filter(|(_, effects)| !effects.is_empty());
        all.extend(pairs.map(|(input, effects)| Elementary::new(output.key, &input.key, &effects)));
    }
    all
}

/// Returns the signed part of its range that an input moves from one value to another by a step of the grid; 0 if it stays.
///
/// Levels and whole numbers move farther or less far than the grid. Any change between words, which have no order, is all of
/// their range.
fn part_of_range(input: &Input, [before, after]: [f64; 2], grid_step: f64) -> f64 {
    match &input.variation {
        Variation::Levels(keys) if keys.levels.0.iter().any(|level| level.number().is_none()) => {
            return f64::from(before != after) * grid_step.signum();
        }
        Variation::Levels(_) => {}
        _ if input.is_whole => {}
        _ => return grid_step,
    }
    let [low, high] = ends(input);
    (after - before) / (high - low)
}

/// Returns the effects of every input, one for each walk; steps from or to a test that failed are omitted, as are those that
/// change nothing. `part` is the signed part of the range that an input moves after a row by a step of the grid.
fn of_walks(
    inputs: usize,
    walk: &dyn Fn(u64) -> Walk,
    part: &dyn Fn(usize, usize, f64) -> f64,
    values: &[f64],
) -> Vec<Vec<f64>> {
    let mut effects = vec![Vec::new(); inputs];
    for (number, tests) in (0..).zip(values.chunks_exact(inputs + 1)) {
        let walk = walk(number);
        for step in 0..inputs {
            let (input, grid_step) = walk.step(step);
            let row = number as usize * (inputs + 1) + step;
            let effect = (tests[step + 1] - tests[step]) / part(input, row, grid_step);
            if effect.is_finite() {
                effects[input].push(effect);
            }
        }
    }
    effects
}

impl Elementary {
    fn new(output: &'static str, input: &str, effects: &[f64]) -> Self {
        let magnitudes: Vec<f64> = effects.iter().map(|effect| effect.abs()).collect();
        let count = effects.len();
        Self {
            output,
            input: input.to_owned(),
            mu: mean(effects),
            mu_star: mean(&magnitudes),
            sigma: standard_deviation(effects),
            mu_star_half_interval: student(0.95, count.saturating_sub(1))
                .map(|quantile| quantile * standard_deviation(&magnitudes) / (count as f64).sqrt()),
            walks: count,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use condyle_case::{
        config::{Level, Levels},
        study::{LevelKeys, UniformKeys},
    };
    use condyle_results::catalogue::MASS_LOSS_MG;

    use crate::{
        answers::emulated::emulated,
        design::{Saltelli, morris_places},
        distribution::Place,
        plan::Plan,
        store::Column,
    };

    #[test]
    fn verify_means_of_levels_and_of_slices() {
        let all = |pairs: &[(f64, f64)]| -> Vec<(f64, f64)> {
            slices(pairs).into_iter().map(means).collect()
        };
        assert_eq!(
            all(&[(1.0, 2.0), (1.0, 4.0), (2.0, 5.0)]),
            [(1.0, 3.0), (2.0, 5.0)]
        );
        let counts = |tests: u32| {
            let tests: Vec<(f64, f64)> = (0..tests).map(|x| (f64::from(x), 0.0)).collect();
            slices(&tests)
                .iter()
                .map(|slice| slice.len())
                .collect::<Vec<_>>()
        };
        assert_eq!(counts(64), [6, 6, 7, 6, 7, 6, 6, 7, 6, 7]);
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
        let mut numbers = Random::stream(7, 0);
        let pairs: Vec<(f64, f64)> = (0..400).map(|x| (f64::from(x), numbers.share())).collect();
        let by_chance = span_by_chance(&slices(&pairs));
        assert!(
            (by_chance / (4.47 * 0.0456) - 1.0).abs() < 0.1,
            "{by_chance}"
        );
    }

    #[test]
    fn verify_the_interval_of_few_walks_is_that_of_student() {
        let found = Elementary::new("mass_loss_mg", "x", &[1.0, -2.0, 3.0, -4.0, 5.0, -6.0]);
        // The standard deviation of 1 to 6 is root(3.5).
        let exact = 2.570_58 * (3.5_f64 / 6.0).sqrt();
        assert!((found.mu_star_half_interval.unwrap() - exact).abs() < 1e-4);
        let single = Elementary::new("mass_loss_mg", "x", &[1.0]);
        assert_eq!(single.mu_star_half_interval, None);
    }

    const KEYS: [(&str, f64); 8] = [
        ("contact.friction", 0.05),
        ("femur.distal_radius_mm", 37.0),
        ("femur.posterior_radius_mm", 21.0),
        ("femur.coronal_radius_mm", 23.0),
        ("insert.sagittal_radius_mm", 55.0),
        ("insert.coronal_radius_mm", 30.0),
        ("insert.thickness_mm", 9.0),
        ("material.poissons_ratio", 0.4),
    ];

    /// Returns a plan of eight inputs.
    fn plan(design: &str) -> Plan {
        let folder = tempfile::tempdir().unwrap();
        let vary = KEYS.map(|(key, low)| {
            let high = 1.01 * low;
            format!("[[vary]]\nkey = \"{key}\"\nlow = {low}\nhigh = {high}\n")
        });
        let text = format!("case = \"case.toml\"\n{design}\n{}", vary.concat());
        std::fs::write(folder.path().join("case.toml"), "").unwrap();
        std::fs::write(folder.path().join("study.toml"), text).unwrap();
        Plan::read(&folder.path().join("study.toml")).unwrap()
    }

    /// Returns tests whose output is `of` their row and their inputs.
    fn data<'a>(
        plan: &'a Plan,
        shares: &dyn Fn(u64) -> Vec<f64>,
        of: &dyn Fn(u64, &[f64]) -> f64,
    ) -> Data<'a> {
        let shares: Vec<Vec<f64>> = (0..plan.tests()).map(shares).collect();
        let column = |place: usize| Column {
            values: shares.iter().map(|shares| shares[place]).collect(),
            words: Vec::new(),
        };
        let values = (0..).zip(&shares).map(|(row, shares)| of(row, shares));
        Data {
            plan,
            inputs: (0..KEYS.len()).map(column).collect(),
            outputs: vec![(&MASS_LOSS_MG, values.collect())],
            within: vec![true; shares.len()],
            kept: vec![true; shares.len()],
            doubts: Column::default(),
        }
    }

    /// Returns how many of the effects exceed what an input without influence spans by chance.
    fn beyond_chance(effects: &[Effect]) -> usize {
        let beyond =
            |effect: &&Effect| effect.span_by_chance.is_some_and(|most| effect.span > most);
        effects.iter().filter(beyond).count()
    }

    #[test]
    fn inputs_whose_every_step_failed_have_no_elementary_effects() {
        let plan = plan("[design]\nkind = \"morris\"\nwalks = 4\nlevels = 4\nseed = 1");
        // All tests after the step of the first input fail.
        let inputs = KEYS.len();
        let is_solved = |row: u64| {
            let walk = Walk::new(row / (inputs as u64 + 1), inputs, 4, 1);
            let steps = row as usize % (inputs + 1);
            (0..steps).all(|step| walk.step(step).0 != 0)
        };
        let of = |row, _: &[f64]| if is_solved(row) { row as f64 } else { f64::NAN };
        let found = elementary_effects(&data(&plan, &|_| vec![0.0; inputs], &of));
        assert!(!found.is_empty() && found.iter().all(|one| one.input != KEYS[0].0));
    }

    #[test]
    fn inputs_without_influence_stay_within_chance_though_saltelli_tests_depend_on_each_other() {
        let plan = plan("[design]\nkind = \"saltelli\"\nsize = 256");
        let shares = |row| {
            let places = Saltelli::places(row, KEYS.len(), 1).into_iter();
            let share = |place| match place {
                Place::Share(share) => share,
                _ => f64::NAN,
            };
            places.map(share).collect()
        };
        let found = effects(&data(&plan, &shares, &|_, shares| shares[0]), &[]);
        assert!(found[0].span > 2.0 * found[0].span_by_chance.unwrap());
        // One in twenty is expected; if dependent rows are shuffled too, nearly all exceed it.
        assert!(beyond_chance(&found[1..]) <= 2);
    }

    #[test]
    fn verify_designs_with_opposite_effects_hide_none() {
        let design = "[design]\nsize = 400\n[[alternative]]\nname = \"a\"\nset = [\"insert.edge_mm=2\"]\n\
                      [[alternative]]\nname = \"b\"\nset = [\"insert.edge_mm=3\"]";
        let plan = plan(design);
        let shares = |row| {
            let mut numbers = Random::stream(5, row / 2);
            (0..KEYS.len()).map(|_| numbers.share()).collect()
        };
        // The second design has the opposite effect: the mean of both would have none.
        let of = |row, shares: &[f64]| match row % 2 {
            0 => shares[0],
            _ => 10.0 - shares[0],
        };
        let found = effects(&data(&plan, &shares, &of), &[]);
        for (effect, name) in found.iter().zip(["a", "b"]) {
            assert_eq!(
                (effect.design.as_deref(), effect.points.len()),
                (Some(name), 200)
            );
            assert!(effect.span > 2.0 * effect.span_by_chance.unwrap());
        }
        let correlations = [0, 1].map(|design| found[design].rank_correlation.unwrap());
        assert!(correlations[0] > 0.999 && correlations[1] < -0.999);
        assert!(beyond_chance(&found[2..]) <= 2);
    }

    /// A tenth of 60 tests differs by chance by more than half of the effect of the second input.
    #[test]
    fn verify_effects_by_an_emulator_are_those_of_the_function() {
        let design = "[design]\nsize = 60\n[[alternative]]\nname = \"a\"\nset = [\"insert.edge_mm=2\"]\n\
                      [[alternative]]\nname = \"b\"\nset = [\"insert.edge_mm=3\"]";
        let plan = plan(design);
        let values = |row| {
            let mut numbers = Random::stream(5, row / 2);
            let low = KEYS.iter().map(|(_, low)| low);
            low.map(|low| low * (1.0 + 0.01 * numbers.share()))
                .collect()
        };
        let of = |row, values: &[f64]| {
            let share = |place: usize| 100.0 * (values[place] / KEYS[place].1 - 1.0);
            (3.0 * share(0) + 0.5 * share(1)) * (1.0 + (row % 2) as f64)
        };
        let data = data(&plan, &values, &of);
        let found = effects(&data, &emulated(&data).0);
        // Over the means of tenths, of both designs, of which the second has twice the effects.
        for (effect, exact) in found.iter().zip([2.7, 5.4, 0.45, 0.9, 0.0, 0.0]) {
            let by_chance = effect.span_by_chance.unwrap();
            assert!(effect.is_emulated && (effect.span > by_chance) == (exact > 0.0));
            // The line of the picture is within each bar.
            let [low, high] = extent(effect.means.iter().map(|mean| mean.1));
            assert!(low <= effect.mean && effect.mean <= high);
            assert!(
                (effect.span - exact).abs() < 0.05,
                "{}: {}",
                effect.input,
                effect.span
            );
        }
    }

    #[test]
    fn verify_effects_of_a_plane_are_its_slopes_and_those_of_a_product_scatter() {
        let (inputs, levels, seed) = (3, 4, 5);
        let x_of = |row: usize| -> Vec<f64> {
            let places = morris_places(row as u64, inputs, levels, seed).into_iter();
            let part = |place| match place {
                Place::Along(part) => part,
                _ => f64::NAN,
            };
            places.map(part).collect()
        };
        let value = |row| {
            let x = x_of(row);
            2.0 * x[0] + 3.0 * x[1] * x[2]
        };
        let values: Vec<f64> = (0..400).map(value).collect();
        let effects = of_walks(
            inputs,
            &|number| Walk::new(number, inputs, levels, seed),
            &|_, _, step| step,
            &values,
        );
        let [plane, product, _] = [0, 1, 2].map(|input| Elementary::new("y", "x", &effects[input]));
        assert!((plane.mu - 2.0).abs() < 1e-12 && plane.sigma < 1e-12);
        // 3 x2 where x2 is 0, 1/3, 2/3 or 1: mean 1.5, standard deviation sqrt(5) / 2.
        assert!((product.mu_star - 1.5).abs() < 0.3 && (product.sigma - 1.118).abs() < 0.2);
        assert_eq!(plane.walks, 100);
    }

    #[test]
    fn verify_levels_move_by_their_own_steps_and_words_by_their_range() {
        let part = |levels: Vec<Level>, values| {
            let levels = Levels(levels);
            let keys = LevelKeys { levels };
            let input = Input::new("x", Variation::Levels(keys));
            part_of_range(&input, values, -2.0 / 3.0)
        };
        let numbers = || [1.0, 10.0, 2.0].map(Level::Number).to_vec();
        assert_eq!(part(numbers(), [10.0, 2.0]), -8.0 / 9.0);
        assert_eq!(part(numbers(), [2.0, 2.0]), 0.0);
        // The places of words are alphabetical.
        let words = || {
            ["c", "a", "b"]
                .map(|word| Level::Word(word.to_owned()))
                .to_vec()
        };
        assert_eq!(part(words(), [0.0, 1.0]), -1.0);
        assert_eq!(part(words(), [2.0, 2.0]).abs(), 0.0);
        let (low, high) = (1.0, 3.0);
        let mut whole = Input::new(
            "march.updates",
            Variation::Uniform(UniformKeys { low, high }),
        );
        whole.is_whole = true;
        assert_eq!(part_of_range(&whole, [1.0, 2.0], 2.0 / 3.0), 0.5);
    }
}
