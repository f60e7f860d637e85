//! Regions of the articulating surface, such as the sides of a knee.

use crate::Vec3;

/// Named regions of the articulating surface, and the region of each surface node.
///
/// They are fixed when an insert is made: a worn node stays in its region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfaceRegions {
    names: Vec<String>,
    numbers: Vec<u8>,
}

impl SurfaceRegions {
    /// Regions called `names`; `region_of` gives the number of a node's region from its position in
    /// the insert frame, mm.
    ///
    /// # Panics
    /// If there is no name or more than 256, or a number has no name.
    pub fn split(
        names: &[&str],
        positions: impl IntoIterator<Item = Vec3>,
        region_of: impl Fn(&Vec3) -> usize,
    ) -> Self {
        assert!(
            (1..=256).contains(&names.len()),
            "a surface has 1 to 256 regions, not {}",
            names.len()
        );
        let number = |position: Vec3| {
            let region = region_of(&position);
            assert!(region < names.len(), "region {region} has no name");
            region as u8
        };
        Self {
            names: names.iter().copied().map(str::to_owned).collect(),
            numbers: positions.into_iter().map(number).collect(),
        }
    }

    /// Creates the regions of the two sides of a right knee, split at z = 0: 0 is medial, where z < 0, and 1 is
    /// lateral.
    pub fn medial_and_lateral(positions: impl IntoIterator<Item = Vec3>) -> Self {
        Self::split(&["medial", "lateral"], positions, |position| {
            usize::from(position.z >= 0.0)
        })
    }

    /// Returns the number of regions.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// Returns the names, in the order of the numbers.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the number of a surface node's region.
    pub fn of_node(&self, node: usize) -> usize {
        self.numbers[node].into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> [Vec3; 4] {
        [-2.0, -1e-9, 0.0, 3.0].map(|z| Vec3::new(1.0, 5.0, z))
    }

    #[test]
    fn a_knee_is_split_at_its_middle() {
        let regions = SurfaceRegions::medial_and_lateral(row());
        assert_eq!(regions.names(), ["medial", "lateral"]);
        let of_nodes = [0, 1, 2, 3].map(|node| regions.of_node(node));
        assert_eq!(of_nodes, [0, 0, 1, 1]);
    }

    #[test]
    fn a_surface_may_be_one_region_or_many() {
        let cup = SurfaceRegions::split(&["cup"], row(), |_| 0);
        assert_eq!((cup.count(), cup.of_node(3)), (1, 0));
        let names = ["far medial", "middle", "far lateral"];
        let three = SurfaceRegions::split(&names, row(), |at| (at.z / 2.0).round() as usize);
        assert_eq!(three.of_node(3), 2);
    }

    #[test]
    #[should_panic(expected = "region 2 has no name")]
    fn every_region_has_a_name() {
        let _ = SurfaceRegions::split(&["one", "other"], row(), |_| 2);
    }
}
