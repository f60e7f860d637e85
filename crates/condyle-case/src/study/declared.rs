//! The keys of a study file.

use crate::config::*;

/// Largest number of tests of a study.
pub(super) const MAX_TESTS: f64 = 1e9;

settings! {
    /// The top of the file.
    HeadingKeys {
        /// The case that the study is of; paths in it count from its own folder.
        case: DataFile;
        /// Shown on the page.
        title: String = String::new();
    }

    /// The keys of every input.
    InputKeys {
        /// Dotted path of a key of the case, such as contact.friction.
        key: String;
        /// Its name in tables and pictures; its key if not given.
        name: String = String::new();
        /// True if it scatters in a search for a robust optimum, instead of being chosen.
        disturbance: bool = false;
    }

    /// Uniform.
    UniformKeys {
        /// Least.
        low: f64;
        /// Most.
        high: f64;
    }

    /// Normal.
    NormalKeys {
        /// Mean; the value of the case if not given.
        mean: Option<f64> = None;
        /// Standard deviation.
        standard_deviation: f64, in within(1e-300, 1e300);
    }

    /// Normal, truncated at two values.
    TruncatedKeys {
        /// Mean of the whole normal distribution; the value of the case if not given.
        mean: Option<f64> = None;
        /// Standard deviation of the whole normal distribution.
        standard_deviation: f64, in within(1e-300, 1e300);
        /// Least.
        low: f64;
        /// Most.
        high: f64;
    }

    /// Triangular around the likeliest value.
    TriangularKeys {
        /// Least.
        low: f64;
        /// Likeliest; the value of the case if not given.
        mode: Option<f64> = None;
        /// Most.
        high: f64;
    }

    /// Lognormal.
    LognormalKeys {
        /// Median, above 0; the value of the case if not given.
        median: Option<f64> = None;
        /// Geometric standard deviation: 68 % of the values lie within this factor of the median.
        geometric_standard_deviation: f64, in within(1.000_001, 1e3);
    }

    /// Weibull.
    WeibullKeys {
        /// Least.
        low: f64 = 0.0;
        /// Distance from the least value that 63 % of the values stay below.
        scale: f64, in within(1e-300, 1e300);
        /// Shape: 1 for an exponential distribution, 3.6 for a nearly symmetric one.
        shape: f64, in within(0.1, 1e3);
    }

    /// Beta.
    BetaKeys {
        /// Least.
        low: f64;
        /// Most.
        high: f64;
        /// First shape: the mean lies at alpha / (alpha + beta) of the range.
        alpha: f64, in within(0.05, 1e4);
        /// Second shape.
        beta: f64, in within(0.05, 1e4);
    }

    /// Measured values, linear between neighbours.
    EmpiricalKeys {
        /// CSV file: the first line has keys or names, every other line values; the column named like the key counts, or the only one.
        file: Option<DataFile> = None;
        /// The values, instead of a file.
        values: Levels = Levels::default();
    }

    /// One of a few values.
    LevelKeys {
        /// The values, each as likely as the others: numbers, words, or names of files counted from the study's folder.
        levels: Levels;
    }

    /// A random sample.
    SampleKeys {
        /// Number of tests; for a Saltelli design, of its bases, each of which takes as many tests as there are inputs, and two.
        size: u64 = 100, in within(2.0, MAX_TESTS);
        /// Seed of the random numbers: the same seed gives the same tests.
        seed: u64 = 1, in within(0.0, 9e15);
    }

    /// Walks through the inputs, one step each.
    MorrisKeys {
        /// Walks; each takes as many tests as there are inputs, and one.
        walks: u64 = 20, in within(2.0, MAX_TESTS);
        /// Values of an input, an even number.
        levels: u64 = 4, in within(2.0, 1000.0);
        /// Seed of the random numbers: the same seed gives the same tests.
        seed: u64 = 1, in within(0.0, 9e15);
    }

    /// Few values of each input.
    FactorialKeys {
        /// Values taken of an input that is given by its distribution, from end to end.
        points: u64 = 3, in within(2.0, 1000.0);
    }

    /// Tests given row by row.
    RowsKeys {
        /// CSV file: the first line has keys of the case, every other line their values in one test.
        file: DataFile;
    }

    /// A search for the optimum.
    OptimiseKeys {
        /// The output to be minimised within the limits; "pareto" for both outputs of the key pareto of the answers.
        minimise: String = "mass_loss_mg".to_owned();
        /// Percentile of the output under the disturbances that a robust search minimises; its mean if not given.
        percentile: Option<f64> = None, in within(50.0, 99.0);
        /// Largest number of tests.
        size: u64 = 100, in within(10.0, 500.0);
        /// Seed of the random numbers: the same seed gives the same tests.
        seed: u64 = 1, in within(0.0, 9e15);
    }

    /// Tests that are added where the emulator of an output is least certain.
    AdaptiveKeys {
        /// Stopping rule, such as "mass_loss_mg known to 1 %": 90 % of the errors of the emulator are at most this part of the
        /// output; or, for the probability of exceeding a limit, "peak_pressure_mpa above 40 known to a factor of 1.5".
        until: String;
        /// Largest number of tests.
        size: u64 = 200, in within(10.0, 256.0);
        /// Seed of the random numbers: the same seed gives the same tests.
        seed: u64 = 1, in within(0.0, 9e15);
    }

    /// Two correlated inputs.
    CorrelationKeys {
        /// Their two keys.
        keys: Names;
        /// Correlation of the two normal distributions; of inputs that are not normal, of the normal scores behind them.
        coefficient: f64, in within(-0.999, 0.999);
    }

    /// One of several designs, each tested under the same disturbances.
    AlternativeKeys {
        /// Its name.
        name: String;
        /// Its changes of the case, each as `key=value`.
        set: Names;
    }

    /// An output of the study's own.
    OutputKeys {
        /// Its key, which ends in its unit, such as mass_per_million_mg.
        name: String;
        /// The formula, with keys of summary.json, such as "mass_loss_mg / 5".
        formula: String;
    }

    /// The limits of an output.
    BoundKeys {
        /// The output.
        output: String;
        /// The smallest value allowed.
        least: Option<f64> = None;
        /// The largest value allowed.
        most: Option<f64> = None;
        /// Probability with which a robust search keeps the limit, and which an alternative must reach to rank first.
        probability: f64 = 0.95, in within(0.5, 0.99);
    }

    /// The questions.
    AnswersKeys {
        /// Outputs in answers and pictures; the table has all of them.
        outputs: Names = Names(["mass_loss_mg", "max_depth_mm", "peak_pressure_mpa"].map(str::to_owned).to_vec());
        /// The output that designs are ranked by, smaller is better; the first of `outputs` if not given.
        rank_by: Option<String> = None;
        /// Two outputs to be minimised together, for a picture of their Pareto front; a search takes the first two of `outputs` if not given.
        pareto: Option<Names> = None;
    }
}

variants! {
    /// The variation of an input.
    Variation by
    /// Distribution of its values.
    distribution = "uniform" {
        /// Uniform.
        Uniform(UniformKeys) = "uniform",
        /// Normal.
        Normal(NormalKeys) = "normal",
        /// Normal, truncated at two values.
        TruncatedNormal(TruncatedKeys) = "truncated-normal",
        /// Triangular around the likeliest value.
        Triangular(TriangularKeys) = "triangular",
        /// Lognormal.
        Lognormal(LognormalKeys) = "lognormal",
        /// Weibull.
        Weibull(WeibullKeys) = "weibull",
        /// Beta, between two values.
        Beta(BetaKeys) = "beta",
        /// Measured values, linear between neighbours.
        Empirical(EmpiricalKeys) = "empirical",
        /// One of a few values.
        Levels(LevelKeys) = "levels",
    }
}

variants! {
    /// The choice of the tests.
    Design by
    /// Kind of the choice.
    kind = "latin-hypercube" {
        /// Latin hypercube: one value of every input lies in each of as many equally likely slices as there are tests.
        LatinHypercube(SampleKeys) = "latin-hypercube",
        /// Sobol points, scrambled by Owen's method.
        Sobol(SampleKeys) = "sobol",
        /// Pairs of Sobol points, mixed for each input: for Sobol indices.
        Saltelli(SampleKeys) = "saltelli",
        /// Walks through the inputs: for the elementary effects of Morris.
        Morris(MorrisKeys) = "morris",
        /// Every value of each input with every value of all others.
        FullFactorial(FactorialKeys) = "full-factorial",
        /// The case as it is, and each value of each input with all others as they are.
        OneAtATime(FactorialKeys) = "one-at-a-time",
        /// The rows of a CSV file.
        Rows(RowsKeys) = "rows",
        /// A search for the optimum, by emulators of the outputs.
        Optimise(OptimiseKeys) = "optimise",
        /// Tests that are added where the emulator of an output is least certain, until it is known as well as stated.
        Adaptive(AdaptiveKeys) = "adaptive",
    }
}
