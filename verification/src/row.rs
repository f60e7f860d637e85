//! One number held against its exact value.

/// How far a number is from its exact value, and how far it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Measure {
    /// Part of the exact value.
    Relative,
    /// In the unit of the quantity.
    Absolute,
}

/// How fast an error falls as the discretisation is refined: with this power of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// What theory says.
    pub expected: f64,
    /// What was found.
    pub observed: f64,
    /// Largest difference of the two that is accepted.
    pub band: f64,
}

/// One number held against its exact value.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What it is, and of what.
    pub quantity: String,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// The exact value.
    pub exact: f64,
    /// What condyle says.
    pub computed: f64,
    /// Largest accepted error: a part of the exact value, or in the unit.
    pub tolerance: f64,
    /// The order of convergence, where there is one.
    pub order: Option<Order>,
    measure: Measure,
}

impl Row {
    /// A row whose error is |computed / exact - 1|.
    pub fn relative(
        quantity: impl Into<String>,
        unit: &'static str,
        exact: f64,
        computed: f64,
        tolerance: f64,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            unit,
            exact,
            computed,
            tolerance,
            order: None,
            measure: Measure::Relative,
        }
    }

    /// A row whose error is |computed - exact|, in the unit.
    pub fn absolute(
        quantity: impl Into<String>,
        unit: &'static str,
        exact: f64,
        computed: f64,
        tolerance: f64,
    ) -> Self {
        Self {
            measure: Measure::Absolute,
            ..Self::relative(quantity, unit, exact, computed, tolerance)
        }
    }

    /// The row with an order of convergence that must lie within `band` of the expected one.
    pub fn with_order(self, expected: f64, observed: f64, band: f64) -> Self {
        let order = Some(Order {
            expected,
            observed,
            band,
        });
        Self { order, ..self }
    }

    /// The error, in the measure of the tolerance.
    pub fn error(&self) -> f64 {
        let apart = (self.computed - self.exact).abs();
        match self.measure {
            Measure::Relative => apart / self.exact.abs(),
            Measure::Absolute => apart,
        }
    }

    /// Whether errors are parts of the exact value.
    pub fn is_relative(&self) -> bool {
        self.measure == Measure::Relative
    }

    /// Whether error and order are accepted; nothing that is not a number is.
    pub fn holds(&self) -> bool {
        let within = |order: Order| (order.observed - order.expected).abs() <= order.band;
        self.error() <= self.tolerance && self.order.is_none_or(within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_holds_within_its_tolerance_and_order() {
        let row = |computed| Row::relative("force", "N", -200.0, computed, 0.01);
        assert!(row(-198.5).holds() && !row(-197.0).holds() && !row(f64::NAN).holds());
        assert!((row(-198.0).error() - 0.01).abs() < 1e-12);
        assert!(row(-200.0).with_order(2.0, 1.9, 0.2).holds());
        assert!(!row(-200.0).with_order(2.0, 1.5, 0.2).holds());
        let still = Row::absolute("slip", "mm", 0.0, 2e-9, 1e-9);
        assert!(!still.holds() && !still.is_relative());
    }
}
