//! Which joint of a mechanism.

use super::JointDescription;

/// The place of a joint in its chain, found by the joint's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct JointIndex(usize);

impl JointIndex {
    /// The six places, from the insert to the femur.
    pub const ALL: [Self; 6] = [Self(0), Self(1), Self(2), Self(3), Self(4), Self(5)];

    /// The place of the joint called `name`; a constant of it is found when the program is compiled.
    ///
    /// # Panics
    /// Where no joint is called so.
    pub const fn named(name: &str, joints: &[JointDescription; 6]) -> Self {
        let mut place = 0;
        while place < joints.len() {
            if is_same(name.as_bytes(), joints[place].name.as_bytes()) {
                return Self(place);
            }
            place += 1;
        }
        panic!("no joint of the mechanism has this name")
    }

    /// The place as a number, from 0 at the insert.
    pub const fn place(self) -> usize {
        self.0
    }

    /// Of one value a joint, in the order of the chain, that of this joint.
    pub const fn of(self, values: &[f64; 6]) -> f64 {
        values[self.0]
    }
}

/// Whether two texts are the same, for constants.
const fn is_same(one: &[u8], other: &[u8]) -> bool {
    if one.len() != other.len() {
        return false;
    }
    let mut i = 0;
    while i < one.len() {
        if one[i] != other[i] {
            return false;
        }
        i += 1;
    }
    true
}
