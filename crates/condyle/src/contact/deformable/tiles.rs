//! Nodes shared out into tiles that lie together.

use crate::{Vec3, geometry::bounds};

/// Nodes shared out into tiles of so many at most: the larger extent halved until few are left.
pub(super) fn tiles(positions: &[Vec3], most: usize) -> Vec<Vec<u32>> {
    let mut open = vec![(0..positions.len() as u32).collect::<Vec<u32>>()];
    let mut tiles = Vec::new();
    while let Some(mut nodes) = open.pop() {
        if nodes.len() <= most {
            tiles.push(nodes);
        } else {
            let at = |node: &u32| positions[*node as usize];
            let (low, high) = bounds(nodes.iter().map(|node| &positions[*node as usize]));
            let axis = (high - low).imax();
            nodes.sort_by(|a, b| at(a)[axis].total_cmp(&at(b)[axis]).then(a.cmp(b)));
            let second = nodes.split_off(nodes.len() / 2);
            open.extend([second, nodes]);
        }
    }
    tiles
}
