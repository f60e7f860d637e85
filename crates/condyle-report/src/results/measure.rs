//! What the report measures on the articulating surface itself.

use condyle_fem::Vec3;

use super::surface::SurfaceFields;

/// A part of the surface by the sign of z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// z below 0: medial in a right knee.
    Left,
    /// z at or above 0: lateral in a right knee.
    Right,
    /// All of it.
    Whole,
}

/// The largest value of a field and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The value, in the unit of the field.
    pub value: f64,
    /// The node's position, mm.
    pub position: Vec3,
}

impl Region {
    /// Whether a point with this z, mm, is in it.
    pub fn holds(self, z: f64) -> bool {
        match self {
            Self::Left => z < 0.0,
            Self::Right => z >= 0.0,
            Self::Whole => true,
        }
    }
}

impl SurfaceFields {
    /// The largest finite value of a field in a region; `None` where it has no node.
    pub fn largest(&self, values: &[f64], region: Region) -> Option<Extreme> {
        self.nodes
            .iter()
            .zip(values)
            .filter(|(node, value)| region.holds(node.z) && value.is_finite())
            .map(|(&position, &value)| Extreme { value, position })
            .reduce(|best, next| if next.value > best.value { next } else { best })
    }

    /// The smallest value above 0 of a field in a region; `None` where there is none.
    pub fn smallest_positive(&self, values: &[f64], region: Region) -> Option<f64> {
        let in_region = self
            .nodes
            .iter()
            .zip(values)
            .filter(|(node, _)| region.holds(node.z));
        in_region
            .map(|(_, &value)| value)
            .filter(|value| *value > 0.0)
            .reduce(f64::min)
    }

    /// Integral of a field over a region's faces: sum of face area times mean of the corners.
    pub fn integral(&self, values: &[f64], region: Region) -> f64 {
        self.faces(region)
            .map(|(quad, area)| area * mean(values, quad))
            .sum()
    }

    /// Area of the faces of a region where the mean of a field is above `threshold`, mm2.
    pub fn area_above(&self, values: &[f64], threshold: f64, region: Region) -> f64 {
        self.faces(region)
            .filter(|&(quad, _)| mean(values, quad) > threshold)
            .map(|(_, area)| area)
            .sum()
    }

    fn faces(&self, region: Region) -> impl Iterator<Item = ([u32; 4], f64)> + '_ {
        self.quads.iter().filter_map(move |&quad| {
            let [a, b, c, d] = self.corners(quad);
            let inside = region.holds((a.z + b.z + c.z + d.z) / 4.0);
            inside.then(|| (quad, (c - a).cross(&(d - b)).norm() / 2.0))
        })
    }
}

fn mean(values: &[f64], quad: [u32; 4]) -> f64 {
    quad.iter().map(|&node| values[node as usize]).sum::<f64>() / 4.0
}

#[cfg(test)]
mod tests {
    use super::*;

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
                fields: Vec::new(),
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
