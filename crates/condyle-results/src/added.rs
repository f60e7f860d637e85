//! Files that other commands add to the folder of a run; a run that replaces it removes them.

/// Files that a command writes into its own folder among the results.
#[derive(Clone, Copy, Debug)]
pub struct AddedFiles {
    /// The folder, inside the folder of the run.
    pub folder: &'static str,
    /// Files without their endings.
    pub names: &'static [&'static str],
    /// Endings that each may have.
    pub endings: &'static [&'static str],
}

/// Names of the maps that `condyle plot` draws, without endings.
pub const MAP_PICTURES: [&str; 6] = [
    "wear_map",
    "peak_pressure_map",
    "sliding_distance_map",
    "cross_shear_map",
    "creep_map",
    "permanent_set_map",
];
/// Name of its picture of slip paths.
pub const SLIP_PATHS_PICTURE: &str = "slip_paths";
/// Name of its curves over cycles.
pub const WEAR_PICTURE: &str = "wear";
/// Name of its curves over the gait cycle.
pub const KINEMATICS_PICTURE: &str = "kinematics";

/// Files of `condyle plot`.
pub const PLOTTED: AddedFiles = AddedFiles {
    folder: "pictures",
    names: &[
        MAP_PICTURES[0],
        MAP_PICTURES[1],
        MAP_PICTURES[2],
        MAP_PICTURES[3],
        MAP_PICTURES[4],
        MAP_PICTURES[5],
        SLIP_PATHS_PICTURE,
        WEAR_PICTURE,
        KINEMATICS_PICTURE,
    ],
    endings: &["svg", "png"],
};

/// Motion compared with measurements.
pub const COMPARED_KINEMATICS: &str = "compare_kinematics";
/// Surface compared with measurements.
pub const COMPARED_SURFACE: &str = "compare_surface";
/// Mass compared with measurements.
pub const COMPARED_WEAR: &str = "compare_wear";
/// All numbers of a comparison.
pub const COMPARED_NUMBERS: &str = "compare";

/// Files of `condyle compare`.
pub const COMPARED: AddedFiles = AddedFiles {
    folder: "compare",
    names: &[
        COMPARED_NUMBERS,
        COMPARED_KINEMATICS,
        COMPARED_SURFACE,
        COMPARED_WEAR,
    ],
    endings: &["json", "csv", "svg"],
};

impl AddedFiles {
    /// Returns all files that may exist, by their paths in the folder of the run.
    pub fn paths(&self) -> impl Iterator<Item = String> {
        let of = move |name| {
            let endings = self.endings.iter();
            endings.map(move |ending| format!("{}/{name}.{ending}", self.folder))
        };
        self.names.iter().flat_map(of)
    }
}
