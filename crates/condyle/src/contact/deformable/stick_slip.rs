//! Stick, slip and the loads along a surface: Coulomb's law on an elastic body.

use super::{
    cholesky::{Cholesky, Eight, ROWS, get, product, set, subtract, zero},
    compliance::{NearMatrix, along_surface},
};

/// Numbers along the two directions of a surface.
pub(crate) type Pair = [f64; 2];

/// Loads are found once a sweep changes none by more than this, N.
const FOUND_N: f64 = 1e-7;
/// A load is at its limit from this part of it on.
const AT_LIMIT: f64 = 1.0 - 1e-9;
/// Limits below this are none, N.
const MIN_LIMIT_N: f64 = 1e-12;
/// If a load is to change by more than this part of its limit, a sweep goes before a step of Newton's method, which would
/// begin with the wrong nodes sticking.
const FAR: f64 = 0.5;
/// If no more than one in so many nodes has changed, only their contributions are recomputed.
const FEW: usize = 8;
/// A step of Newton's method counts if it leaves at most this part.
const LEAPS: f64 = 0.5;
/// Sweeps after a step of Newton's method that did not count.
const SWEEPS_BETWEEN: u32 = 3;
/// Steps after which what is left is round-off.
const MAX_STEPS: u32 = 500;

/// The loads along a surface under a femur that moves past it.
///
/// The node i that presses may carry a load T_i along the surface up to its limit g_i = mu F_i. Its place there has
/// moved past the femur, but for what the surface deflects, by b_i, and deflects by the compliance C along the surface:
/// it slips by s_i = b_i - sum_j C_ij T_j. It sticks, or slides the way its load points,
///
/// $$ s_i = 0, \enspace |T_i| \le g_i \qquad \text{or} \qquad s_i = \lambda_i T_i, \enspace \lambda_i > 0, \enspace |T_i| = g_i , $$
///
/// which is the least of T' C T / 2 - b' T with |T_i| <= g_i: C is positive definite, so there is one. It is found by
/// sweeps from node to node, each to its own least, which lead there from everywhere; and by steps of Newton's
/// method, which are quick in the end: the nodes that stick are free in them, the others turn on their circles.
#[derive(Default)]
pub(crate) struct StickSlip {
    /// The nodes, in an order that is always the same, and each with its place there, ascending.
    nodes: Vec<u32>,
    places: Vec<(u32, usize)>,
    /// The rows of the compliance of every node that presses, and the places of its loads among `by_panel`.
    rows: Vec<[u32; 2]>,
    slots: Vec<[usize; 2]>,
    limits_n: Vec<f64>,
    reach_mm: Vec<Pair>,
    loads_n: Vec<Pair>,
    /// The smallest stiffness of a node against its own load, N/mm.
    stiffness_n_per_mm: Vec<f64>,
    /// The loads by the panels of the compliance.
    by_panel: Vec<(usize, Eight)>,
    /// The slip of each node under the loads.
    slips_mm: Vec<Pair>,
}

/// A node that may carry a load along the surface.
#[derive(Clone, Copy)]
pub(crate) struct Rubbed {
    pub node: u32,
    /// Its limit g, N.
    pub limit_n: f64,
    /// The motion of its place past the femur since it carried nothing, b, mm.
    pub reach_mm: Pair,
    /// The load to begin with, N.
    pub load_n: Pair,
}

/// A load that may change: that of a node, along one direction.
struct Freedom {
    node: usize,
    along: Pair,
    /// Beside the compliance, mm/N: what a load on a circle is turned against.
    more: f64,
}

impl StickSlip {
    /// The loads on nodes, in an order that is always the same.
    pub fn solve(&mut self, rubbed: &[Rubbed], compliance: &NearMatrix) {
        self.take(rubbed, compliance);
        self.approach(compliance);
        // What slides has its limit to the last digit.
        for place in 0..self.rows.len() {
            self.load(place, self.better_n(place, self.slips_mm[place]));
        }
    }

    /// Goes to the loads until what is left is small.
    fn approach(&mut self, compliance: &NearMatrix) {
        let mut left_n = self.left_n();
        for _ in 0..MAX_STEPS {
            if left_n <= FOUND_N {
                return;
            }
            if self.change_what_is_far(compliance) {
                left_n = self.left_n();
            }
            let before = (self.loads_n.clone(), self.slips_mm.clone());
            self.leap(compliance);
            let now_n = self.left_n();
            if now_n <= LEAPS * left_n {
                left_n = now_n;
                continue;
            }
            let (loads_n, slips_mm) = before;
            (0..loads_n.len()).for_each(|place| self.load(place, loads_n[place]));
            self.slips_mm = slips_mm;
            (0..SWEEPS_BETWEEN).for_each(|_| self.sweep(compliance));
            self.find_slips(compliance);
            left_n = self.left_n();
        }
    }

    /// The loads on the nodes, N.
    pub fn loads_n(&self) -> &[Pair] {
        &self.loads_n
    }

    /// Returns whether a node sticks.
    pub fn sticks(&self, place: usize) -> bool {
        length(self.loads_n[place]) < AT_LIMIT * self.limits_n[place]
    }

    /// Takes the loads along with a short motion of the femur, by their derivatives, to other limits and reaches.
    pub fn take_along(&mut self, rubbed: &[Rubbed], changes_n: &[Pair], compliance: &NearMatrix) {
        for (place, (rubbed, change_n)) in rubbed.iter().zip(changes_n).enumerate() {
            let slides = self.slides(place);
            self.reach_mm[place] = rubbed.reach_mm;
            self.limits_n[place] = rubbed.limit_n;
            let load_n = [0, 1].map(|k| self.loads_n[place][k] + change_n[k]);
            let load_n = if slides {
                to_length(load_n, rubbed.limit_n)
            } else {
                within(load_n, rubbed.limit_n)
            };
            self.load(place, load_n);
        }
        self.find_slips(compliance);
    }

    /// Returns the displacement of a node along the surface by the loads, mm.
    pub fn moved_mm(&self, place: usize) -> Pair {
        [0, 1].map(|k| self.reach_mm[place][k] - self.slips_mm[place][k])
    }

    /// Takes nodes, with the loads that were found for them before, which may be beyond the new limits.
    fn take(&mut self, rubbed: &[Rubbed], compliance: &NearMatrix) {
        let before = std::mem::take(self);
        self.nodes = rubbed.iter().map(|rubbed| rubbed.node).collect();
        self.places = self.nodes.iter().copied().zip(0..).collect();
        self.places.sort_unstable();
        let rows = |node: &u32| along_surface(*node).map(|load| compliance.row(load));
        self.rows = self.nodes.iter().map(rows).collect();
        self.limits_n = rubbed.iter().map(|rubbed| rubbed.limit_n).collect();
        self.reach_mm = rubbed.iter().map(|rubbed| rubbed.reach_mm).collect();
        let stiffness = |&[a, b]: &[u32; 2]| {
            let [aa, ab, bb] = [(a, a), (a, b), (b, b)].map(|(i, j)| compliance.at(i, j));
            2.0 / (aa + bb + (aa - bb).hypot(2.0 * ab))
        };
        self.stiffness_n_per_mm = self.rows.iter().map(stiffness).collect();
        self.find_slots(compliance);
        self.loads_n = vec![[0.0; 2]; rubbed.len()];
        for (place, rubbed) in rubbed.iter().enumerate() {
            self.load(place, rubbed.load_n);
        }
        self.go_on_from(&before, compliance);
    }

    /// Finds slips from how far the loads of before moved the nodes.
    fn go_on_from(&mut self, before: &Self, compliance: &NearMatrix) {
        let stays = |(place, node): (usize, &u32)| {
            let was = before.place_of(*node)?;
            (before.loads_n[was] == self.loads_n[place]).then_some(was)
        };
        let stays: Vec<Option<usize>> = self.nodes.iter().enumerate().map(stays).collect();
        let others = before.nodes.iter().enumerate();
        let others = others.filter(|(_, node)| {
            self.place_of(**node)
                .is_none_or(|place| stays[place].is_none())
        });
        let gone: Vec<([u32; 2], Pair)> = others
            .map(|(was, _)| (before.rows[was], before.loads_n[was]))
            .collect();
        let changed = |place: usize| stays[place].is_none() && self.loads_n[place] != [0.0; 2];
        let has_changed = (0..stays.len()).any(changed);
        if has_changed || gone.len() > self.nodes.len() / FEW {
            self.find_slips(compliance);
            return;
        }
        let slip = |(place, was): (usize, &Option<usize>)| {
            let Some(was) = *was else {
                return self.slip_mm(place, compliance);
            };
            let moved_mm = before.moved_mm(was);
            let back_mm = moved_by(&gone, self.rows[place], compliance);
            [0, 1].map(|k| self.reach_mm[place][k] - (moved_mm[k] - back_mm[k]))
        };
        self.slips_mm = stays.iter().enumerate().map(slip).collect();
    }

    fn place_of(&self, node: u32) -> Option<usize> {
        let found = self.places.binary_search_by_key(&node, |(node, _)| *node);
        found.ok().map(|found| self.places[found].1)
    }

    /// Finds the panels of the nodes, and where in them each is.
    fn find_slots(&mut self, compliance: &NearMatrix) {
        let loads = self.nodes.iter().flat_map(|&node| along_surface(node));
        let mut places: Vec<(u32, usize)> = loads
            .map(|load| (compliance.place(load), compliance.row(load) as usize / ROWS))
            .collect();
        places.sort_unstable();
        for (_, panel) in places {
            if self.by_panel.last().is_none_or(|(last, _)| *last != panel) {
                self.by_panel.push((panel, zero()));
            }
        }
        let mut at: Vec<(usize, usize)> = self
            .by_panel
            .iter()
            .map(|(panel, _)| *panel)
            .zip(0..)
            .collect();
        at.sort_unstable();
        let slot = |row: u32| {
            let (panel, side) = (row as usize / ROWS, row as usize % ROWS);
            let found = at.binary_search_by_key(&panel, |(panel, _)| *panel);
            found.map_or(0, |found| ROWS * at[found].1 + side)
        };
        self.slots = self.rows.iter().map(|rows| rows.map(slot)).collect();
    }

    /// Puts a load on a node.
    fn load(&mut self, place: usize, load_n: Pair) {
        self.loads_n[place] = load_n;
        for (slot, load_n) in self.slots[place].into_iter().zip(load_n) {
            set(&mut self.by_panel[slot / ROWS].1, slot % ROWS, load_n);
        }
    }

    /// Returns the slip of a node under the present loads, mm.
    fn slip_mm(&self, place: usize, compliance: &NearMatrix) -> Pair {
        let moved = self.rows[place].map(|row| compliance.moved(row, &self.by_panel));
        [0, 1].map(|k| self.reach_mm[place][k] - moved[k])
    }

    fn find_slips(&mut self, compliance: &NearMatrix) {
        let places = 0..self.rows.len();
        self.slips_mm = places
            .map(|place| self.slip_mm(place, compliance))
            .collect();
    }

    /// A better load on a node that slips, if the others stay.
    fn better_n(&self, place: usize, slip_mm: Pair) -> Pair {
        within(self.unlimited_n(place, slip_mm), self.limits_n[place])
    }

    /// The same without its limit.
    fn unlimited_n(&self, place: usize, slip_mm: Pair) -> Pair {
        let (load_n, stiffness) = (self.loads_n[place], self.stiffness_n_per_mm[place]);
        [0, 1].map(|k| load_n[k] + stiffness * slip_mm[k])
    }

    /// By how much a load is off a better one, N.
    fn off_n(&self, place: usize) -> f64 {
        let better_n = self.better_n(place, self.slips_mm[place]);
        length([0, 1].map(|k| better_n[k] - self.loads_n[place][k]))
    }

    fn left_n(&self) -> f64 {
        let places = 0..self.rows.len();
        places.map(|place| self.off_n(place)).fold(0.0, f64::max)
    }

    /// Puts better loads on the nodes whose loads are far off, as of those that have just begun to press; whether there are
    /// such.
    fn change_what_is_far(&mut self, compliance: &NearMatrix) -> bool {
        let is_far = |&place: &usize| self.off_n(place) > FAR * self.limits_n[place];
        let far: Vec<usize> = (0..self.rows.len()).filter(is_far).collect();
        if far.len() > self.rows.len() / FEW {
            self.sweep(compliance);
            self.find_slips(compliance);
            return true;
        }
        let mut changes = Vec::with_capacity(far.len());
        for &place in &far {
            let (before, better) = (
                self.loads_n[place],
                self.better_n(place, self.slips_mm[place]),
            );
            changes.push((self.rows[place], [0, 1].map(|k| better[k] - before[k])));
            self.load(place, better);
        }
        for (slip_mm, rows) in self.slips_mm.iter_mut().zip(&self.rows) {
            let moved_mm = moved_by(&changes, *rows, compliance);
            *slip_mm = [0, 1].map(|k| slip_mm[k] - moved_mm[k]);
        }
        !far.is_empty()
    }

    /// Goes from node to node, each to a better load.
    fn sweep(&mut self, compliance: &NearMatrix) {
        for place in 0..self.rows.len() {
            let slip_mm = self.slip_mm(place, compliance);
            self.load(place, self.better_n(place, slip_mm));
        }
    }

    /// A step of Newton's method for the loads that may change, those that slide put to their limits first.
    fn leap(&mut self, compliance: &NearMatrix) {
        let freedoms = self.freedoms();
        let slides: Vec<bool> = (0..self.rows.len())
            .map(|place| self.slides(place))
            .collect();
        let mut loads_n = self.loads_n.clone();
        let mut by_slot = vec![0.0; self.width()];
        for (place, load_n) in loads_n.iter_mut().enumerate() {
            if slides[place] {
                *load_n = to_length(*load_n, self.limits_n[place]);
                for (k, slot) in self.slots[place].iter().enumerate() {
                    by_slot[*slot] = load_n[k] - self.loads_n[place][k];
                }
            }
        }
        let mut sides = vec![zero(); freedoms.len()];
        let factor = self.factor(&freedoms, compliance, |row, line| {
            let (freedom, moved_mm) = (&freedoms[row], product(line, &by_slot));
            let slip_mm = dot(freedom.along, self.slips_mm[freedom.node]);
            set(&mut sides[row], 0, slip_mm - moved_mm);
        });
        sides.resize(factor.rows(), zero());
        factor.forward(&mut sides);
        factor.backward(&mut sides);
        for (freedom, side) in freedoms.iter().zip(&sides) {
            let (more_n, load_n) = (get(side, 0), &mut loads_n[freedom.node]);
            *load_n = [0, 1].map(|k| load_n[k] + more_n * freedom.along[k]);
        }
        for (place, load_n) in loads_n.into_iter().enumerate() {
            let limit_n = self.limits_n[place];
            let load_n = if slides[place] {
                to_length(load_n, limit_n)
            } else {
                within(load_n, limit_n)
            };
            self.load(place, load_n);
        }
        self.find_slips(compliance);
    }

    /// Derivatives of the loads by six motions, from those of reach and limit.
    pub fn by_motion(&self, changes: &[ByMotion], compliance: &NearMatrix) -> Vec<[Eight; 2]> {
        let freedoms = self.freedoms();
        let mut loads = self.loads_by_limit(changes);
        let mut by_slot = vec![zero(); self.width()];
        for (slots, loads) in self.slots.iter().zip(&loads) {
            for (slot, load) in slots.iter().zip(loads) {
                by_slot[*slot] = *load;
            }
        }
        let mut sides = vec![zero(); freedoms.len()];
        let factor = self.factor(&freedoms, compliance, |row, line| {
            let (side, freedom) = (&mut sides[row], &freedoms[row]);
            for (reach, along) in changes[freedom.node].reach_mm.iter().zip(freedom.along) {
                subtract(side, reach, -along);
            }
            for (load, moved) in by_slot.iter().zip(line) {
                subtract(side, load, *moved);
            }
        });
        sides.resize(factor.rows(), zero());
        factor.forward(&mut sides);
        factor.backward(&mut sides);
        for (freedom, side) in freedoms.iter().zip(&sides) {
            for (load, along) in loads[freedom.node].iter_mut().zip(freedom.along) {
                subtract(load, side, -along);
            }
        }
        loads
    }

    /// Returns the derivatives of the loads of sliding nodes through their limits.
    fn loads_by_limit(&self, changes: &[ByMotion]) -> Vec<[Eight; 2]> {
        let of_node = |(place, change): (usize, &ByMotion)| {
            let slides = self.slides(place);
            let part = if slides {
                1.0 / self.limits_n[place]
            } else {
                0.0
            };
            self.loads_n[place].map(|load_n| times(&change.limit_n, part * load_n))
        };
        changes.iter().enumerate().map(of_node).collect()
    }

    /// Numbers of a line: those of the panels.
    fn width(&self) -> usize {
        ROWS * self.by_panel.len()
    }

    /// Returns whether a node is taken to slide: a better load for it is one at its limit.
    fn slides(&self, place: usize) -> bool {
        let better = self.unlimited_n(place, self.slips_mm[place]);
        length(better) > self.limits_n[place]
    }

    /// The loads that may change: of a node that slides along its circle, of others any way.
    fn freedoms(&self) -> Vec<Freedom> {
        let mut freedoms = Vec::with_capacity(2 * self.rows.len());
        for (node, &slip_mm) in self.slips_mm.iter().enumerate() {
            let limit_n = self.limits_n[node];
            if limit_n <= MIN_LIMIT_N {
                continue;
            }
            let free = |along, more| Freedom { node, along, more };
            if self.slides(node) {
                let [x, y] = to_length(self.loads_n[node], 1.0);
                let more = (dot(slip_mm, [x, y]) / limit_n).max(0.0);
                freedoms.push(free([-y, x], more));
            } else {
                freedoms.extend([free([1.0, 0.0], 0.0), free([0.0, 1.0], 0.0)]);
            }
        }
        freedoms
    }

    /// The factor of how far loads that may change move each other. `visit` is told of each of them its line: how far every
    /// load of the panels moves its node along it.
    fn factor(
        &self,
        freedoms: &[Freedom],
        compliance: &NearMatrix,
        mut visit: impl FnMut(usize, &[f64]),
    ) -> Cholesky {
        let mut line = Vec::with_capacity(self.width());
        // The rows one after the other, as far as the diagonal.
        let mut entries: Vec<f64> = Vec::with_capacity((freedoms.len() + 1).pow(2) / 2);
        for (row, freedom) in freedoms.iter().enumerate() {
            line.clear();
            let rows = self.rows[freedom.node];
            compliance.mix(rows, freedom.along, &self.by_panel, &mut line);
            visit(row, &line);
            entries.extend(freedoms[..=row].iter().map(|other| {
                let [x, y] = self.slots[other.node];
                line[x] * other.along[0] + line[y] * other.along[1]
            }));
            if let Some(diagonal) = entries.last_mut() {
                *diagonal += freedom.more;
            }
        }
        let mut factor = Cholesky::default();
        let entry = |row: usize, column: usize| entries[row * (row + 1) / 2 + column];
        factor.factor(freedoms.len(), entry);
        factor
    }
}

/// Returns the displacement of a node along the surface by some loads, given by their rows, mm.
fn moved_by(loads: &[([u32; 2], Pair)], rows: [u32; 2], compliance: &NearMatrix) -> Pair {
    let mut moved_mm = [0.0; 2];
    for (columns, load_n) in loads {
        for (moved_mm, row) in moved_mm.iter_mut().zip(rows) {
            *moved_mm += dot(columns.map(|column| compliance.at(row, column)), *load_n);
        }
    }
    moved_mm
}

/// The derivatives of a node's reach and limit by six motions; two of the eight numbers are unused.
#[derive(Clone, Copy)]
pub(crate) struct ByMotion {
    pub reach_mm: [Eight; 2],
    pub limit_n: Eight,
}

/// A load cut to its limit.
fn within(load_n: Pair, limit_n: f64) -> Pair {
    let length_n = length(load_n);
    if length_n > limit_n {
        load_n.map(|part_n| limit_n / length_n * part_n)
    } else {
        load_n
    }
}

/// A load of the same way and that length.
fn to_length(load_n: Pair, length_n: f64) -> Pair {
    let part = length_n / length(load_n).max(f64::MIN_POSITIVE);
    load_n.map(|part_n| part * part_n)
}

fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn length(of: Pair) -> f64 {
    dot(of, of).sqrt()
}

fn times(numbers: &Eight, factor: f64) -> Eight {
    let mut product = zero();
    subtract(&mut product, numbers, -factor);
    product
}
