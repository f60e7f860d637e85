//! What the articulating surface went through in one cycle.

use std::ops::Range;

use super::SlipWork;

/// One instant of contact at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Mean pressure on the node's share of the surface, MPa.
    pub pressure_mpa: f64,
    /// Slip of the femur past the insert that this instant stands for, mm, in the surface's own
    /// directions: anterior along the surface, then lateral.
    pub slip_mm: [f64; 2],
}

impl Moment {
    /// Distance slid, mm.
    #[inline]
    pub fn distance_mm(&self) -> f64 {
        let [anterior, lateral] = self.slip_mm;
        (anterior * anterior + lateral * lateral).sqrt()
    }
}

/// An instant of contact as it is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// The node of the articulating surface.
    pub node: u32,
    /// Area of the node's share that presses, mm2; in 32 bits it takes no room of its own.
    pub pressed_mm2: f32,
    /// What the node feels.
    pub moment: Moment,
}

/// All instants at which one node was in contact, and their sums.
#[derive(Clone, Copy, Debug)]
pub struct NodeHistory<'a> {
    records: &'a [Record],
    /// Which of them are the node's, in the order of time.
    own: &'a [u32],
    /// Highest mean pressure on the node's share in the cycle, MPa.
    pub peak_pressure_mpa: f64,
    /// Sum of the mean pressure on the node's share over the instants, MPa.
    pub summed_pressure_mpa: f64,
    /// Distance slid while any of the node's share presses, sum of |ds|, mm.
    pub sliding_distance_mm: f64,
    /// Area that presses times distance slid, sum of A' |ds|, mm3. Over the area of the share it is how
    /// far a place of the share slides under pressure, on the mean.
    pub pressed_area_slip_mm3: f64,
    /// Pressure times slip, sum of p |ds|, MPa mm.
    pub pressure_slip_mpa_mm: f64,
    /// The same by direction.
    pub slip_work: SlipWork,
}

/// What a node's moments come to.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    peak_pressure_mpa: f64,
    summed_pressure_mpa: f64,
    sliding_distance_mm: f64,
    pressed_area_slip_mm3: f64,
    pressure_slip_mpa_mm: f64,
    slip_work: SlipWork,
}

impl Sums {
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

impl<'a> NodeHistory<'a> {
    /// The instants in the order of time; none where the node was never touched.
    pub fn moments(&self) -> impl Iterator<Item = &'a Moment> + use<'a> {
        let records = self.records;
        self.own
            .iter()
            .map(|&record| &records[record as usize].moment)
    }
}

/// The contact history of all nodes of an articulating surface over one cycle.
///
/// It is recorded instant by instant, and then sorted by node: moments stay where they are, and
/// every node knows which are its own. A history takes a megabyte or more, and new memory costs more
/// than to fill it: one that is cleared keeps its own.
#[derive(Clone, Debug, Default)]
pub struct CycleHistory {
    /// How many instants will likely be recorded.
    expected: usize,
    /// As they were recorded.
    records: Vec<Record>,
    /// Records of node i are those numbered `sorted[first[i]..first[i + 1]]`.
    first: Vec<usize>,
    sorted: Vec<u32>,
    /// One a node: made as the records are sorted, when they are at hand.
    sums: Vec<Sums>,
}

impl CycleHistory {
    /// Nothing happened yet; about so many instants are to come.
    pub fn clear(&mut self, expected: usize) {
        self.expected = expected;
        self.records.clear();
        self.sorted.clear();
        self.first.clear();
        self.sums.clear();
    }

    /// Records an instant: the nodes in contact then. Where it is kept, for
    /// [`CycleHistory::sort`].
    pub fn record(&mut self, instant: impl Iterator<Item = Record>) -> Range<usize> {
        let start = self.records.len();
        self.records.extend(instant);
        if start == 0 {
            // To grow would be to copy, and room that is never used costs nothing.
            self.records.reserve(2 * self.expected * self.records.len());
        }
        start..self.records.len()
    }

    /// Sorts what was recorded by node; of all instants those that count, in the order of time.
    pub fn sort(&mut self, node_count: usize, instants: &[Range<usize>]) {
        let Self {
            records,
            first,
            sorted,
            sums,
            ..
        } = self;
        sums.clear();
        sums.resize(node_count, Sums::default());
        let records = || {
            let counting = instants.iter().flat_map(Range::clone);
            counting.map(|number| (number as u32, &records[number]))
        };
        // Counted two places on: filling then moves every node's end on to where the next begins.
        first.clear();
        first.resize(node_count + 2, 0);
        for (_, record) in records() {
            first[record.node as usize + 2] += 1;
        }
        for i in 0..=node_count {
            first[i + 1] += first[i];
        }
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

    /// The nodes in contact at one instant, as [`CycleHistory::record`] kept them.
    pub fn instant(&self, at: &Range<usize>) -> &[Record] {
        &self.records[at.clone()]
    }

    /// How many nodes the surface has.
    pub fn node_count(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// The history of node `node` of the articulating surface.
    pub fn node(&self, node: usize) -> NodeHistory<'_> {
        let Sums {
            peak_pressure_mpa,
            summed_pressure_mpa,
            sliding_distance_mm,
            pressed_area_slip_mm3,
            pressure_slip_mpa_mm,
            slip_work,
        } = self.sums[node];
        NodeHistory {
            records: &self.records,
            own: &self.sorted[self.first[node]..self.first[node + 1]],
            peak_pressure_mpa,
            summed_pressure_mpa,
            sliding_distance_mm,
            pressed_area_slip_mm3,
            pressure_slip_mpa_mm,
            slip_work,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            history.node(node).moments().copied().collect()
        };
        assert_eq!(moments(&history, 2), [moment(1.0), moment(3.0)]);
        assert!(moments(&history, 1).is_empty() && !forgotten.is_empty());
        assert_eq!(history.node(2).peak_pressure_mpa, 3.0);
        assert_eq!(history.node(2).summed_pressure_mpa, 4.0);
        assert_eq!(history.node(2).sliding_distance_mm, 2.0);
        assert_eq!(history.node(2).pressed_area_slip_mm3, 0.5);

        history.clear(1);
        let only = history.record([at(1, 2.0)].into_iter());
        history.sort(2, &[only]);
        assert_eq!(history.node_count(), 2);
        assert!(moments(&history, 0).is_empty());
        assert_eq!(moments(&history, 1), [moment(2.0)]);
    }
}
