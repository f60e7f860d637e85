//! The solver for the loads along a surface: Coulomb's law with stick and slip on an elastic body.

use std::collections::BTreeMap;

use super::{
    cholesky::{Cholesky, Eight, ROWS, get, product, set, subtract, zero},
    compliance::{NearMatrix, along_surface},
};

pub(crate) type Pair = [f64; 2];

/// The loads are found once no sweep would change one of them by more than this, N: about 1e-8 of the loads in
/// contact.
const FOUND_N: f64 = 1e-7;
/// A node slides if its load is at least this part of its limit; the rest is rounding.
const AT_LIMIT: f64 = 1.0 - 1e-9;
/// Smaller limits count as zero, N: such a node carries no load.
const MIN_LIMIT_N: f64 = 1e-12;
/// Nodes whose load is to change by more than this part of their limit are updated before a Newton step, which would
/// otherwise start with the wrong nodes sticking.
const FAR: f64 = 0.5;
/// If at most one node in this number has changed, only the contributions of the changed nodes are updated; otherwise
/// everything is recomputed, which then costs no more.
const FEW: usize = 8;
/// A Newton step is kept if it reduces the residual to at most this part; sweeps do that, too, but slowly.
const KEPT: f64 = 0.5;
/// Sweeps after a rejected Newton step.
const SWEEPS_BETWEEN: u32 = 3;
/// Steps after which the residual is round-off.
const MAX_STEPS: u32 = 500;

/// The loads along a surface under a counterface that moves past it.
///
/// A node i in contact may carry a load T_i along the surface up to its limit g_i = mu F_i. Without deflection the counterface
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
    /// The nodes in a fixed order, and each with its place in that order, ascending.
    nodes: Vec<Searched>,
    places: Vec<(u32, usize)>,
    /// The loads by the panels of the compliance.
    by_panel: Vec<(usize, Eight)>,
}

/// A node that may carry a load along the surface.
#[derive(Clone, Copy)]
pub(crate) struct FrictionNode {
    pub node: u32,
    pub limit_n: f64,
    /// The motion of the counterface past it since it carried no load, b, mm.
    pub reach_mm: Pair,
    /// The load, N; initially the start value of the search.
    pub load_n: Pair,
}

#[derive(Clone, Copy)]
struct Searched {
    own: FrictionNode,
    slip_mm: Pair,
    /// The rows of the compliance for its loads, and the places of its loads in the panels.
    rows: [u32; 2],
    slots: [usize; 2],
    /// Its smallest stiffness against its own load, N/mm.
    stiffness_n_per_mm: f64,
}

impl Searched {
    /// Returns the improved load for its slip with the other loads fixed; it may exceed the limit.
    fn unlimited_n(&self) -> Pair {
        let (load_n, slip_mm) = (self.own.load_n, self.slip_mm);
        [0, 1].map(|k| load_n[k] + self.stiffness_n_per_mm * slip_mm[k])
    }

    fn better_n(&self) -> Pair {
        within(self.unlimited_n(), self.own.limit_n)
    }

    fn change_n(&self) -> Pair {
        let better_n = self.better_n();
        [0, 1].map(|k| better_n[k] - self.own.load_n[k])
    }

    /// Returns whether it counts as sliding: its improved load would exceed its limit.
    fn slides(&self) -> bool {
        length(self.unlimited_n()) > self.own.limit_n
    }

    /// Returns its displacement along the surface by the loads, mm.
    fn moved_mm(&self) -> Pair {
        [0, 1].map(|k| self.own.reach_mm[k] - self.slip_mm[k])
    }
}

/// An unknown of a Newton step: the change of a node's load along one direction.
struct Freedom {
    node: usize,
    along: Pair,
    /// Added to the diagonal of the compliance, mm/N: the resistance to turning a load on its circle.
    more: f64,
}

impl StickSlip {
    /// Solves for the loads on nodes, given in a fixed order.
    pub fn solve(&mut self, nodes: &[FrictionNode], compliance: &NearMatrix) {
        self.start(nodes, compliance);
        self.approach(compliance);
        // Sliding loads are set exactly to their limits.
        for place in 0..self.nodes.len() {
            self.load(place, self.nodes[place].better_n());
        }
    }

    pub fn load_n(&self, place: usize) -> Pair {
        self.nodes[place].own.load_n
    }

    pub fn sticks(&self, place: usize) -> bool {
        length(self.load_n(place)) < AT_LIMIT * self.nodes[place].own.limit_n
    }

    pub fn moved_mm(&self, place: usize) -> Pair {
        self.nodes[place].moved_mm()
    }

    /// Extrapolates the loads over a short motion of the counterface by their changes, to other limits and motions past the nodes.
    pub fn extrapolate(
        &mut self,
        nodes: &[FrictionNode],
        changes_n: &[Pair],
        compliance: &NearMatrix,
    ) {
        for (place, (node, change_n)) in nodes.iter().zip(changes_n).enumerate() {
            let searched = &mut self.nodes[place];
            let (slides, load_n) = (searched.slides(), searched.own.load_n);
            (searched.own.reach_mm, searched.own.limit_n) = (node.reach_mm, node.limit_n);
            let load_n = [0, 1].map(|k| load_n[k] + change_n[k]);
            self.load(place, admissible(load_n, node.limit_n, slides));
        }
        self.find_slips(compliance);
    }

    /// Starts the search with other nodes, and the loads that were found for them before; these may exceed the new limits.
    fn start(&mut self, nodes: &[FrictionNode], compliance: &NearMatrix) {
        // The old loads and slips are kept apart: most nodes reuse them.
        let before = std::mem::take(self);
        self.places = nodes.iter().map(|node| node.node).zip(0..).collect();
        self.places.sort_unstable();
        // The panels in the order of places, so that sums do not depend on the order in which tiles were added.
        let loads = nodes.iter().flat_map(|node| along_surface(node.node));
        let mut panels: Vec<(u32, usize)> = loads
            .map(|load| (compliance.place(load), compliance.row(load) as usize / ROWS))
            .collect();
        panels.sort_unstable();
        panels.dedup_by_key(|(_, panel)| *panel);
        let panels = panels.into_iter().map(|(_, panel)| panel);
        let slot_of: BTreeMap<usize, usize> = panels.clone().zip(0..).collect();
        self.by_panel = panels.map(|panel| (panel, zero())).collect();
        let searched = |own: &FrictionNode| {
            let rows = along_surface(own.node).map(|load| compliance.row(load));
            let [a, b] = rows;
            let [aa, ab, bb] = [(a, a), (a, b), (b, b)].map(|(i, j)| compliance.at(i, j));
            Searched {
                own: *own,
                slip_mm: [0.0; 2],
                rows,
                slots: rows.map(|row| ROWS * slot_of[&(row as usize / ROWS)] + row as usize % ROWS),
                // One over the larger eigenvalue of the node's own compliance: with it a sweep never overshoots.
                stiffness_n_per_mm: 2.0 / (aa + bb + (aa - bb).hypot(2.0 * ab)),
            }
        };
        self.nodes = nodes.iter().map(searched).collect();
        for (place, node) in nodes.iter().enumerate() {
            self.load(place, node.load_n);
        }
        self.start_slips(&before, compliance);
    }

    /// Computes the slips: from those of the search before if few loads have changed since, else from all loads.
    fn start_slips(&mut self, before: &Self, compliance: &NearMatrix) {
        let stays = |(place, node): (usize, &Searched)| {
            let was = before.place_of(node.own.node)?;
            (before.load_n(was) == self.load_n(place)).then_some(was)
        };
        let stays: Vec<Option<usize>> = self.nodes.iter().enumerate().map(stays).collect();
        let is_gone = |node: &&Searched| {
            let place = self.place_of(node.own.node);
            place.is_none_or(|place| stays[place].is_none())
        };
        let gone = before.nodes.iter().filter(is_gone);
        let gone: Vec<([u32; 2], Pair)> = gone.map(|node| (node.rows, node.own.load_n)).collect();
        let has_new_load = |place: usize| stays[place].is_none() && self.load_n(place) != [0.0; 2];
        if (0..stays.len()).any(has_new_load) || gone.len() > self.nodes.len() / FEW {
            self.find_slips(compliance);
            return;
        }
        for (place, was) in stays.into_iter().enumerate() {
            let slip_mm = was.map_or_else(
                || self.slip_mm(place, compliance),
                |was| {
                    let (node, moved_mm) = (&self.nodes[place], before.moved_mm(was));
                    let back_mm = moved_by(&gone, node.rows, compliance);
                    [0, 1].map(|k| node.own.reach_mm[k] - (moved_mm[k] - back_mm[k]))
                },
            );
            self.nodes[place].slip_mm = slip_mm;
        }
    }

    fn place_of(&self, node: u32) -> Option<usize> {
        let found = self.places.binary_search_by_key(&node, |(node, _)| *node);
        found.ok().map(|found| self.places[found].1)
    }

    fn load(&mut self, place: usize, load_n: Pair) {
        self.nodes[place].own.load_n = load_n;
        for (slot, load_n) in self.nodes[place].slots.into_iter().zip(load_n) {
            set(&mut self.by_panel[slot / ROWS].1, slot % ROWS, load_n);
        }
    }

    fn slip_mm(&self, place: usize, compliance: &NearMatrix) -> Pair {
        let node = &self.nodes[place];
        let moved = node.rows.map(|row| compliance.moved(row, &self.by_panel));
        [0, 1].map(|k| node.own.reach_mm[k] - moved[k])
    }

    fn find_slips(&mut self, compliance: &NearMatrix) {
        for place in 0..self.nodes.len() {
            self.nodes[place].slip_mm = self.slip_mm(place, compliance);
        }
    }

    fn residual_n(&self) -> f64 {
        let changes = self.nodes.iter().map(|node| length(node.change_n()));
        changes.fold(0.0, f64::max)
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
            let before = self.nodes.clone();
            self.newton_step(compliance);
            let now_n = self.residual_n();
            if now_n <= KEPT * residual_n {
                residual_n = now_n;
                continue;
            }
            for (place, node) in before.iter().enumerate() {
                self.load(place, node.own.load_n);
            }
            // Newton's step started with the wrong nodes sticking: sweeps find better ones first.
            self.nodes = before;
            (0..SWEEPS_BETWEEN).for_each(|_| self.sweep(compliance));
            self.find_slips(compliance);
            residual_n = self.residual_n();
        }
    }

    /// Improves the loads of nodes that are far from the solution, such as nodes that have just come into contact,
    /// and returns whether there are any.
    fn update_far_nodes(&mut self, compliance: &NearMatrix) -> bool {
        let is_far = |place: &usize| {
            let node = &self.nodes[*place];
            length(node.change_n()) > FAR * node.own.limit_n
        };
        let far: Vec<usize> = (0..self.nodes.len()).filter(is_far).collect();
        if far.len() > self.nodes.len() / FEW {
            self.sweep(compliance);
            self.find_slips(compliance);
            return true;
        }
        let mut changes = Vec::with_capacity(far.len());
        for &place in &far {
            let node = self.nodes[place];
            changes.push((node.rows, node.change_n()));
            self.load(place, node.better_n());
        }
        for node in &mut self.nodes {
            let moved_mm = moved_by(&changes, node.rows, compliance);
            node.slip_mm = [0, 1].map(|k| node.slip_mm[k] - moved_mm[k]);
        }
        !far.is_empty()
    }

    /// Improves the load of each node in turn.
    fn sweep(&mut self, compliance: &NearMatrix) {
        for place in 0..self.nodes.len() {
            self.nodes[place].slip_mm = self.slip_mm(place, compliance);
            self.load(place, self.nodes[place].better_n());
        }
    }

    /// Takes a Newton step, after setting sliding loads to their limits.
    fn newton_step(&mut self, compliance: &NearMatrix) {
        let freedoms = self.freedoms();
        let slides: Vec<bool> = self.nodes.iter().map(Searched::slides).collect();
        let mut loads_n: Vec<Pair> = self.nodes.iter().map(|node| node.own.load_n).collect();
        let mut by_slot = vec![0.0; self.width()];
        for (place, load_n) in loads_n.iter_mut().enumerate() {
            if slides[place] {
                let node = &self.nodes[place];
                *load_n = to_length(*load_n, node.own.limit_n);
                for (k, slot) in node.slots.iter().enumerate() {
                    by_slot[*slot] = load_n[k] - node.own.load_n[k];
                }
            }
        }
        let mut sides = vec![zero(); freedoms.len()];
        let factor = self.factor(&freedoms, compliance, |row, line| {
            let (freedom, moved_mm) = (&freedoms[row], product(line, &by_slot));
            let slip_mm = dot(freedom.along, self.nodes[freedom.node].slip_mm);
            set(&mut sides[row], 0, slip_mm - moved_mm);
        });
        sides.resize(factor.rows(), zero());
        factor.forward(&mut sides);
        factor.backward(&mut sides);
        for (freedom, side) in freedoms.iter().zip(&sides) {
            let (more_n, load_n) = (get(side, 0), &mut loads_n[freedom.node]);
            *load_n = [0, 1].map(|k| load_n[k] + more_n * freedom.along[k]);
        }
        // A step along the tangent of a circle leaves it, and a sticking load may exceed its limit.
        for (place, load_n) in loads_n.into_iter().enumerate() {
            let limit_n = self.nodes[place].own.limit_n;
            self.load(place, admissible(load_n, limit_n, slides[place]));
        }
        self.find_slips(compliance);
    }

    /// Returns the derivatives of the loads by six motions, from those of the motions past the nodes and of the limits.
    pub fn by_motion(&self, changes: &[ByMotion], compliance: &NearMatrix) -> Vec<[Eight; 2]> {
        let freedoms = self.freedoms();
        // First the derivatives of sliding loads through their limits, then those of all through the freedoms.
        let by_limit = |(node, change): (&Searched, &ByMotion)| {
            let part = if node.slides() {
                1.0 / node.own.limit_n
            } else {
                0.0
            };
            node.own.load_n.map(|load_n| {
                let mut by = zero();
                subtract(&mut by, &change.limit_n, -(part * load_n));
                by
            })
        };
        let mut loads: Vec<[Eight; 2]> = self.nodes.iter().zip(changes).map(by_limit).collect();
        let mut by_slot = vec![zero(); self.width()];
        for (node, loads) in self.nodes.iter().zip(&loads) {
            for (slot, load) in node.slots.iter().zip(loads) {
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

    /// Returns the unknowns of a Newton step: a sliding load turns on its circle, others change in any direction.
    fn freedoms(&self) -> Vec<Freedom> {
        let mut freedoms = Vec::with_capacity(2 * self.nodes.len());
        for (node, searched) in self.nodes.iter().enumerate() {
            let FrictionNode {
                limit_n, load_n, ..
            } = searched.own;
            if limit_n <= MIN_LIMIT_N {
                continue;
            }
            let free = |along, more| Freedom { node, along, more };
            if searched.slides() {
                let [x, y] = to_length(load_n, 1.0);
                let more = (dot(searched.slip_mm, [x, y]) / limit_n).max(0.0);
                freedoms.push(free([-y, x], more));
            } else {
                freedoms.extend([free([1.0, 0.0], 0.0), free([0.0, 1.0], 0.0)]);
            }
        }
        freedoms
    }

    /// Factors the compliance between the freedoms. `visit` receives the line of each freedom: the displacements of
    /// its node along it by every load of the panels.
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
            let rows = self.nodes[freedom.node].rows;
            compliance.mix(rows, freedom.along, &self.by_panel, &mut line);
            visit(row, &line);
            entries.extend(freedoms[..=row].iter().map(|other| {
                let [x, y] = self.nodes[other.node].slots;
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

/// Scales a sliding load to its limit, and any other load only if it exceeds its limit.
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
