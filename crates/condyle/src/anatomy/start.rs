//! The start position of the femur over the insert.

use super::views::{Orientation, Picture, Views, mean, median, part};
use crate::{Mat3, geometry::TriangleMesh};

/// Height above the lowest row of a dish or a condyle within which rows are averaged, as a share of the
/// body's longest extent: on a flat one the middle of the flat part counts.
const FLAT: f64 = 0.003;

/// Returns the start position of the femoral frame in the insert frame, (x, z), mm, at which the lowest points of the
/// condyles are over the lowest points of the dishes, and the middle of the femur is over the middle of the insert.
///
/// Both bodies in mm, x anterior, y superior, z right; the femur is flexed by `flexion_rad` first. None for
/// bodies without extent.
pub fn start_over_the_dishes_mm(
    femur: &TriangleMesh,
    insert: &TriangleMesh,
    flexion_rad: f64,
) -> Option<(f64, f64)> {
    let (sine, cosine) = flexion_rad.sin_cos();
    let flexion = Mat3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
    let femur = femur.clone().mapped(|vertex| flexion * vertex);
    let isb = Orientation::ISB;
    let (anterior, superior, right) = (isb.anterior, isb.superior, isb.right);
    let (femur_views, insert_views) = (Views::new(&femur)?, Views::new(insert)?);
    let condyles = femur_views.picture(superior.reversed(), anterior, right);
    let dishes = insert_views.picture(superior, anterior, right);
    let condyle_x = femur_views.place(0, farthest_row(&condyles, 1.0));
    let dish_x = insert_views.place(0, farthest_row(&dishes, -1.0));
    Some((dish_x - condyle_x, middle_z(insert) - middle_z(&femur)))
}

/// Returns the row at which both sides are highest towards the viewer, or lowest (`sign` -1); the ends do not count,
/// where an insert may be bevelled.
fn farthest_row(picture: &Picture, sign: f64) -> f64 {
    let side = |from, to| {
        let height = |row: usize| median(picture.across(row, from, to)).map(|height| sign * height);
        let rows = || part(picture.rows, 0.2, 0.8);
        let farthest = rows().filter_map(height).reduce(f64::max);
        let is_far = |row: &usize| {
            height(*row)
                .zip(farthest)
                .is_some_and(|(one, far)| one > far - FLAT)
        };
        mean(rows().filter(is_far).map(|row| row as f64 + 0.5))
    };
    (side(0.2, 0.35) + side(0.65, 0.8)) / 2.0
}

fn middle_z(mesh: &TriangleMesh) -> f64 {
    let (low, high) = mesh.bounds();
    (low.z + high.z) / 2.0
}
