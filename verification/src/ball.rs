//! A ball of triangles.

use std::f64::consts::{PI, TAU};

use condyle::{Vec3, geometry::TriangleMesh};

/// A ball about the origin with triangles of about `edge_mm`, in rings about the x axis so that
/// the poles lie far from where it touches.
pub(crate) fn ball_mesh(radius_mm: f64, edge_mm: f64) -> TriangleMesh {
    let rows = (PI * radius_mm / edge_mm).round() as u32;
    let columns = 2 * rows;
    let vertex = |row: u32, column: u32| {
        let (ring, along) = (PI * f64::from(row) / f64::from(rows)).sin_cos();
        let (sine, cosine) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
        Vec3::new(along, ring * cosine, ring * sine) * radius_mm
    };
    let number = |row: u32, column: u32| row * columns + column % columns;
    let quads = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let triangles = quads.flat_map(|(row, column)| {
        let (a, b) = (number(row, column), number(row, column + 1));
        let (c, d) = (number(row + 1, column + 1), number(row + 1, column));
        [[a, d, c], [a, c, b]]
    });
    TriangleMesh {
        vertices: (0..=rows)
            .flat_map(|row| (0..columns).map(move |column| vertex(row, column)))
            .collect(),
        triangles: triangles.collect(),
    }
}
