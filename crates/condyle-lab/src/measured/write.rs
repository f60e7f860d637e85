//! A comparison as files: numbers as JSON and CSV, pictures as SVG.

use condyle_report::{
    SurfaceFields,
    measured::{compared_kinematics_svg, compared_surface_svg, compared_wear_svg},
};
use condyle_results::{
    COMPARED_KINEMATICS, COMPARED_NUMBERS, COMPARED_SURFACE, COMPARED_WEAR, MotionColumn, json_text,
};

use crate::measured::{
    Comparison, gravimetric::GravimetricComparison, kinematics::KinematicsComparison,
    surface::SurfaceComparison,
};

impl Comparison {
    /// `compare.json`: everything but the curves and the map.
    pub fn json(&self) -> String {
        json_text(self)
    }

    /// Returns name, ending and text of each file.
    pub fn files(&self) -> Vec<(&'static str, &'static str, String)> {
        let mut files = vec![(COMPARED_NUMBERS, "json", self.json())];
        if let Some(kinematics) = &self.kinematics {
            files.push((COMPARED_KINEMATICS, "svg", kinematics.svg(&self.motions)));
            files.push((COMPARED_KINEMATICS, "csv", kinematics.csv()));
        }
        if let Some(gravimetric) = &self.gravimetric {
            files.push((COMPARED_WEAR, "svg", gravimetric.svg()));
            files.push((COMPARED_WEAR, "csv", gravimetric.csv()));
        }
        if let Some(surface) = &self.surface {
            files.push((COMPARED_SURFACE, "csv", surface.csv()));
            let map = compared_surface_svg(&surface.fields, self.directions);
            files.extend(map.map(|map| (COMPARED_SURFACE, "svg", map)));
        }
        files
    }
}

impl KinematicsComparison {
    fn svg(&self, motions: &[MotionColumn]) -> String {
        let columns = self.columns.iter();
        let columns = columns.map(|column| (column.column.as_str(), column.points.as_slice()));
        let title = format!("Motion in the {} cycle, measured and predicted", self.cycle);
        compared_kinematics_svg(&title, &columns.collect::<Vec<_>>(), motions)
    }

    /// Returns the aligned measurement, a row for each instant of the run's cycle and a column for each measured one;
    /// empty where nothing was measured.
    fn csv(&self) -> String {
        let columns: String = self
            .columns
            .iter()
            .map(|one| format!(",{}", one.column))
            .collect();
        let mut text = format!("cycles,percent{columns}\n");
        let points = self.columns.iter().flat_map(|column| &column.points);
        let mut percents: Vec<f64> = points.map(|point| point[0]).collect();
        percents.sort_by(f64::total_cmp);
        // Columns may lack some instants where their measurement has gaps: all instants of any column have a row.
        percents.dedup();
        for percent in percents {
            text += &format!("{},{percent}", self.cycles_before);
            for column in &self.columns {
                let point = column.points.iter().find(|point| point[0] == percent);
                let measured = point.map_or_else(String::new, |point| point[2].to_string());
                text += &format!(",{measured}");
            }
            text += "\n";
        }
        text
    }
}

impl GravimetricComparison {
    /// Returns the soak-corrected losses, a row for each weighing and a column for each specimen.
    fn csv(&self) -> String {
        let specimens = 1..=self.specimens.len();
        let head: String = specimens.map(|one| format!(",specimen_{one}_mg")).collect();
        let mut text = format!("cycles{head}\n");
        for weighing in &self.weighings {
            let losses = weighing.loss_mg.iter().map(|loss| format!(",{loss}"));
            text += &format!("{}{}\n", weighing.cycles, losses.collect::<String>());
        }
        text
    }

    fn svg(&self) -> String {
        let weighings = || self.weighings.iter();
        let specimen = |index: usize| -> Vec<(f64, f64)> {
            let points = weighings().map(|weighing| (weighing.cycles, weighing.loss_mg[index]));
            points.collect()
        };
        let predicted = weighings().filter_map(|one| Some((one.cycles, one.predicted_loss_mg?)));
        // The line through all weighings, from the first that counts to the last.
        let counted = || weighings().filter(|weighing| weighing.in_line);
        let ends = [counted().next(), counted().next_back()];
        let line = ends.map(|weighing| {
            let cycles = weighing.map_or(0.0, |weighing| weighing.cycles);
            let start = self.all.intercept_mg.unwrap_or_default();
            let rise_mg = self.all.mg_per_million_cycles * cycles / 1e6;
            (cycles, start + rise_mg)
        });
        let specimens: Vec<_> = (0..self.specimens.len()).map(specimen).collect();
        compared_wear_svg(&specimens, &line, &predicted.collect::<Vec<_>>())
    }
}

impl SurfaceComparison {
    /// Returns a row for each node that the scan covers.
    fn csv(&self) -> String {
        let mut text = String::from("x_mm,y_mm,z_mm,predicted_mm,scanned_mm,difference_mm\n");
        let SurfaceFields { nodes, fields, .. } = &self.fields;
        for (index, node) in nodes.iter().enumerate() {
            let values: Vec<f64> = fields.iter().map(|(_, values)| values[index]).collect();
            if let [predicted, scanned, difference] = values[..]
                && scanned.is_finite()
            {
                let (x, y, z) = (node.x, node.y, node.z);
                text += &format!("{x},{y},{z},{predicted},{scanned},{difference}\n");
            }
        }
        text
    }
}
