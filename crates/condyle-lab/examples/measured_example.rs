//! Makes up the data of `cases/measured-example` from a results folder:
//! `cargo run --release -p condyle-lab --example measured_example RESULTS`.
//!
//! Every difference from the run is known: it is written beside the numbers that make it.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use condyle_report::{Results, SurfaceFields, Table};
use nalgebra::{Rotation3, Vector3};

const FOLDER: &str = "cases/measured-example";
/// Every so many instants of the run.
const EVERY: usize = 2;
/// Wear rates of four specimens, mg per million cycles.
const RATES: [f64; 4] = [13.6, 15.1, 16.9, 17.8];
/// Uptake of two soak controls after a million cycles, mg; it grows with the root of time.
const UPTAKES: [f64; 2] = [0.9, 1.1];
/// Standard deviations of the noise.
const NOISE_MG: f64 = 0.25;
const NOISE_MM: f64 = 0.004;
/// The scan is deeper than the prediction by this part.
const DEEPER: f64 = 0.12;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("give a results folder")?;
    let results = Results::read(Path::new(&folder))?;
    let run = results.kinematics.ok_or("no kinematics.csv")?;
    let surface = results.surface.ok_or("no insert_*.vtu")?;
    let mut noise = Noise(1);
    save("kinematics.csv", &kinematics(&run, &mut noise)?)?;
    save("masses.csv", &masses(&mut noise))?;
    save("scan.csv", &scan(&surface, &mut noise)?)?;
    Ok(())
}

fn save(name: &str, text: &str) -> std::io::Result<()> {
    fs::write(Path::new(FOLDER).join(name), text)
}

/// AP with a sine of 0.4 mm and a constant of 0.2 mm, IE with a sine of 0.5 degrees.
fn kinematics(run: &Table, noise: &mut Noise) -> Result<String, Box<dyn Error>> {
    let column = |name: &str| run.column(name).ok_or(format!("no column {name}"));
    let (cycles, percent) = (column("cycles")?, column("percent")?);
    let (ap, ie) = (column("ap_mm")?, column("ie_deg")?);
    let mut text = String::from("# made up: no laboratory measured this\npercent,ap_mm,ie_deg\n");
    for row in (EVERY - 1..percent.len()).step_by(EVERY) {
        if cycles[row] > cycles[0] {
            break;
        }
        let sine = (percent[row] / 100.0 * std::f64::consts::TAU).sin();
        let ap = ap[row] + 0.2 + 0.4 * sine + 0.03 * noise.next();
        let ie = ie[row] + 0.5 * sine + 0.05 * noise.next();
        writeln!(text, "{},{ap:.3},{ie:.3}", percent[row])?;
    }
    Ok(text)
}

fn masses(noise: &mut Noise) -> String {
    let mut text = String::from(
        "# made up: no laboratory weighed this\ncycles,k1_mg,k2_mg,k3_mg,k4_mg,soak1_mg,soak2_mg\n",
    );
    for stop in 0..=10 {
        let millions = f64::from(stop) / 2.0;
        let mean_uptake = UPTAKES.iter().sum::<f64>() / 2.0;
        let mut cells = vec![format!("{}", millions * 1e6)];
        for (index, rate) in (0..).zip(RATES) {
            let start = 21_300.0 + 40.0 * f64::from(index);
            let mass = start - rate * millions + mean_uptake * millions.sqrt();
            cells.push(format!("{:.2}", mass + NOISE_MG * noise.next()));
        }
        for (index, uptake) in (0..).zip(UPTAKES) {
            let mass = 21_350.0 + 25.0 * f64::from(index) + uptake * millions.sqrt();
            cells.push(format!("{:.2}", mass + NOISE_MG / 4.0 * noise.next()));
        }
        text += &(cells.join(",") + "\n");
    }
    text
}

/// The nodes of the worn surface, 12 % deeper, with noise, turned by about 3 degrees and
/// shifted by a few millimetres.
fn scan(surface: &SurfaceFields, noise: &mut Noise) -> Result<String, Box<dyn Error>> {
    let depth = surface.field("wear_depth_mm").ok_or("no wear_depth_mm")?;
    let turn = Rotation3::from_euler_angles(0.03, -0.04, 0.02);
    let shift = Vector3::new(1.5, 4.0, -2.5);
    let mut text = String::from("# made up: no machine scanned this\nx_mm,y_mm,z_mm\n");
    for (node, depth) in surface.nodes.iter().zip(depth) {
        let lower = DEEPER * depth - NOISE_MM * noise.next();
        let place = turn * (node - Vector3::y() * lower) + shift;
        writeln!(text, "{:.4},{:.4},{:.4}", place.x, place.y, place.z)?;
    }
    Ok(text)
}

/// The same numbers on every machine, about normal: 0 on average, of standard deviation 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    /// Knuth's linear congruential generator.
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
