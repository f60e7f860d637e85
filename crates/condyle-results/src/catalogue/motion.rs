//! Motion and loads of the first cycle.

use super::{Scalar, scalar::scalars};

scalars! { "Motion";
    /// Range of AP in the first cycle. Largest less smallest position of the insert, of the first activity.
    AP_RANGE_MM = Scalar::new("ap_range_mm", "AP range", 2)
        .headline().estimated().of_knee();

    /// Range of IE in the first cycle. Largest less smallest rotation of the insert, of the first activity.
    IE_RANGE_DEG = Scalar::new("ie_range_deg", "IE range", 2)
        .headline().estimated().of_knee();

    /// Medial part of the axial force. Averaged over the first cycle of the first activity, weighted by force.
    MEDIAL_LOAD_SHARE = Scalar::new("medial_load_share", "medial load share", 1).headline().share().of_knee();
}
