//! The articulating surface with its fields.

use std::path::Path;

use condyle_fem::{HexMesh, Vec3, numbered};
use condyle_results::Directions;

use crate::error::ReportError;

/// Point data that is 1 on nodes of the articulating surface.
pub(crate) const ARTICULATING: &str = "articulating";

/// A surface of quads with values at its nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceFields {
    /// Node positions in the insert frame, mm.
    pub nodes: Vec<Vec3>,
    /// Nodes of each quad, from 0, anticlockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
    /// Name of each field, which carries the unit, and a value for each node.
    pub fields: Vec<(String, Vec<f64>)>,
    /// True for a cup about the origin, whose maps are azimuthal: walls are as wide as the floor.
    pub is_cup: bool,
}

/// A part of the surface by the sign of z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// z below 0: medial in a right knee.
    Left,
    /// z at or above 0: lateral in a right knee.
    Right,
    /// The whole surface.
    Whole,
}

/// The largest value of a field and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value, in the unit of the field.
    pub value: f64,
    /// The node.
    pub node: usize,
    /// Its position, mm.
    pub position: Vec3,
}

impl Region {
    /// Returns the regions whose values are stated separately, with their names: the sides of a knee from -z to +z; the
    /// whole surface, without a name, of another joint.
    pub fn all_of(directions: Directions) -> Vec<(Self, &'static str)> {
        if directions.is_knee() {
            let [left, right] = directions.along_z();
            return vec![(Self::Left, left), (Self::Right, right)];
        }
        vec![(Self::Whole, "")]
    }

    /// Returns whether a point with this z, mm, is in the region.
    pub fn holds(self, z: f64) -> bool {
        match self {
            Self::Left => z < 0.0,
            Self::Right => z >= 0.0,
            Self::Whole => true,
        }
    }
}

impl SurfaceFields {
    /// Extracts the boundary faces of a mesh all of whose nodes have `articulating` = 1, with the point data.
    ///
    /// `path` is for messages only.
    ///
    /// # Errors
    /// `articulating` is missing or marks no face, or an array does not fit the nodes.
    pub fn of_mesh(
        mesh: &HexMesh,
        point_data: &[(String, Vec<f64>)],
        path: &Path,
    ) -> Result<Self, ReportError> {
        let nodes = mesh.nodes.len();
        let fail = |problem: String| Err(ReportError::content(path, problem));
        if let Some((field, values)) = point_data.iter().find(|(_, all)| all.len() != nodes) {
            let found = values.len();
            return fail(format!(
                "has {nodes} nodes, but {found} values of `{field}`"
            ));
        }
        let Some((_, marks)) = point_data.iter().find(|(name, _)| name == ARTICULATING) else {
            return fail(format!("has no point data `{ARTICULATING}`"));
        };
        let Some(surface) = Articulating::of(mesh, marks) else {
            return fail(format!(
                "has no face whose nodes all have `{ARTICULATING}` = 1"
            ));
        };
        let fields = point_data.iter().map(|field| surface.pick_field(field));
        Ok(Self {
            nodes: surface.pick(&mesh.nodes),
            fields: fields.collect(),
            quads: surface.quads,
            is_cup: false,
        })
    }

    /// Returns the field called `name`, a value for each node.
    pub fn field(&self, name: &str) -> Option<&[f64]> {
        let (_, values) = self.fields.iter().find(|(known, _)| known == name)?;
        Some(values)
    }

    /// Returns the positions of the corners of a quad, mm.
    pub fn corners(&self, quad: [u32; 4]) -> [Vec3; 4] {
        quad.map(|node| self.nodes[node as usize])
    }

    /// Returns the places of the nodes on maps, mm: x and z of the insert frame; of a cup, its arcs from the middle in the
    /// directions of x and z (azimuthal equidistant projection).
    pub(crate) fn flat(&self) -> Vec<[f64; 2]> {
        if !self.is_cup {
            return self.nodes.iter().map(|node| [node.x, node.z]).collect();
        }
        let sum: Vec3 = self.nodes.iter().map(Vec3::normalize).sum();
        let pole = sum.normalize();
        // Anterior is perpendicular to the axis of every cup that is only inclined; of another one, next to it.
        let across = pole.cross(&Vec3::x()).normalize();
        let along = across.cross(&pole);
        let place = |node: &Vec3| {
            let [x, z] = [node.dot(&along), node.dot(&across)];
            let from_axis = x.hypot(z);
            let arc = node.norm() * from_axis.atan2(node.dot(&pole));
            // The arc is as long as the distance from the axis next to it.
            let scale = if from_axis > 0.0 {
                arc / from_axis
            } else {
                1.0
            };
            [x * scale, z * scale]
        };
        self.nodes.iter().map(place).collect()
    }

    pub(crate) fn bounds(&self) -> [(f64, f64); 2] {
        let flat = self.flat();
        [0, 1].map(|axis| {
            let values = flat.iter().map(|place| place[axis]);
            let low = values.clone().fold(f64::INFINITY, f64::min);
            (low, values.fold(f64::NEG_INFINITY, f64::max))
        })
    }

    /// Returns the largest finite value of a field in a region; `None` where it has no node.
    pub fn largest(&self, values: &[f64], region: Region) -> Option<Extreme> {
        self.largest_by(values, region, |value| value)
    }

    /// Returns the finite value of a field in a region whose `size` is largest.
    pub(crate) fn largest_by(
        &self,
        values: &[f64],
        region: Region,
        size: impl Fn(f64) -> f64,
    ) -> Option<Extreme> {
        let found = self.in_region(values, region);
        let finite = found.filter(|extreme| extreme.value.is_finite());
        finite.reduce(|best, next| {
            if size(next.value) > size(best.value) {
                next
            } else {
                best
            }
        })
    }

    /// Returns the smallest value above 0 of a field in a region; `None` where there is none.
    pub fn smallest_positive(&self, values: &[f64], region: Region) -> Option<f64> {
        let values = self.in_region(values, region).map(|found| found.value);
        values.filter(|value| *value > 0.0).reduce(f64::min)
    }

    /// Integral of a field over a region's faces: sum of face area times mean of the corners.
    pub fn integral(&self, values: &[f64], region: Region) -> f64 {
        let faces = self.faces(region);
        faces.map(|(quad, area)| area * mean(values, quad)).sum()
    }

    /// Returns the area of a region where a field is above `threshold`, mm2.
    pub fn area_above(&self, values: &[f64], threshold: f64, region: Region) -> f64 {
        let faces = self.faces(region);
        let above = |quad: [u32; 4]| part_above(quad.map(|node| values[node as usize]), threshold);
        faces.map(|(quad, area)| area * above(quad)).sum()
    }

    fn in_region(&self, values: &[f64], region: Region) -> impl Iterator<Item = Extreme> {
        let all = self.nodes.iter().zip(values).enumerate();
        let own = all.filter(move |(_, (position, _))| region.holds(position.z));
        own.map(|(node, (&position, &value))| Extreme {
            value,
            node,
            position,
        })
    }

    fn faces(&self, region: Region) -> impl Iterator<Item = ([u32; 4], f64)> {
        self.quads.iter().filter_map(move |&quad| {
            let [a, b, c, d] = self.corners(quad);
            let is_inside = region.holds((a.z + b.z + c.z + d.z) / 4.0);
            // The diagonals of a quad span twice its area.
            is_inside.then(|| (quad, (c - a).cross(&(d - b)).norm() / 2.0))
        })
    }
}

/// Returns the part of a quad where the bilinear field with these corners is above `threshold`.
fn part_above([a, b, c, d]: [f64; 4], threshold: f64) -> f64 {
    const SIDE: u32 = 8;
    let place = |at: u32| (f64::from(at) + 0.5) / f64::from(SIDE);
    let value = |at: &u32| {
        let (u, v) = (place(at % SIDE), place(at / SIDE));
        (1.0 - v) * (a + u * (b - a)) + v * (d + u * (c - d))
    };
    let above = (0..SIDE * SIDE).filter(|at| value(at) > threshold);
    above.count() as f64 / f64::from(SIDE * SIDE)
}

fn mean(values: &[f64], quad: [u32; 4]) -> f64 {
    quad.iter().map(|&node| values[node as usize]).sum::<f64>() / 4.0
}

#[derive(Clone, Debug)]
pub(crate) struct Articulating {
    /// Its nodes by their numbers in the mesh, in rising order.
    pub nodes: Vec<u32>,
    /// Nodes of each quad, numbered as in `nodes`.
    pub quads: Vec<[u32; 4]>,
}

impl Articulating {
    /// Returns the boundary faces whose nodes are all marked 1; none if there are no such faces.
    pub fn of(mesh: &HexMesh, marks: &[f64]) -> Option<Self> {
        if marks.len() != mesh.nodes.len() {
            return None;
        }
        let is_marked = |quad: &[u32; 4]| quad.iter().all(|&node| marks[node as usize] == 1.0);
        let quads = mesh.boundary_quads_where(is_marked);
        if quads.is_empty() {
            return None;
        }
        let (nodes, quads) = numbered(&quads);
        Some(Self { nodes, quads })
    }

    /// Selects the values of a field as [`Self::pick`]; noise of the cross-shear of straight paths is zero.
    pub fn pick_field(&self, (name, values): &(String, Vec<f64>)) -> (String, Vec<f64>) {
        /// A map of smaller values would show rounding.
        const NOISE: f64 = 1e-6;
        let mut values = self.pick(values);
        if name == "cross_shear" {
            let noise = values.iter_mut().filter(|value| value.abs() < NOISE);
            noise.for_each(|value| *value = 0.0);
        }
        (name.clone(), values)
    }

    /// Selects the values at the nodes of the surface from those at all nodes of the mesh.
    pub fn pick<T: Copy>(&self, values: &[T]) -> Vec<T> {
        let nodes = self.nodes.iter();
        nodes.map(|&node| values[node as usize]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two unit cubes on top of each other along y; the field is the node's number.
    fn column() -> HexMesh {
        let corner = |i: u32| Vec3::new(f64::from(i % 2), f64::from(i / 4), f64::from(i / 2 % 2));
        let nodes = (0..12).map(corner).collect();
        let hex = |low: u32| {
            [
                low,
                low + 2,
                low + 3,
                low + 1,
                low + 4,
                low + 6,
                low + 7,
                low + 5,
            ]
        };
        HexMesh {
            nodes,
            hexes: [hex(0), hex(4)].into(),
        }
    }

    fn data(marked: &[usize]) -> Vec<(String, Vec<f64>)> {
        let marks = (0..12)
            .map(|node| f64::from(u8::from(marked.contains(&node))))
            .collect();
        let number = (0..12).map(f64::from).collect();
        vec![
            (ARTICULATING.to_owned(), marks),
            (String::from("number"), number),
        ]
    }

    #[test]
    fn the_top_of_a_column_is_its_surface() {
        let surface = SurfaceFields::of_mesh(&column(), &data(&[8, 9, 10, 11]), Path::new("a.vtu"))
            .expect("has a surface");
        assert_eq!((surface.nodes.len(), surface.quads.len()), (4, 1));
        assert_eq!(
            surface.field("number"),
            Some([8.0, 9.0, 10.0, 11.0].as_slice())
        );
        assert!(surface.nodes.iter().all(|node| node.y == 2.0));
        let [a, b, c, _] = surface.corners(surface.quads[0]);
        assert!((b - a).cross(&(c - b)).y > 0.0, "the surface faces up");
    }

    #[test]
    fn noise_of_the_cross_shear_is_zero() {
        let mut data = data(&[8, 9, 10, 11]);
        data.push(("cross_shear".to_owned(), vec![7.76e-10; 12]));
        data.push(("depth_per_cycle_mm".to_owned(), vec![7.76e-10; 12]));
        let surface = SurfaceFields::of_mesh(&column(), &data, Path::new("a.vtu")).unwrap();
        let highest = |name: &str| surface.largest(surface.field(name)?, Region::Whole);
        let [shear, depth] =
            ["cross_shear", "depth_per_cycle_mm"].map(|name| highest(name).unwrap().value);
        assert_eq!((shear, depth), (0.0, 7.76e-10));
    }

    #[test]
    fn a_face_between_two_elements_is_no_surface() {
        let all: Vec<_> = (0..12).collect();
        let surface = SurfaceFields::of_mesh(&column(), &data(&all), Path::new("a.vtu"))
            .expect("has a surface");
        assert_eq!(surface.quads.len(), column().boundary_quads().len());
    }

    #[test]
    fn an_unusable_mesh_is_an_error_with_its_reason() {
        let reported = |data: &[(String, Vec<f64>)]| {
            SurfaceFields::of_mesh(&column(), data, Path::new("a.vtu"))
                .expect_err("is wrong")
                .to_string()
        };
        assert_eq!(
            reported(&data(&[])),
            "The file a.vtu has no face whose nodes all have `articulating` = 1."
        );
        assert_eq!(
            reported(&[]),
            "The file a.vtu has no point data `articulating`."
        );
        let short = [(String::from("depth"), vec![0.0; 3])];
        assert_eq!(
            reported(&short),
            "The file a.vtu has 12 nodes, but 3 values of `depth`."
        );
    }

    /// Two unit squares side by side along z, the field equal to z + 1.
    fn pair() -> (SurfaceFields, Vec<f64>) {
        let nodes: Vec<_> = (0..6)
            .map(|i| Vec3::new(f64::from(i / 3), 0.0, f64::from(i % 3) - 1.0))
            .collect();
        let values = nodes.iter().map(|node| node.z + 1.0).collect();
        let quads = vec![[0, 1, 4, 3], [1, 2, 5, 4]];
        (
            SurfaceFields {
                nodes,
                quads,
                ..SurfaceFields::default()
            },
            values,
        )
    }

    #[test]
    fn verify_integral_and_area_of_two_squares() {
        let (surface, values) = pair();
        assert!((surface.integral(&values, Region::Left) - 0.5).abs() < 1e-12);
        assert!((surface.integral(&values, Region::Right) - 1.5).abs() < 1e-12);
        assert!((surface.integral(&values, Region::Whole) - 2.0).abs() < 1e-12);
        assert!((surface.area_above(&values, 1.0, Region::Whole) - 1.0).abs() < 1e-12);
        assert!((surface.area_above(&values, 0.25, Region::Whole) - 1.75).abs() < 1e-12);
    }

    #[test]
    fn verify_a_cup_is_unrolled_by_its_arcs_about_its_own_axis() {
        // A hemisphere of 10 mm whose middle is tilted by 30 degrees towards +z.
        let (sine, cosine) = 30f64.to_radians().sin_cos();
        let node = |polar_deg: f64, around_deg: f64| {
            let (polar, around) = (polar_deg.to_radians(), around_deg.to_radians());
            let (x, z) = (polar.sin() * around.cos(), polar.sin() * around.sin());
            let y = -polar.cos();
            10.0 * Vec3::new(x, cosine * y + sine * z, cosine * z - sine * y)
        };
        let rings = [0.0, 45.0, 90.0];
        let all = rings
            .iter()
            .flat_map(|&polar| (0..8).map(move |n| (polar, 45.0 * f64::from(n))));
        let places: Vec<(f64, f64)> = all.collect();
        let cup = SurfaceFields {
            nodes: places
                .iter()
                .map(|&(polar, around)| node(polar, around))
                .collect(),
            is_cup: true,
            ..SurfaceFields::default()
        };
        for (&(polar, around), [x, z]) in places.iter().zip(cup.flat()) {
            let arc = 10.0 * polar.to_radians();
            let wanted = [
                arc * around.to_radians().cos(),
                arc * around.to_radians().sin(),
            ];
            let off = (x - wanted[0]).hypot(z - wanted[1]);
            assert!(off < 1e-9, "{polar} {around}: {x} {z}, not {wanted:?}");
        }
    }

    #[test]
    fn the_largest_value_is_found_in_its_region() {
        let (surface, values) = pair();
        let left = surface.largest(&values, Region::Left).expect("has nodes");
        let whole = surface.largest(&values, Region::Whole).expect("has nodes");
        assert_eq!((left.value, whole.value), (0.0, 2.0));
        assert_eq!(whole.position.z, 1.0);
        assert_eq!(surface.smallest_positive(&values, Region::Whole), Some(1.0));
        assert_eq!(surface.smallest_positive(&values, Region::Left), None);
    }
}
