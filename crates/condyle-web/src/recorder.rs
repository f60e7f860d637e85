//! Records of a run for the page.

use std::path::Path;

use condyle::{evolve::March, geometry::TriangleMesh};
use condyle_case::case::Side;
use condyle_lab::RunKeeper;
use condyle_report::{
    Results, Table,
    scene::{Scene, SceneCycle},
};
use condyle_results::{
    InsertFields, KeptCycle, NeutralPose, Summary, cycle_pressure_csv, cycle_pressure_file,
    femur_on_side, femur_pose_csv, kinematics_csv, wear_csv,
};

/// Records the scene of a run that its results folder would give.
pub struct Recorder {
    side: Side,
    scene: Scene,
    pressures: Vec<Table>,
}

impl Recorder {
    pub fn new(side: Side) -> Self {
        Self {
            side,
            scene: Scene::default(),
            pressures: Vec::new(),
        }
    }

    pub fn into_scene(mut self, neutral_pose: Option<NeutralPose>) -> Scene {
        self.scene.neutral_pose = neutral_pose;
        self.scene
    }

    fn add_update(&mut self, march: &March) {
        let fields = InsertFields::of(march, self.side);
        let cycles = march.cycles();
        let scalars = fields.scalars.iter();
        let scalars = scalars.map(|(name, values)| (*name, values.as_slice()));
        self.scene.add_update(cycles, &fields.mesh.nodes, scalars);
    }

    fn add_pressures(&mut self, march: &March) {
        for cycle in KeptCycle::solved_by(march) {
            let text = cycle_pressure_csv(march).unwrap_or_default();
            self.pressures
                .push(table(&text, &cycle_pressure_file(cycle)));
        }
    }

    fn add_tables(&mut self, march: &March) {
        let mechanism = march.test().machine().mechanism;
        let kinematics = kinematics_csv(march, 0);
        let poses = femur_pose_csv(march, self.side);
        self.scene.cycles = SceneCycle::of_poses(&table(&poses, "femur_pose.csv"));
        for (cycle, pressures) in self.scene.cycles.iter_mut().zip(&self.pressures) {
            cycle.add_pressures(pressures);
        }
        let wear = wear_csv(&march.state().updates);
        self.scene.add_charts(&Results {
            wear: Some(table(&wear, "wear.csv")),
            kinematics: Some(table(&kinematics, "kinematics.csv")),
            // Charts have the headings of the machine.
            summary: Some(Summary::of_machine(mechanism)),
            ..Results::default()
        });
    }
}

impl RunKeeper for Recorder {
    fn settled(&mut self, march: &March, femur: &TriangleMesh) {
        let fields = InsertFields::of(march, self.side);
        let marks: Vec<f64> = fields
            .articulating
            .iter()
            .map(|&mark| mark.into())
            .collect();
        self.scene = Scene::of_insert(&fields.mesh, &marks).unwrap_or_default();
        let femur = femur_on_side(femur, &march.neutral_pose(), self.side);
        // As `femur.vtu` has its places: in 32 bits.
        let rounded = |place: f64| f64::from(place as f32);
        self.scene.femur = Some(femur.mapped(|place| place.map(rounded)));
        self.add_update(march);
    }

    fn updated(&mut self, march: &March) {
        self.add_pressures(march);
        // The fields after the last update are those of the final cycle, which comes next.
        if !march.is_worn() || march.is_done() {
            self.add_update(march);
        }
        if march.is_done() {
            self.add_tables(march);
        }
    }
}

fn table(text: &str, name: &str) -> Table {
    Table::parse(text, Path::new(name)).expect("a table that condyle writes reads back")
}
