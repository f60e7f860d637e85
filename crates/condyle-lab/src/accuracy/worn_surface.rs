//! Depths at the nodes of a surface, and their transfer to another mesh.

use condyle::{
    evolve::{March, weight_of_depth},
    geometry::Insert,
};
use nalgebra::{Matrix2, Matrix6, Vector2, Vector6};

/// Number of neighbouring nodes whose mean depth is that of a place between them.
const NEIGHBOURS: usize = 4;

/// Number of nodes to which a paraboloid is fitted: a node of a grid and those around it.
const FITTED: usize = 9;

/// (x, z) of the nodes of a surface, and their depth.
pub(super) struct WornSurface(Vec<([f64; 2], f64)>);

impl WornSurface {
    /// Creates the worn surface of a march, each depth as a part of the largest.
    pub fn of(march: &March) -> Self {
        let worn_mm = &march.state().depths.wear_mm;
        let deepest = worn_mm.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let depths = worn_mm.iter().map(|depth| depth / deepest);
        Self(places(march.insert()).zip(depths).collect())
    }

    /// Creates a surface from the depths of the nodes of an insert.
    pub fn with(insert: &Insert, depth_mm: &[f64]) -> Self {
        Self(places(insert).zip(depth_mm.iter().copied()).collect())
    }

    /// Returns the weight of every node in the maximum depth.
    pub fn weights(&self) -> Vec<f64> {
        let depths = self.0.iter().map(|(_, depth)| depth);
        depths.map(|depth| weight_of_depth(*depth)).collect()
    }

    /// Returns the weights on another mesh, whose nodes are as deep as the nearest node here.
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

    /// Returns the depth between nodes beyond that of the deepest node, as a part of it.
    ///
    /// The depth is that of the lowest point of the paraboloid fitted to the nine nodes around it; none if the
    /// paraboloid is not a hollow, or if its lowest point is farther away than the nodes.
    pub fn missed_between_nodes(&self) -> f64 {
        let deepest = self.0.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let Some(&(place, depth)) = deepest else {
            return 0.0;
        };
        let mut nodes: Vec<&([f64; 2], f64)> = self.0.iter().collect();
        nodes.sort_by(|a, b| apart2(place, a.0).total_cmp(&apart2(place, b.0)));
        nodes.truncate(FITTED);
        let reach2 = nodes.last().map_or(0.0, |(far, _)| apart2(place, *far));
        let top = Paraboloid::fit(place, &nodes).and_then(|paraboloid| paraboloid.top(reach2));
        top.map_or(0.0, |top| (top / depth - 1.0).max(0.0))
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
            // A node at the place itself has nearly all the weight.
            let weight = apart2.max(f64::EPSILON).recip();
            sum += weight * depth;
            whole += weight;
        }
        sum / whole
    }
}

/// height + slope . u + u . bend u / 2, u from a place.
struct Paraboloid {
    height: f64,
    slope: Vector2<f64>,
    bend: Matrix2<f64>,
}

impl Paraboloid {
    /// Creates the paraboloid nearest to heights at places around `middle`; none if they do not determine one.
    fn fit([x, z]: [f64; 2], nodes: &[&([f64; 2], f64)]) -> Option<Self> {
        let (mut matrix, mut right) = (Matrix6::zeros(), Vector6::zeros());
        for &&([node_x, node_z], height) in nodes {
            let (u, v) = (node_x - x, node_z - z);
            let row = Vector6::new(1.0, u, v, u * u / 2.0, u * v, v * v / 2.0);
            matrix += row * row.transpose();
            right += row * height;
        }
        let found = matrix.cholesky()?.solve(&right);
        Some(Self {
            height: found[0],
            slope: Vector2::new(found[1], found[2]),
            bend: Matrix2::new(found[3], found[4], found[4], found[5]),
        })
    }

    /// Returns its highest value, if its maximum is not farther away than the root of `reach2`.
    fn top(&self, reach2: f64) -> Option<f64> {
        let to_top = (-self.bend).cholesky()?.solve(&self.slope);
        let top = self.height + self.slope.dot(&to_top) / 2.0;
        (to_top.norm_squared() <= reach2).then_some(top)
    }
}

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

    #[test]
    fn verify_the_top_of_a_paraboloid_between_nodes() {
        let depth = |[x, z]: [f64; 2]| 0.3 - 0.01 * (x - 0.4).powi(2) - 0.02 * (z + 0.3).powi(2);
        let block = block(1.0);
        let depths: Vec<f64> = places(&block).map(depth).collect();
        let deepest = depths.iter().copied().fold(0.0, f64::max);
        let missed = WornSurface::with(&block, &depths).missed_between_nodes();
        assert!((missed - (0.3 / deepest - 1.0)).abs() < 1e-9, "{missed}");
    }

    #[test]
    fn nothing_is_missed_where_nothing_is_hollow() {
        let block = block(1.0);
        for depth in [
            |[x, _]: [f64; 2]| 1.0 + 0.1 * x,
            |[x, z]: [f64; 2]| 1.0 + x * x + z * z,
        ] {
            let depths: Vec<f64> = places(&block).map(depth).collect();
            assert_eq!(
                WornSurface::with(&block, &depths).missed_between_nodes(),
                0.0
            );
        }
    }

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
