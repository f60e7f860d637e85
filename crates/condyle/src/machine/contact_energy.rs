//! The energy of a contact in explicit steps, by which steps that are not stable show.

/// Upper bound of the elastic depth of a contact, mm, several times that of any implant: a contact
/// stores no more energy than its load times this depth.
const STORED_MM: f64 = 1.0;

/// The energy that the contact takes from the moving parts in a cycle. It is passive: it gives back what it held at the
/// start of the cycle and takes in later, and no more; steps that are not stable make energy out of nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactEnergy {
    taken_nmm: f64,
    /// The contact force at the start of the cycle, or the largest load since.
    most_n: f64,
}

impl ContactEnergy {
    /// Returns true while neither a contact force nor a load is known.
    pub fn is_unpressed(&self) -> bool {
        self.most_n == 0.0
    }

    pub fn press(&mut self, force_n: f64) {
        self.most_n = self.most_n.max(force_n);
    }

    pub fn give(&mut self, energy_nmm: f64) {
        self.taken_nmm -= energy_nmm;
    }

    /// Returns whether the contact has given back more than it can hold.
    pub fn is_made(&self) -> bool {
        !self.is_unpressed() && self.taken_nmm < -STORED_MM * self.most_n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_gives_back_what_it_held_and_no_more() {
        let mut energy = ContactEnergy::default();
        energy.give(1.0);
        assert!(!energy.is_made(), "no load is known");
        energy.press(10.0);
        energy.give(8.0);
        assert!(!energy.is_made());
        energy.give(-5.0);
        energy.give(5.0);
        assert!(!energy.is_made());
        energy.give(2.0);
        assert!(energy.is_made());
    }
}
