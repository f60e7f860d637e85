//! Small triangle meshes, as ASCII STL.

use std::fmt::Write;

/// Corners of a triangle.
pub type Triangle = [[f64; 3]; 3];

/// A height for every place (x, z), or nothing below a sheet.
type Height<'a> = &'a dyn Fn(f64, f64) -> f64;

/// A rectangle in x and z cut into squares.
pub struct Field {
    pub low: (f64, f64),
    pub high: (f64, f64),
    pub edge_mm: f64,
}

impl Field {
    /// The squares as corners in x and z, going round from above against the clock.
    fn squares(&self) -> Vec<[(f64, f64); 4]> {
        let count = |low: f64, high: f64| ((high - low) / self.edge_mm).ceil() as u32;
        let (nx, nz) = (
            count(self.low.0, self.high.0),
            count(self.low.1, self.high.1),
        );
        let at = |i: u32, k: u32| {
            let along = |low: f64, high: f64, i: u32, n: u32| {
                low + (high - low) * f64::from(i) / f64::from(n)
            };
            (
                along(self.low.0, self.high.0, i, nx),
                along(self.low.1, self.high.1, k, nz),
            )
        };
        (0..nx)
            .flat_map(|i| (0..nz).map(move |k| (i, k)))
            .map(|(i, k)| [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)])
            .collect()
    }

    /// The sheet y = height(x, z), facing up.
    pub fn sheet(&self, height: Height<'_>) -> Vec<Triangle> {
        let lift = |(x, z): (f64, f64)| [x, height(x, z), z];
        let halves = |[a, b, c, d]: [(f64, f64); 4]| {
            [[lift(a), lift(b), lift(c)], [lift(a), lift(c), lift(d)]]
        };
        self.squares().into_iter().flat_map(halves).collect()
    }

    /// The closed body between y = 0 and the sheet.
    pub fn body(&self, height: Height<'_>) -> Vec<Triangle> {
        let mut triangles = self.sheet(height);
        triangles.extend(inside_out(self.sheet(&|_, _| 0.0)));
        triangles.extend(self.walls(height));
        triangles
    }

    fn walls(&self, height: Height<'_>) -> Vec<Triangle> {
        let squares = self.squares();
        let edges = squares
            .iter()
            .flat_map(|square| (0..4).map(move |i| (square[i], square[(i + 1) % 4])));
        let edges: Vec<_> = edges.collect();
        let is_rim = |&&(a, b): &&((f64, f64), (f64, f64))| !edges.contains(&(b, a));
        let wall = |&((ax, az), (bx, bz)): &((f64, f64), (f64, f64))| {
            let (a, b) = ([ax, height(ax, az), az], [bx, height(bx, bz), bz]);
            let (below_a, below_b) = ([ax, 0.0, az], [bx, 0.0, bz]);
            [[b, a, below_a], [b, below_a, below_b]]
        };
        edges.iter().filter(is_rim).flat_map(wall).collect()
    }
}

/// Every triangle facing the other way.
pub fn inside_out(mut triangles: Vec<Triangle>) -> Vec<Triangle> {
    triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    triangles
}

/// Every triangle moved, and turned to face the same way if `mirrors`.
pub fn moved(
    mut triangles: Vec<Triangle>,
    mirrors: bool,
    place: impl Fn([f64; 3]) -> [f64; 3],
) -> Vec<Triangle> {
    for corners in &mut triangles {
        *corners = corners.map(&place);
        if mirrors {
            corners.swap(1, 2);
        }
    }
    triangles
}

/// The triangles as a file.
pub fn stl(triangles: &[Triangle]) -> String {
    let mut text = String::from("solid shape\n");
    for corners in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in corners {
            writeln!(text, "vertex {x:e} {y:e} {z:e}").expect("text takes text");
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid shape\n"
}

/// The condyles of [`femur`] end at 14 mm, so they cannot flex as far as a knee does.
pub const FLEXED_A_LITTLE: &str = "[machine.flexion]\nwaveform = \"iso-like\"\nscale = 0.2\n";

const INSERT: Field = Field {
    low: (-22.0, -32.0),
    high: (22.0, 32.0),
    edge_mm: 2.0,
};
const FEMUR: Field = Field {
    low: (-14.0, -33.0),
    high: (14.0, 33.0),
    edge_mm: 2.0,
};

/// How far a dish or a condyle of these radii lies from its lowest point, both 20 mm off the middle
/// but a millimetre wider on the lateral side, so that a mirror image shows.
fn rise(x: f64, z: f64, sagittal_mm: f64, coronal_mm: f64) -> f64 {
    let across = if z > 0.0 { z - 21.0 } else { z + 20.0 };
    x * x / (2.0 * sagittal_mm) + across * across / (2.0 * coronal_mm)
}

fn dish(x: f64, z: f64) -> f64 {
    9.0 + rise(x, z, 60.0, 45.0)
}

/// An insert of two dishes, closed, 9 mm where it is thinnest.
pub fn insert() -> Vec<Triangle> {
    INSERT.body(&dish)
}

/// The articulating surface of [`insert`] alone.
pub fn open_insert() -> Vec<Triangle> {
    INSERT.sheet(&dish)
}

/// Two condyles, open above, their lowest points on y = -20; they face down.
pub fn femur() -> Vec<Triangle> {
    let condyles = |x: f64, z: f64| rise(x, z, 30.0, 24.0) - 20.0;
    inside_out(FEMUR.sheet(&condyles))
}

/// A closed roof whose sides rise by `slope` mm a mm.
pub fn wedge(slope: f64) -> Vec<Triangle> {
    INSERT.body(&|x, _| 1.0 + slope * (22.0 - x.abs()))
}

/// A block of these bounds, closed.
pub fn block(low: [f64; 3], high: [f64; 3]) -> Vec<Triangle> {
    let field = Field {
        low: (low[0], low[2]),
        high: (high[0], high[2]),
        edge_mm: 1e9,
    };
    let up = |[x, y, z]: [f64; 3]| [x, y + low[1], z];
    moved(field.body(&|_, _| high[1] - low[1]), false, up)
}
