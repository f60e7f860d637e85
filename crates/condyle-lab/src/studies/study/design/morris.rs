//! Walks through the inputs, one step each.

use super::super::super::chance::Numbers;
use super::place::Place;

/// One walk: from a point on a grid, every input steps once, in an order of chance (Morris 1991).
pub(in super::super) struct Walk {
    start: Vec<f64>,
    steps: Vec<f64>,
    order: Vec<usize>,
}

impl Walk {
    /// Walk `number` over `levels` of each input, an even number; a step is levels / (2 (levels - 1)) of the way.
    pub fn new(number: u64, inputs: usize, levels: u64, seed: u64) -> Self {
        let mut numbers = Numbers::of_one(seed, number);
        let (half, last) = (levels / 2, (levels - 1) as f64);
        let mut start = Vec::with_capacity(inputs);
        let mut steps = Vec::with_capacity(inputs);
        for _ in 0..inputs {
            let low = numbers.place(half as usize) as f64;
            let is_up = numbers.share() < 0.5;
            let step = half as f64 / last;
            start.push(if is_up { low / last } else { low / last + step });
            steps.push(if is_up { step } else { -step });
        }
        let mut order: Vec<usize> = (0..inputs).collect();
        numbers.shuffle(&mut order);
        Self {
            start,
            steps,
            order,
        }
    }

    /// The input that steps from test `step` of the walk to the next, and how far.
    pub fn step(&self, step: usize) -> (usize, f64) {
        let input = self.order[step];
        (input, self.steps[input])
    }

    fn at(&self, step: usize) -> Vec<Place> {
        let mut parts = self.start.clone();
        for &input in &self.order[..step] {
            parts[input] += self.steps[input];
        }
        parts
            .into_iter()
            .map(|part| Place::Along(part.clamp(0.0, 1.0)))
            .collect()
    }
}

/// Where test `row` has its inputs.
pub(in super::super) fn morris_places(
    row: u64,
    inputs: usize,
    levels: u64,
    seed: u64,
) -> Vec<Place> {
    let tests = inputs as u64 + 1;
    Walk::new(row / tests, inputs, levels, seed).at((row % tests) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_one_input_steps_at_a_time_and_stays_on_the_grid() {
        let (inputs, levels) = (5, 4);
        for walk in 0..20 {
            let rows: Vec<Vec<Place>> = (0..6)
                .map(|step| morris_places(walk * 6 + step, inputs, levels, 3))
                .collect();
            for (step, pair) in rows.windows(2).enumerate() {
                let moved: Vec<usize> =
                    (0..inputs).filter(|i| pair[0][*i] != pair[1][*i]).collect();
                let known = Walk::new(walk, inputs, levels, 3).step(step);
                assert_eq!(moved, [known.0]);
                assert!((known.1.abs() - 2.0 / 3.0).abs() < 1e-12);
            }
            let on_grid = |place: &Place| match place {
                Place::Along(part) => (part * 3.0 - (part * 3.0).round()).abs() < 1e-12,
                _ => false,
            };
            assert!(rows.iter().flatten().all(on_grid));
        }
    }
}
