//! Triangle meshes for tests.

use crate::{Vec3, triangle_mesh::TriangleMesh};

pub(crate) fn unit_block() -> TriangleMesh {
    TriangleMesh::block(Vec3::zeros(), Vec3::repeat(1.0))
}

/// A rolling strip of squares from `from` along x, at a height that falls by `fall` a step.
pub(crate) fn strip(steps: u32, fall: f64) -> TriangleMesh {
    let place = |i: u32| {
        let (x, y) = (f64::from(i / 2), f64::from(i % 2));
        Vec3::new(x, y, -fall * x)
    };
    let pair = |i: u32| {
        [
            [2 * i, 2 * i + 2, 2 * i + 1],
            [2 * i + 1, 2 * i + 2, 2 * i + 3],
        ]
    };
    TriangleMesh {
        vertices: (0..2 * steps + 2).map(place).collect(),
        triangles: (0..steps).flat_map(pair).collect(),
    }
}

/// A closed block on y = 0, its middle at x = z = 0, of squares of about `edge` cut in two.
pub(crate) fn fine_block(size: Vec3, edge: f64) -> TriangleMesh {
    let cells = size.map(|length| (length / edge).round() as usize);
    let mut numbers = std::collections::BTreeMap::new();
    let mut mesh = TriangleMesh::default();
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        for end in [0, cells[axis]] {
            for (i, j) in (0..cells[u]).flat_map(|i| (0..cells[v]).map(move |j| (i, j))) {
                let corner = |(di, dj): (usize, usize)| {
                    let mut place = [0; 3];
                    (place[axis], place[u], place[v]) = (end, i + di, j + dj);
                    place
                };
                let mut quad = [(0, 0), (1, 0), (1, 1), (0, 1)].map(corner);
                if end == 0 {
                    quad.reverse();
                }
                let [a, b, c, d] = quad.map(|place| {
                    *numbers.entry(place).or_insert_with(|| {
                        let share = |k: usize| place[k] as f64 / cells[k] as f64 * size[k];
                        let middle = Vec3::new(size.x / 2.0, 0.0, size.z / 2.0);
                        mesh.vertices
                            .push(Vec3::new(share(0), share(1), share(2)) - middle);
                        mesh.vertices.len() as u32 - 1
                    })
                });
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    mesh
}

#[expect(
    clippy::needless_pass_by_value,
    reason = "tests join values that they make on the spot"
)]
pub(crate) fn joined(a: TriangleMesh, b: TriangleMesh) -> TriangleMesh {
    a.joined(&b)
}
