//! Wear.

use super::{Scalar, scalar::scalars};

scalars! { "Wear";
    /// Cycles that the insert has gone through.
    CYCLES = Scalar::new("cycles", "cycles", 0, |run| run.last.cycles)
        .exact()
        .printed();

    /// Mass worn. Volume loss, from depth, times the density of the material.
    MASS_LOSS_MG = Scalar::new("mass_loss_mg", "mass loss", 2, |run| run.last.mass_loss_mg)
        .headline()
        .estimated();

    /// Volume worn, from depth. Each update's depth times the area that it wore; mass is computed from it.
    VOLUME_LOSS_MM3 = Scalar::new("volume_loss_mm3", "volume loss", 2, |run| run.last.volume_loss_mm3);

    /// Volume worn, from the mesh. Volume of the unworn mesh less that of the worn one, less the volume of creep: it
    /// checks the volume from depth.
    VOLUME_LOSS_MESH_MM3 = Scalar::new("volume_loss_mesh_mm3", "volume loss from the mesh", 2, |run| run.last.volume_loss_mesh_mm3)
        .printed()
        .continued();

    /// Wear depth at the deepest node. Measured along the normals of the surface, from the unworn surface.
    MAX_DEPTH_MM = Scalar::new("max_depth_mm", "deepest wear", 4, |run| run.last.max_depth_mm)
        .headline()
        .estimated();

    /// Wear of cross-linked over conventional polyethylene. Every wear law, fitted to conventional polyethylene, is
    /// multiplied by it.
    WEAR_OVER_CONVENTIONAL = Scalar::sometimes("wear_over_conventional", "cross-linked over conventional", 3, |run| run.facts.wear_over_conventional)
        .exact()
        .listed();
}
