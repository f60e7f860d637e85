//! The study of Knight 2007, on a mesh too coarse for its numbers to mean anything.

use std::{fs, ops::ControlFlow, path::Path};

use condyle_knight_2007::{Stamp, StudyError, StudyFiles, study};

const FORCE: &str = "\
[insert]
edge_mm = 4.0
layers = 1
[march]
cycles = 400_000
[time]
increments = 20
[wear]
law = \"archard\"
";

const DISPLACEMENT: &str = "\
[machine]
preset = \"stanmore-displacement\"
[machine.ap_motion]
file = \"ap-motion.csv\"
[machine.ie_motion]
file = \"ie-motion.csv\"
";

fn files(folder: &Path) -> StudyFiles {
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::write(&path, text).expect("the folder can be written");
        path
    };
    StudyFiles {
        force_case: write("force.toml", FORCE),
        displacement_case: write("displacement.toml", &format!("{DISPLACEMENT}{FORCE}")),
        runs: folder.join("runs"),
        out: folder.to_owned(),
    }
}

fn stamp() -> Stamp {
    Stamp {
        commit: "abcdef".to_owned(),
        date: "2026-01-01".to_owned(),
    }
}

#[test]
fn every_figure_of_the_paper_has_its_row_and_the_files_are_there() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let table = study(&files(folder.path()), &stamp(), &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("the runs work");
    for what in [
        "from commit abcdef",
        "| volume against update interval |",
        "| pressure, area |",
        "| maximum depth, 500k to 125k |",
        "| oscillation of maximum depth |",
        "| kinematics, force control against measured |",
        "| change of kinematics by 5 million |",
        "| volume in cycles |",
        "| wear, force against displacement control |",
        "| posterior shift by 5 million |",
        "| wear against the specimens |",
        "| maximum depth over time, force against displacement control |",
        "| scars |",
        "| lateral scar to the posterior edge |",
        "| cost of 10 x 500k |",
    ] {
        assert!(table.contains(what), "{what} in\n{table}");
    }
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    assert_eq!(read("results.md"), table);
    let json: serde_json::Value = serde_json::from_str(&read("results.json")).expect("JSON");
    let findings = &json["findings"];
    for control in ["displacement_intervals", "force_intervals"] {
        let volumes = findings[control]["volume_loss_mm3"].as_array();
        assert_eq!(volumes.map(Vec::len), Some(6));
    }
    let mass = |name: &str| findings[name].as_f64().expect(name);
    assert!(mass("mass_force_mg") > 0.0);
    assert!((mass("mass_displacement_mg") / mass("mass_force_mg") - 1.0).abs() < 0.2);
    assert!(read("wear-map.svg").starts_with("<svg"));
    assert!(read("wear-over-cycles.svg").contains("Deepest wear, 5 updates"));
    let motion = read("ap-motion.csv");
    assert!(motion.starts_with("percent,ap_mm\n5,") && motion.lines().count() == 21);
}

#[test]
fn runs_that_are_there_already_are_not_written_over() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let files = files(folder.path());
    fs::create_dir_all(files.runs.join("force/mine")).expect("a folder can be made");
    let error = study(&files, &stamp(), &mut |_| ControlFlow::Continue(()))
        .expect_err("the folder is not empty");
    assert!(matches!(error, StudyError::Converge(_)), "{error}");
    assert!(
        error.to_string().contains("the folder is not empty"),
        "{error}"
    );
}

#[test]
fn a_study_can_be_stopped() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let files = files(folder.path());
    let stopped = study(&files, &stamp(), &mut |_| ControlFlow::Break(()));
    let error = stopped.expect_err("it was stopped");
    assert_eq!(error.to_string(), "interrupted");
    assert!(!folder.path().join("results.md").exists());
}
