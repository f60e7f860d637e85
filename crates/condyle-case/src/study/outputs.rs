//! The outputs of the tests of a study: those of the catalogue, and those that the study computes by formulas.

use std::cell::RefCell;

use condyle::machine::TestedJoint;
use condyle_results::{
    catalogue::{self, Scalar},
    split_unit,
};

use super::declared::OutputKeys;
use super::input::check_count;
use crate::case::Case;
use crate::config::*;

/// Columns of the table of tests that are neither inputs nor outputs.
const OTHER_COLUMNS: [&str; 5] = ["row", "design", "status", "reason", "checksum"];
/// Largest number of characters of a formula: parentheses are read by recursion, on the stack of a thread.
const MAX_CHARACTERS: usize = 500;

/// The outputs of every test of a study.
#[derive(Clone, Debug, Default)]
pub struct Outputs {
    joint: TestedJoint,
    formulas: Vec<Formula>,
}

/// An output that a formula computes from the numbers of a run.
#[derive(Clone, Debug)]
struct Formula {
    output: &'static Scalar,
    text: String,
}

peg::parser! {
    /// Formulas with `+ - * / ^`, parentheses and a few functions; `value` returns the number with a name.
    grammar arithmetic() for str {
        rule _ = quiet!{ [' ']* }
        rule digits() = ['0'..='9']+
        rule number() -> f64
            = text:$(digits() ("." digits())? (['e' | 'E'] ['+' | '-']? digits())?) {? text.parse().or(Err("a number")) }
        rule name() -> &'input str = $(['a'..='z' | 'A'..='Z' | '_'] ['a'..='z' | 'A'..='Z' | '0'..='9' | '_']*)
        rule inner(value: &dyn Fn(&str) -> f64) -> f64 = "(" _ inner:sum(value) _ ")" { inner }
        rule two(value: &dyn Fn(&str) -> f64) -> [f64; 2]
            = "(" _ one:sum(value) _ "," _ other:sum(value) _ ")" {
                // An unknown number stays unknown.
                if one.is_nan() || other.is_nan() { [f64::NAN; 2] } else { [one, other] }
            }
        rule sum(value: &dyn Fn(&str) -> f64) -> f64 = precedence! {
            one:(@) _ "+" _ other:@ { one + other }
            one:(@) _ "-" _ other:@ { one - other }
            --
            one:(@) _ "*" _ other:@ { one * other }
            one:(@) _ "/" _ other:@ { one / other }
            --
            "-" _ one:@ { -one }
            --
            one:@ _ "^" _ other:(@) { one.powf(other) }
            --
            number:number() { number }
            "sqrt" of:inner(value) { of.sqrt() }
            "abs" of:inner(value) { of.abs() }
            "exp" of:inner(value) { of.exp() }
            "ln" of:inner(value) { of.ln() }
            "min" of:two(value) { of[0].min(of[1]) }
            "max" of:two(value) { of[0].max(of[1]) }
            name:name() { value(name) }
            inner:inner(value) { inner }
        }
        pub rule formula(value: &dyn Fn(&str) -> f64) -> f64 = _ sum:sum(value) _ { sum }
    }
}

impl Formula {
    fn value(&self, number: &dyn Fn(&str) -> f64) -> f64 {
        let given = number(self.output.key);
        if given.is_finite() {
            return given;
        }
        arithmetic::formula(&self.text, number).unwrap_or(f64::NAN)
    }
}

impl Outputs {
    /// Returns all outputs, in the order of the table.
    pub fn all(&self) -> impl Iterator<Item = &'static Scalar> {
        catalogue::outputs().chain(self.formulas.iter().map(|one| one.output))
    }

    /// Returns the output with this key.
    pub fn get(&self, key: &str) -> Option<&'static Scalar> {
        self.all().find(|output| output.key == key)
    }

    /// Returns the value of an output among those of a test; NaN if the test does not have it.
    pub fn value(&self, values: &[f64], output: &Scalar) -> f64 {
        let place = self.all().position(|one| one == output);
        place.map_or(f64::NAN, |place| values[place])
    }

    /// Returns the values of all outputs of a test whose results `number` returns by their keys, NaN for those that it does
    /// not have. A formula is computed unless its own value is among them, as that of a laboratory may be.
    pub fn values(&self, number: &dyn Fn(&str) -> f64) -> Vec<f64> {
        let computed = self.formulas.iter().map(|formula| formula.value(number));
        let plain = catalogue::outputs().map(|output| number(output.key));
        plain.chain(computed).collect()
    }

    /// Returns the formulas, each with the key of its output, on which the values of the tests depend.
    pub(super) fn formulas(&self) -> impl Iterator<Item = (&str, &str)> {
        let all = self.formulas.iter();
        all.map(|formula| (formula.output.key, formula.text.as_str()))
    }

    pub(super) fn read(root: &Section<'_>, case: &Case, log: &mut Log<'_>) -> Option<Self> {
        let joint = case.tested_joint();
        let listed = root.list("output", log)?;
        check_count("outputs", listed.len(), root.key_span("output"), log)?;
        let mut outputs = Self {
            joint,
            formulas: Vec::new(),
        };
        let mut is_read = true;
        for section in &listed {
            let formula = outputs.formula(section, log);
            is_read &= formula.is_some();
            outputs.formulas.extend(formula);
        }
        is_read.then_some(outputs)
    }

    fn formula(&self, section: &Section<'_>, log: &mut Log<'_>) -> Option<Formula> {
        let keys = OutputKeys::read_checked(section, log)?;
        let name = keys.name.as_str();
        let is_taken = catalogue::scalar(name).is_some()
            || self.get(name).is_some()
            || OTHER_COLUMNS.contains(&name);
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if is_taken || name.is_empty() || !name.chars().all(is_word) {
            let message = if is_taken {
                format!("every test has a column `{name}` already")
            } else {
                format!("`{name}` is not a valid name of an output")
            };
            let advice = "use letters, digits and `_`, with the unit at the end, such as `mass_per_million_mg`";
            return log.reject(section.value_span("name"), Fault::new(message, advice));
        }
        if keys.formula.chars().count() > MAX_CHARACTERS {
            let message = format!("a formula has at most {MAX_CHARACTERS} characters");
            let fault = Fault::new(
                message,
                "shorten it, or compute it from the table afterwards",
            );
            return log.reject(section.value_span("formula"), fault);
        }
        let names = RefCell::new(Vec::new());
        let read = arithmetic::formula(&keys.formula, &|name: &str| {
            names.borrow_mut().push(name.to_owned());
            1.0
        });
        if let Err(error) = read {
            let place = error.location.column;
            let message = format!("the formula cannot be read from its character {place} on");
            let advice = "write numbers and results such as `mass_loss_mg / 5`, with + - * / ^, parentheses, \
                          sqrt(), abs(), exp(), ln(), min(,) and max(,)";
            return log.reject(section.value_span("formula"), Fault::new(message, advice));
        }
        let numbers: Vec<&'static Scalar> = catalogue::results().collect();
        let mut known = names.into_inner().into_iter();
        let is_known = known.all(|name| {
            self.checked(&name, &numbers, "formula", section, log)
                .is_some()
        });
        is_known.then(|| Formula {
            output: leaked(&keys.name),
            text: keys.formula,
        })
    }

    /// Returns the output with the name that `section` has at `key`.
    pub(super) fn named(
        &self,
        name: &str,
        key: &str,
        section: &Section<'_>,
        log: &mut Log<'_>,
    ) -> Option<&'static Scalar> {
        let all: Vec<&'static Scalar> = self.all().collect();
        self.checked(name, &all, key, section, log)
    }

    /// Returns the one of `all` with this name. Reports an unknown name, and a number that the joint of the case does not have.
    fn checked(
        &self,
        name: &str,
        all: &[&'static Scalar],
        key: &str,
        section: &Section<'_>,
        log: &mut Log<'_>,
    ) -> Option<&'static Scalar> {
        let own = |scalar: &&&'static Scalar| scalar.applies_to(Some(self.joint));
        let found = all.iter().find(|scalar| scalar.key == name);
        if let Some(scalar) = found.filter(own) {
            return Some(scalar);
        }
        let keys: Vec<&str> = all.iter().filter(own).map(|scalar| scalar.key).collect();
        let outputs = keys.join(", ");
        let advice = match likeliest(name, &keys) {
            Some(near) if found.is_none() => format!("did you mean `{near}`? It can be {outputs}"),
            _ => format!("it can be {outputs}"),
        };
        let message = match found {
            Some(_) => format!("a test of this joint has no `{name}`"),
            None => format!("a run has no output `{name}`"),
        };
        log.reject(section.value_span(key), Fault::new(message, advice))
    }
}

/// Returns an output outside the catalogue. It lives as long as the program, as those of the catalogue do, so that all
/// answers can refer to it.
fn leaked(name: &str) -> &'static Scalar {
    let key: &'static str = Box::leak(name.to_owned().into_boxed_str());
    let label: String = split_unit(key).0.replace('_', " ");
    Box::leak(Box::new(Scalar::new(
        key,
        Box::leak(label.into_boxed_str()),
        3,
        |_| f64::NAN,
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_formulas_by_the_rules_of_arithmetic() {
        let number = |name: &str| match name {
            "a" => 2.0,
            "min_b" => 3.0,
            _ => f64::NAN,
        };
        for (text, expected) in [
            ("1 - 2 - 3", -4.0),
            (" 8/2/2*a ", 4.0),
            ("-a^2", -4.0),
            ("2^3^a", 512.0),
            ("(1 + min_b) * 1.5e1", 60.0),
            ("min(a, min_b) + max(a,min_b) - abs(-1)", 4.0),
            ("sqrt(a*8) * ln(exp(2))", 8.0),
        ] {
            let found = arithmetic::formula(text, &number).unwrap();
            assert!((found - expected).abs() < 1e-12, "{text}: {found}");
        }
        let deep = format!("{}1{}", "(".repeat(249), ")".repeat(249));
        assert_eq!(arithmetic::formula(&deep, &number), Ok(1.0));
        for (text, column) in [
            ("", 1),
            ("a + ", 5),
            ("a b", 3),
            ("(a", 3),
            ("a ** 2", 4),
            ("min(a)", 6),
        ] {
            let error = arithmetic::formula(text, &number).unwrap_err();
            assert_eq!(error.location.column, column, "{text}");
        }
        for text in ["a / unknown", "min(1, unknown)", "max(unknown, 1)"] {
            assert!(
                arithmetic::formula(text, &number).unwrap().is_nan(),
                "{text}"
            );
        }
        assert!(
            arithmetic::formula("a / unknown", &number)
                .unwrap()
                .is_nan()
        );
    }

    #[test]
    fn formulas_are_computed_unless_their_value_is_given() {
        let output = leaked("twice_mg");
        let text = "2 * mass_loss_mg".to_owned();
        let formulas = vec![Formula { output, text }];
        let outputs = Outputs {
            joint: TestedJoint::Knee,
            formulas,
        };
        assert_eq!((output.label, output.unit()), ("twice", "mg"));
        for (given, expected) in [(f64::NAN, 20.0), (21.0, 21.0)] {
            let values = outputs.values(&|key| match key {
                "mass_loss_mg" => 10.0,
                "twice_mg" => given,
                _ => f64::NAN,
            });
            assert_eq!(outputs.value(&values, output), expected);
        }
    }
}
