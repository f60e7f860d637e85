//! Stress below the surface of a deformable insert, what has yielded, and its backside.
//!
//! Stress is that of the centres of elements, at the increment of each update with the highest pressure.

use super::{Scalar, scalar::scalars};

scalars! { "Below the surface";
    /// Largest von Mises stress. At the centre of an element, at the instant of highest pressure of a cycle solved.
    PEAK_VON_MISES_MPA = Scalar::new("peak_von_mises_mpa", "largest von Mises stress", 1).sometimes();

    /// Depth of the largest von Mises stress. Below the surface, to half an element.
    PEAK_VON_MISES_DEPTH_MM = Scalar::new("peak_von_mises_depth_mm", "depth of that stress", 1).sometimes();

    /// Largest shear stress. At the centre of an element, at the instant of highest pressure of a cycle solved.
    PEAK_MAX_SHEAR_MPA = Scalar::new("peak_max_shear_mpa", "largest shear stress", 1).sometimes().in_cycle("peak_max_shear_cycle");

    /// Depth of the largest shear stress. Below the surface, to half an element.
    PEAK_MAX_SHEAR_DEPTH_MM = Scalar::new("peak_max_shear_depth_mm", "depth of that stress", 1).sometimes();

    /// Cycles done before the cycle with the largest shear stress. 0 is the first cycle.
    PEAK_MAX_SHEAR_CYCLE = Scalar::new("peak_max_shear_cycle", "cycles before that stress", 0).sometimes().listed();

    /// Instant of the largest shear stress in its cycle.
    PEAK_MAX_SHEAR_PERCENT = Scalar::new("peak_max_shear_percent", "instant of that stress", 1).sometimes().listed();

    /// Largest shear stress of the first cycle. Of the unworn insert.
    FIRST_CYCLE_MAX_SHEAR_MPA = Scalar::new("first_cycle_max_shear_mpa", "largest shear stress, first cycle", 1).sometimes().listed();

    /// Depth of the largest shear stress of the first cycle. Below the surface, to half an element.
    FIRST_CYCLE_MAX_SHEAR_DEPTH_MM = Scalar::new("first_cycle_max_shear_depth_mm", "depth of that stress", 1).sometimes().listed();

    /// Largest permanent set. How far yielding has lowered the surface for good; wear is not included.
    MAX_PERMANENT_SET_MM = Scalar::new("max_permanent_set_mm", "permanent set", 4).sometimes();

    /// Largest permanent set of the first cycle. After the first cycle that repeats itself.
    FIRST_CYCLE_PERMANENT_SET_MM = Scalar::new("first_cycle_permanent_set_mm", "permanent set, first cycle", 4).sometimes();

    /// Largest accumulated plastic strain. At a Gauss point.
    MAX_PLASTIC_STRAIN = Scalar::new("max_plastic_strain", "largest plastic strain", 4).sometimes();

    /// Elements that have yielded.
    YIELDED_ELEMENTS = Scalar::new("yielded_elements", "yielded elements", 0).count().sometimes();

    /// Elements that still yield in every cycle. By a strain of more than 1e-5 in the last cycle; the other yielded
    /// elements have shaken down.
    RATCHETING_ELEMENTS = Scalar::new("ratcheting_elements", "ratcheting elements", 0).count().sometimes();

    /// Largest lift of the backside off the tray. In the last cycle of any update, as all numbers of the backside.
    BACKSIDE_LIFT_MM = Scalar::new("backside_lift_mm", "lift of the backside", 4).sometimes();

    /// Largest part of the backside that lifts at once.
    BACKSIDE_LIFTED_PERCENT = Scalar::new("backside_lifted_percent", "part of the backside that lifts", 0).sometimes();

    /// Longest slip of the backside in a cycle. The path of a node along the tray while it presses, there and back.
    BACKSIDE_SLIP_MM = Scalar::new("backside_slip_mm", "slip of the backside", 4).sometimes();

    /// Largest force on the lock. Along the tray; friction under the insert carries the rest.
    BACKSIDE_LOCK_FORCE_N = Scalar::new("backside_lock_force_n", "force on the lock", 0).sometimes();

    /// Largest moment on the lock. About the vertical axis.
    BACKSIDE_LOCK_MOMENT_NM = Scalar::new("backside_lock_moment_nm", "moment on the lock", 2).sometimes();
}
