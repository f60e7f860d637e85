//! The wear by every law of powers on the histories of a march, for the uncertainty of its constants.

use serde::{Deserialize, Serialize};

use crate::wear::{COLUMNS, FamilyConstants, MeanCycle, family_columns, weighted};

/// The wear so far by every law of the power-law family on the surface of the march, without changing it.
///
/// Intervals are added by Euler's method, whose error cancels in ratios between laws of the family.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FamilyWear {
    /// Columns of the worn volume.
    volume: Vec<f64>,
    /// Worn surface nodes, ascending.
    nodes: Vec<u32>,
    /// Columns of the depth of each of them.
    depths: Vec<f64>,
}

/// Part of the deepest wear by one law above which a node may be the deepest by another.
const DEEP: f64 = 0.4;

impl FamilyWear {
    /// Adds an interval of these cycles.
    pub(super) fn add(&mut self, cycles: &[MeanCycle<'_>], area_mm2: &[f64], interval: f64) {
        let before = std::mem::take(self);
        let mut old = before
            .nodes
            .iter()
            .zip(before.depths.chunks(COLUMNS))
            .peekable();
        self.volume = before.volume.clone();
        self.volume.resize(COLUMNS, 0.0);
        for (node, cycle) in cycles.iter().enumerate() {
            let worn = old
                .next_if(|(old, _)| **old as usize == node)
                .map(|(_, depths)| depths);
            let slides = cycle.sliding_distance_mm > 0.0;
            if worn.is_none() && !slides {
                continue;
            }
            self.nodes.push(node as u32);
            let start = self.depths.len();
            match worn {
                Some(depths) => self.depths.extend_from_slice(depths),
                None => self.depths.resize(start + COLUMNS, 0.0),
            }
            if slides {
                let own = self.depths[start..].iter_mut().zip(&mut self.volume);
                for ((depth, volume), column) in own.zip(family_columns(cycle)) {
                    *depth += interval * column;
                    *volume += interval * area_mm2[node] * column;
                }
            }
        }
    }

    /// Returns the volume that each of these laws would have worn, mm3, and its deepest wear, mm.
    pub fn volumes_and_depths(&self, laws: &[FamilyConstants]) -> Vec<(f64, f64)> {
        let weights: Vec<_> = laws.iter().map(FamilyConstants::weights).collect();
        let Some(first) = weights.first() else {
            return Vec::new();
        };
        let depths = self.depths.chunks(COLUMNS);
        let deepest = depths
            .clone()
            .map(|columns| weighted(columns, first))
            .fold(0.0, f64::max);
        let deep: Vec<&[f64]> = depths
            .filter(|columns| weighted(columns, first) > DEEP * deepest)
            .collect();
        let one = |weights| {
            let depths = deep.iter().map(|columns| weighted(columns, weights));
            (weighted(&self.volume, weights), depths.fold(0.0, f64::max))
        };
        weights.iter().map(one).collect()
    }
}
