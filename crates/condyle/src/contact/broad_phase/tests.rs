//! Tests that blocks that are not candidates are not in contact, by comparison with a search over all blocks and with
//! the gaps at all corners of their shares.

use super::separations::{BlockPlaces, BlockWear, LastWear, SeparationBound, Separations};
use crate::{
    Mat3, Vec3, Vector,
    contact::{broad_phase::ShareBlock, contact_patch::CachedSample, foundation::EdgeSlopes},
    geometry::{
        Counterface, GenericFemur, GenericFemurShape, GenericInsertShape, Insert, Meshing,
        SmoothField, TriangleMesh, flat_insert,
    },
    number::{F64x4, LANES, Number, dot},
    spatial::{Pose, Pose4},
};

/// Farthest step of the counterface, mm and rad.
const FARTHEST: (f64, f64) = (3.0, 0.1);

/// Repeatable numbers in -1..1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }

    /// Two poses, `height_mm` over the insert or so, and not far from each other.
    fn step(&mut self, height_mm: f64) -> (Pose, Pose) {
        let from = Pose::new(
            turned(&self.vector(0.1)),
            Vec3::y() * (height_mm + self.next()) + self.vector(2.0),
        );
        let turn = turned(&(self.vector(1.0).normalize() * self.size(FARTHEST.1)));
        let shift = self.vector(1.0).normalize() * self.size(FARTHEST.0);
        let to = Pose::new(turn * from.rotation, from.translation + shift);
        (from, to)
    }

    /// From a thousandth of `size` to all of it, every order of magnitude as often.
    fn size(&mut self, size: f64) -> f64 {
        size * 10f64.powf(1.5 * (self.next() - 1.0))
    }
}

/// A surface that faces down, with bumps and hollows sharper than it is round.
fn bumpy() -> TriangleMesh {
    let (count, step_mm) = (41, 1.0);
    let mut mesh = TriangleMesh::default();
    for i in 0..count {
        for j in 0..count {
            let [x, z] = [i, j].map(|i| step_mm * (f64::from(i) - 20.0));
            let bumps = 0.3 * (x / 3.0).sin() * (z / 4.0).cos();
            mesh.vertices
                .push(Vec3::new(x, x * x / 100.0 + z * z / 60.0 + bumps, z));
        }
    }
    for i in 0..count as u32 - 1 {
        for j in 0..count as u32 - 1 {
            let (a, b) = (i * count as u32 + j, (i + 1) * count as u32 + j);
            mesh.triangles.extend([[a, b, a + 1], [b, b + 1, a + 1]]);
        }
    }
    mesh
}

/// A block as a search would find it: its sample, its reach, and whether it is apart.
fn sampled_near(
    counterface: &Counterface,
    block: &ShareBlock,
    pose: &Pose,
) -> (CachedSample, F64x4, bool) {
    let pose = Pose4::new(pose);
    let place = pose.to_counterface(&block.centre);
    let cached = CachedSample::at(counterface, place, block.spread_mm2);
    let normal = pose.turn_to_insert(&cached.sample.normal);
    let slopes = EdgeSlopes::new([dot(&normal, &block.edge_a), dot(&normal, &block.edge_b)]);
    let reach_mm = slopes.reach_mm();
    let is_apart = (cached.sample.gap_mm - reach_mm).least() > 0.0;
    (cached, reach_mm, is_apart)
}

/// Smallest gap at the corners of a block's shares, less how much the mean over a share lies above the
/// gap in its middle.
fn least_corner_mm(counterface: &Counterface, block: &ShareBlock, pose: &Pose) -> f64 {
    let pose4 = Pose4::new(pose);
    let gap_at = |place: &Vector<F64x4>| counterface.gap_mm(&pose4.to_counterface(place));
    let (cached, ..) = sampled_near(counterface, block, pose);
    let above_mm = cached.sample.gap_mm - gap_at(&block.centre);
    let [half_a, half_b] = [&block.edge_a, &block.edge_b].map(|edge| edge * F64x4::splat(0.5));
    let corners = [
        block.centre + half_a + half_b,
        block.centre + half_a - half_b,
        block.centre - half_a + half_b,
        block.centre - half_a - half_b,
    ];
    let least = |corner: &Vector<F64x4>| (gap_at(corner) + above_mm).least();
    corners.iter().map(least).fold(f64::INFINITY, f64::min)
}

fn turned(turn: &Vec3) -> Mat3 {
    nalgebra::Rotation3::new(*turn).into_inner()
}

/// Separations after every block was sampled.
fn searched(counterface: &Counterface, blocks: &[ShareBlock], pose: &Pose) -> Separations {
    let mut separations = Separations::new(blocks.len());
    let mut candidates = Vec::new();
    separations.follow(
        pose,
        &BlockPlaces::from_blocks(blocks),
        &LastWear::default(),
        None,
        &mut candidates,
    );
    assert_eq!(candidates.len(), blocks.len());
    for (number, shares) in (0..).zip(blocks) {
        let (cached, reach_mm, is_apart) = sampled_near(counterface, shares, pose);
        if is_apart {
            let around = counterface.curvature_bounds(&cached.place);
            separations.set(
                number,
                &SeparationBound::new(&cached.sample, reach_mm, shares, around),
            );
        } else {
            separations.touches(number);
        }
    }
    separations
}

/// Steps the counterface at random from about `height_mm` over the insert, which wears or is restored at
/// two of three steps, and compares what is no candidate then with a search, with the help of another increment
/// near by. Gives how many blocks were no candidates.
fn check(counterface: &Counterface, insert: impl Fn() -> Insert, height_mm: f64) -> usize {
    let shares = |insert: &Insert| ShareBlock::from_shares(insert, &insert.surface());
    let (unworn, worn) = (shares(&insert()), shares(&worn(insert())));
    let mut numbers = Numbers(17);
    let (mut sure, mut taken_over) = (0, 0);
    for step in 0..150 {
        let (from, to) = numbers.step(height_mm);
        let (before, after) = match step % 3 {
            0 => (&unworn, &unworn),
            1 => (&unworn, &worn),
            _ => (&worn, &unworn),
        };
        let mut separations = searched(counterface, before, &from);
        let wear = LastWear {
            number: 1,
            eights: BlockWear::between(before, after),
        };
        let mut candidates = Vec::new();
        // There by way of half of it, as over many steps.
        let half = Pose::new(from.rotation, to.translation);
        let places = BlockPlaces::from_blocks(after);
        separations.follow(&half, &places, &wear, None, &mut candidates);
        let mut alone = separations.clone();
        alone.follow(&to, &places, &wear, None, &mut candidates);
        let candidates_alone = candidates.len();
        let near_by = Pose::new(to.rotation, to.translation + numbers.vector(0.2));
        let mut other = searched(counterface, after, &near_by);
        let no_more_wear = LastWear {
            number: 1,
            eights: BlockWear::between(after, after),
        };
        other.follow(&near_by, &places, &no_more_wear, None, &mut candidates);
        separations.follow(&to, &places, &wear, Some(&other), &mut candidates);
        taken_over += candidates_alone - candidates.len();
        for (number, block) in (0..).zip(after) {
            if !candidates.contains(&number) {
                sure += 1;
                assert!(
                    sampled_near(counterface, block, &to).2,
                    "{:?} touch",
                    block.nodes
                );
                let corner_mm = least_corner_mm(counterface, block, &to);
                assert!(corner_mm > 0.0, "{:?}: {corner_mm}", block.nodes);
            }
        }
    }
    println!("{sure} of {}, {taken_over} taken over", 150 * unworn.len());
    assert!(taken_over > LANES);
    sure
}

/// The insert with worn spots, as deep as a few tenths of a millimetre.
fn worn(mut insert: Insert) -> Insert {
    let surface = insert.surface();
    let depth_mm = |place: &Vec3| 0.15 * (1.0 + (place.x / 3.0).sin() * (place.z / 4.0).cos());
    let depth_mm: Vec<f64> = surface.positions.iter().map(depth_mm).collect();
    insert.wear_down(&surface, &depth_mm);
    insert
}

#[test]
fn what_is_no_candidate_is_apart() {
    let dished = || {
        let shape = GenericInsertShape::default();
        shape.insert(Meshing::default()).expect("a dish")
    };
    let meshing = Meshing {
        edge_mm: 1.0,
        layers: 1,
    };
    let flat = || flat_insert((24.0, 24.0), 9.0, meshing).expect("a plate");
    let spread_mm2 = flat().surface().mean_spread_mm2();
    let bumpy = Counterface::Mesh(SmoothField::new(&bumpy(), 1)).prepared_for(spread_mm2);
    let generic = Counterface::Generic(GenericFemur::new(GenericFemurShape::default()));
    let ball = Counterface::sphere(24.0);
    // The lowest points of the counterfaces lie 22.96, 24 and 0.3 mm below their origins.
    assert!(check(&generic, dished, 23.5) > 10 * LANES);
    assert!(check(&ball, flat, 24.5) > 10 * LANES);
    assert!(check(&bumpy, flat, 1.0) > 10 * LANES);
}
