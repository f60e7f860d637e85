//! Polyethylene of a case.

use condyle::contact::Moment;
use condyle::wear::{MeanCycle, WearLaw};

use super::{assert_shows, parsed, pressed_once, refusal};

const HIGH: &str = "[insert]\nedge_mm = 6.0\n[material]\ncross_linking = \"high\"\n";

#[test]
fn cross_linked_polyethylene_is_read_written_and_reads_back() {
    let times = |text: &str| {
        let case = parsed(text).unwrap();
        assert_eq!(parsed(&case.to_toml()).unwrap(), case);
        case.material.cross_linking.wear_over_conventional()
    };
    assert_eq!(times(""), None);
    assert_eq!(times(HIGH), Some(0.2));
    assert_eq!(times(&HIGH.replace("\"high\"", "\"moderate\"")), Some(0.5));
    assert_eq!(
        times(&format!("{HIGH}wear_over_conventional = 0.095\n")),
        Some(0.095)
    );
}

#[test]
fn a_factor_out_of_range_or_of_conventional_polyethylene_is_refused() {
    assert_shows(
        &refusal(&format!("{HIGH}wear_over_conventional = 0.0\n")),
        &["0, outside its range", "it can be 0.001 to 2"],
    );
    assert_shows(
        &refusal("[material]\nwear_over_conventional = 0.2\n"),
        &["`wear_over_conventional` belongs to cross_linking = "],
    );
    assert_shows(
        &refusal("[material]\ncross_linking = \"hihg\"\n"),
        &["did you mean \"high\"? It can be \"none\", \"moderate\" or \"high\""],
    );
}

#[test]
fn verify_every_law_of_the_test_is_multiplied_by_the_factor() {
    let history = pressed_once(Moment {
        pressure_mpa: 5.0,
        slip_mm: [3.0, 1.0],
    });
    let depth = |law: &dyn WearLaw| {
        law.wear(&MeanCycle::new(&[(1.0, &history)], 0, 1.0))
            .depth_mm
    };
    let depths = |text: &str| -> Vec<f64> {
        let test = parsed(text).unwrap().build(1).unwrap().test;
        let others = test.comparison_laws.iter().map(|named| named.law.as_ref());
        let laws = std::iter::once(test.wear.as_ref()).chain(others);
        laws.map(depth).collect()
    };
    let conventional = depths("[insert]\nedge_mm = 6.0\n");
    let times = |depth: &f64| 0.2 * depth;
    assert_eq!(
        depths(HIGH),
        conventional.iter().map(times).collect::<Vec<_>>()
    );
    assert_eq!(conventional.len(), 6);
}
