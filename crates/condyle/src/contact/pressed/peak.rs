//! The highest pressure, which may lie between the nodes.

use crate::contact::model::{MAX_REGIONS, TouchedNode};

/// Nodes whose pressures differ by no more than this part press equally: which of them leads is a
/// matter of round-off, and of which way round the knee is told.
const EQUAL: f64 = 1e-9;

/// Around any node inside a surface there are as many, and they determine a quadratic; at its rim
/// there are fewer, and farther ones must help.
pub(in crate::contact) const MIN_NODES: usize = 7;

/// Highest pressure at or around the nodes that touch, MPa, any region of which may have it.
///
/// `highest_around` tells it for a node's share and what lies around; it is asked of those that lead their region,
/// and told the highest so far: what cannot be above that need not be told exactly.
/// It is not below the highest mean over a share.
pub(in crate::contact) fn highest_mpa(
    touched: &[TouchedNode],
    highest_around: impl Fn(u32, f64) -> f64,
) -> f64 {
    let highest = highest_of_regions(touched);
    let leads = highest.map(|highest| highest * (1.0 - EQUAL));
    let leads = |node: &&TouchedNode| node.pressure_mpa >= leads[usize::from(node.region)];
    let mut tops = touched.iter().filter(leads).collect::<Vec<_>>();
    tops.sort_by(|a, b| b.pressure_mpa.total_cmp(&a.pressure_mpa));
    let of_means = highest.into_iter().fold(0.0, f64::max);
    tops.iter().fold(of_means, |so_far, top| {
        highest_around(top.node, so_far).max(so_far)
    })
}

/// Highest mean over a share in every region, MPa.
fn highest_of_regions(touched: &[TouchedNode]) -> [f64; MAX_REGIONS] {
    let mut highest = [0.0; MAX_REGIONS];
    for node in touched {
        let highest = &mut highest[usize::from(node.region)];
        // A jump that is seldom taken is faster than a maximum that waits for the one before.
        if node.pressure_mpa > *highest {
            *highest = node.pressure_mpa;
        }
    }
    highest
}
