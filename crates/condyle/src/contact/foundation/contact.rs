//! The elastic foundation: rigid bodies, and pressure from local overclosure.

use super::{
    ContactModel, Landing, Linearization, PressureLaw, Response, Tangent, TouchedNode,
    clearance::Clearance,
    nearness::Nearness,
    partial::{Rises, mean_overclosure},
    peak::PeakSearch,
    seen::Seen,
    shares::ShareBlock,
    tangent::TangentSum,
    traction::{Sliding, SlipSums, Tractions4, WrenchSum},
};
use crate::{
    Vec3, Vector,
    geometry::{ArticulatingSurface, FemoralSurface, Insert},
    number::{F64x4, LANES, Number},
    number::vector::{cross, dot, scale_add, tangential_part, zero_vector},
    spatial::{
        FrameChange, Pose, Pose4, RelativeMotion, Twist, Twist4, Wrench, WrenchByTwist, body,
    },
};

/// How the foundation presses and rubs.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundationSettings {
    /// Pressure from overclosure.
    pub law: PressureLaw,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
    /// Speed at which friction has reached 71 % of its full value, mm/s, > 0.
    ///
    /// Friction is mu p v/sqrt(v^2 + v0^2) with this v0. Smaller is nearer to Coulomb's stick and
    /// slip; larger lets parts that should stick creep, and is easier to solve.
    pub slip_tolerance_mm_per_s: f64,
}

/// NodeBlock shares that touch, as they see the femur.
struct Look {
    four: u32,
    seen: Seen,
    /// How the overclosure rises along the shares' edges.
    rises: Rises<F64x4>,
}

/// What one foundation knew of which shares come near, and when.
///
/// It makes the foundation after it quicker, and changes none of its answers.
pub struct Former {
    shares: Vec<ShareBlock>,
    nearness: Nearness,
    /// For its memory.
    seen: Vec<Seen>,
}

impl Former {
    fn worn(self, shares: &[ShareBlock]) -> (Nearness, Vec<Seen>) {
        let nearness = match self.shares.len() == shares.len() {
            true => self.nearness.worn(&self.shares, shares),
            false => Nearness::new(shares),
        };
        (nearness, self.seen)
    }
}

/// Contact of a rigid femur with an elastic layer on a rigid base.
///
/// Every node's share of the articulating surface presses with the law's pressure at its mean
/// overclosure, along the femur's normal there. Shares at the edge of contact count with the part
/// of them that presses. Limits: neighbours do not feel each other, so a foundation does not match
/// Hertz, and edge loading is over-estimated (Halloran 2005).
pub struct Foundation<'a> {
    settings: &'a FoundationSettings,
    femur: &'a FemoralSurface,
    surface: ArticulatingSurface,
    shares: Vec<ShareBlock>,
    /// The surface's own directions at every four nodes.
    directions: Vec<[Vector<F64x4>; 2]>,
    insert: &'a Insert,
    /// What every four of them saw of the femur, and the number of the response at which they
    /// touched it last.
    seen: Vec<Seen>,
    touched: Vec<u64>,
    /// The number of the last response: the first is 2, and none has touched at the one before it.
    response: u64,
    nearness: Nearness,
    /// The node_blocks that may touch, and the places of their centres in the femoral frame.
    due: Vec<(u32, Vector<F64x4>)>,
    /// The node_blocks that touched at the last response, and what pressed them.
    looks: Vec<Look>,
    tractions: Vec<Tractions4>,
    /// How the two sides slid.
    mean_slip: [Vec3; 2],
    /// Where the femur was then.
    pose: Pose,
}

impl<'a> Foundation<'a> {
    /// The foundation of an insert as it is now, under a femur.
    pub fn new(
        settings: &'a FoundationSettings,
        femur: &'a FemoralSurface,
        insert: &'a Insert,
    ) -> Self {
        Self::after(None, settings, femur, insert)
    }

    /// The same, quicker where another was made for the insert less worn, under the same femur.
    pub fn after(
        former: Option<Former>,
        settings: &'a FoundationSettings,
        femur: &'a FemoralSurface,
        insert: &'a Insert,
    ) -> Self {
        let surface = insert.surface();
        let shares = ShareBlock::of(insert, &surface);
        let (nearness, mut seen) = match former {
            Some(former) => former.worn(&shares),
            None => (Nearness::new(&shares), Vec::new()),
        };
        seen.resize(shares.len(), Seen::nothing());
        Self {
            settings,
            femur,
            directions: shares
                .iter()
                .map(|four| directions(&surface, four))
                .collect(),
            nearness,
            seen,
            insert,
            touched: vec![0; shares.len()],
            response: 1,
            shares,
            surface,
            due: Vec::new(),
            looks: Vec::new(),
            tractions: Vec::new(),
            mean_slip: [Vec3::zeros(); 2],
            pose: Pose::identity(),
        }
    }

    /// The articulating surface that it presses on.
    pub fn surface(&self) -> &ArticulatingSurface {
        &self.surface
    }

    /// The articulating surface, and what helps the foundation after this one, when this is no
    /// longer needed.
    pub fn into_parts(self) -> (ArticulatingSurface, Former) {
        let former = Former {
            shares: self.shares,
            nearness: self.nearness,
            seen: self.seen,
        };
        (self.surface, former)
    }

    /// Looks from every four that may touch, and keeps those that do.
    ///
    /// Only what touches is remembered, and until it parts: what is remembered then follows from the
    /// motion alone, and not from what was found due.
    fn look(&mut self, pose: &Pose4) {
        self.looks.clear();
        self.response += 1;
        for &(four, place) in &self.due {
            let at = four as usize;
            let shares = &self.shares[at];
            let touched = self.touched[at] + 1 == self.response;
            let reaches = touched && self.seen[at].reaches(&place);
            let seen = match reaches {
                true => self.seen[at].moved_to(place),
                false => Seen::anew(self.femur, place, shares.spread_mm2),
            };
            let normal = pose.turn_to_insert(&seen.sample.normal);
            let rises = Rises::new([dot(&normal, &shares.edge_a), dot(&normal, &shares.edge_b)]);
            let reach_mm = rises.reach_mm();
            if (seen.sample.gap_mm - reach_mm).least() > 0.0 {
                let around = self.femur.curvature_bounds(&place);
                let clearance = Clearance::new(&seen, reach_mm, shares, around);
                self.nearness.is_apart(four, &clearance);
            } else {
                self.nearness.touches(four);
                self.touched[at] = self.response;
                if !reaches {
                    self.seen[at] = seen;
                }
                self.looks.push(Look { four, seen, rises });
            }
        }
    }

    /// Presses all that touch; the wrench on the insert at the femur's origin.
    fn press(&mut self, pose: &Pose4, twist: &Twist4) -> Wrench<body::Insert, body::Femur> {
        self.tractions.clear();
        let mut total = WrenchSum::new();
        let mut slips = SlipSums::new();
        for look in &self.looks {
            let shares = &self.shares[look.four as usize];
            let pressed = press(self.settings, shares, look, pose, twist);
            let force_n = pressed.force_n(&look.seen.sample.normal, self.settings.friction);
            total.add(&look.seen.place, &force_n);
            slips.add(shares.centre.z, &pressed);
            self.tractions.push(pressed);
        }
        self.mean_slip = slips.means();
        total.total()
    }
}

/// Pressure and rubbing on four shares.
///
/// With n the femur's normal, K its curvature, e_k the share's edges and W the mean overclosure of
/// the share, a motion a and a turn w of the femur change the middle's overclosure by G . a, the
/// normal by w x n - K a, and each rise n . e_k with the normal.
#[inline(always)]
fn press(
    settings: &FoundationSettings,
    shares: &ShareBlock,
    look: &Look,
    pose: &Pose4,
    twist: &Twist4,
) -> Tractions4 {
    let Seen { place, sample } = &look.seen;
    let mean = mean_overclosure(-sample.gap_mm, &look.rises);
    let (pressure_mpa, slope) = settings.law.pressures(mean.mm, shares.per_thickness);
    let stiffness = slope * shares.area_mm2;
    let mut load_by_motion = sample.gap_gradient * (mean.by_middle * stiffness);
    let mut load_by_turn = zero_vector();
    if let Some(by_rise) = mean.by_rise {
        let (by_a, by_b) = (by_rise[0] * stiffness, by_rise[1] * stiffness);
        let by_normal = scale_add(&shares.edge_a, by_a, &(shares.edge_b * by_b));
        let by_normal = pose.turn_to_femur(&by_normal);
        let along_surface = tangential_part(&by_normal, &sample.normal);
        load_by_motion -= sample.curvature.times(&along_surface);
        load_by_turn = cross(&sample.normal, &by_normal);
    }
    Tractions4 {
        pressure_mpa,
        area_mm2: shares.area_mm2,
        covered_mm2: mean.by_middle * shares.area_mm2,
        load_by_motion,
        load_by_turn,
        sliding: Sliding::new(
            &twist.velocity(place),
            &sample.normal,
            settings.slip_tolerance_mm_per_s,
        ),
    }
}

impl Linearization for Foundation<'_> {
    fn tangent(&self) -> Tangent {
        let mut sum = TangentSum::new();
        for (looks, tractions) in self.looks.chunks(2).zip(self.tractions.chunks(2)) {
            let one = (&looks[0].seen, &tractions[0]);
            let nothing = (one.0, &Tractions4::none());
            let other = looks.get(1).map(|look| (&look.seen, &tractions[1]));
            sum.add(one, other.unwrap_or(nothing), self.settings.friction);
        }
        let (by_pose, by_twist) = sum.total();
        let change = FrameChange::to_femur(&self.pose);
        Tangent {
            by_pose: change.derivative_back(&WrenchByTwist::new(by_pose)),
            by_twist: change.derivative_back(&WrenchByTwist::new(by_twist)),
        }
    }
}

impl ContactModel for Foundation<'_> {
    fn node_count(&self) -> usize {
        self.surface.positions.len()
    }

    fn begin_increment(&mut self, increment: usize) {
        self.nearness.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response<'_> {
        self.pose = motion.pose;
        let change = FrameChange::to_femur(&self.pose);
        let pose = Pose4::new(&self.pose);
        let twist = Twist4::new(&change.twist(&motion.twist));
        self.nearness
            .find_due(&self.shares, &self.pose, &pose, &mut self.due);
        self.look(&pose);
        let wrench = change.wrench_back(&self.press(&pose, &twist));
        Response::new(wrench, self.mean_slip, self)
    }

    fn land(&mut self, motion: &RelativeMotion) -> Landing {
        let touched = self.touched(motion);
        let peak_pressure_mpa = self.peak_pressure_mpa(motion, &touched);
        Landing {
            touched,
            peak_pressure_mpa,
        }
    }
}

impl Foundation<'_> {
    /// The nodes in contact at a motion near that of the last response, to first order.
    fn touched(&self, motion: &RelativeMotion) -> Vec<TouchedNode> {
        let change = FrameChange::to_femur(&self.pose);
        let moved = Twist::between(&self.pose, &motion.pose);
        let moved = Twist4::new(&change.twist(&moved));
        let twist = Twist4::new(&change.twist(&motion.twist));
        let pose = Pose4::new(&self.pose);
        let mut touched = Vec::with_capacity(LANES * self.looks.len());
        for (look, tractions) in self.looks.iter().zip(&self.tractions) {
            let landed = self.landed(look, tractions, &moved, &twist, &pose);
            landed.touch(&self.shares[look.four as usize], &mut touched);
        }
        touched
    }

    fn peak_pressure_mpa(&self, motion: &RelativeMotion, touched: &[TouchedNode]) -> f64 {
        let search = PeakSearch {
            law: &self.settings.law,
            femur: self.femur,
            shares: &self.surface.shares,
            thickness_mm: self.insert.thickness_mm(),
            faces: self.insert.faces_around(),
            pose: Pose4::new(&motion.pose),
        };
        search.highest_mpa(touched)
    }
}

/// The surface's own directions at four nodes.
fn directions(surface: &ArticulatingSurface, four: &ShareBlock) -> [Vector<F64x4>; 2] {
    let at = |lane: usize| surface.directions(four.nodes[lane] as usize);
    [0, 1].map(|which| {
        Vector::from([0, 1, 2].map(|axis| F64x4::from_lanes(|lane| at(lane)[which][axis])))
    })
}

/// NodeBlock shares at the end of an increment.
struct Landed4 {
    pressure_mpa: F64x4,
    covered_mm2: F64x4,
    /// In the insert frame.
    force_n: Vector<F64x4>,
    /// In the surface's own directions.
    sliding_mm_per_s: [F64x4; 2],
}

impl Foundation<'_> {
    /// NodeBlock shares after a short motion of the femur, turn and shift in its frame, to first order,
    /// and with the speeds of `twist`; the covered area stays.
    #[inline(always)]
    fn landed(
        &self,
        look: &Look,
        tractions: &Tractions4,
        motion: &Twist4,
        twist: &Twist4,
        pose: &Pose4,
    ) -> Landed4 {
        let Seen { place, sample } = &look.seen;
        let shares = &self.shares[look.four as usize];
        let rise_n = tractions.load_rise_n(place, motion);
        let area_mm2 = Number::max(shares.area_mm2, F64x4::splat(f64::MIN_POSITIVE));
        let pressure_mpa = tractions.pressure_mpa + rise_n / area_mm2;
        let landed = Tractions4 {
            pressure_mpa: Number::max(pressure_mpa, F64x4::splat(0.0)),
            sliding: Sliding::new(
                &twist.velocity(place),
                &sample.normal,
                self.settings.slip_tolerance_mm_per_s,
            ),
            ..*tractions
        };
        let force_n = landed.force_n(&sample.normal, self.settings.friction);
        let sliding = pose.turn_to_insert(&landed.sliding.velocity_mm_per_s);
        let [anterior, lateral] = &self.directions[look.four as usize];
        Landed4 {
            pressure_mpa: landed.pressure_mpa,
            covered_mm2: landed.covered_mm2,
            force_n: pose.turn_to_insert(&force_n),
            sliding_mm_per_s: [dot(&sliding, anterior), dot(&sliding, lateral)],
        }
    }
}

impl Landed4 {
    /// Adds those of four shares that press.
    #[inline(always)]
    fn touch(&self, shares: &ShareBlock, touched: &mut Vec<TouchedNode>) {
        for (lane, &node) in shares.nodes.iter().enumerate() {
            let pressure_mpa = self.pressure_mpa.lane(lane);
            if pressure_mpa * shares.area_mm2.lane(lane) > 0.0 {
                let force = &self.force_n;
                let [anterior, lateral] = &self.sliding_mm_per_s;
                touched.push(TouchedNode {
                    node,
                    region: shares.regions[lane],
                    pressure_mpa,
                    covered_mm2: self.covered_mm2.lane(lane),
                    force_n: Vec3::new(force.x.lane(lane), force.y.lane(lane), force.z.lane(lane)),
                    sliding_mm_per_s: [anterior.lane(lane), lateral.lane(lane)],
                });
            }
        }
    }
}
