//! The place of the deepest wear in a cup.

use super::finished::FinishedRun;
use super::{Scalar, scalar::scalars};

scalars! { "Cup";
    /// Angle between the load and the deepest wear. At the centre of the unworn cup, which is the origin of its frame.
    DEEPEST_FROM_LOAD_DEG = Scalar::new("deepest_from_load_deg", "deepest wear, from the load", 1, |run| from_load_deg(deepest(run)))
        .printed()
        .of_hip();

    /// Direction of the deepest wear around the load. From medial, + towards anterior; without meaning near the load.
    DEEPEST_AROUND_LOAD_DEG = Scalar::new("deepest_around_load_deg", "deepest wear, around the load", 1, |run| around_load_deg(deepest(run)))
        .listed()
        .of_hip();
}

/// Returns the unworn position of the node with the deepest wear, mm.
fn deepest(run: &FinishedRun<'_>) -> [f64; 3] {
    let (insert, depths_mm) = (run.march.insert(), &run.march.fields().wear_depth_mm);
    let nodes = insert.surface_nodes().iter().zip(depths_mm);
    let deepest = nodes.max_by(|a, b| a.1.total_cmp(b.1));
    deepest.map_or([0.0; 3], |(&node, _)| insert.unworn_nodes()[node as usize].into())
}

/// The load points to -y.
fn from_load_deg([x, y, z]: [f64; 3]) -> f64 {
    x.hypot(z).atan2(-y).to_degrees()
}

fn around_load_deg([x, _, z]: [f64; 3]) -> f64 {
    x.atan2(-z).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_those_of_the_machine() {
        assert_eq!((from_load_deg([0.0, -14.0, 0.0]), around_load_deg([0.0, -14.0, -2.0])), (0.0, 0.0));
        assert!((from_load_deg([0.0, -1.0, -1.0]) - 45.0).abs() < 1e-12);
        assert_eq!(around_load_deg([3.0, -10.0, 0.0]), 90.0);
    }
}
