//! A flat pin worn by a plate.

use condyle::evolve::March;

use crate::{
    Case, Row,
    convergence::order_of_errors,
    drives::to_and_fro,
    law::THICKNESS_MM,
    marched::marched,
    plate::{plate, rubbing},
    pressed::block,
    rub_test::{MM_PER_M, Rub, WEAR_FACTOR_MM3_PER_NM},
};

pub(crate) const CASE: Case = Case {
    name: "archard-pin-on-plate",
    readme: include_str!("README.md"),
    rows,
};

const SIZE_MM: f64 = 12.0;
const LOAD_N: f64 = 500.0;
const AMPLITUDE_MM: f64 = 4.0;
const CYCLES: f64 = 1e6;

fn rows() -> Vec<Row> {
    let [coarse, middle, fine] = [50, 100, 200].map(worn);
    let exact_mm = exact_depth_mm();
    let error = |march: &March| (deepest_mm(march) / exact_mm - 1.0).abs();
    let order = order_of_errors([error(&coarse), error(&fine)], 4.0);
    let depths = &fine.fields().wear_depth_mm;
    let thinnest = depths.iter().copied().fold(f64::INFINITY, f64::min);
    let updates = &fine.state().updates;
    let last = updates.last().expect("two updates");
    let exact_mm3 = exact_mm * SIZE_MM * SIZE_MM;
    vec![
        Row::relative(
            "depth, 100 increments",
            "mm",
            exact_mm,
            deepest_mm(&middle),
            5e-4,
        ),
        Row::relative(
            "depth, 200 increments",
            "mm",
            exact_mm,
            deepest_mm(&fine),
            1e-4,
        )
        .with_order(2.0, order, 0.1),
        Row::relative("least depth of all nodes", "mm", exact_mm, thinnest, 1e-4),
        Row::relative(
            "volume from depth",
            "mm3",
            exact_mm3,
            last.volume_loss_mm3,
            1e-4,
        ),
        Row::relative(
            "volume from the mesh",
            "mm3",
            exact_mm3,
            last.volume_loss_mesh_mm3,
            1e-4,
        ),
    ]
}

fn exact_depth_mm() -> f64 {
    let pressure_mpa = LOAD_N / (SIZE_MM * SIZE_MM);
    WEAR_FACTOR_MM3_PER_NM / MM_PER_M * pressure_mpa * 4.0 * AMPLITUDE_MM * CYCLES
}

fn worn(increments: usize) -> March {
    let (contact, _) = rubbing(0.07, 1.0);
    let rub = Rub {
        femur: plate(SIZE_MM),
        insert: block(SIZE_MM, THICKNESS_MM, 1.5),
        contact,
        ap: to_and_fro(AMPLITUDE_MM),
        load_n: LOAD_N,
        increments,
        cycles: CYCLES,
        updates: 2,
    };
    marched(rub.test())
}

fn deepest_mm(march: &March) -> f64 {
    march
        .state()
        .updates
        .last()
        .map_or(0.0, |last| last.max_depth_mm)
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_archard_pin_on_plate() {
        super::CASE.assert_holds();
    }
}
