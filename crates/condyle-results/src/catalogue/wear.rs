//! Wear.

use super::{Scalar, scalar::scalars};

scalars! { "Wear";
    /// Cycles of the test.
    CYCLES = Scalar::new("cycles", "cycles", 0, |run| run.last.cycles)
        .exact()
        .printed();

    /// Worn mass. Volume loss from depth times the density of the material.
    MASS_LOSS_MG = Scalar::new("mass_loss_mg", "mass loss", 2, |run| run.last.mass_loss_mg)
        .headline()
        .estimated();

    /// Worn volume, from depth. Depth times area, summed over the updates; mass is computed from it.
    VOLUME_LOSS_MM3 = Scalar::new("volume_loss_mm3", "volume loss", 2, |run| run.last.volume_loss_mm3);

    /// Worn volume, from the mesh. Volume of the unworn mesh minus those of the worn mesh and of creep; it checks the volume from depth.
    VOLUME_LOSS_MESH_MM3 = Scalar::new("volume_loss_mesh_mm3", "volume loss from the mesh", 2, |run| run.last.volume_loss_mesh_mm3)
        .printed()
        .continued();

    /// Wear depth at the deepest node. Along the normals, from the unworn surface.
    MAX_DEPTH_MM = Scalar::new("max_depth_mm", "deepest wear", 4, |run| run.last.max_depth_mm)
        .headline()
        .estimated();

    /// Wear of cross-linked relative to conventional polyethylene. A factor on every wear law, since all are fitted to conventional polyethylene.
    WEAR_OVER_CONVENTIONAL = Scalar::sometimes("wear_over_conventional", "cross-linked over conventional", 3, |run| run.facts.wear_over_conventional)
        .exact()
        .listed();
}
