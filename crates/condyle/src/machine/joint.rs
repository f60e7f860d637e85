//! A joint as a description: its kind, its axis, and the waveforms that can drive it.

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// It turns: rad and N mm in the solver, degrees in files.
    Rotation,
    /// It shifts: mm and N everywhere.
    Translation,
}

impl JointKind {
    /// The unit of positions in files, as names end in it.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Rotation => "deg",
            Self::Translation => "mm",
        }
    }

    /// How much of the solver's unit (rad, mm) the unit of files has.
    pub const fn file_unit_in_solver(self) -> f64 {
        match self {
            Self::Rotation => 1f64.to_radians(),
            Self::Translation => 1.0,
        }
    }

    /// A position of the solver (rad, mm) in the unit of files.
    pub const fn in_files(self, position: f64) -> f64 {
        match self {
            Self::Rotation => position.to_degrees(),
            Self::Translation => position,
        }
    }
}

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

/// The unit that the values of a waveform have in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelUnit {
    /// N.
    Newton,
    /// N m.
    NewtonMetre,
    /// mm.
    Millimetre,
    /// Degrees.
    Degree,
}

impl ChannelUnit {
    /// How a name ends that has the unit: `n` of `knots_n`.
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::Newton => "n",
            Self::NewtonMetre => "nm",
            Self::Millimetre => JointKind::Translation.unit(),
            Self::Degree => JointKind::Rotation.unit(),
        }
    }

    /// How much of the solver's unit (N, N mm, mm, rad) it has.
    pub const fn in_solver(self) -> f64 {
        match self {
            Self::Newton => 1.0,
            Self::NewtonMetre => 1e3,
            Self::Millimetre => JointKind::Translation.file_unit_in_solver(),
            Self::Degree => JointKind::Rotation.file_unit_in_solver(),
        }
    }
}

/// A waveform that moves or loads a joint, as files have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// Its name in files: `ap_force`.
    pub name: &'static str,
    /// What it is, and which way is positive.
    pub about: &'static str,
    /// The unit of its values.
    pub unit: ChannelUnit,
    /// 1 where its values have the sign of the joint, -1 where they have the other.
    pub sign: f64,
    /// Least that a value may be.
    pub least: f64,
    /// Most that a value may be.
    pub most: f64,
}

impl Channel {
    /// What a value in a file is multiplied by to act on the joint: sign and unit.
    pub const fn factor(&self) -> f64 {
        self.sign * self.unit.in_solver()
    }
}

/// The line that a joint moves along or about, with a unit vector in the insert's directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// Along a direction.
    Along([f64; 3]),
    /// About a direction, through a point of the insert frame that the machine sets for the joint
    /// ([`Joint::axis_point_mm`](super::Joint)).
    About([f64; 3]),
    /// About a direction, through the point of the femur that the femur turns about; the joints nearer to
    /// the insert carry it along.
    AboutFemur([f64; 3]),
}

/// Which body a joint moves. When the insert moves one way, the femur falls behind the other way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovedBody {
    /// The insert.
    Insert,
    /// The femur.
    Femur,
}

/// What a joint does while the machine settles under the load at the start of the cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settling {
    /// It is free, and nothing pushes it, whatever drives it in the cycle.
    Free,
    /// It is held at zero.
    HeldAtZero,
    /// It is driven as at the start of the cycle, by its load too.
    Driven,
    /// It is driven as at the start of the cycle, but free of load where a load drives it.
    DrivenWithoutLoad,
}

/// Whether a joint can be free under a load, and which waveform gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loading {
    /// It cannot be free.
    None,
    /// It can be free, and nothing pushes it.
    Free,
    /// It can be free under a waveform.
    By(&'static Channel),
}

/// A joint of a mechanism: its names, its axis, how it settles, and the waveforms that can drive it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointDescription {
    /// Its name in files: `ap`.
    pub name: &'static str,
    /// Its column in files of motions: the name and the unit.
    pub column: &'static str,
    /// What messages call it: `AP`.
    pub symbol: &'static str,
    /// What messages call it where there is room: `AnteroPosterior`.
    pub long_name: &'static str,
    /// What a page calls it.
    pub title: &'static str,
    /// Which way is positive, in words.
    pub positive: &'static str,
    /// Decimals that messages give of its position, in the unit of files.
    pub decimals: usize,
    /// Range below which a curve of it is drawn flat rather than enlarged, in the unit of files.
    pub least_span: f64,
    /// What it moves along or about.
    pub axis: Axis,
    /// What it moves, and so its sign.
    pub moves: MovedBody,
    /// What it does while the machine settles.
    pub settling: Settling,
    /// Whether it reads zero where the machine has settled.
    pub is_zeroed: bool,
    /// Mass in tonne, or moment of inertia in tonne mm2, unless a machine says otherwise.
    pub inertia: f64,
    /// Viscous damping, N s/mm or N mm s/rad, unless a machine says otherwise.
    pub damping: f64,
    /// The waveform that can prescribe its motion, if one can.
    pub motion: Option<&'static Channel>,
    /// The waveform that can load it.
    pub load: Loading,
}

impl JointDescription {
    /// Whether it turns or shifts.
    pub const fn kind(&self) -> JointKind {
        match self.axis {
            Axis::Along(_) => JointKind::Translation,
            Axis::About(_) | Axis::AboutFemur(_) => JointKind::Rotation,
        }
    }

    /// The waveform that can load it, if one can.
    pub const fn load_channel(&self) -> Option<&'static Channel> {
        match self.load {
            Loading::By(channel) => Some(channel),
            Loading::None | Loading::Free => None,
        }
    }

    /// Whether it can be free.
    pub const fn can_be_free(&self) -> bool {
        !matches!(self.load, Loading::None)
    }

    /// Whether it stands at zero once the machine has settled.
    pub fn settles_at_zero(&self) -> bool {
        self.is_zeroed || self.settling == Settling::HeldAtZero
    }
}
