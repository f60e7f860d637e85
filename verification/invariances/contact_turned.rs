//! Contact of bodies that are turned and shifted together.

use condyle::{
    Mat3, Vec3,
    contact::{Bodies, Tangent},
    geometry::{Counterface, GenericInsertShape, Insert},
    spatial::{Mat6, Pose, RelativeMotion, Twist, Vec6, WrenchByTwist},
};
use condyle_mesh::columns::{ColumnGrid, Meshing};
use nalgebra::Rotation3;

use crate::{Row, plate::rubbing, pressed::contact_of};

/// A turn and then a shift of everything.
struct Moved {
    turn: Mat3,
    shift: Vec3,
}

impl Moved {
    fn point(&self, point: &Vec3) -> Vec3 {
        self.turn * point + self.shift
    }

    /// The matrix A that takes wrenches at the origin along; twists go with the inverse of its
    /// transpose, since power stays, and so tangents as A K A'.
    fn wrenches(&self) -> Mat6 {
        let mut matrix = Mat6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.turn);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.turn);
        let lever = self.shift.cross_matrix() * self.turn;
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&lever);
        matrix
    }

    fn motion(&self, motion: &RelativeMotion) -> RelativeMotion {
        let to_old = self.wrenches().transpose();
        let to_new = to_old.try_inverse().expect("a rigid motion");
        RelativeMotion {
            pose: Pose::new(
                self.turn * motion.pose.rotation,
                self.point(&motion.pose.translation),
            ),
            twist: Twist::from_numbers(&(to_new * motion.twist.numbers())),
        }
    }
}

pub(super) fn rows() -> [Row; 3] {
    let level = Rotation3::new(Vec3::new(0.6, 0.0, 0.8) * 5f64.to_radians());
    let upright = Rotation3::new(Vec3::y() * 40f64.to_radians());
    let moved = Moved {
        turn: (level * upright).into_inner(),
        shift: Vec3::new(12.0, -5.0, 30.0),
    };
    let motion = RelativeMotion {
        pose: Pose::new(Mat3::identity(), Vec3::new(1.3, 23.8, 22.4)),
        twist: Twist::new(Vec3::new(0.3, -0.2, 0.5), Vec3::new(12.0, 1.0, -7.0)),
    };
    let (wrench, tangent) = response(&insert(Vec3::clone), &motion);
    let there = response(&insert(|point| moved.point(point)), &moved.motion(&motion));
    let along = moved.wrenches();
    let apart = |there: &WrenchByTwist, here: &WrenchByTwist| {
        (there.matrix - along * here.matrix * along.transpose()).norm()
    };
    let row = |what: &str, apart: f64, size: f64| {
        Row::absolute(
            format!("contact turned: {what}, relative difference"),
            "",
            0.0,
            apart / size,
            1e-10,
        )
    };
    [
        row("wrench", (there.0 - along * wrench).norm(), there.0.norm()),
        row(
            "derivative by pose",
            apart(&there.1.by_pose, &tangent.by_pose),
            there.1.by_pose.matrix.norm(),
        ),
        row(
            "derivative by twist",
            apart(&there.1.by_twist, &tangent.by_twist),
            there.1.by_twist.matrix.norm(),
        ),
    ]
}

/// A ball's wrench and tangent.
fn response(insert: &Insert, motion: &RelativeMotion) -> (Vec6, Tangent) {
    let (femur, (law, _)) = (Counterface::sphere(24.0), rubbing(0.07, 1.0));
    let bodies = Bodies {
        counterface: &femur,
        insert,
        surface: &insert.surface(),
    };
    let mut contact = contact_of(&law, bodies);
    let response = contact.respond(motion);
    (response.wrench.numbers(), contact.tangent())
}

/// The lateral dish, every node placed anew.
fn insert(place: impl Fn(&Vec3) -> Vec3) -> Insert {
    let shape = GenericInsertShape::default();
    let grid = ColumnGrid::filling((-20.0, 6.0), (20.0, 40.0), 1.0, 1).expect("a grid");
    let column = |i, k| {
        let [x, z] = grid.place_mm(i, k).into();
        (-shape.thickness_mm, shape.height_mm(x, z))
    };
    let points = (0..=grid.cells.0).flat_map(|i| (0..=grid.cells.1).map(move |k| (i, k)));
    let columns: Vec<_> = points.map(|(i, k)| column(i, k)).collect();
    let mut built = grid.plan().hexahedra(
        &columns,
        Meshing {
            edge_mm: 1.0,
            layers: 1,
        },
    );
    built
        .mesh
        .nodes
        .iter_mut()
        .for_each(|node| *node = place(node));
    Insert::new(built.mesh, &built.articulating, &built.backside).expect("an insert")
}
