//! Rendered messages: limited in number, and harmless to a terminal.

use super::page::schema_markdown;
use super::{assert_shows, parsed, refusal};
use crate::config::{RenderStyle, SYNONYMS};

#[test]
fn of_many_problems_the_first_are_shown_and_the_rest_counted() {
    let keys = |count: usize| (0..count).map(|key| format!("wrong_{key} = 1\n"));
    let shown = |count| refusal(&format!("[march]\n{}", keys(count).collect::<String>()));
    assert!(!shown(20).contains("more problem"));
    assert!(shown(20).contains("`wrong_19`"));
    assert_shows(
        &shown(21),
        &["`wrong_19`", "and 1 more problem; correct these first"],
    );
    let of_many = shown(5000);
    assert_shows(
        &of_many,
        &["`wrong_0`", "`wrong_19`", "and 4980 more problems"],
    );
    assert!(!of_many.contains("`wrong_20`"));
}

#[test]
fn control_characters_of_a_case_do_not_reach_the_terminal() {
    let raw = "[femur]\nfile = \"\u{1b}[31m\"\n";
    let key = "[femur]\n\"a\\u001b[31m\\u009b\" = 1\n";
    let value = "[femur]\nshape = \"mesh\\u001b]0;x\\u0007\"\n";
    let path = "[insert]\nshape = \"mesh\"\nfile = \"\\u001b[2J\\u202e.stl\"\n";
    for text in [raw, key, value, path] {
        let plain = refusal(text);
        let in_colour = parsed(text)
            .unwrap_err()
            .render(RenderStyle::Terminal { width: 100 });
        let from_the_file = [
            "\u{1b}[31m\u{9b}",
            "\u{1b}]0",
            "\u{7}",
            "\u{1b}[2J",
            "\u{202e}",
        ];
        for steering in from_the_file {
            assert!(!in_colour.contains(steering), "{in_colour:?}");
        }
        let steers = |c: char| c.is_control() && c != '\n';
        assert!(!plain.contains(steers), "{plain:?}");
    }
    assert_shows(&refusal(key), &["`a\\u{1b}[31m\\u{9b}`"]);
    assert_shows(&refusal(raw), &[" 2 | file = \"?[31m\""]);
    // A title that is otherwise good would reach pages and tables.
    assert_shows(
        &refusal("title = \"a\\u001b[31m\"\n"),
        &["this text contains the control character \\u{1b}"],
    );
}

#[test]
fn another_word_for_a_key_leads_to_the_key() {
    for (text, key) in [
        ("[contact]\nmu = 0.07\n", "friction"),
        ("[material]\nE = 463\n", "youngs_modulus_mpa"),
        ("[material]\nE_gpa = 0.463\n", "youngs_modulus_mpa"),
        ("[material]\nnu = 0.46\n", "poissons_ratio"),
        ("[wear]\nk = 1e-7\n", "circle_factor_mm3_per_nm"),
        (
            "[wear]\nlaw = \"archard\"\nk = 1e-7\n",
            "wear_factor_mm3_per_nm",
        ),
        ("[machine.springs]\nk_n_per_mm = 7\n", "posterior_n_per_mm"),
        (
            "[femur]\nshape = \"mesh\"\nfile = \"a.stl\"\nunit = \"m\"\n",
            "length_unit",
        ),
        (
            "[femur]\nshape = \"mesh\"\nfile = \"a.stl\"\nunit_mm = 1000\n",
            "length_unit",
        ),
    ] {
        assert_shows(&refusal(text), &[&format!("did you mean `{key}`?")]);
    }
}

#[test]
fn every_key_that_has_another_word_is_a_key() {
    let page = schema_markdown(condyle::wear::WEAR_LAWS);
    for (_, key) in SYNONYMS {
        assert!(page.contains(&format!("| `{key}` |")), "{key}");
    }
}
