//! Parts of the articulating surface by name: the sides of a knee, or the whole of a cup.

use crate::Vec3;

/// Labelled regions of the articulating surface, and of each surface node the one it belongs to.
///
/// They are fixed when an insert is made: a node stays in its region wherever it wears to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfaceRegions {
    names: Vec<String>,
    numbers: Vec<u8>,
}

impl SurfaceRegions {
    /// Regions called `names`; a node is in that whose number `region_of` gives for its position in
    /// the insert frame, mm.
    ///
    /// # Panics
    /// There is no name, there are more than 256, or a number has none.
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

    /// The two sides of a right knee, split at z = 0: 0 is medial, where z < 0, and 1 is lateral.
    pub fn medial_and_lateral(positions: impl IntoIterator<Item = Vec3>) -> Self {
        Self::split(&["medial", "lateral"], positions, |position| {
            usize::from(position.z >= 0.0)
        })
    }

    /// One region of all nodes, as of a cup or of a disc under a pin.
    pub fn whole(name: &str, node_count: usize) -> Self {
        Self {
            names: vec![name.to_owned()],
            numbers: vec![0; node_count],
        }
    }

    /// How many regions there are.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// Their names, in the order of their numbers.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of the region called `name`.
    pub fn number_of(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// Number of the region of surface node `node`.
    pub fn of_node(&self, node: usize) -> usize {
        self.numbers[node].into()
    }

    /// How many surface nodes there are.
    pub fn node_count(&self) -> usize {
        self.numbers.len()
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
        assert_eq!(regions.number_of("lateral"), Some(1));
        assert_eq!(regions.number_of("rim"), None);
    }

    #[test]
    fn a_surface_may_be_one_region_or_many() {
        let cup = SurfaceRegions::whole("cup", 4);
        assert_eq!((cup.count(), cup.node_count(), cup.of_node(3)), (1, 4, 0));
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
