//! The articulating surface as it is now: normals, areas, and each node's share of the surface.

use crate::{Mat3, Vec3};

/// A node's share of the articulating surface: a quarter of each face around it, taken together
/// as the flat parallelogram with the same area, centroid and second moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Centroid, mm. Along the normal it is that of the smooth surface through the nodes.
    pub centre: Vec3,
    /// First edge of the parallelogram, mm.
    pub edge_a: Vec3,
    /// Second edge of the parallelogram, mm.
    pub edge_b: Vec3,
    /// Area, mm2.
    pub area_mm2: f64,
    /// A quarter of the trace of the second moment over the area, mm2: a 24th of a square's area.
    pub spread_mm2: f64,
}

/// The articulating surface of an insert; every array has one entry a surface node.
#[derive(Clone, Debug, PartialEq)]
pub struct ArticulatingSurface {
    /// Node positions, mm.
    pub positions: Vec<Vec3>,
    /// Unit normals outwards: the average of the unit normals of the faces around.
    pub normals: Vec<Vec3>,
    /// Shares of the surface.
    pub shares: Vec<Share>,
}

/// A quarter of a face, at one corner of it.
struct Quarter {
    centre: Vec3,
    edges: [Vec3; 2],
    area_vector: Vec3,
}

impl Quarter {
    /// The quarter of the bilinear face at `corner`, with the two corners beside and the one across.
    fn new(corner: Vec3, next: Vec3, across: Vec3, before: Vec3) -> Self {
        let edges = [
            ((next - corner) * 3.0 + (across - before)) / 8.0,
            ((before - corner) * 3.0 + (across - next)) / 8.0,
        ];
        Self {
            centre: (corner * 9.0 + next * 3.0 + before * 3.0 + across) / 16.0,
            edges,
            area_vector: edges[0].cross(&edges[1]),
        }
    }
}

impl ArticulatingSurface {
    /// The surface of `faces`, in numbers of `positions`, facing out.
    pub fn new(positions: &[Vec3], faces: &[[u32; 4]]) -> Self {
        let mut normals = vec![Vec3::zeros(); positions.len()];
        let mut firsts = vec![FirstMoments::default(); positions.len()];
        for face in faces {
            let corners = face.map(|i| positions[i as usize]);
            let [a, b, c, d] = corners;
            let normal = (c - a)
                .cross(&(d - b))
                .try_normalize(0.0)
                .unwrap_or_default();
            for (turn, &node) in face.iter().enumerate() {
                normals[node as usize] += normal;
                firsts[node as usize].add(&positions[node as usize], &quarter(&corners, turn));
            }
        }
        let flats: Vec<Flat> = firsts.iter().map(Flat::new).collect();
        let mut seconds = vec![Mat3::zeros(); positions.len()];
        for face in faces {
            let corners = face.map(|i| positions[i as usize]);
            for (turn, &node) in face.iter().enumerate() {
                let (from, flat) = (positions[node as usize], &flats[node as usize]);
                seconds[node as usize] += flat.second_moment(&from, &quarter(&corners, turn));
            }
        }
        let nodes = positions.iter().zip(&flats).zip(&seconds);
        Self {
            normals: normals
                .iter()
                .map(|n| n.try_normalize(0.0).unwrap_or_default())
                .collect(),
            shares: nodes
                .map(|((node, flat), second)| flat.share(node, second))
                .collect(),
            positions: positions.to_vec(),
        }
    }

    /// Area of the whole surface, mm2.
    pub fn area_mm2(&self) -> f64 {
        self.shares.iter().map(|share| share.area_mm2).sum()
    }

    /// Lowest and highest node, mm.
    pub fn height_range_mm(&self) -> (f64, f64) {
        let heights = || self.positions.iter().map(|position| position.y);
        (
            heights().fold(f64::INFINITY, f64::min),
            heights().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// Mean spread of the shares, weighted by their areas, mm2.
    pub fn mean_spread_mm2(&self) -> f64 {
        let weighted = |share: &Share| share.spread_mm2 * share.area_mm2;
        self.shares.iter().map(weighted).sum::<f64>() / self.area_mm2()
    }

    /// The surface's own directions at a node: anterior and lateral along the surface.
    pub fn directions(&self, node: usize) -> [Vec3; 2] {
        let normal = self.normals[node];
        let forward = Vec3::x() - normal * normal.x;
        let anterior = forward
            .try_normalize(1e-9)
            .unwrap_or_else(|| normal.cross(&Vec3::z()).normalize());
        [anterior, anterior.cross(&normal)]
    }
}

/// The quarter of a face at its corner number `turn`.
fn quarter(corners: &[Vec3; 4], turn: usize) -> Quarter {
    let at = |k: usize| corners[(turn + k) % 4];
    Quarter::new(at(0), at(1), at(2), at(3))
}

/// Sums over the quarters of faces around a node.
#[derive(Clone, Copy, Default)]
struct FirstMoments {
    area_mm2: f64,
    area_vector: Vec3,
    /// Offset of the centroids from the node, times the area.
    offset: Vec3,
    /// An edge of one of them, for a direction.
    edge: Vec3,
}

impl FirstMoments {
    fn add(&mut self, node: &Vec3, quarter: &Quarter) {
        let area = quarter.area_vector.norm();
        if self.area_mm2 == 0.0 {
            self.edge = quarter.edges[0];
        }
        self.area_mm2 += area;
        self.area_vector += quarter.area_vector;
        self.offset += (quarter.centre - node) * area;
    }
}

/// The plane of a node's share, and where its centroid lies.
struct Flat {
    area_mm2: f64,
    normal: Vec3,
    /// Offset of the centroid from the node along the plane.
    offset: Vec3,
    /// And along its normal.
    rise: Vec3,
    edge: Vec3,
}

impl Flat {
    fn new(sums: &FirstMoments) -> Self {
        let normal = sums.area_vector.normalize();
        let offset = sums.offset / sums.area_mm2;
        let rise = normal * offset.dot(&normal);
        Self {
            area_mm2: sums.area_mm2,
            normal,
            offset: offset - rise,
            rise,
            edge: sums.edge,
        }
    }

    /// A quarter's part in the second moment over the area.
    fn second_moment(&self, node: &Vec3, quarter: &Quarter) -> Mat3 {
        let [a, b] = quarter.edges;
        let lever = quarter.centre - node - self.offset;
        let own = (a * a.transpose() + b * b.transpose()) / 12.0;
        (own + lever * lever.transpose()) * (quarter.area_vector.norm() / self.area_mm2)
    }

    /// The node's share.
    ///
    /// Between nodes the true surface bulges away from the bilinear faces: the mean of a parabola
    /// over a share is a third of what the bilinear faces say. So of the centroid's offset from the
    /// node, the part along the normal counts a third.
    fn share(&self, node: &Vec3, second_moment: &Mat3) -> Share {
        let [edge_a, edge_b] = parallelogram(second_moment, &self.normal, &self.edge);
        Share {
            centre: node + self.offset + self.rise / 3.0,
            edge_a,
            edge_b,
            area_mm2: self.area_mm2,
            spread_mm2: (edge_a.norm_squared() + edge_b.norm_squared()) / 48.0,
        }
    }
}

/// Edges of the flat parallelogram with a given second moment over its area, the first along
/// `along`: moment = (a a' + b b')/12.
fn parallelogram(moment: &Mat3, normal: &Vec3, along: &Vec3) -> [Vec3; 2] {
    let u = (along - normal * along.dot(normal)).normalize();
    let v = normal.cross(&u);
    let twelve = |p: &Vec3, q: &Vec3| 12.0 * p.dot(&(moment * q));
    let (uu, uv, vv) = (twelve(&u, &u), twelve(&u, &v), twelve(&v, &v));
    let edge_a = u * ((uu * vv - uv * uv).max(0.0) / vv).sqrt();
    let edge_b = u * (uv / vv.sqrt()) + v * vv.sqrt();
    [edge_a, edge_b]
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
        let middle = ArticulatingSurface::new(&positions, &faces).shares[4];
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
