//! Where a surface that is rubbed sticks and where it slides, and the loads along it: Coulomb's law on an elastic body.

use super::{
    cholesky::{Cholesky, Eight, ROWS, get, set, subtract, zero},
    near_matrix::NearMatrix,
    unit_loads::along_surface,
};

/// Numbers along the two directions of a surface.
pub(super) type Pair = [f64; 2];

/// Loads are found once a sweep changes none by more than this, N.
const FOUND_N: f64 = 1e-7;
/// A load is at its limit from this part of it on.
const AT_LIMIT: f64 = 1.0 - 1e-9;
/// Limits below this are none, N.
const LEAST_LIMIT_N: f64 = 1e-12;
/// Sweeps go on by themselves while each leaves less than this part of the change before.
const QUICK: f64 = 0.25;
/// A step of Newton's method counts if it leaves at most this part.
const LEAPS: f64 = 0.5;
/// Sweeps after a step of Newton's method that did not count, before the next one.
const SWEEPS_BETWEEN: u32 = 10;
/// The motions of the femur: three turns, three shifts.
const MOTIONS: usize = 6;
/// Sweeps after which what is left is round-off.
const MOST_SWEEPS: u32 = 5000;

/// The loads along a surface under a femur that moves past it.
///
/// The node i that presses may carry a load T_i along the surface up to its limit g_i = mu F_i. Its place there has
/// moved past the femur, but for what the surface gives way, by b_i, and gives way by the compliance C along the surface:
/// it slips by s_i = b_i - sum_j C_ij T_j. It sticks, or slides the way its load points,
///
/// $$ s_i = 0, \enspace |T_i| \le g_i \qquad \text{or} \qquad s_i = \lambda_i T_i, \enspace \lambda_i > 0, \enspace |T_i| = g_i , $$
///
/// which is the least of T' C T / 2 - b' T with |T_i| <= g_i: C is positive definite, so there is one. It is found by
/// sweeps from node to node, each to its own least, which lead there from everywhere; and by steps of Newton's
/// method, which are quick in the end: the nodes that stick are free in them, the others turn on their circles.
#[derive(Default)]
pub(super) struct StickSlip {
    /// Of every node that presses the rows of the compliance, and where among `by_panel` its loads are.
    rows: Vec<[u32; 2]>,
    slots: Vec<[usize; 2]>,
    limits_n: Vec<f64>,
    reach_mm: Vec<Pair>,
    loads_n: Vec<Pair>,
    /// How far a load moves its own node at most, N/mm.
    stiffness_n_per_mm: Vec<f64>,
    /// The loads by the panels of the compliance.
    by_panel: Vec<(usize, Eight)>,
}

/// A node that may carry a load along the surface.
#[derive(Clone, Copy)]
pub(super) struct Rubbed {
    pub node: u32,
    /// Its limit g, N.
    pub limit_n: f64,
    /// How far its place has moved past the femur since it carried nothing, b, mm.
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
        let mut left_n = self.sweep(compliance);
        let (mut until_leap, mut is_quick) = (0, false);
        for _ in 0..MOST_SWEEPS {
            if left_n <= FOUND_N {
                return;
            }
            if until_leap == 0 && !is_quick {
                let before_n = self.loads_n.clone();
                self.leap(compliance);
                let now_n = self.sweep(compliance);
                if now_n <= LEAPS * left_n {
                    left_n = now_n;
                    continue;
                }
                (0..before_n.len()).for_each(|i| self.load(i, before_n[i]));
                until_leap = SWEEPS_BETWEEN;
            }
            let now_n = self.sweep(compliance);
            is_quick = now_n <= QUICK * left_n;
            until_leap = until_leap.saturating_sub(1);
            left_n = now_n;
        }
    }

    /// The loads on the nodes, N.
    pub fn loads_n(&self) -> &[Pair] {
        &self.loads_n
    }

    /// Whether a node sticks.
    pub fn sticks(&self, place: usize) -> bool {
        length(self.loads_n[place]) < AT_LIMIT * self.limits_n[place]
    }

    fn take(&mut self, rubbed: &[Rubbed], compliance: &NearMatrix) {
        let rows = |rubbed: &Rubbed| along_surface(rubbed.node).map(|load| compliance.row(load));
        self.rows.clear();
        self.rows.extend(rubbed.iter().map(rows));
        self.limits_n.clear();
        self.limits_n
            .extend(rubbed.iter().map(|rubbed| rubbed.limit_n));
        self.reach_mm.clear();
        self.reach_mm
            .extend(rubbed.iter().map(|rubbed| rubbed.reach_mm));
        let rows = self.rows.iter();
        self.stiffness_n_per_mm = rows
            .map(|&[a, b]| {
                let [aa, ab, bb] = [(a, a), (a, b), (b, b)].map(|(i, j)| compliance.at(i, j));
                2.0 / (aa + bb + (aa - bb).hypot(2.0 * ab))
            })
            .collect();
        self.find_slots(rubbed, compliance);
        self.loads_n.clear();
        self.loads_n.resize(rubbed.len(), [0.0; 2]);
        for (i, rubbed) in rubbed.iter().enumerate() {
            self.load(i, within(rubbed.load_n, rubbed.limit_n));
        }
    }

    /// Finds the panels of the nodes, and where in them each is.
    fn find_slots(&mut self, rubbed: &[Rubbed], compliance: &NearMatrix) {
        let loads = rubbed.iter().flat_map(|rubbed| along_surface(rubbed.node));
        let mut places: Vec<(u32, usize)> = loads
            .map(|load| (compliance.place(load), compliance.row(load) as usize / ROWS))
            .collect();
        places.sort_unstable();
        self.by_panel.clear();
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
        self.slots.clear();
        self.slots
            .extend(self.rows.iter().map(|rows| rows.map(slot)));
    }

    /// Puts a load on a node.
    fn load(&mut self, place: usize, load_n: Pair) {
        self.loads_n[place] = load_n;
        for (slot, load_n) in self.slots[place].into_iter().zip(load_n) {
            set(&mut self.by_panel[slot / ROWS].1, slot % ROWS, load_n);
        }
    }

    /// How far a node slips, mm.
    pub fn slip_mm(&self, place: usize, compliance: &NearMatrix) -> Pair {
        let moved = self.rows[place].map(|row| compliance.moved(row, &self.by_panel));
        [0, 1].map(|k| self.reach_mm[place][k] - moved[k])
    }

    /// Goes from node to node, each to a better load; by how much one changes at most, N.
    fn sweep(&mut self, compliance: &NearMatrix) -> f64 {
        let mut most_n: f64 = 0.0;
        for place in 0..self.rows.len() {
            let (slip, before) = (self.slip_mm(place, compliance), self.loads_n[place]);
            let stiffness = self.stiffness_n_per_mm[place];
            let better = [0, 1].map(|k| before[k] + stiffness * slip[k]);
            let better = within(better, self.limits_n[place]);
            most_n = most_n.max(length([better[0] - before[0], better[1] - before[1]]));
            self.load(place, better);
        }
        most_n
    }

    /// A step of Newton's method for the loads that may change.
    fn leap(&mut self, compliance: &NearMatrix) {
        let slips = self.slips_mm(compliance);
        let freedoms = self.freedoms(&slips);
        let factor = self.factor(&freedoms, compliance);
        let mut sides = vec![zero(); factor.rows()];
        for (side, freedom) in sides.iter_mut().zip(&freedoms) {
            set(side, 0, dot(freedom.along, slips[freedom.node]));
        }
        factor.forward(&mut sides);
        factor.backward(&mut sides);
        let mut loads_n = self.loads_n.clone();
        for (freedom, side) in freedoms.iter().zip(&sides) {
            let (more_n, load_n) = (get(side, 0), &mut loads_n[freedom.node]);
            *load_n = [0, 1].map(|k| load_n[k] + more_n * freedom.along[k]);
        }
        for (place, load_n) in loads_n.into_iter().enumerate() {
            let limit_n = self.limits_n[place];
            let is_beyond = length(load_n) > limit_n || self.slides(place, slips[place]);
            let load_n = if is_beyond {
                load_n.map(|part_n| limit_n / length(load_n) * part_n)
            } else {
                load_n
            };
            self.load(place, load_n);
        }
    }

    /// Derivatives of the loads by six motions, from those of reach and limit.
    pub fn by_motion(&self, changes: &[ByMotion], compliance: &NearMatrix) -> Vec<[Eight; 2]> {
        let slips = self.slips_mm(compliance);
        let freedoms = self.freedoms(&slips);
        let factor = self.factor(&freedoms, compliance);
        // The loads of those that slide grow with their limits.
        let mut loads: Vec<[Eight; 2]> = (0..changes.len())
            .map(|place| {
                let slides = self.slides(place, slips[place]);
                let part = if slides {
                    1.0 / self.limits_n[place]
                } else {
                    0.0
                };
                let limit_n = changes[place].limit_n;
                self.loads_n[place].map(|load_n| times(&limit_n, part * load_n))
            })
            .collect();
        let mut sides = vec![zero(); factor.rows()];
        for (side, freedom) in sides.iter_mut().zip(&freedoms) {
            for (reach, along) in changes[freedom.node].reach_mm.iter().zip(freedom.along) {
                subtract(side, reach, -along);
            }
        }
        for motion in 0..MOTIONS {
            let by_panel = self.with_loads(|place, k| get(&loads[place][k], motion));
            for (side, freedom) in sides.iter_mut().zip(&freedoms) {
                let moved = self.rows[freedom.node].map(|row| compliance.moved(row, &by_panel));
                set(side, motion, get(side, motion) - dot(freedom.along, moved));
            }
        }
        factor.forward(&mut sides);
        factor.backward(&mut sides);
        for (freedom, side) in freedoms.iter().zip(&sides) {
            for (load, along) in loads[freedom.node].iter_mut().zip(freedom.along) {
                subtract(load, side, -along);
            }
        }
        loads
    }

    fn slips_mm(&self, compliance: &NearMatrix) -> Vec<Pair> {
        let places = 0..self.rows.len();
        places
            .map(|place| self.slip_mm(place, compliance))
            .collect()
    }

    /// Other loads on the nodes, by the panels of the compliance.
    fn with_loads(&self, load: impl Fn(usize, usize) -> f64) -> Vec<(usize, Eight)> {
        let mut by_panel = self.by_panel.clone();
        for (place, slots) in self.slots.iter().enumerate() {
            for (k, slot) in slots.iter().enumerate() {
                set(&mut by_panel[slot / ROWS].1, slot % ROWS, load(place, k));
            }
        }
        by_panel
    }

    /// Whether a node is at its limit and slips the way its load points.
    fn slides(&self, place: usize, slip_mm: Pair) -> bool {
        !self.sticks(place) && dot(self.loads_n[place], slip_mm) > 0.0
    }

    /// The loads that may change: of a node that slides along its circle, of others any way.
    fn freedoms(&self, slips: &[Pair]) -> Vec<Freedom> {
        let mut freedoms = Vec::with_capacity(2 * slips.len());
        for (node, &slip) in slips.iter().enumerate() {
            let (limit_n, [x, y]) = (self.limits_n[node], self.loads_n[node]);
            if limit_n <= LEAST_LIMIT_N {
                continue;
            }
            let free = |along, more| Freedom { node, along, more };
            if self.slides(node, slip) {
                let more = dot(slip, [x, y]) / (limit_n * limit_n);
                freedoms.push(free([-y / limit_n, x / limit_n], more));
            } else {
                freedoms.extend([free([1.0, 0.0], 0.0), free([0.0, 1.0], 0.0)]);
            }
        }
        freedoms
    }

    /// The factor of how far loads that may change move each other.
    fn factor(&self, freedoms: &[Freedom], compliance: &NearMatrix) -> Cholesky {
        let entry = |row: usize, column: usize| {
            let (one, other) = (&freedoms[row], &freedoms[column]);
            let [others, ones] = [other, one].map(|freedom| self.rows[freedom.node]);
            let by = |row: u32| {
                let [a, b] = others.map(|column| compliance.at(row, column));
                a * other.along[0] + b * other.along[1]
            };
            let moved = one.along[0] * by(ones[0]) + one.along[1] * by(ones[1]);
            if row == column {
                moved + one.more
            } else {
                moved
            }
        };
        let mut factor = Cholesky::default();
        factor.factor(freedoms.len(), entry);
        factor
    }
}

/// How reach and limit of a node change with each of six motions; two numbers are nothing.
#[derive(Clone, Copy)]
pub(super) struct ByMotion {
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
