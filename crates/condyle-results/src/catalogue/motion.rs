//! Motion and loads of the first cycle.

use condyle::machine::knee::{AP, IE, KNEE};

use crate::parts::{joint_range, medial_load_share};

use super::{Scalar, scalar::scalars};

scalars! { "Motion";
    /// Range of AP in the first cycle. Largest minus smallest position of the insert, in the first activity.
    AP_RANGE_MM = Scalar::new("ap_range_mm", "AP range, first cycle", 2, |run| joint_range(run.first_cycle, &KNEE, AP))
        .headline()
        .estimated()
        .of_knee();

    /// Range of IE in the first cycle. Largest minus smallest rotation of the insert, in the first activity.
    IE_RANGE_DEG = Scalar::new("ie_range_deg", "IE range, first cycle", 2, |run| joint_range(run.first_cycle, &KNEE, IE))
        .headline()
        .estimated()
        .of_knee();

    /// Medial part of the axial force. Averaged over the first cycle of the first activity, weighted by force.
    MEDIAL_LOAD_SHARE = Scalar::new("medial_load_share", "medial load share", 1, |run| medial_load_share(run.first_cycle))
        .headline()
        .share()
        .of_knee();
}
