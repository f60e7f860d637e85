//! What a study file is made of.

use crate::config::{DataFile, Levels, Names, settings, variants, within};

/// Tests of a study, at most.
pub(super) const MAX_TESTS: f64 = 1e9;

settings! {
    /// The top of the file.
    HeadingKeys {
        /// The case that the study is of; paths in it count from its own folder.
        case: DataFile;
        /// Shown on the page.
        title: String = String::new();
    }

    /// What every input has.
    InputKeys {
        /// Dotted path of a key of the case, such as contact.friction.
        key: String;
        /// What it is called in tables and pictures; its key if not given.
        name: String = String::new();
    }

    /// Equally likely everywhere.
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

    /// Normal, but never outside of two values.
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

    /// Likelier the nearer to one value.
    TriangularKeys {
        /// Least.
        low: f64;
        /// Likeliest; the value of the case if not given.
        mode: Option<f64> = None;
        /// Most.
        high: f64;
    }

    /// One of a few values.
    LevelKeys {
        /// The values, each as likely as the others: numbers, words, or names of files counted from the study's folder.
        levels: Levels;
    }

    /// How many tests, and of which chance.
    SampleKeys {
        /// Tests; of a Saltelli design its base, of which every test is done again with each input changed.
        size: u64 = 100, in within(2.0, MAX_TESTS);
        /// Of the chance: the same seed gives the same tests.
        seed: u64 = 1, in within(0.0, 9e15);
    }

    /// Walks through the inputs, one step each.
    MorrisKeys {
        /// Walks; each takes as many tests as there are inputs, and one.
        walks: u64 = 20, in within(2.0, MAX_TESTS);
        /// Values of an input, an even number.
        levels: u64 = 4, in within(2.0, 1000.0);
        /// Of the chance: the same seed gives the same tests.
        seed: u64 = 1, in within(0.0, 9e15);
    }

    /// Few values of each input.
    FactorialKeys {
        /// Values taken of an input that is given by its distribution, from end to end.
        points: u64 = 3, in within(2.0, 1000.0);
    }

    /// The tests themselves.
    RowsKeys {
        /// CSV file: the first line has keys of the case, every other line their values in one test.
        file: DataFile;
    }

    /// A search for the best.
    OptimiseKeys {
        /// The output that is to be least, as far as the limits allow.
        minimise: String = "mass_loss_mg".to_owned();
        /// Tests, at most.
        size: u64 = 400, in within(10.0, 1e6);
        /// Of the chance: the same seed gives the same tests.
        seed: u64 = 1, in within(0.0, 9e15);
    }

    /// Two inputs that go together.
    CorrelationKeys {
        /// Their two keys.
        keys: Names;
        /// Correlation of the two normal distributions; of inputs that are not normal, of the normal scores behind them.
        coefficient: f64, in within(-0.999, 0.999);
    }

    /// One of several designs, each tried under the same disturbances.
    AlternativeKeys {
        /// Its name.
        name: String;
        /// What it sets of the case, each as `key=value`.
        set: Names;
    }

    /// What an output must keep to.
    BoundKeys {
        /// The output.
        output: String;
        /// Least that is allowed.
        least: Option<f64> = None;
        /// Most that is allowed.
        most: Option<f64> = None;
    }

    /// What is asked.
    AnswersKeys {
        /// Outputs that answers and pictures are about; the table has all of them.
        outputs: Names = Names(["mass_loss_mg", "max_depth_mm", "peak_pressure_mpa"].map(str::to_owned).to_vec());
        /// The output that designs are ranked by, the least first; the first of `outputs` if not given.
        rank_by: Option<String> = None;
        /// Two outputs that are both to be small; the first two of `outputs` if not given.
        pareto: Option<Names> = None;
    }
}

variants! {
    /// How an input varies.
    Variation by
    /// How its values are distributed.
    distribution = "uniform" {
        /// Equally likely everywhere.
        Uniform(UniformKeys) = "uniform",
        /// Normal.
        Normal(NormalKeys) = "normal",
        /// Normal, but never outside of two values.
        TruncatedNormal(TruncatedKeys) = "truncated-normal",
        /// Likelier the nearer to one value.
        Triangular(TriangularKeys) = "triangular",
        /// One of a few values.
        Levels(LevelKeys) = "levels",
    }
}

variants! {
    /// Which tests are done.
    Design by
    /// How tests are chosen.
    kind = "latin-hypercube" {
        /// Of every input one value lies in each of as many equally likely slices.
        LatinHypercube(SampleKeys) = "latin-hypercube",
        /// Points of Sobol, scrambled by Owen's method.
        Sobol(SampleKeys) = "sobol",
        /// Points of Sobol, each again with every input changed: for Sobol's indices.
        Saltelli(SampleKeys) = "saltelli",
        /// Walks through the inputs: for the elementary effects of Morris.
        Morris(MorrisKeys) = "morris",
        /// Every value of each input with every value of all others.
        FullFactorial(FactorialKeys) = "full-factorial",
        /// The case as it is, and each value of each input with all others as they are.
        OneAtATime(FactorialKeys) = "one-at-a-time",
        /// Those of a CSV file.
        Rows(RowsKeys) = "rows",
        /// Those that a search for the best asks for.
        Optimise(OptimiseKeys) = "optimise",
    }
}
