//! Blocks of triangles for tests.

use crate::{Vec3, geometry::triangle_mesh::TriangleMesh};

/// A block from `low` to `high`, twelve triangles, facing outwards.
pub(crate) fn block(low: Vec3, high: Vec3) -> TriangleMesh {
    let corner = |i: u32| {
        let pick = |axis: u32| if i >> axis & 1 == 0 { low } else { high }[axis as usize];
        Vec3::new(pick(0), pick(1), pick(2))
    };
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    let vertices = (0..8).map(corner).collect();
    TriangleMesh {
        vertices,
        triangles,
    }
}

pub(crate) fn unit_block() -> TriangleMesh {
    block(Vec3::zeros(), Vec3::repeat(1.0))
}

pub(crate) fn joined(mut a: TriangleMesh, b: TriangleMesh) -> TriangleMesh {
    let shift = a.vertices.len() as u32;
    a.vertices.extend(b.vertices);
    a.triangles
        .extend(b.triangles.iter().map(|t| t.map(|vertex| vertex + shift)));
    a
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

/// A body with a flat underside at `height_mm`, grown together with a plate and a stem below: the plate has the
/// outline of the underside, scaled about its middle, and the stem a fifth of it.
pub(crate) fn fused(
    mut body: TriangleMesh,
    height_mm: f64,
    scale: f64,
    plate_mm: f64,
    stem_mm: f64,
) -> TriangleMesh {
    let outline = open_underside(&mut body, height_mm);
    let places: Vec<Vec3> = outline.iter().map(|&n| body.vertices[n as usize]).collect();
    let middle = places.iter().sum::<Vec3>() / places.len() as f64;
    let below_mm = height_mm - plate_mm;
    let rings = [
        (scale, height_mm),
        (scale, below_mm),
        (0.2, below_mm),
        (0.2, below_mm - stem_mm),
    ];
    let mut above = outline;
    let is_flat = |ring: &(f64, f64)| *ring == (1.0, height_mm);
    for (scale, y) in rings.into_iter().filter(|ring| !is_flat(ring)) {
        let place = |at: &Vec3| {
            let at = middle + (at - middle) * scale;
            Vec3::new(at.x, y, at.z)
        };
        let first = body.vertices.len() as u32;
        body.vertices.extend(places.iter().map(place));
        let below: Vec<u32> = (first..body.vertices.len() as u32).collect();
        for n in 0..above.len() {
            let after = (n + 1) % above.len();
            let quad = [above[n], below[n], below[after], above[after]];
            body.triangles
                .extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
        above = below;
    }
    let tip = body.vertices.len() as u32;
    body.vertices
        .push(Vec3::new(middle.x, below_mm - stem_mm, middle.z));
    let next = above.iter().cycle().skip(1);
    body.triangles
        .extend(above.iter().zip(next).map(|(&a, &b)| [a, tip, b]));
    body
}

/// Takes away the triangles at a height; gives the line around them, as it lies in what is left.
fn open_underside(body: &mut TriangleMesh, height_mm: f64) -> Vec<u32> {
    let heights: Vec<f64> = body.vertices.iter().map(|vertex| vertex.y).collect();
    let is_there = |n: &u32| (heights[*n as usize] - height_mm).abs() < 1e-9;
    body.triangles
        .retain(|triangle| !triangle.iter().all(is_there));
    let sides = |triangle: &[u32; 3]| {
        let [a, b, c] = *triangle;
        [(a, b), (b, c), (c, a)]
    };
    let next: std::collections::BTreeMap<u32, u32> = body
        .triangles
        .iter()
        .flat_map(sides)
        .filter(|(a, b)| is_there(a) && is_there(b))
        .collect();
    let start = *next.keys().next().unwrap();
    let mut outline = vec![start];
    while let Some(&after) = next.get(&outline[outline.len() - 1])
        && after != start
    {
        outline.push(after);
    }
    outline
}
