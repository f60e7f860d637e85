//! The solver for the loads along a surface: Coulomb's law with stick and slip on an elastic body.

use super::{
    cholesky::{Cholesky, Eight, ROWS, get, product, set, subtract, zero},
    compliance::{NearMatrix, along_surface},
};

/// Numbers along the two directions of a surface.
pub(crate) type Pair = [f64; 2];

/// The loads are found once no sweep would change one of them by more than this, N: some 1e-8 of the loads in contact.
const FOUND_N: f64 = 1e-7;
/// A node slides if its load is at least this part of its limit; the rest is rounding.
const AT_LIMIT: f64 = 1.0 - 1e-9;
/// Smaller limits count as zero, N: such a node carries no load.
const MIN_LIMIT_N: f64 = 1e-12;
/// Nodes whose load is to change by more than this part of their limit are updated before a Newton step, which would
/// otherwise start with the wrong nodes sticking.
const FAR: f64 = 0.5;
/// If at most one in so many nodes has changed, only the contributions of these are updated; otherwise everything is
/// recomputed, which then costs no more.
const FEW: usize = 8;
/// A Newton step is kept if it reduces the residual to at most this part; sweeps do that, too, but slowly.
const KEPT: f64 = 0.5;
/// Sweeps after a rejected Newton step.
const SWEEPS_BETWEEN: u32 = 3;
/// Steps after which the residual is round-off.
const MAX_STEPS: u32 = 500;

/// The loads along a surface under a femur that moves past it.
///
/// A node i in contact may carry a load T_i along the surface up to its limit g_i = mu F_i. Without deflection the femur
/// would have moved past it by b_i; the surface deflects by its compliance C along itself, so that the node slips by
/// s_i = b_i - sum_j C_ij T_j. It sticks, or slips in the direction of its load,
///
/// $$ s_i = 0, \enspace |T_i| \le g_i \qquad \text{or} \qquad s_i = \lambda_i T_i, \enspace \lambda_i > 0, \enspace |T_i| = g_i , $$
///
/// which is the minimum of T' C T / 2 - b' T with |T_i| <= g_i; C is positive definite, so there is one. Two methods
/// alternate: sweeps over the nodes, each of which goes to its own minimum, converge from everywhere, but slowly; Newton
/// steps converge quickly near the solution. In these, loads of sticking nodes are free, and those of sliding nodes turn
/// on the circles of their limits.
#[derive(Default)]
pub(crate) struct StickSlip {
    /// The nodes, in an order that is always the same; and each with its place in that order, ascending.
    nodes: Vec<u32>,
    places: Vec<(u32, usize)>,
    /// The rows of the compliance of every node, and the places of its loads among `by_panel`.
    rows: Vec<[u32; 2]>,
    slots: Vec<[usize; 2]>,
    limits_n: Vec<f64>,
    reach_mm: Vec<Pair>,
    loads_n: Vec<Pair>,
    /// The smallest stiffness of a node against its own load, N/mm.
    stiffness_n_per_mm: Vec<f64>,
    /// The loads by the panels of the compliance.
    by_panel: Vec<(usize, Eight)>,
    slips_mm: Vec<Pair>,
}

/// A node that may carry a load along the surface.
#[derive(Clone, Copy)]
pub(crate) struct FrictionNode {
    pub node: u32,
    /// Its limit g, N.
    pub limit_n: f64,
    /// The motion of the femur past it since it carried no load, b, mm.
    pub reach_mm: Pair,
    /// The load with which the search starts, N.
    pub load_n: Pair,
}

/// An unknown of a Newton step: the change of a node's load along one direction.
struct Freedom {
    node: usize,
    along: Pair,
    /// Added to the diagonal of the compliance, mm/N: the resistance to turning a load on its circle.
    more: f64,
}

impl StickSlip {
    /// Solves for the loads on nodes, given in an order that is always the same.
    pub fn solve(&mut self, nodes: &[FrictionNode], compliance: &NearMatrix) {
        self.start(nodes, compliance);
        self.approach(compliance);
        // Sliding loads get their limit to the last digit.
        for place in 0..self.rows.len() {
            self.load(place, self.better_n(place, self.slips_mm[place]));
        }
    }

    /// Alternates Newton steps and sweeps until the residual is small.
    fn approach(&mut self, compliance: &NearMatrix) {
        let mut residual_n = self.residual_n();
        for _ in 0..MAX_STEPS {
            if residual_n <= FOUND_N {
                return;
            }
            if self.update_far_nodes(compliance) {
                residual_n = self.residual_n();
            }
            let before = (self.loads_n.clone(), self.slips_mm.clone());
            self.newton_step(compliance);
            let now_n = self.residual_n();
            if now_n <= KEPT * residual_n {
                residual_n = now_n;
                continue;
            }
            let (loads_n, slips_mm) = before;
            (0..loads_n.len()).for_each(|place| self.load(place, loads_n[place]));
            self.slips_mm = slips_mm;
            (0..SWEEPS_BETWEEN).for_each(|_| self.sweep(compliance));
            self.find_slips(compliance);
            residual_n = self.residual_n();
        }
    }

    pub fn loads_n(&self) -> &[Pair] {
        &self.loads_n
    }

    /// Returns whether a node sticks.
    pub fn sticks(&self, place: usize) -> bool {
        length(self.loads_n[place]) < AT_LIMIT * self.limits_n[place]
    }

    /// Extrapolates the loads over a short motion of the femur by their changes, to other limits and motions past the nodes.
    pub fn extrapolate(
        &mut self,
        nodes: &[FrictionNode],
        changes_n: &[Pair],
        compliance: &NearMatrix,
    ) {
        for (place, (node, change_n)) in nodes.iter().zip(changes_n).enumerate() {
            let slides = self.slides(place);
            self.reach_mm[place] = node.reach_mm;
            self.limits_n[place] = node.limit_n;
            let load_n = [0, 1].map(|k| self.loads_n[place][k] + change_n[k]);
            self.load(place, admissible(load_n, node.limit_n, slides));
        }
        self.find_slips(compliance);
    }

    /// Returns the displacement of a node along the surface by the loads, mm.
    pub fn moved_mm(&self, place: usize) -> Pair {
        [0, 1].map(|k| self.reach_mm[place][k] - self.slips_mm[place][k])
    }

    /// Starts the search with other nodes, and the loads that were found for them before; these may exceed the new limits.
    fn start(&mut self, nodes: &[FrictionNode], compliance: &NearMatrix) {
        let before = std::mem::take(self);
        self.nodes = nodes.iter().map(|node| node.node).collect();
        self.places = self.nodes.iter().copied().zip(0..).collect();
        self.places.sort_unstable();
        let rows = |node: &u32| along_surface(*node).map(|load| compliance.row(load));
        self.rows = self.nodes.iter().map(rows).collect();
        self.limits_n = nodes.iter().map(|node| node.limit_n).collect();
        self.reach_mm = nodes.iter().map(|node| node.reach_mm).collect();
        let stiffness = |&[a, b]: &[u32; 2]| {
            let [aa, ab, bb] = [(a, a), (a, b), (b, b)].map(|(i, j)| compliance.at(i, j));
            2.0 / (aa + bb + (aa - bb).hypot(2.0 * ab))
        };
        self.stiffness_n_per_mm = self.rows.iter().map(stiffness).collect();
        self.find_slots(compliance);
        self.loads_n = vec![[0.0; 2]; nodes.len()];
        for (place, node) in nodes.iter().enumerate() {
            self.load(place, node.load_n);
        }
        self.update_slips(&before, compliance);
    }

    /// Computes the slips from those of the search before, if few loads have changed since.
    fn update_slips(&mut self, before: &Self, compliance: &NearMatrix) {
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

    /// Finds the panels of the nodes, and the place of each node in them.
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

    /// Returns the load on a node that is better for its slip while the others stay.
    fn better_n(&self, place: usize, slip_mm: Pair) -> Pair {
        within(self.unlimited_n(place, slip_mm), self.limits_n[place])
    }

    fn unlimited_n(&self, place: usize, slip_mm: Pair) -> Pair {
        let (load_n, stiffness) = (self.loads_n[place], self.stiffness_n_per_mm[place]);
        [0, 1].map(|k| load_n[k] + stiffness * slip_mm[k])
    }

    /// Returns how much a load differs from a better one, N.
    fn off_n(&self, place: usize) -> f64 {
        let better_n = self.better_n(place, self.slips_mm[place]);
        length([0, 1].map(|k| better_n[k] - self.loads_n[place][k]))
    }

    fn residual_n(&self) -> f64 {
        let places = 0..self.rows.len();
        places.map(|place| self.off_n(place)).fold(0.0, f64::max)
    }

    /// Puts better loads on the nodes whose loads are far off, such as those that have just come into contact, and returns
    /// whether there are any.
    fn update_far_nodes(&mut self, compliance: &NearMatrix) -> bool {
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

    /// Puts a better load on each node in turn.
    fn sweep(&mut self, compliance: &NearMatrix) {
        for place in 0..self.rows.len() {
            let slip_mm = self.slip_mm(place, compliance);
            self.load(place, self.better_n(place, slip_mm));
        }
    }

    /// Takes a Newton step. Sliding loads are put to their limits first.
    fn newton_step(&mut self, compliance: &NearMatrix) {
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
            self.load(
                place,
                admissible(load_n, self.limits_n[place], slides[place]),
            );
        }
        self.find_slips(compliance);
    }

    /// Returns the derivatives of the loads by six motions, from those of the motions past the nodes and of the limits.
    pub fn by_motion(&self, changes: &[ByMotion], compliance: &NearMatrix) -> Vec<[Eight; 2]> {
        let freedoms = self.freedoms();
        // First the derivatives of sliding loads through their limits, then those of all through the freedoms.
        let by_limit = |(place, change): (usize, &ByMotion)| {
            let part = if self.slides(place) {
                1.0 / self.limits_n[place]
            } else {
                0.0
            };
            self.loads_n[place].map(|load_n| {
                let mut by = zero();
                subtract(&mut by, &change.limit_n, -(part * load_n));
                by
            })
        };
        let mut loads: Vec<[Eight; 2]> = changes.iter().enumerate().map(by_limit).collect();
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

    fn width(&self) -> usize {
        ROWS * self.by_panel.len()
    }

    /// Returns whether a node counts as sliding: a better load for it would exceed its limit.
    fn slides(&self, place: usize) -> bool {
        let better = self.unlimited_n(place, self.slips_mm[place]);
        length(better) > self.limits_n[place]
    }

    /// Returns the unknowns of a Newton step: a sliding load turns on its circle, others change in any direction.
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

    /// Factors the compliance between the freedoms. `visit` receives of each freedom its line: the displacements of its node
    /// along it by every load of the panels.
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

/// Puts a sliding load to its limit, and cuts any other to it.
fn admissible(load_n: Pair, limit_n: f64, slides: bool) -> Pair {
    if slides {
        to_length(load_n, limit_n)
    } else {
        within(load_n, limit_n)
    }
}

fn within(load_n: Pair, limit_n: f64) -> Pair {
    let length_n = length(load_n);
    if length_n > limit_n {
        load_n.map(|part_n| limit_n / length_n * part_n)
    } else {
        load_n
    }
}

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
