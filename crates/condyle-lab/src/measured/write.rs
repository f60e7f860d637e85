//! A comparison as files: numbers as JSON and CSV, pictures as SVG.

use std::{
    fmt::Write,
    fs,
    path::{Path, PathBuf},
};

use condyle_report::{
    SurfaceFields,
    measured::{
        ComparedCurve, ComparedWear, compared_kinematics_svg, compared_surface_svg,
        compared_wear_svg,
    },
};
use condyle_results::{COMPARED_KINEMATICS, COMPARED_NUMBERS, COMPARED_SURFACE, COMPARED_WEAR};

use crate::measured::{
    CompareError, Comparison, gravimetric::GravimetricComparison, kinematics::KinematicsComparison,
    surface::SurfaceComparison,
};

impl Comparison {
    /// `compare.json`: everything but the curves and the map, units in the names.
    pub fn json(&self) -> String {
        let text = serde_json::to_string_pretty(self);
        text.expect("numbers and text always serialise") + "\n"
    }

    /// Writes the files into `folder`, which is made if it is not there; gives their paths.
    ///
    /// # Errors
    /// The folder or a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, CompareError> {
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            |source| CompareError::Write { path, source }
        };
        fs::create_dir_all(folder).map_err(failed(folder))?;
        let mut written = Vec::new();
        for (name, ending, text) in self.files() {
            let path = folder.join(format!("{name}.{ending}"));
            fs::write(&path, text).map_err(failed(&path))?;
            written.push(path);
        }
        Ok(written)
    }

    /// Name, ending and text of each file.
    fn files(&self) -> Vec<(&'static str, &'static str, String)> {
        let mut files = vec![(COMPARED_NUMBERS, "json", self.json())];
        if let Some(kinematics) = &self.kinematics {
            files.push((COMPARED_KINEMATICS, "svg", kinematics.svg()));
            files.push((COMPARED_KINEMATICS, "csv", kinematics.csv()));
        }
        if let Some(gravimetric) = &self.gravimetric {
            files.push((COMPARED_WEAR, "svg", gravimetric.svg()));
            files.push((COMPARED_WEAR, "csv", gravimetric.csv()));
        }
        if let Some(surface) = &self.surface {
            files.push((COMPARED_SURFACE, "csv", surface.csv()));
            let map = compared_surface_svg(&surface.fields, self.side);
            files.extend(map.map(|map| (COMPARED_SURFACE, "svg", map)));
        }
        files
    }
}

impl KinematicsComparison {
    fn svg(&self) -> String {
        let curve = |column: &crate::measured::kinematics::ColumnComparison| ComparedCurve {
            column: column.column,
            points: column.points.clone(),
        };
        let curves: Vec<ComparedCurve> = self.columns.iter().map(curve).collect();
        let title = format!("Motion in the {} cycle, measured and predicted", self.cycle);
        compared_kinematics_svg(&title, &curves)
    }

    /// What was measured, less what alignment takes out: a row an instant of the run's cycle, a column a measured column; a
    /// cell is empty where nothing was measured.
    fn csv(&self) -> String {
        let mut text = String::from("cycles,percent");
        for column in &self.columns {
            text += ",";
            text += column.column;
        }
        text += "\n";
        let points = self.columns.iter().flat_map(|column| &column.points);
        let mut percents: Vec<f64> = points.map(|point| point[0]).collect();
        percents.sort_by(f64::total_cmp);
        percents.dedup();
        for percent in percents {
            write!(text, "{},{percent}", self.cycles_before)
                .expect("writing to a string cannot fail");
            for column in &self.columns {
                let there = column.points.iter().find(|point| point[0] == percent);
                let measured = there.map_or_else(String::new, |point| point[2].to_string());
                write!(text, ",{measured}").expect("writing to a string cannot fail");
            }
            text += "\n";
        }
        text
    }
}

impl GravimetricComparison {
    /// What was weighed, soak-corrected: a row a weighing, a column a specimen.
    fn csv(&self) -> String {
        let mut text = String::from("cycles");
        for specimen in 1..=self.specimens.len() {
            write!(text, ",specimen_{specimen}_mg").expect("writing to a string cannot fail");
        }
        text += "\n";
        for weighing in &self.weighings {
            let losses = weighing.loss_mg.iter().map(|loss| format!(",{loss}"));
            let losses: String = losses.collect();
            writeln!(text, "{}{losses}", weighing.cycles).expect("writing to a string cannot fail");
        }
        text
    }

    fn svg(&self) -> String {
        let specimen = |index: usize| {
            let point = |weighing: &crate::measured::gravimetric::Weighing| {
                (weighing.cycles, weighing.loss_mg[index])
            };
            self.weighings.iter().map(point).collect()
        };
        let predicted = self
            .weighings
            .iter()
            .filter_map(|weighing| Some((weighing.cycles, weighing.predicted_loss_mg?)));
        compared_wear_svg(&ComparedWear {
            specimens: (0..self.specimens.len()).map(specimen).collect(),
            line: self.ends_of_line(),
            predicted: predicted.collect(),
        })
    }

    /// The line through all weighings, from the first that counts to the last.
    fn ends_of_line(&self) -> [(f64, f64); 2] {
        let counted = || self.weighings.iter().filter(|weighing| weighing.in_line);
        let at = |weighing: Option<&crate::measured::gravimetric::Weighing>| {
            let cycles = weighing.map_or(0.0, |weighing| weighing.cycles);
            let start = self.all.intercept_mg.unwrap_or_default();
            (
                cycles,
                start + self.all.mg_per_million_cycles * cycles / 1e6,
            )
        };
        [at(counted().next()), at(counted().next_back())]
    }
}

impl SurfaceComparison {
    /// A row a node that the scan covers.
    fn csv(&self) -> String {
        let mut text = String::from("x_mm,y_mm,z_mm,predicted_mm,scanned_mm,difference_mm\n");
        let SurfaceFields { nodes, fields, .. } = &self.fields;
        for (index, node) in nodes.iter().enumerate() {
            let values: Vec<f64> = fields.iter().map(|(_, values)| values[index]).collect();
            if let [predicted, scanned, difference] = values[..]
                && scanned.is_finite()
            {
                let (x, y, z) = (node.x, node.y, node.z);
                writeln!(text, "{x},{y},{z},{predicted},{scanned},{difference}")
                    .expect("writing to a string cannot fail");
            }
        }
        text
    }
}
