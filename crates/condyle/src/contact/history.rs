//! The contact history of the articulating surface over one cycle.

use std::ops::Range;

/// One instant of contact at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Mean pressure on the node's share of the surface, MPa.
    pub pressure_mpa: f64,
    /// Slip of the counterface past the insert over the increment, mm, in the surface's own directions: anterior along the
    /// surface, then lateral.
    pub slip_mm: [f64; 2],
}

impl Moment {
    /// Returns the distance slid, mm.
    #[inline]
    pub fn distance_mm(&self) -> f64 {
        let [anterior, lateral] = self.slip_mm;
        (anterior * anterior + lateral * lateral).sqrt()
    }
}

/// An instant of contact at a node, as it is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// The node of the articulating surface.
    pub node: u32,
    /// Area of the node's share that is in contact, mm2; in 32 bits it fills the padding of the struct.
    pub pressed_mm2: f32,
    /// Pressure and slip at the node.
    pub moment: Moment,
}

/// Sums over the instants at which one node was in contact.
#[derive(Clone, Copy, Debug, Default)]
pub struct NodeSums {
    /// Highest mean pressure on the node's share in the cycle, MPa.
    pub peak_pressure_mpa: f64,
    /// Sum of the mean pressure on the node's share over the instants, MPa.
    pub summed_pressure_mpa: f64,
    /// Distance slid while any of the node's share is in contact, sum of |ds|, mm.
    pub sliding_distance_mm: f64,
    /// Area in contact times distance slid, sum of A' |ds|, mm3; divided by the area of the share, the mean distance
    /// that a place of the share slides under pressure.
    pub pressed_area_slip_mm3: f64,
    /// Pressure times slip, sum of p |ds|, MPa mm.
    pub pressure_slip_mpa_mm: f64,
    /// Pressure times slip by direction.
    pub slip_work: SlipWork,
}

impl NodeSums {
    #[inline(always)]
    fn add(&mut self, record: &Record) {
        let moment = &record.moment;
        let distance_mm = moment.distance_mm();
        self.peak_pressure_mpa = self.peak_pressure_mpa.max(moment.pressure_mpa);
        self.summed_pressure_mpa += moment.pressure_mpa;
        self.sliding_distance_mm += distance_mm;
        self.pressed_area_slip_mm3 += f64::from(record.pressed_mm2) * distance_mm;
        self.pressure_slip_mpa_mm += moment.pressure_mpa * distance_mm;
        self.slip_work
            .add(moment.pressure_mpa, moment.slip_mm, distance_mm);
    }
}

/// The contact history of all nodes of an articulating surface over one cycle.
///
/// It is recorded instant by instant and then sorted by node: the records stay in place, and every node gets a list
/// of the numbers of its records. A history takes a megabyte or more, and allocating that costs more than filling it:
/// clearing keeps the memory.
#[derive(Clone, Debug, Default)]
pub struct CycleHistory {
    /// The expected number of instants.
    expected: usize,
    records: Vec<Record>,
    /// The records of node i are those numbered `sorted[first[i]..first[i + 1]]`.
    first: Vec<usize>,
    sorted: Vec<u32>,
    /// The sums of each node, computed as the records are sorted.
    sums: Vec<NodeSums>,
}

impl CycleHistory {
    /// Removes all records; `expected` is the approximate number of instants to come.
    pub fn clear(&mut self, expected: usize) {
        self.expected = expected;
        self.records.clear();
        self.sorted.clear();
        self.first.clear();
        self.sums.clear();
    }

    /// Records the nodes in contact at an instant, and returns the range of their records, for [`CycleHistory::sort`].
    pub fn record(&mut self, instant: impl Iterator<Item = Record>) -> Range<usize> {
        let start = self.records.len();
        self.records.extend(instant);
        if start == 0 {
            // Growing would copy the records; address space that is never touched costs nothing.
            self.records.reserve(2 * self.expected * self.records.len());
        }
        start..self.records.len()
    }

    /// Sorts the records of the given instants by node, each node's in the order of time. Instants of rejected steps are left
    /// out.
    pub fn sort(&mut self, node_count: usize, instants: &[Range<usize>]) {
        let Self {
            records,
            first,
            sorted,
            sums,
            ..
        } = self;
        sums.clear();
        sums.resize(node_count, NodeSums::default());
        let records = || {
            let counting = instants.iter().flat_map(Range::clone);
            counting.map(|number| (number as u32, &records[number]))
        };
        // A counting sort. Counts are stored two places ahead: filling then moves every node's end to the next one's start.
        first.clear();
        first.resize(node_count + 2, 0);
        for (_, record) in records() {
            first[record.node as usize + 2] += 1;
        }
        for i in 0..=node_count {
            first[i + 1] += first[i];
        }
        // All records counted: the last entry is their number.
        sorted.resize(first[node_count + 1], 0);
        for (number, record) in records() {
            let node = record.node as usize;
            let place = &mut first[node + 1];
            sorted[*place] = number;
            *place += 1;
            sums[node].add(record);
        }
        first.truncate(node_count + 1);
    }

    /// Returns the nodes in contact at an instant, in the order in which they were recorded.
    pub fn instant(&self, at: &Range<usize>) -> &[Record] {
        &self.records[at.clone()]
    }

    /// Returns the number of nodes of the surface.
    pub fn node_count(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// Returns the records of a node, in the order of time.
    pub fn records_of(&self, node: usize) -> impl Iterator<Item = &Record> {
        let own = &self.sorted[self.first[node]..self.first[node + 1]];
        own.iter().map(|&record| &self.records[record as usize])
    }

    /// Returns the instants at which a node was in contact, in the order of time.
    pub fn moments(&self, node: usize) -> impl Iterator<Item = &Moment> {
        self.records_of(node).map(|record| &record.moment)
    }

    /// Returns the sums over those instants.
    pub fn sums(&self, node: usize) -> &NodeSums {
        &self.sums[node]
    }
}

/// A node whose work along and across differs by less than this part of the whole has no principal direction: on a circle
/// the difference is rounding.
const ISOTROPIC: f64 = 1e-6;

/// Shorter than any slip but that of length 0, mm.
const MIN_MM: f64 = 1e-200;

/// Pressure times slip of a node by direction: the sum of $p |\Delta s| \thinspace t t^T$ over the instants of a
/// cycle, $t$ the direction of the slip, MPa mm.
///
/// The part along a direction $d$ is $d^T T d$, the sum of $p |\Delta s| \cos^2$ of the angle between. The principal
/// direction is the $d$ with the largest part: the molecules of the surface align with it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlipWork {
    anterior: f64,
    mixed: f64,
    lateral: f64,
}

impl SlipWork {
    /// Adds a slip under a pressure; `distance_mm` is its length.
    #[inline(always)]
    pub fn add(&mut self, pressure_mpa: f64, slip_mm: [f64; 2], distance_mm: f64) {
        let [anterior, lateral] = slip_mm;
        // A slip of length 0 has components of 0; the bound only keeps the quotient finite.
        let per_mm = pressure_mpa / distance_mm.max(MIN_MM);
        self.anterior += per_mm * anterior * anterior;
        self.mixed += per_mm * anterior * lateral;
        self.lateral += per_mm * lateral * lateral;
    }

    /// Adds a part of another.
    pub(crate) fn add_part(&mut self, part: f64, other: &Self) {
        self.anterior += part * other.anterior;
        self.mixed += part * other.mixed;
        self.lateral += part * other.lateral;
    }

    /// Returns the sum over all directions, sum of p |ds|, MPa mm.
    pub(crate) fn total_mpa_mm(&self) -> f64 {
        self.anterior + self.lateral
    }

    /// Returns the part along the principal direction, MPa mm.
    pub(crate) fn along_mpa_mm(&self) -> f64 {
        self.total_mpa_mm() - self.across_mpa_mm()
    }

    /// Returns the part across the principal direction, MPa mm.
    pub(crate) fn across_mpa_mm(&self) -> f64 {
        (0.5 * self.total_mpa_mm() - self.half_difference()).max(0.0)
    }

    /// Returns the cross-shear ratio: the part across over the sum, 0 for a straight path to 0.5 for a circle; 0 without slip.
    pub fn cross_shear(&self) -> f64 {
        let total = self.total_mpa_mm();
        if total > 0.0 {
            self.across_mpa_mm() / total
        } else {
            0.0
        }
    }

    /// Returns the principal direction, a unit vector: anterior along the surface, then lateral, the first not negative. None
    /// without slip, or if the work is the same in every direction.
    pub fn principal_direction(&self) -> Option<[f64; 2]> {
        if self.half_difference() <= 0.5 * ISOTROPIC * self.total_mpa_mm() {
            return None;
        }
        let angle = 0.5 * (2.0 * self.mixed).atan2(self.anterior - self.lateral);
        let (sine, cosine) = angle.sin_cos();
        Some([cosine, sine])
    }

    /// Returns half the difference of the eigenvalues.
    fn half_difference(&self) -> f64 {
        // Not the discriminant of the characteristic polynomial: this form does not cancel.
        let skew = 0.5 * (self.anterior - self.lateral);
        (skew * skew + self.mixed * self.mixed).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn records_are_sorted_by_node_and_keep_their_order_in_time() {
        let moment = |pressure_mpa| Moment {
            pressure_mpa,
            slip_mm: [1.0, 0.0],
        };
        let at = |node, pressure_mpa| Record {
            node,
            pressed_mm2: 0.25,
            moment: moment(pressure_mpa),
        };
        let mut history = CycleHistory::default();
        let late = history.record([at(2, 3.0)].into_iter());
        let forgotten = history.record([at(1, 9.0)].into_iter());
        let early = history.record([at(2, 1.0), at(0, 1.0)].into_iter());
        history.sort(3, &[early, late]);
        assert_eq!(history.node_count(), 3);
        let moments = |history: &CycleHistory, node| -> Vec<Moment> {
            history.moments(node).copied().collect()
        };
        assert_eq!(moments(&history, 2), [moment(1.0), moment(3.0)]);
        assert!(moments(&history, 1).is_empty() && !forgotten.is_empty());
        assert_eq!(history.sums(2).peak_pressure_mpa, 3.0);
        assert_eq!(history.sums(2).summed_pressure_mpa, 4.0);
        assert_eq!(history.sums(2).sliding_distance_mm, 2.0);
        assert_eq!(history.sums(2).pressed_area_slip_mm3, 0.5);

        history.clear(1);
        let only = history.record([at(1, 2.0)].into_iter());
        history.sort(2, &[only]);
        assert_eq!(history.node_count(), 2);
        assert!(moments(&history, 0).is_empty());
        assert_eq!(moments(&history, 1), [moment(2.0)]);
    }

    /// Of a path under 2 MPa, given by its corners, turned by `turn` rad.
    fn of_path(corners: &[[f64; 2]], turn: f64) -> SlipWork {
        let (sine, cosine) = turn.sin_cos();
        let mut work = SlipWork::default();
        for pair in corners.windows(2) {
            let (x, z) = (pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
            let slip_mm = [cosine * x - sine * z, sine * x + cosine * z];
            work.add(2.0, slip_mm, slip_mm[0].hypot(slip_mm[1]));
        }
        work
    }

    fn curve(place: impl Fn(f64) -> [f64; 2]) -> Vec<[f64; 2]> {
        const PARTS: usize = 20_000;
        let at = |part| place(TAU * part as f64 / PARTS as f64);
        (0..=PARTS).map(at).collect()
    }

    fn rectangle(width: f64, depth: f64) -> [[f64; 2]; 5] {
        [
            [0.0; 2],
            [width, 0.0],
            [width, depth],
            [0.0, depth],
            [0.0; 2],
        ]
    }

    fn near(found: f64, exact: f64, within: f64) {
        assert!((found - exact).abs() <= within, "{found} for {exact}");
    }

    #[test]
    fn verify_cross_shear_of_paths_with_closed_forms_however_they_lie() {
        let straight = [[-3.0, -1.0], [3.0, 1.0], [-3.0, -1.0]];
        let circle = curve(|t| [5.0 * t.cos(), 5.0 * t.sin()]);
        for turn in [0.0, 0.3, 1.2, 2.9, -0.7] {
            near(of_path(&straight, turn).cross_shear(), 0.0, 1e-14);
            near(of_path(&circle, turn).cross_shear(), 0.5, 1e-9);
            near(
                of_path(&rectangle(4.0, 4.0), turn).cross_shear(),
                0.5,
                1e-14,
            );
            near(
                of_path(&rectangle(9.0, 1.0), turn).cross_shear(),
                0.1,
                1e-14,
            );
            near(
                of_path(&rectangle(1.0, 3.0), turn).cross_shear(),
                0.25,
                1e-14,
            );
        }
    }

    #[test]
    fn verify_cross_shear_of_an_even_spread_of_directions() {
        // Steps of one length to all angles within a: (1 - sin 2a / 2a) / 2 is across the middle.
        for spread in [0.1, 0.5, 1.0, PI / 2.0] {
            const PARTS: usize = 4000;
            let mut work = SlipWork::default();
            for part in 0..PARTS {
                let angle = spread * ((2 * part + 1) as f64 / PARTS as f64 - 1.0);
                work.add(1.0, [angle.cos(), angle.sin()], 1.0);
            }
            let exact = 0.5 * (1.0 - (2.0 * spread).sin() / (2.0 * spread));
            near(work.cross_shear(), exact, 1e-6);
        }
    }

    #[test]
    fn verify_cross_shear_of_a_figure_of_eight() {
        // Gerono's: x = sin t, z = sin t cos t. Its own sums, by Simpson's rule on the derivative.
        let eight = curve(|t| [3.0 * t.sin(), 3.0 * t.sin() * t.cos()]);
        const PARTS: usize = 2000;
        let (mut along, mut across) = (0.0, 0.0);
        for part in 0..=PARTS {
            let t = TAU * part as f64 / PARTS as f64;
            let weight = [1.0, 4.0, 2.0][if part % PARTS == 0 { 0 } else { 2 - part % 2 }];
            let (x, z) = (t.cos(), (2.0 * t).cos());
            along += weight * x * x / x.hypot(z).max(1e-300);
            across += weight * z * z / x.hypot(z).max(1e-300);
        }
        let exact = along.min(across) / (along + across);
        for turn in [0.0, 0.8, 2.0] {
            near(of_path(&eight, turn).cross_shear(), exact, 1e-6);
        }
    }

    #[test]
    fn verify_the_principal_direction_to_a_hundredth_of_a_degree() {
        for degrees in [-89.0f64, -45.0, -0.02, 0.0, 12.34, 45.0, 77.7, 90.0] {
            let work = of_path(&rectangle(6.0, 4.0), degrees.to_radians());
            let [anterior, lateral] = work.principal_direction().unwrap();
            let off = lateral.atan2(anterior).to_degrees() - degrees;
            near((off + 90.0).rem_euclid(180.0), 90.0, 1e-9);
            near(anterior.hypot(lateral), 1.0, 1e-15);
            assert!(anterior >= 0.0);
        }
    }

    #[test]
    fn the_principal_direction_has_the_most_work_of_all() {
        let bent = [[0.0, 0.0], [5.0, 1.0], [6.0, 4.0], [2.0, 3.0], [0.0, 0.0]];
        let work = of_path(&bent, 0.0);
        let along = |[x, z]: [f64; 2]| {
            x * x * work.anterior + 2.0 * x * z * work.mixed + z * z * work.lateral
        };
        let most = along(work.principal_direction().unwrap());
        near(most, work.along_mpa_mm(), 1e-12);
        for degree in 0..180 {
            let (sine, cosine) = f64::from(degree).to_radians().sin_cos();
            assert!(along([cosine, sine]) <= most + 1e-12);
        }
    }

    #[test]
    fn nothing_and_a_circle_have_no_direction() {
        assert_eq!(SlipWork::default().principal_direction(), None);
        assert_eq!(SlipWork::default().cross_shear(), 0.0);
        let circle = curve(|t| [t.cos(), t.sin()]);
        assert_eq!(of_path(&circle, 0.4).principal_direction(), None);
        let still = of_path(&[[1.0, 2.0], [1.0, 2.0]], 0.0);
        assert_eq!(still, SlipWork::default());
        let mut stuck = SlipWork::default();
        stuck.add(1e3, [0.0; 2], 0.0);
        assert_eq!(stuck, SlipWork::default());
    }
}
