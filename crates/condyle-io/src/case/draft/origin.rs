//! Where a draft puts the origin of an insert.

use condyle::geometry::TriangleMesh;

use crate::case::build::{MAX_ACROSS_MM, middle_of_mesh};

/// An origin so far in front of the dishes' middle, or behind it, is not that of a machine, mm.
const FAR_ALONG_MM: f64 = 20.0;

/// Where the origin of an insert frame is.
pub(super) struct ConcludedOrigin {
    pub key: &'static str,
    pub remark: Option<String>,
}

impl ConcludedOrigin {
    /// That of the file, unless the dishes lie off it; then between them, where the insert is moved to.
    pub fn centred(insert: &mut TriangleMesh) -> Self {
        let middle = middle_of_mesh(insert);
        // Flat dishes are lowest at no certain place along: only what is far off is taken for another origin.
        let is_far = middle.z.abs() > MAX_ACROSS_MM || middle.x.abs() > FAR_ALONG_MM;
        if !is_far {
            return Self {
                key: "",
                remark: None,
            };
        }
        *insert = std::mem::take(insert).mapped(|vertex| vertex - middle);
        let remark = format!(
            "  origin \"centre\", since the file has its own {:.0} mm from the middle of the dishes.",
            middle.norm()
        );
        Self {
            key: "origin = \"centre\"\n",
            remark: Some(remark),
        }
    }
}
