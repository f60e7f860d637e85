//! Elementary effects of Morris.

use serde::Serialize;

use condyle_io::study::{Design, Output};

use super::super::{design::Walk, plan::Plan};
use super::moments::{mean, standard_deviation};
use super::named::Named;

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

pub(super) fn all(plan: &Plan, outputs: &[Named<'_, Output>]) -> Vec<Elementary> {
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
            told.map(|(input, effects)| Elementary::of(output.of.name, &input.key, &effects)),
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
    use super::super::super::design::{Place, morris_places};
    use super::*;

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
