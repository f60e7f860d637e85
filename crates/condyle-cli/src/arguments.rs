//! The arguments of the command line.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand};
use condyle_case::case::{Assignment, Preset, Side};
use condyle_study::Shard;

/// A virtual wear test of a joint replacement: from an implant to its wear.
#[derive(Parser)]
#[command(
    name = "condyle",
    version,
    after_help = "Exit codes: 0 done, 2 bad input or output that cannot be written, 3 the physics could not be solved, \
                  130 interrupted and resumable."
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Run a case into a results folder.
    Run(Run),
    /// Check a case without running it: its bodies, their position at rest, time and memory of a run.
    Check(Check),
    /// Write a new case file to start from.
    New(New),
    /// Print the JSON schema of case files, for editors, or of results.
    Schema(Schema),
    /// List the machines, print one as a file to start from, or check a machine file.
    #[command(subcommand)]
    Machine(Machine),
    /// Write the contact of a deformable insert at one pose as an input file of CalculiX and Abaqus.
    Export(Export),
    /// Write the report page of a results folder again, or one page that compares several folders.
    Report(Report),
    /// Write the pictures of a results folder as files, without a browser.
    Plot(Plot),
    /// List the numbers, curves and maps in which two runs differ, with their discretisation errors.
    Diff(Diff),
    /// Run a case with finer and finer values of one of its numbers, and compare the results.
    Converge(Converge),
    /// Run a case with one assumption changed at a time, and compare the results.
    Sensitivity(Sensitivity),
    /// Run a case many times with randomly varied inputs, and report the scatter of its results.
    Uncertainty(Uncertainty),
    /// Run many tests with varied inputs: scatter, sensitivity, ranking, the best design within limits.
    Study(Study),
    /// Compare a run with measured kinematics, weighed wear and a scanned surface.
    Compare(Compare),
    /// Fit the pressure law of a foundation to the deformable insert, and report the remaining errors.
    Calibrate(Calibrate),
    /// Find the constants of the wear law that reproduce measured wear rates.
    CalibrateWear(CalibrateWear),
    /// Print the completions of commands and options for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Write a man page of every command into a folder.
    Man {
        /// The folder; it is created if it does not exist.
        folder: PathBuf,
        /// Replace existing files in that folder.
        #[arg(long)]
        force: bool,
    },
}

#[derive(Args)]
pub struct Run {
    /// The case file.
    pub case: PathBuf,
    /// Folder for the results [default: results/ and the case's name].
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Resume the run that was stopped in that folder.
    #[arg(long)]
    pub resume: bool,
    /// Replace the run in that folder.
    #[arg(long, conflicts_with = "resume")]
    pub force: bool,
    #[command(flatten)]
    pub changes: Changes,
    /// Threads for the preparation of a mesh; the results do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: u16,
    /// Print the summary as JSON, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

/// Changes of a case before it is read.
#[derive(Args)]
pub struct Changes {
    /// Change a value of the case: a dotted path such as contact.friction=0.05, or the last word of one. May be given
    /// several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = Assignment::parse)]
    pub set: Vec<Assignment>,
}

#[derive(Args)]
pub struct Check {
    /// The case file.
    pub case: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// Print the case with all its defaults.
    #[arg(long, conflicts_with = "json")]
    pub print: bool,
    /// Print the findings as JSON, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
    /// Also draw both bodies in place from three sides, as an SVG file.
    #[arg(long, value_name = "FILE.svg")]
    pub picture: Option<PathBuf>,
    /// Replace the picture if it exists.
    #[arg(long, requires = "picture")]
    pub force: bool,
    /// Threads for the preparation of a mesh; the findings do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: u16,
}

#[derive(Subcommand)]
pub enum Machine {
    /// List the machines that come with condyle.
    List,
    /// Print a machine as a file to start from.
    Show {
        /// The machine.
        #[arg(value_name = "MACHINE", value_parser = presets())]
        preset: Preset,
    },
    /// Check a machine file: its joints, drives and ligaments.
    Check {
        /// The machine file.
        file: PathBuf,
    },
}

#[derive(Args)]
pub struct New {
    /// The case file to write; an existing one is kept without --force.
    pub case: PathBuf,
    /// Replace the case and the picture next to it if they exist.
    #[arg(long)]
    pub force: bool,
    /// The simulator [default: stanmore-force, or that of --joint].
    #[arg(long, value_parser = presets())]
    preset: Option<Preset>,
    /// The joint, for its usual simulator.
    #[arg(long, value_parser = joints(), conflicts_with = "preset")]
    joint: Option<Preset>,
    /// Mesh or STEP file of the femoral component, whose unit and axes are derived from its shape. The Python package converts STEP files.
    #[arg(long, value_name = "MESH", requires = "insert")]
    pub femur: Option<PathBuf>,
    /// Mesh or STEP file of the insert: a closed surface, or the articulating surface alone.
    #[arg(long, value_name = "MESH", requires = "femur")]
    pub insert: Option<PathBuf>,
    /// Side of the knee; by default derived from the trochlea of the femur.
    #[arg(long, value_parser = sides(), requires = "femur")]
    pub side: Option<Side>,
    /// Mesh or STEP file of the head of a hip, to which a sphere is fitted.
    #[arg(long, value_name = "MESH", requires = "cup", conflicts_with_all = ["femur", "insert"])]
    pub head: Option<PathBuf>,
    /// Closed mesh or STEP file of the cup of a hip, whose socket and opening direction are derived from its shape.
    #[arg(long, value_name = "MESH", requires = "head")]
    pub cup: Option<PathBuf>,
}

#[derive(Args)]
pub struct Export {
    /// The case file.
    pub case: PathBuf,
    #[command(flatten)]
    pub changes: Changes,
    /// The input file to write; it must not exist yet.
    #[arg(short, long, value_name = "FILE.inp")]
    pub out: PathBuf,
    /// Replace the input file if it exists.
    #[arg(long)]
    pub force: bool,
    /// Position in the first cycle, %: the file contains the contact at the pose of the femur there.
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub pressed_at: f64,
    /// Threads for the preparation of a mesh; the file does not depend on it.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: u16,
}

#[derive(Args)]
pub struct Report {
    /// The results folder; several are shown side by side on one page, compared with the first.
    #[arg(required = true, value_name = "RESULTS")]
    pub results: Vec<PathBuf>,
    /// Also write wear_map.svg, wear.svg and kinematics.svg.
    #[arg(long)]
    pub pictures: bool,
    /// The page of several folders [default: runs.html].
    #[arg(short, long, value_name = "FILE.html", conflicts_with = "pictures")]
    pub out: Option<PathBuf>,
    /// Replace the page of several folders if it exists; that of one is always replaced.
    #[arg(long)]
    pub force: bool,
}

#[derive(Args)]
pub struct Plot {
    /// The results folder.
    pub results: PathBuf,
    /// Folder for the pictures [default: pictures in the results folder].
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace pictures that exist in another folder than the default.
    #[arg(long)]
    pub force: bool,
    /// Pixels of a PNG per point of the picture.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=8))]
    pub dots: u8,
    /// Write only this format [default: SVG, and PNG if built with the feature `png`].
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub format: Vec<PictureFormat>,
}

/// The format of a picture.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum PictureFormat {
    /// Vector graphics.
    Svg,
    /// Pixels.
    Png,
}

#[derive(Args)]
pub struct Schema {
    /// Print the schema of summary.json, with the columns of tables and the fields of meshes.
    #[arg(long)]
    pub results: bool,
}

#[derive(Args)]
pub struct Diff {
    /// The results folder of the first run.
    pub first: PathBuf,
    /// The results folder of the second run; differences are the second minus the first.
    pub second: PathBuf,
    /// Print the differences as JSON, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct Converge {
    /// The case file.
    pub case: PathBuf,
    /// A number of the case and its values: a dotted path such as insert.edge_mm=2,1,0.5, or the last word of one.
    #[arg(
        long,
        value_name = "KEY=VALUES",
        default_value = "updates=1,2,5,10,20,40"
    )]
    pub over: String,
    /// Folder for the table, the picture and the results of every run; it must be empty [default: results/, the case's
    /// name and -converge].
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Resume the study that was stopped in that folder.
    #[arg(long)]
    pub resume: bool,
    /// Simultaneous runs, by default one per core; the results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
    /// Print converge.json, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct Sensitivity {
    /// The case file.
    pub case: PathBuf,
    /// Simultaneous runs, by default one per core; the results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
    /// Print the results and their changes as JSON, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct Uncertainty {
    /// The case file.
    pub case: PathBuf,
    /// Number of runs with varied inputs.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub runs: u32,
    /// Seed of the random inputs: the same seed gives the same numbers.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Simultaneous runs, by default one per core; the results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
    /// Print the results as JSON, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Study {
    #[command(subcommand)]
    pub command: Option<StudyCommand>,
    /// The study file: the case, the varied inputs, the design and the answers. The same command continues a study
    /// that was stopped.
    #[arg(required = true)]
    pub study: Option<PathBuf>,
    /// Folder for study.db, table.csv, answers.json, the pictures and study.html [default: results/ and the study's name].
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Simultaneous tests, by default one per core; the table does not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
    /// Run only every N-th test, starting with test i; `condyle study merge` joins the shards.
    #[arg(long, value_name = "i/N")]
    pub shard: Option<Shard>,
    /// Print answers.json, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Subcommand)]
pub enum StudyCommand {
    /// Write the table of the tests so far as CSV.
    Export(StudyExport),
    /// Run one test of a study, by the number of its row, into its own folder.
    RunRow(RunRow),
    /// Join the shards of a study, and compute its answers.
    Merge(StudyMerge),
}

#[derive(Args)]
pub struct StudyExport {
    /// The study's folder.
    pub folder: PathBuf,
    /// The file to write; standard output if not given.
    #[arg(long, value_name = "FILE.csv")]
    pub csv: Option<PathBuf>,
    /// Replace the file if it exists.
    #[arg(long, requires = "csv")]
    pub force: bool,
}

#[derive(Args)]
pub struct RunRow {
    /// The study file.
    pub study: PathBuf,
    /// The number in the first column of the table.
    pub row: u64,
    /// Folder for the results [default: row-N in the study's folder].
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

#[derive(Args)]
pub struct StudyMerge {
    /// The study file.
    pub study: PathBuf,
    /// The folders of its shards.
    #[arg(required = true)]
    pub shards: Vec<PathBuf>,
    /// Folder for the whole study [default: results/ and the study's name].
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print answers.json, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct Compare {
    /// The results folder.
    pub results: PathBuf,
    /// The TOML file that names the measured data.
    pub measured: PathBuf,
    /// Folder for compare.json, the pictures and the table of depths [default: compare in the results folder].
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace existing files in that folder.
    #[arg(long)]
    pub force: bool,
    /// Print compare.json, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct Calibrate {
    /// The case file, with either model of contact.
    pub case: PathBuf,
    /// Folder for pressure_table.csv, the case that uses it, calibration.md and calibration.json; an existing one is kept without --force.
    #[arg(short, long, value_name = "DIR")]
    pub out: PathBuf,
    /// Replace these files in a folder that exists.
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub changes: Changes,
    /// Also report the errors of the table for this case, which is not part of the fit; may be given several times.
    #[arg(long, value_name = "CASE")]
    pub hold_out: Vec<PathBuf>,
    /// Print calibration.json, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct CalibrateWear {
    /// A results folder and the TOML file that names its measured data, which needs `[gravimetric]`; give as many such
    /// pairs as there are tests. The cases are run again with other constants; the folders are not changed.
    #[arg(required = true, num_args = 2.., value_names = ["RESULTS", "MEASURED"])]
    pub tests: Vec<PathBuf>,
    /// Find this constant of the law, such as cross_shear_exponent; may be given several times. Without it, a common factor on the wear is fitted.
    #[arg(long, value_name = "NAME")]
    pub constant: Vec<String>,
    /// Predict the mass loss of this case with the constants found, with its interval; may be given several times.
    #[arg(long, value_name = "CASE")]
    pub predict: Vec<PathBuf>,
    /// Print the constants, their intervals and every trial as JSON, and nothing else on standard output.
    #[arg(long)]
    pub json: bool,
}

fn sides() -> impl TypedValueParser<Value = Side> {
    let possible = |side: &Side| PossibleValue::new(side.word()).help(side.about());
    PossibleValuesParser::new(Side::ALL.iter().map(possible))
        .try_map(|word| Side::from_word(&word).ok_or("it is neither side"))
}

fn presets() -> impl TypedValueParser<Value = Preset> {
    let possible = |preset: &Preset| PossibleValue::new(preset.word()).help(preset.about());
    PossibleValuesParser::new(Preset::ALL.iter().map(possible))
        .try_map(|word| Preset::from_word(&word).ok_or("it is none of the presets"))
}

impl New {
    /// Returns the simulator of the case.
    pub fn preset(&self) -> Preset {
        let usual = match self.head {
            Some(_) => Preset::Iso142421Like,
            None => Preset::StanmoreForce,
        };
        self.preset.or(self.joint).unwrap_or(usual)
    }
}

/// The usual simulator of a joint.
const OF_JOINT: [(&str, Preset); 4] = [
    ("knee", Preset::StanmoreForce),
    ("hip", Preset::Iso142421Like),
    ("disc", Preset::Iso181921LumbarLike),
    ("ankle", Preset::Iso22622Like),
];

fn joints() -> impl TypedValueParser<Value = Preset> {
    PossibleValuesParser::new(OF_JOINT.map(|(joint, _)| joint)).try_map(|word| {
        let found = OF_JOINT.into_iter().find(|(joint, _)| *joint == word);
        found
            .map(|(_, preset)| preset)
            .ok_or("it is none of the joints")
    })
}

fn percent(word: &str) -> Result<f64, String> {
    let percent: f64 = word.parse().map_err(|_| "it must be a number".to_owned())?;
    if (0.0..=100.0).contains(&percent) {
        Ok(percent)
    } else {
        Err("it must be from 0 to 100".to_owned())
    }
}
