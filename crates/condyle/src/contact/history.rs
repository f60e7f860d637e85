//! What the articulating surface went through in one cycle.

/// One instant of contact at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Place in the cycle, %.
    pub percent: f64,
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

/// All instants at which one node was in contact, in the order of time.
#[derive(Clone, Copy, Debug)]
pub struct NodeHistory<'a> {
    /// The instants; none where the node was never touched.
    pub moments: &'a [Moment],
}

/// The contact history of all nodes of an articulating surface over one cycle.
#[derive(Clone, Debug, Default)]
pub struct CycleHistory {
    /// Moments of node i are `moments[first[i]..first[i + 1]]`.
    first: Vec<usize>,
    moments: Vec<Moment>,
}

impl CycleHistory {
    /// Sorts `records` of (node, moment), given in the order of time, by their nodes.
    pub fn from_records<'a>(
        node_count: usize,
        records: impl Iterator<Item = &'a (u32, Moment)> + Clone,
    ) -> Self {
        let mut first = vec![0; node_count + 1];
        for (node, _) in records.clone() {
            first[*node as usize + 1] += 1;
        }
        for i in 0..node_count {
            first[i + 1] += first[i];
        }
        let nowhere = Moment {
            percent: 0.0,
            pressure_mpa: 0.0,
            slip_mm: [0.0; 2],
        };
        let mut moments = vec![nowhere; first[node_count]];
        let mut next = first.clone();
        for (node, moment) in records {
            let place = &mut next[*node as usize];
            moments[*place] = *moment;
            *place += 1;
        }
        Self { first, moments }
    }

    /// How many nodes the surface has.
    pub fn node_count(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// The history of node `node` of the articulating surface.
    pub fn node(&self, node: usize) -> NodeHistory<'_> {
        NodeHistory {
            moments: &self.moments[self.first[node]..self.first[node + 1]],
        }
    }
}

impl NodeHistory<'_> {
    /// Highest mean pressure on the node's share in the cycle, MPa.
    pub fn peak_pressure_mpa(&self) -> f64 {
        self.moments
            .iter()
            .map(|moment| moment.pressure_mpa)
            .fold(0.0, f64::max)
    }

    /// Distance slid under pressure, mm.
    pub fn sliding_distance_mm(&self) -> f64 {
        self.moments.iter().map(Moment::distance_mm).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_sorted_by_node_and_keep_their_order_in_time() {
        let moment = |percent| Moment {
            percent,
            pressure_mpa: percent,
            slip_mm: [1.0, 0.0],
        };
        let records = [(2, moment(1.0)), (0, moment(1.0)), (2, moment(3.0))];
        let history = CycleHistory::from_records(3, records.iter());
        assert_eq!(history.node_count(), 3);
        assert_eq!(history.node(2).moments, [moment(1.0), moment(3.0)]);
        assert!(history.node(1).moments.is_empty());
        assert_eq!(history.node(2).peak_pressure_mpa(), 3.0);
        assert_eq!(history.node(2).sliding_distance_mm(), 2.0);
    }
}
