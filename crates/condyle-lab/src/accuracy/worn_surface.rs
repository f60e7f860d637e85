//! Depths at the nodes of a surface, and what they are on another mesh.

use condyle::{
    evolve::{March, weight_of_depth},
    geometry::Insert,
};

/// Nodes whose depths a place between them takes the mean of.
const NEIGHBOURS: usize = 4;

/// (x, z) of the nodes of a surface, and their depth.
pub(super) struct WornSurface(Vec<([f64; 2], f64)>);

impl WornSurface {
    /// How a march has worn its insert, each depth as a part of the largest.
    pub fn of(march: &March) -> Self {
        let worn_mm = march.state().depths.wear_mm();
        let deepest = worn_mm.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let depths = worn_mm.iter().map(|depth| depth / deepest);
        Self(places(march.insert()).zip(depths).collect())
    }

    /// Depths of the nodes of an insert.
    pub fn with(insert: &Insert, depth_mm: &[f64]) -> Self {
        Self(places(insert).zip(depth_mm.iter().copied()).collect())
    }

    /// How much every node counts for the maximum depth.
    pub fn weights(&self) -> Vec<f64> {
        let depths = self.0.iter().map(|(_, depth)| depth);
        depths.map(|depth| weight_of_depth(*depth)).collect()
    }

    /// The same on another mesh, whose nodes are as deep as the nearest one here.
    pub fn weights_on(&self, insert: &Insert) -> Vec<f64> {
        let depth = |place: [f64; 2]| {
            let nodes = self.0.iter();
            let nodes = nodes.map(|(other, depth)| (apart2(place, *other), *depth));
            let nearest = nodes.min_by(|a, b| a.0.total_cmp(&b.0));
            nearest.map_or(0.0, |(_, depth)| depth)
        };
        places(insert)
            .map(|place| weight_of_depth(depth(place)))
            .collect()
    }

    /// Depths at the nodes of another insert: the mean of the nearest here, by their distance.
    pub fn depths_on(&self, insert: &Insert) -> Vec<f64> {
        places(insert).map(|place| self.depth_at(place)).collect()
    }

    fn depth_at(&self, place: [f64; 2]) -> f64 {
        let nodes = self.0.iter();
        let mut nodes: Vec<(f64, f64)> = nodes
            .map(|(other, depth)| (apart2(place, *other), *depth))
            .collect();
        let count = NEIGHBOURS.min(nodes.len());
        if count == 0 {
            return 0.0;
        }
        nodes.select_nth_unstable_by(count - 1, |a, b| a.0.total_cmp(&b.0));
        let (mut sum, mut whole) = (0.0, 0.0);
        for (apart2, depth) in &nodes[..count] {
            let weight = apart2.max(f64::EPSILON).recip();
            sum += weight * depth;
            whole += weight;
        }
        sum / whole
    }
}

/// Square of the distance of two places.
fn apart2([a, b]: [f64; 2], [x, z]: [f64; 2]) -> f64 {
    (a - x).powi(2) + (b - z).powi(2)
}

/// (x, z) of the nodes of the articulating surface.
fn places(insert: &Insert) -> impl Iterator<Item = [f64; 2]> {
    let nodes = insert.surface_nodes().iter();
    nodes.map(|&node| {
        let node = insert.mesh().nodes[node as usize];
        [node.x, node.z]
    })
}

#[cfg(test)]
mod tests {
    use condyle::geometry::{Meshing, flat_insert};

    use super::*;

    fn block(edge_mm: f64) -> Insert {
        let meshing = Meshing { edge_mm, layers: 1 };
        flat_insert((8.0, 8.0), 5.0, meshing).expect("it is a block")
    }

    #[test]
    fn verify_depths_on_a_coarser_mesh() {
        let (fine, coarse) = (block(1.0), block(2.0));
        let depth = |[x, z]: [f64; 2]| 1.0 + 0.1 * x - 0.05 * z;
        let of_fine: Vec<f64> = places(&fine).map(depth).collect();
        let found = WornSurface::with(&fine, &of_fine).depths_on(&coarse);
        for (found, place) in found.iter().zip(places(&coarse)) {
            assert!((found - depth(place)).abs() < 1e-9, "{place:?}: {found}");
        }
    }
}
