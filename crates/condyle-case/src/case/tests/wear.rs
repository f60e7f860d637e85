//! A wear law that condyle does not have, added in one place.

use std::path::Path;
use std::sync::Arc;

use condyle::contact::Moment;
use condyle::parameter::{Known, Parameter};
use condyle::wear::{MeanCycle, NodeWear, WEAR_LAWS, WearLaw, WearLawKind};

use super::page::schema_markdown;
use super::{assert_shows, pressed_once};
use crate::case::{Case, CaseReader, ConstantError, Wear, WearLaws};

/// Wear that begins at a pressure: depth per cycle = a (sum of p |ds| - b), 0 or more.
#[derive(Debug)]
struct Threshold {
    wear_factor_mm3_per_nm: f64,
    from_n_per_mm: f64,
}

impl WearLaw for Threshold {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let above = cycle.pressure_slip_mpa_mm - self.from_n_per_mm;
        NodeWear::of_depth(self.wear_factor_mm3_per_nm / 1000.0 * above.max(0.0))
    }
}

const THRESHOLD: WearLawKind = WearLawKind {
    word: "threshold",
    about: "Depth per cycle = a (sum of p |ds| - b).",
    known: Known::Chosen,
    parameters: &[
        Parameter {
            name: "factor_mm3_per_nm",
            about: "Factor a on the work of friction.",
            default: 3e-7,
            least: 0.0,
            most: 1e-3,
            source: "choice",
            known: Known::Chosen,
        },
        Parameter {
            name: "from_n_per_mm",
            about: "Work b below which nothing wears.",
            default: 20.0,
            least: 0.0,
            most: 1000.0,
            source: "choice",
            known: Known::Chosen,
        },
    ],
    scaled: |constants, times| vec![times * constants[0], constants[1]],
    make: |constants| {
        Arc::new(Threshold {
            wear_factor_mm3_per_nm: constants[0],
            from_n_per_mm: constants[1],
        })
    },
};

/// Archard's law and the new one.
const LAWS: WearLaws = &[WEAR_LAWS[1], &THRESHOLD];

fn read(text: &str) -> Result<Case, String> {
    let reader = CaseReader {
        wear_laws: LAWS,
        ..CaseReader::default()
    };
    let case = reader.parse(text, "case.toml", Path::new(""));
    case.map_err(|problems| problems.to_string())
}

const CASE: &str = "[insert]\nedge_mm = 6.0\n[wear]\nlaw = \"threshold\"\nfrom_n_per_mm = 40.0\n";

#[test]
fn a_law_with_two_constants_is_read_with_its_defaults() {
    let wear = read(CASE).unwrap().wear;
    assert_eq!(wear.kind().word, "threshold");
    assert_eq!(wear.constant("factor_mm3_per_nm"), Ok(3e-7));
    assert_eq!(wear.constant("from_n_per_mm"), Ok(40.0));
    assert_eq!(read("").unwrap().wear, Wear::new(WEAR_LAWS[1]));
}

#[test]
fn it_is_written_and_reads_back() {
    let case = read(CASE).unwrap();
    let text = case.to_toml();
    assert_shows(
        &text,
        &[
            "[wear]\nlaw = \"threshold\"  ",
            " # Wear law.\n",
            "factor_mm3_per_nm = 3e-7  ",
            " # Factor a on the work of friction.\n",
            "from_n_per_mm = 40.0  ",
            " # Work b below which nothing wears.\n",
        ],
    );
    assert_eq!(read(&text).unwrap(), case);
}

#[test]
fn its_keys_are_checked_as_all_others() {
    let refusal = |keys: &str| read(&format!("[wear]\n{keys}\n")).unwrap_err();
    assert_shows(
        &refusal("from_n_per_mm = 40.0"),
        &[
            "`from_n_per_mm` belongs to law = \"threshold\", but this case has law = \"archard\"",
            "help: remove it, or write `law = \"threshold\"`",
        ],
    );
    let threshold = |key: &str| refusal(&format!("law = \"threshold\"\n{key}"));
    assert_shows(
        &threshold("from_n_per_mm = -1.0"),
        &["-1 N/mm, outside its range", "it can be 0 to 1000 N/mm"],
    );
    assert_shows(
        &threshold("from_n_per_m = 1.0"),
        &["the key is `from_n_per_mm`, in N/mm"],
    );
    assert_shows(
        &refusal("law = \"treshold\""),
        &["did you mean \"threshold\"? It can be \"archard\" or \"threshold\""],
    );
}

#[test]
fn its_keys_are_on_the_page() {
    assert_shows(
        &schema_markdown(LAWS),
        &[
            "| `law` |  | \"archard\" or \"threshold\" | `\"archard\"` | Wear law. |",
            "With `law = \"threshold\"`:",
            "| `from_n_per_mm` | N/mm | a number, 0 to 1000 | `20.0` | Work b below which",
            "- `threshold`: Depth per cycle = a (sum of p |ds| - b). Sources of the constants, in the order of the table: \
             choice, choice.",
        ],
    );
}

#[test]
fn verify_the_test_wears_by_it() {
    let test = read(CASE).unwrap().build(1).unwrap().test;
    let history = pressed_once(Moment {
        pressure_mpa: 10.0,
        slip_mm: [10.0, 0.0],
    });
    let shared = [(1.0, &history)];
    let depth = |law: &dyn WearLaw| law.wear(&MeanCycle::new(&shared, 0, 1.0)).depth_mm;
    let found = depth(test.wear.as_ref());
    assert!((found - 3e-10 * 60.0).abs() < 1e-20, "{found:e}");
}

#[test]
fn it_is_evaluated_for_comparison_with_another_law() {
    let words = |case: &str| -> Vec<&str> {
        let test = read(case).unwrap().build(1).unwrap().test;
        test.comparison_laws.iter().map(|law| law.word).collect()
    };
    assert_eq!(words("[insert]\nedge_mm = 6.0\n"), ["threshold"]);
    assert_eq!(words(CASE), ["archard"]);
}

#[test]
fn constants_quoted_from_memory_are_called_approximate() {
    let kang = Case::parse("[wear]\nlaw = \"kang\"\n", "case.toml", Path::new("")).unwrap();
    assert_shows(
        &kang.to_toml(),
        &[
            "cross_shear_exponent = 0.19 ",
            " # Constant b: the power of the cross-shear ratio. The default is approximate.\n",
        ],
    );
    assert_shows(
        &schema_markdown(WEAR_LAWS),
        &[
            "[kang2008] (approximate)",
            "The formula is approximate: quoted from memory",
        ],
    );
}

#[test]
fn a_constant_that_is_unknown_or_out_of_range_is_refused() {
    let archard = || Wear::new(WEAR_LAWS[1]);
    let missing = archard().constant("from_n_per_mm").unwrap_err();
    assert_eq!(
        missing.to_string(),
        "the wear law \"archard\" has no `from_n_per_mm`; use a case whose law has it"
    );
    let beyond = archard().with_constant("wear_factor_mm3_per_nm", 0.5);
    let beyond: ConstantError = beyond.unwrap_err();
    assert_eq!(
        beyond.to_string(),
        "`wear_factor_mm3_per_nm` is 5e-1; it must be 0 to 0.001"
    );
    let changed = archard().with_constant("wear_factor_mm3_per_nm", 1e-6);
    let changed = changed.unwrap();
    assert_eq!(changed.constant("wear_factor_mm3_per_nm"), Ok(1e-6));
}
