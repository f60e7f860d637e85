//! Loops of open edges: the rim of an open surface, and holes.

use super::{
    defect::DefectKind, edges::edge_report, fill::fill, joints::join_filled, judge::Judge,
    orientation::Piece,
};
use crate::{Vec3, bounds::bounds, triangle_mesh::TriangleMesh};

/// The longest loop of a piece is its rim, and no hole, if it is longer than this share of the piece, corner to corner.
const RIM: f64 = 1.0 / 3.0;

/// Closes the holes where nothing touches, flat from edge to edge, and judges all.
pub(super) fn close_holes(mesh: &mut TriangleMesh, pieces: &[Piece], judge: &mut Judge) {
    if pieces.iter().all(|piece| !piece.is_open) {
        return;
    }
    let mut filled = false;
    for around in holes(mesh, pieces) {
        let places: Vec<Vec3> = around.iter().map(|&v| mesh.vertices[v as usize]).collect();
        let middle = places.iter().sum::<Vec3>() / places.len() as f64;
        let matters = judge.judge(mesh, DefectKind::Hole, middle, &places);
        let normal = area_vector(&places).try_normalize(0.0);
        if let Some(normal) = normal.filter(|_| !matters) {
            fill(mesh, &[around], &-normal);
            filled = true;
        }
    }
    if filled {
        join_filled(mesh);
    }
}

/// The loops that are not the rim of an open piece.
fn holes(mesh: &TriangleMesh, pieces: &[Piece]) -> Vec<Vec<u32>> {
    let mut piece_of = vec![0; mesh.vertices.len()];
    for (number, piece) in pieces.iter().enumerate() {
        let corners = piece
            .triangles
            .iter()
            .flat_map(|&t| mesh.triangles[t as usize]);
        corners.for_each(|vertex| piece_of[vertex as usize] = number);
    }
    let mut loops = vec![Vec::new(); pieces.len()];
    for around in edge_report(mesh).boundary_loops {
        loops[piece_of[around[0] as usize]].push(around);
    }
    for (piece, loops) in pieces.iter().zip(&mut loops) {
        let corners = piece
            .triangles
            .iter()
            .flat_map(|&t| mesh.triangles[t as usize]);
        let whole = extent(mesh, corners);
        let sizes: Vec<f64> = loops
            .iter()
            .map(|around| extent(mesh, around.iter().copied()))
            .collect();
        let longest = (0..sizes.len()).max_by(|&one, &other| sizes[one].total_cmp(&sizes[other]));
        if let Some(rim) = longest.filter(|&rim| sizes[rim] > RIM * whole) {
            loops.remove(rim);
        }
    }
    loops
        .into_iter()
        .flatten()
        .filter(|around| around.len() > 2)
        .collect()
}

/// Diagonal of the box around some vertices.
fn extent(mesh: &TriangleMesh, vertices: impl Iterator<Item = u32>) -> f64 {
    let (low, high) = bounds(vertices.map(|vertex| &mesh.vertices[vertex as usize]));
    (high - low).norm()
}

/// Twice the area that a loop bounds, along its normal.
fn area_vector(places: &[Vec3]) -> Vec3 {
    let next = places.iter().cycle().skip(1);
    let from = places[0];
    places
        .iter()
        .zip(next)
        .map(|(one, other)| (one - from).cross(&(other - from)))
        .sum()
}
