//! The articulating surface in its present shape: normals, areas, and each node's share of the surface.

use super::{
    connectivity::FacesAround,
    share::{Share, shares_and_normals},
};
use crate::Vec3;

/// The articulating surface of an insert; every array has one entry per surface node.
#[derive(Clone, Debug, PartialEq)]
pub struct ArticulatingSurface {
    /// Node positions, mm.
    pub positions: Vec<Vec3>,
    /// Unit normals outwards: the average of the unit normals of the faces around.
    pub normals: Vec<Vec3>,
    /// Shares of the surface.
    pub shares: Vec<Share>,
}

impl ArticulatingSurface {
    /// Creates the surface of nodes at `positions` with outward faces around them.
    pub(crate) fn new(positions: Vec<Vec3>, around: &FacesAround) -> Self {
        let (shares, normals) = shares_and_normals(&positions, around);
        Self {
            normals,
            shares,
            positions,
        }
    }

    /// Returns the area of the whole surface, mm2.
    pub fn area_mm2(&self) -> f64 {
        self.shares.iter().map(|share| share.area_mm2).sum()
    }

    /// Returns the heights of the lowest and the highest node, mm.
    pub fn height_range_mm(&self) -> (f64, f64) {
        let heights = || self.positions.iter().map(|position| position.y);
        (
            heights().fold(f64::INFINITY, f64::min),
            heights().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// Returns the mean spread of the shares, weighted by their areas, mm2.
    pub fn mean_spread_mm2(&self) -> f64 {
        let weighted = |share: &Share| share.spread_mm2 * share.area_mm2;
        self.shares.iter().map(weighted).sum::<f64>() / self.area_mm2()
    }

    /// Returns the tangential directions at a node, anterior and lateral.
    pub fn directions(&self, node: usize) -> [Vec3; 2] {
        let normal = self.normals[node];
        let forward = Vec3::x() - normal * normal.x;
        // A wall that faces forwards or backwards has no anterior tangent; the direction up or down it takes its place.
        let anterior = forward
            .try_normalize(1e-9)
            .unwrap_or_else(|| normal.cross(&Vec3::z()).normalize());
        [anterior, anterior.cross(&normal)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{GenericInsertShape, Meshing, flat_insert};

    #[test]
    fn verify_shares_of_a_flat_grid_are_its_cells() {
        let insert = flat_insert(
            (6.0, 4.0),
            5.0,
            Meshing {
                edge_mm: 1.0,
                layers: 1,
            },
        )
        .unwrap();
        let surface = insert.surface();
        assert!((surface.area_mm2() - 24.0).abs() < 1e-12);
        for (position, share) in surface.positions.iter().zip(&surface.shares) {
            let at_rim = position.x.abs() == 3.0 || position.z.abs() == 2.0;
            if !at_rim {
                assert!((share.centre - position).norm() < 1e-12);
                assert!((share.area_mm2 - 1.0).abs() < 1e-12);
                assert!((share.edge_a.norm() - 1.0).abs() < 1e-12);
                assert!((share.edge_b.norm() - 1.0).abs() < 1e-12);
                assert!(share.edge_a.dot(&share.edge_b).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn verify_shares_of_a_skewed_grid_are_its_parallelograms() {
        let place =
            |i: u32, k: u32| Vec3::new(f64::from(i) + 0.4 * f64::from(k), 0.0, 0.8 * f64::from(k));
        let positions: Vec<Vec3> = (0..9).map(|n| place(n / 3, n % 3)).collect();
        let faces = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]];
        let middle = ArticulatingSurface::new(positions, &FacesAround::new(9, &faces)).shares[4];
        assert!((middle.area_mm2 - 0.8).abs() < 1e-12);
        assert!((middle.edge_a.cross(&middle.edge_b).norm() - 0.8).abs() < 1e-12);
    }

    #[test]
    fn verify_centroid_of_a_share_of_a_dish() {
        let insert = GenericInsertShape::default()
            .insert(Meshing {
                edge_mm: 1.0,
                layers: 1,
            })
            .unwrap();
        let surface = insert.surface();
        let shape = GenericInsertShape::default();
        let node = surface
            .positions
            .iter()
            .position(|p| (p - Vec3::new(3.0, p.y, 25.0)).norm() < 1e-9);
        let share = surface.shares[node.unwrap()];
        let n = 200;
        let mut mean = 0.0;
        for i in 0..n {
            for k in 0..n {
                let place = |j: i32| (f64::from(j) + 0.5) / f64::from(n) - 0.5;
                mean += shape.height_mm(3.0 + place(i), 25.0 + place(k)) / f64::from(n * n);
            }
        }
        let bulge = share.centre.y - shape.height_mm(share.centre.x, share.centre.z);
        let exact = mean - shape.height_mm(3.0, 25.0);
        assert!((bulge - exact).abs() < 1e-5, "{bulge} {exact}");
    }

    #[test]
    fn directions_are_anterior_and_lateral() {
        let insert = flat_insert(
            (2.0, 2.0),
            5.0,
            Meshing {
                edge_mm: 1.0,
                layers: 1,
            },
        )
        .unwrap();
        assert_eq!(insert.surface().directions(0), [Vec3::x(), Vec3::z()]);
    }
}
