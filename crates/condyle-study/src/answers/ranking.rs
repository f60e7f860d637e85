//! Comparison of designs, the optimum of a search, and the Pareto front.

use std::cmp::Ordering;

use condyle_case::study::{Bound, Input};
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{
    answers::{
        data::Data,
        words::{percent, sides_in_words, with_interval},
    },
    error::StudyError,
    plan::designs,
    search::{Standing, is_converged, standing, starting_test},
    statistics::{central_interval, extent, mean, standard_deviation, wilson_interval},
    store::{Column, Store},
};

/// A comparison of designs, each tested under the same disturbances.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Ranking {
    pub output: &'static str,
    pub title: &'static str,
    pub unit: &'static str,
    /// Disturbances under which all designs were tested, and which are compared.
    pub disturbances: usize,
    /// Those under which the tests of all designs are solved.
    pub solved: usize,
    /// True if the disturbances are a random sample, so that shares of them are probabilities.
    pub is_sample: bool,
    /// The limits, then that of being solved.
    pub limits: Vec<RankedLimit>,
    pub designs: Vec<RankedDesign>,
}

/// A side of a limit, and the probability with which a design must keep it to rank before those that do not.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct RankedLimit {
    pub words: String,
    pub probability: f64,
}

/// Probability with which a design must be solved.
const MIN_SOLVED: f64 = 0.95;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct RankedDesign {
    pub name: String,
    /// All tests of the design, those that could not be solved, and the doubtful ones.
    pub tests: usize,
    pub failed: usize,
    pub doubtful: usize,
    /// Over the disturbances under which the tests of all designs are solved; NaN without one.
    pub mean: f64,
    pub standard_deviation: f64,
    /// Share of the disturbances under which the design is within every limit; one that cannot be solved is not.
    pub within_limits: f64,
    pub within_limits_interval: [f64; 2],
    /// Share of its tests in which it keeps each limit.
    pub kept: Vec<f64>,
    /// True if it keeps each limit with the probability that the limit demands.
    pub keeps_limits: bool,
    /// Mean probability of beating another design.
    pub wins: f64,
    /// Share of the disturbances under which the design is solved and no other one is better.
    pub best: f64,
    pub best_interval: [f64; 2],
    /// The probability of beating each design of the list: one that is solved beats one that is not, and ties, also of two
    /// that are not solved, count half.
    pub beats: Vec<f64>,
    pub beats_intervals: Vec<[f64; 2]>,
    /// The range that holds 95 % of the differences of the next design's output from that of this one under the same disturbance,
    /// where all designs are solved; none for the last design.
    pub lead: Option<[f64; 2]>,
}

/// The output of one design under every disturbance.
struct Outcomes {
    name: String,
    /// Infinite where the test could not be solved: such a design is worse than one that could, and not left out, since it
    /// would otherwise be compared under easy disturbances only.
    values: Vec<f64>,
    /// Of each test of the design; none where the test could not be solved.
    within_limits: Vec<Option<bool>>,
    /// Share of the tests that keep each limit.
    kept: Vec<f64>,
    doubtful: usize,
}

impl Ranking {
    /// Ranks the designs of a study; none if it compares no designs.
    pub fn read(data: &Data<'_>, store: &Store) -> Result<Option<Self>, StudyError> {
        let study = data.plan.study();
        if study.alternatives.is_empty() {
            return Ok(None);
        }
        let output = study.answers.rank_by;
        let values = store.column(data.plan, output.key)?.values;
        let count = designs(study);
        let tested = data.kept.chunks(count).enumerate();
        let tested = tested.filter(|(_, designs)| designs.iter().all(|is| *is));
        let compared: Vec<usize> = tested.map(|(row, _)| row * count).collect();
        let or_infinite = |value: f64| match value.is_finite() {
            true => value,
            false => f64::INFINITY,
        };
        let limits = limits(data, &values);
        let alternatives = study.alternatives.iter().enumerate();
        let outcomes = alternatives.map(|(place, design)| {
            let compared = compared.iter().map(|first| values[first + place]);
            let kept = (place..values.len()).step_by(count);
            let kept: Vec<usize> = kept.filter(|test| data.kept[*test]).collect();
            let within = |test: &usize| values[*test].is_finite().then_some(data.within[*test]);
            let share = |keeps: &[bool]| {
                let own = kept.iter().map(|test| f64::from(keeps[*test]));
                mean(&own.collect::<Vec<_>>())
            };
            let is_doubtful = |test: &&usize| data.doubts(**test).is_some();
            Outcomes {
                name: design.name.clone(),
                values: compared.map(or_infinite).collect(),
                within_limits: kept.iter().map(within).collect(),
                kept: limits.iter().map(|(_, keeps)| share(keeps)).collect(),
                doubtful: kept.iter().filter(is_doubtful).count(),
            }
        });
        let outcomes: Vec<Outcomes> = outcomes.collect();
        let limits: Vec<RankedLimit> = limits.into_iter().map(|(limit, _)| limit).collect();
        Ok(Some(Self {
            output: output.key,
            title: output.label,
            unit: output.unit(),
            disturbances: compared.len(),
            solved: solved_by_all(&outcomes).len(),
            is_sample: data.is_sample(),
            designs: ranked(&outcomes, &limits),
            limits,
        }))
    }

    /// Returns a share of the disturbances in words, with the interval of the probability if they are a sample.
    pub fn share(&self, share: f64, interval: [f64; 2]) -> String {
        match self.is_sample {
            true => with_interval(share, interval),
            false => percent(share),
        }
    }
}

/// Returns both sides of every limit, then that of being solved, and whether each test keeps it; `values` are those that rank.
fn limits(data: &Data<'_>, values: &[f64]) -> Vec<(RankedLimit, Vec<bool>)> {
    let bounds = data.plan.study().answers.bounds.iter();
    let sides = bounds.flat_map(|bound| {
        let words = sides_in_words(bound);
        bound.sides().zip(words).map(move |((sign, limit), words)| {
            let keeps = |value: &f64| sign * (value - limit) <= 0.0;
            let limit = RankedLimit {
                words,
                probability: bound.probability,
            };
            (limit, data.of(bound.output).iter().map(keeps).collect())
        })
    });
    let solved = RankedLimit {
        words: "solved".to_owned(),
        probability: MIN_SOLVED,
    };
    let is_solved = values.iter().map(|value| value.is_finite());
    sides.chain([(solved, is_solved.collect())]).collect()
}

impl Outcomes {
    /// Returns the share of the tests within every limit and its interval: an unsolved test counts as beyond a limit in the
    /// share, and both ways in the interval, since the implant may be one that the test overloads.
    fn within(&self) -> (f64, [f64; 2]) {
        let tests = self.within_limits.len() as f64;
        let (within, unsolved) = (self.count(Some(true)) as f64, self.count(None) as f64);
        let [low, high] = [within, within + unsolved].map(|hits| wilson_interval(hits, tests));
        (within / tests.max(1.0), [low[0], high[1]])
    }

    fn count(&self, of: Option<bool>) -> usize {
        self.within_limits.iter().filter(|one| **one == of).count()
    }

    /// Returns the number of disturbances under which the output is smaller than that of another design; a tie counts as half.
    fn wins(&self, other: &Self) -> f64 {
        let win = |(one, other): (&f64, &f64)| match one.total_cmp(other) {
            Ordering::Less => 1.0,
            Ordering::Equal => 0.5,
            Ordering::Greater => 0.0,
        };
        self.values.iter().zip(&other.values).map(win).sum()
    }

    /// Returns a number of disturbances as a share of all, and the interval of the probability.
    fn share(&self, hits: f64) -> (f64, [f64; 2]) {
        let tests = self.values.len() as f64;
        (hits / tests.max(1.0), wilson_interval(hits, tests))
    }

    /// Returns the range of 95 % of the differences of the output of the next design under the `solved` disturbances; none without
    /// one.
    fn lead(&self, next: &Self, solved: &[usize]) -> Option<[f64; 2]> {
        let difference = |row: &usize| next.values[*row] - self.values[*row];
        (!solved.is_empty()).then(|| central_interval(solved.iter().map(difference).collect()))
    }

    /// Returns the design compared with `all`, without what depends on their order.
    fn compared(&self, all: &[Outcomes], solved: &[usize], limits: &[RankedLimit]) -> RankedDesign {
        let is_best = |row: &usize| {
            let value = self.values[*row];
            value.is_finite() && all.iter().all(|other| value <= other.values[*row])
        };
        let hits = (0..self.values.len()).filter(is_best).count() as f64;
        let (best, best_interval) = self.share(hits);
        let values: Vec<f64> = solved.iter().map(|row| self.values[*row]).collect();
        let of_solved = |of: fn(&[f64]) -> f64| match values.is_empty() {
            true => f64::NAN,
            false => of(&values),
        };
        // A design ties with itself.
        let won: f64 = all.iter().map(|other| self.wins(other)).sum();
        let (tests, others) = (self.values.len() as f64, all.len() as f64 - 1.0);
        let (within_limits, within_limits_interval) = self.within();
        let mut kept = self.kept.iter().zip(limits);
        RankedDesign {
            name: self.name.clone(),
            tests: self.within_limits.len(),
            failed: self.count(None),
            doubtful: self.doubtful,
            mean: of_solved(mean),
            standard_deviation: of_solved(standard_deviation),
            within_limits,
            within_limits_interval,
            kept: self.kept.clone(),
            keeps_limits: kept.all(|(kept, limit)| *kept >= limit.probability),
            wins: (won - 0.5 * tests) / (others.max(1.0) * tests.max(1.0)),
            best,
            best_interval,
            beats: Vec::new(),
            beats_intervals: Vec::new(),
            lead: None,
        }
    }
}

/// Returns the disturbances under which every design is solved.
fn solved_by_all(all: &[Outcomes]) -> Vec<usize> {
    let count = all.first().map_or(0, |design| design.values.len());
    let is_solved = |row: &usize| all.iter().all(|design| design.values[*row].is_finite());
    (0..count).filter(is_solved).collect()
}

/// Returns the designs that keep the limits, then the others by how often they keep all; equal ones by how often they beat
/// another, then by the mean.
fn ranked(all: &[Outcomes], limits: &[RankedLimit]) -> Vec<RankedDesign> {
    let solved = solved_by_all(all);
    let compared = |own| (Outcomes::compared(own, all, &solved, limits), own);
    let mut order: Vec<(RankedDesign, &Outcomes)> = all.iter().map(compared).collect();
    // How often a design is best depends on the others: the last of three may be best more often than the second.
    order.sort_by(|(one, _), (other, _)| {
        let within =
            |design: &RankedDesign| f64::max(design.within_limits, f64::from(design.keeps_limits));
        within(other)
            .total_cmp(&within(one))
            .then(other.wins.total_cmp(&one.wins))
            .then(one.mean.total_cmp(&other.mean))
    });
    let (mut designs, outcomes): (Vec<_>, Vec<_>) = order.into_iter().unzip();
    for (place, (design, own)) in designs.iter_mut().zip(&outcomes).enumerate() {
        let beats = outcomes.iter().map(|other| own.share(own.wins(other)));
        (design.beats, design.beats_intervals) = beats.unzip();
        design.lead = outcomes
            .get(place + 1)
            .and_then(|next| own.lead(next, &solved));
    }
    designs
}

/// The optimum that a search found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Best {
    pub minimised: &'static str,
    #[serde(skip)]
    pub unit: &'static str,
    /// The best test within every limit, if there is one.
    pub row: Option<u64>,
    pub inputs: Vec<Valued>,
    pub outputs: Vec<Valued>,
    /// Distances of the best test from the limits, positive within them.
    pub margins: Vec<Margin>,
    pub standing: Option<Standing>,
    /// The number of tests and the best value, at each improvement.
    #[serde(skip)]
    pub progress: Vec<(f64, f64)>,
}

/// A value of the best test, and that of the one that the search starts from: the case itself, if it lies within the ranges.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Valued {
    pub name: String,
    pub value: f64,
    pub first: f64,
}

impl Valued {
    pub fn new(name: &str, values: &[f64], [row, first]: [usize; 2]) -> Self {
        Self {
            name: name.to_owned(),
            value: values[row],
            first: values[first],
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Margin {
    pub output: &'static str,
    pub limit: f64,
    pub margin: f64,
}

impl Best {
    /// Returns the optimum; none for a study that is not a search for one, and for a robust search.
    pub fn read(data: &Data<'_>, store: &Store) -> Result<Option<Self>, StudyError> {
        let (plan, study) = (data.plan, data.plan.study());
        let ([minimised], false) = (&study.objectives()[..], study.is_robust()) else {
            return Ok(None);
        };
        let values = store.column(plan, minimised.key)?.values;
        let (row, progress) = least(&values, &data.within);
        let known = store.known(plan, 0)?;
        let start = starting_test(plan, &known);
        let mut best = Self {
            minimised: minimised.key,
            unit: minimised.unit(),
            row: row.map(|row| row as u64),
            inputs: Vec::new(),
            outputs: Vec::new(),
            margins: Vec::new(),
            standing: standing(plan, &known),
            progress,
        };
        let Some(row) = row else {
            return Ok(Some(best));
        };
        let valued = |name: &str, values: &[f64]| Valued::new(name, values, [row, start]);
        let inputs = study.inputs.iter().zip(&data.inputs);
        let inputs = inputs.map(|(input, column)| valued(&input.key, &column.values));
        best.inputs = inputs.collect();
        for output in study.outputs.all() {
            let values = store.column(plan, output.key)?.values;
            let sides = study.answers.bounds_of(output).flat_map(Bound::sides);
            best.margins.extend(sides.map(|(sign, limit)| Margin {
                output: output.key,
                limit,
                margin: sign * (limit - values[row]),
            }));
            best.outputs.push(valued(output.key, &values));
        }
        Ok(Some(best))
    }
}

/// Returns the test with the smallest value that keeps every limit, and the improvements up to it.
fn least(values: &[f64], within: &[bool]) -> (Option<usize>, Vec<(f64, f64)>) {
    let (mut best, mut progress) = (None, Vec::new());
    let allowed = values.iter().zip(within).enumerate();
    for (row, (value, _)) in allowed.filter(|(_, (value, within))| **within && value.is_finite()) {
        if best.is_none_or(|best: usize| *value < values[best]) {
            best = Some(row);
            progress.push(((row + 1) as f64, *value));
        }
    }
    (best, progress)
}

/// The tests within all limits that no other test beats in both of two outputs (Pareto 1896).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Front {
    pub outputs: [&'static str; 2],
    pub titles: [&'static str; 2],
    pub units: [&'static str; 2],
    /// Number and both outputs of each test, by the first output.
    pub tests: Vec<(u64, f64, f64)>,
    /// The part of the rectangle between the best and the worst values within all limits that tests of the front beat;
    /// none without two tests on it.
    pub hypervolume: Option<f64>,
    /// The row of the knee point: the test on the front farthest below the line that joins its ends, in units of their
    /// distances (Das 1999); none on a front that is nearly straight or concave.
    pub knee: Option<u64>,
    /// True if the study searched for the front.
    pub is_searched: bool,
    /// Whether the search has converged; none without a search, and before emulators can be fitted.
    pub is_converged: Option<bool>,
    /// The inputs of its tests; only of a search, whose inputs are numbers.
    pub inputs: Vec<InputOfFront>,
    /// Tests within the limits, for a picture; of many, some.
    #[serde(skip)]
    pub others: Vec<(f64, f64)>,
}

/// The values of an input in the tests of a front, in their order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct InputOfFront {
    pub name: String,
    pub values: Vec<f64>,
}

const MAX_POINTS: usize = 1000;

impl Front {
    /// Returns the front; none if the study neither searches for it nor names two outputs.
    pub fn read(data: &Data<'_>, store: &Store) -> Result<Option<Self>, StudyError> {
        let study = data.plan.study();
        // Tests under different disturbances say nothing of the designs.
        let is_searched = study.objectives().len() > 1;
        let is_asked = (is_searched || study.answers.names_pareto) && !study.is_robust();
        let Some(outputs) = study.answers.pareto.filter(|_| is_asked) else {
            return Ok(None);
        };
        let one = store.column(data.plan, outputs[0].key)?.values;
        let other = store.column(data.plan, outputs[1].key)?.values;
        let both = one.into_iter().zip(other).zip(&data.within);
        let tests: Vec<(u64, f64, f64)> = (0..)
            .zip(both)
            .filter(|(_, ((one, other), within))| **within && one.is_finite() && other.is_finite())
            .map(|(row, ((one, other), _))| (row, one, other))
            .collect();
        let every = tests.len().div_ceil(MAX_POINTS).max(1);
        let shown = tests.iter().step_by(every);
        let worst = [
            extent(tests.iter().map(|test| test.1))[1],
            extent(tests.iter().map(|test| test.2))[1],
        ];
        let front = undominated(tests.clone());
        let inputs = study.inputs.iter().zip(&data.inputs);
        let input = |(input, column): (&Input, &Column)| {
            let values = front.iter().map(|test| column.values[test.0 as usize]);
            InputOfFront {
                name: input.name.clone(),
                values: values.collect(),
            }
        };
        Ok(Some(Self {
            inputs: inputs.filter(|_| is_searched).map(input).collect(),
            outputs: outputs.map(|output| output.key),
            titles: outputs.map(|output| output.label),
            units: outputs.map(Scalar::unit),
            others: shown.map(|(_, one, other)| (*one, *other)).collect(),
            is_searched,
            is_converged: if is_searched {
                is_converged(data.plan, &store.known(data.plan, 0)?)
            } else {
                None
            },
            hypervolume: hypervolume(&front, worst),
            knee: knee(&front),
            tests: front,
        }))
    }

    /// Returns the place of the knee among the tests.
    pub fn place_of_knee(&self) -> Option<usize> {
        let mut tests = self.tests.iter();
        tests.position(|test| Some(test.0) == self.knee)
    }
}

/// Returns the front, by the first output. After sorting, a test belongs to it if its second output is below all
/// before.
pub(crate) fn undominated(mut tests: Vec<(u64, f64, f64)>) -> Vec<(u64, f64, f64)> {
    tests.sort_by(|a, b| {
        a.1.total_cmp(&b.1)
            .then(a.2.total_cmp(&b.2))
            .then(a.0.cmp(&b.0))
    });
    let mut least = f64::INFINITY;
    tests.retain(|test| {
        let is_better = test.2 < least;
        least = least.min(test.2);
        is_better
    });
    tests
}

/// Returns the part of the rectangle from the best values of a front to the `worst` ones that its tests beat; none without
/// such a rectangle.
pub(crate) fn hypervolume(front: &[(u64, f64, f64)], worst: [f64; 2]) -> Option<f64> {
    let (first, last) = (front.first()?, front.last()?);
    let whole = (worst[0] - first.1) * (worst[1] - last.2);
    let ends = front.iter().skip(1).map(|test| test.1);
    let strips = front.iter().zip(ends.chain([worst[0]]));
    let beaten: f64 = strips
        .map(|(test, end)| (end - test.1) * (worst[1] - test.2))
        .sum();
    (whole > 0.0).then(|| beaten / whole)
}

fn knee(front: &[(u64, f64, f64)]) -> Option<u64> {
    /// Distance below the line that makes a test a knee: fronts that are nearly straight have none.
    const MIN_BELOW: f64 = 0.05;
    let (first, last) = (front.first()?, front.last()?);
    let [width, height] = [last.1 - first.1, first.2 - last.2];
    let below =
        |test: &(u64, f64, f64)| 1.0 - (test.1 - first.1) / width - (test.2 - last.2) / height;
    let inner = front.iter().filter(|test| below(test) > MIN_BELOW);
    let most = inner.max_by(|one, other| below(one).total_cmp(&below(other)));
    most.map(|test| test.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranks designs whose only limit is to be kept with a probability of 95 %.
    fn ranked_within(all: &[Outcomes]) -> Vec<RankedDesign> {
        ranked(all, &[limit(0.95)])
    }

    fn limit(probability: f64) -> RankedLimit {
        let words = "peak pressure at most 33 MPa".to_owned();
        RankedLimit { words, probability }
    }

    /// Returns 100 tests of a design with this output, of which `kept` keep the limit.
    fn outcomes(name: &str, value: impl Fn(usize) -> f64, kept: usize) -> Outcomes {
        Outcomes {
            name: name.to_owned(),
            values: (0..100).map(value).collect(),
            within_limits: (0..100).map(|test| Some(test < kept)).collect(),
            kept: vec![kept as f64 / 100.0],
            doubtful: 0,
        }
    }

    fn names(designs: &[RankedDesign]) -> Vec<&str> {
        designs.iter().map(|design| &*design.name).collect()
    }

    #[test]
    fn a_design_that_is_best_by_luck_ranks_after_one_that_beats_it() {
        // The worst design is the best in 3 of 100 tests, the second one in none.
        let all = [
            outcomes("flat", |test| if test < 3 { 1.0 } else { 58.0 }, 100),
            outcomes("standard", |_| 46.0, 100),
            outcomes("conforming", |_| 38.0, 100),
        ];
        let ranked = ranked_within(&all);
        assert_eq!(names(&ranked), ["conforming", "standard", "flat"]);
        assert_eq!((ranked[1].best, ranked[2].best), (0.0, 0.03));
        assert_eq!((ranked[0].lead, ranked[2].lead), (Some([8.0; 2]), None));
        assert_eq!(ranked[1].mean - ranked[0].mean, 8.0);
        for (design, wins) in ranked.iter().zip([0.985, 0.485, 0.03]) {
            assert!((design.wins - wins).abs() < 1e-12, "{design:?}");
        }
    }

    #[test]
    fn limits_rank_designs_by_the_probability_that_they_demand() {
        let all = || {
            [
                outcomes("never", |_| 1.0, 0),
                outcomes("often", |_| 3.0, 65),
                outcomes("more often", |_| 4.0, 70),
            ]
        };
        // None keeps it under 95 %: that which keeps it most often is first; under 60 %, two do.
        let [strict, loose] = [0.95, 0.6].map(|probability| ranked(&all(), &[limit(probability)]));
        assert_eq!(names(&strict), ["more often", "often", "never"]);
        assert_eq!(names(&loose), ["often", "more often", "never"]);
        let keep = |designs: &[RankedDesign]| designs.iter().filter(|one| one.keeps_limits).count();
        assert_eq!((keep(&strict), keep(&loose)), (0, 2));
    }

    #[test]
    fn verify_the_hypervolume_and_the_knee_of_a_front() {
        let front = [(7, 0.0, 4.0), (3, 1.0, 1.0), (5, 4.0, 0.0)];
        // Strips of (1 - 0) (5 - 4), (4 - 1) (5 - 1) and (5 - 4) (5 - 0), of 5 times 5.
        let part = hypervolume(&front, [5.0, 5.0]).unwrap();
        assert!((part - 18.0 / 25.0).abs() < 1e-15);
        assert_eq!(knee(&front), Some(3));
        let concave = [(7, 0.0, 4.0), (3, 3.0, 3.0), (5, 4.0, 0.0)];
        assert_eq!((knee(&concave), knee(&front[..1])), (None, None));
        let straight = [(7, 0.0, 4.0), (3, 2.0, 1.9), (5, 4.0, 0.0)];
        assert_eq!(knee(&straight), None);
        assert_eq!(hypervolume(&front[..1], [0.0, 4.0]), None);
    }

    #[test]
    fn verify_common_disturbances_separate_designs_that_scatter_alone_would_hide() {
        // One is always better by 1 where both scatter by 100.
        let base: Vec<f64> = (0..50).map(|row| f64::from(row * 37 % 101)).collect();
        let outcomes = |name: &str, add: f64| Outcomes {
            name: name.to_owned(),
            values: base.iter().map(|value| value + add).collect(),
            within_limits: vec![Some(true); 50],
            kept: vec![1.0],
            doubtful: 0,
        };
        let ranked = ranked_within(&[outcomes("worse", 1.0), outcomes("better", 0.0)]);
        assert_eq!(ranked[0].name, "better");
        assert_eq!(
            (ranked[0].best, ranked[0].beats.as_slice()),
            (1.0, [0.5, 1.0].as_slice())
        );
        assert!(ranked[0].beats_intervals[1][0] > 0.9);
        assert!(ranked[0].standard_deviation > 10.0);
    }

    #[test]
    fn designs_within_their_limits_rank_first() {
        let outcomes = |name: &str, value: f64, within: bool| Outcomes {
            name: name.to_owned(),
            values: vec![value; 20],
            within_limits: vec![Some(within); 20],
            kept: vec![f64::from(within)],
            doubtful: 0,
        };
        let ranked = ranked_within(&[outcomes("flat", 1.0, false), outcomes("deep", 2.0, true)]);
        assert_eq!(ranked[0].name, "deep");
        assert!(ranked[0].within_limits_interval[0] > 0.8);
    }

    #[test]
    fn verify_unsolved_tests_are_not_within_the_limits_and_may_be_in_the_interval() {
        let outcomes = |name: &str, value: f64, unsolved: usize| Outcomes {
            name: name.to_owned(),
            values: vec![value; 20],
            within_limits: [vec![Some(true); 20], vec![None; unsolved]].concat(),
            kept: vec![20.0 / (20 + unsolved) as f64],
            doubtful: 0,
        };
        let ranked = ranked_within(&[outcomes("fails", 1.0, 5), outcomes("holds", 2.0, 0)]);
        assert_eq!((&*ranked[0].name, ranked[1].within_limits), ("holds", 0.8));
        let interval = [
            wilson_interval(20.0, 25.0)[0],
            wilson_interval(25.0, 25.0)[1],
        ];
        assert_eq!(ranked[1].within_limits_interval, interval);
    }

    #[test]
    fn verify_a_design_that_cannot_be_solved_beats_none_that_can() {
        const FAILED: f64 = f64::INFINITY;
        let outcomes = |name: &str, values: [f64; 5]| Outcomes {
            name: name.to_owned(),
            within_limits: values
                .map(|value| value.is_finite().then_some(true))
                .to_vec(),
            kept: vec![1.0],
            values: values.to_vec(),
            doubtful: 0,
        };
        // Both fail under the last disturbance, which counts half.
        let all = [
            outcomes("low", [1.0, FAILED, FAILED, FAILED, FAILED]),
            outcomes("firm", [2.0, 2.0, 2.0, 2.0, FAILED]),
        ];
        let ranked = ranked_within(&all);
        let [firm, low] = &ranked[..] else {
            panic!("two designs")
        };
        assert_eq!((&*firm.name, firm.best, low.best), ("firm", 0.6, 0.2));
        assert_eq!((firm.beats[1], low.beats[0]), (0.7, 0.3));
        assert_eq!(firm.beats_intervals[1], wilson_interval(3.5, 5.0));
        assert_eq!((firm.failed, low.failed, firm.mean), (1, 4, 2.0));
        assert_eq!(solved_by_all(&all), [0]);
    }

    #[test]
    fn verify_none_is_better_in_both() {
        let tests = vec![
            (0, 2.0, 2.0),
            (1, 1.0, 3.0),
            (2, 3.0, 1.0),
            (3, 3.0, 3.0),
            (4, 2.0, 2.0),
        ];
        let rows: Vec<u64> = undominated(tests).into_iter().map(|test| test.0).collect();
        assert_eq!(rows, [1, 0, 2]);
    }
}
