//! The tests of a study in one SQLite file, which Python's standard library reads.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    time::Duration,
};

use condyle_case::config::Level;
use rusqlite::{
    Connection, params_from_iter,
    types::{Value, ValueRef},
};

use crate::{
    error::StudyError,
    plan::{Plan, Shard, Test, TestResult},
};

/// Its name in the study's folder.
pub const DATABASE: &str = "study.db";
/// Changes when the tables do.
const FORMAT: &str = "1";
/// How long another process that reads may hold up a write.
const PATIENCE: Duration = Duration::from_secs(60);

/// The database of a study.
pub struct Store {
    connection: Connection,
    path: PathBuf,
}

/// What is kept of a study besides its tests.
pub(crate) struct Keeping<'a> {
    pub plan: &'a Plan,
    pub shard: Shard,
}

/// How a test ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    Done,
    Failed,
}

impl Status {
    pub fn word(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Failed => "failed",
        }
    }
}

impl Store {
    /// The database of a study in `folder`, made if the folder is empty or not there; one of the same study is gone on
    /// with.
    ///
    /// # Errors
    /// A folder of another study, or with something else in it; a file that cannot be written.
    pub(crate) fn open(folder: &Path, keeping: &Keeping<'_>) -> Result<Self, StudyError> {
        let path = folder.join(DATABASE);
        let is_new = !path.exists();
        if is_new && holds_anything(folder)? {
            let folder = folder.to_path_buf();
            return Err(StudyError::NotEmpty { folder });
        }
        fs::create_dir_all(folder).map_err(|source| StudyError::Refused {
            path: folder.to_path_buf(),
            source,
        })?;
        let store = Self::connected(path)?;
        store.checked(|connection| {
            // A commit survives the end of the program at once, and that of the machine soon.
            connection.execute_batch("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;")
        })?;
        if store.is_empty()? {
            store.create(keeping)?;
        } else {
            store.check_same(folder, keeping)?;
        }
        Ok(store)
    }

    /// The database of any study in `folder`, to be read.
    ///
    /// # Errors
    /// A folder without a study.
    pub fn read(folder: &Path) -> Result<Self, StudyError> {
        let path = folder.join(DATABASE);
        if !path.is_file() {
            let folder = folder.to_path_buf();
            return Err(StudyError::NoStudy { folder });
        }
        Self::connected(path)
    }

    /// The database of `plan` that is in `folder`.
    ///
    /// # Errors
    /// A folder without a study, or with another one than `plan`.
    pub fn existing(folder: &Path, plan: &Plan) -> Result<Self, StudyError> {
        let store = Self::read(folder)?;
        store.check_tests(folder, plan)?;
        Ok(store)
    }

    fn connected(path: PathBuf) -> Result<Self, StudyError> {
        let connection = Connection::open(&path).map_err(|source| StudyError::Store {
            path: path.clone(),
            source,
        })?;
        let store = Self { connection, path };
        store.checked(|connection| connection.busy_timeout(PATIENCE))?;
        Ok(store)
    }

    /// What `work` does with the connection, with the file named where it cannot.
    pub(crate) fn checked<T>(
        &self,
        work: impl FnOnce(&Connection) -> rusqlite::Result<T>,
    ) -> Result<T, StudyError> {
        work(&self.connection).map_err(|source| StudyError::Store {
            path: self.path.clone(),
            source,
        })
    }

    fn is_empty(&self) -> Result<bool, StudyError> {
        let count = "SELECT count(*) FROM sqlite_schema WHERE name = 'study'";
        let count: i64 = self.checked(|one| one.query_row(count, [], |row| row.get(0)))?;
        Ok(count == 0)
    }

    /// Makes the tables in one step.
    fn create(&self, keeping: &Keeping<'_>) -> Result<(), StudyError> {
        let table = table(keeping.plan);
        let facts = facts(keeping);
        self.checked(|connection| {
            let transaction = connection.unchecked_transaction()?;
            transaction.execute_batch(&table)?;
            for (name, value) in facts {
                transaction.execute("INSERT INTO study VALUES (?1, ?2)", [name, value.as_str()])?;
            }
            transaction.commit()
        })
    }

    fn check_same(&self, folder: &Path, keeping: &Keeping<'_>) -> Result<(), StudyError> {
        self.check_tests(folder, keeping.plan)?;
        let same = self.fact("shard")? == Some(keeping.shard.to_string());
        let (folder, is_shard) = (folder.to_path_buf(), true);
        if same {
            Ok(())
        } else {
            Err(StudyError::OtherStudy { folder, is_shard })
        }
    }

    /// Refuses a database of other tests.
    fn check_tests(&self, folder: &Path, plan: &Plan) -> Result<(), StudyError> {
        let is_format = self.fact("format")?.as_deref() == Some(FORMAT);
        let same = self.fact("inputs_blake3")?.as_deref() == Some(plan.inputs_blake3());
        let (folder, is_shard) = (folder.to_path_buf(), false);
        if is_format && same {
            Ok(())
        } else {
            Err(StudyError::OtherStudy { folder, is_shard })
        }
    }

    fn fact(&self, name: &str) -> Result<Option<String>, StudyError> {
        let query = "SELECT value FROM study WHERE name = ?1";
        self.checked(|connection| {
            let found = connection.query_row(query, [name], |row| row.get(0));
            match found {
                Err(rusqlite::Error::QueryReturnedNoRows) => Ok(None),
                found => found.map(Some),
            }
        })
    }

    /// Which of so many tests are kept.
    pub(crate) fn kept(&self, tests: u64) -> Result<Vec<bool>, StudyError> {
        self.checked(|connection| {
            let mut kept = vec![false; tests as usize];
            let mut statement = connection.prepare("SELECT \"row\" FROM tests")?;
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                if let Some(one) = kept.get_mut(row.get::<_, i64>(0)? as usize) {
                    *one = true;
                }
            }
            Ok(kept)
        })
    }

    /// Keeps what tests found, all in one step.
    pub fn keep(&self, plan: &Plan, found: &[(Test, TestResult)]) -> Result<(), StudyError> {
        self.checked(|connection| {
            let transaction = connection.unchecked_transaction()?;
            {
                let mut statement = transaction.prepare(&insert(plan))?;
                for (test, result) in found {
                    statement.execute(params_from_iter(cells(plan, test, result)))?;
                }
            }
            transaction.commit()
        })
    }

    /// The outputs of a test that is done; none of one that failed or is not there.
    pub(crate) fn outputs(&self, row: u64, plan: &Plan) -> Result<Option<TestResult>, StudyError> {
        let (_, outputs) = plan.columns();
        let query = format!(
            "SELECT reason, {} FROM tests WHERE \"row\" = ?1",
            quoted(&outputs)
        );
        self.checked(|connection| {
            let mut statement = connection.prepare(&query)?;
            let mut rows = statement.query([row as i64])?;
            let Some(row) = rows.next()? else {
                return Ok(None);
            };
            let reason: Option<String> = row.get(0)?;
            let values: rusqlite::Result<Vec<Option<f64>>> =
                (1..=outputs.len()).map(|place| row.get(place)).collect();
            let values: Option<Vec<f64>> = values?.into_iter().collect();
            Ok(Some(values.ok_or_else(|| reason.unwrap_or_default())))
        })
    }

    /// Test `row` with the inputs that are kept of it: the only place that has those of a search.
    ///
    /// # Errors
    /// A test that is not kept.
    pub fn test(&self, row: u64, plan: &Plan) -> Result<Test, StudyError> {
        let (inputs, _) = plan.columns();
        let query = format!("SELECT {} FROM tests WHERE \"row\" = ?1", quoted(&inputs));
        let values = self.checked(|connection| {
            let found = connection.query_row(&query, [row as i64], |cells| {
                (0..inputs.len())
                    .map(|place| cells.get::<_, f64>(place))
                    .collect()
            });
            match found {
                Err(rusqlite::Error::QueryReturnedNoRows) => Ok(None),
                found => found.map(Some),
            }
        })?;
        let values: Vec<f64> = values.ok_or(StudyError::NotYet { row })?;
        Ok(Test {
            row,
            alternative: 0,
            values: values
                .into_iter()
                .map(|value| Some(Level::Number(value)))
                .collect(),
        })
    }

    /// Puts the tests of the database at `other` beside these; those that are here already stay.
    pub(crate) fn take_all(&self, other: &Path) -> Result<(), StudyError> {
        self.checked(|connection| {
            connection.execute(
                "ATTACH DATABASE ?1 AS other",
                [other.to_string_lossy().into_owned()],
            )?;
            connection.execute("INSERT OR IGNORE INTO tests SELECT * FROM other.tests", [])?;
            connection.execute_batch("DETACH DATABASE other")
        })
    }
}

fn holds_anything(folder: &Path) -> Result<bool, StudyError> {
    match fs::read_dir(folder) {
        // The lock of the folder is ours.
        Ok(entries) => Ok(entries.flatten().any(|entry| entry.file_name() != "in_use")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(source) => {
            let path = folder.to_path_buf();
            Err(StudyError::Refused { path, source })
        }
    }
}

/// A name as SQL has it.
pub(crate) fn name(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}

pub(crate) fn quoted(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().copied().map(name).collect();
    quoted.join(", ")
}

fn has_designs(plan: &Plan) -> bool {
    !plan.study().alternatives.is_empty()
}

fn table(plan: &Plan) -> String {
    let (inputs, outputs) = plan.columns();
    let inputs: String = inputs
        .iter()
        .map(|key| format!("{}, ", name(key)))
        .collect();
    let outputs: Vec<String> = outputs
        .iter()
        .map(|output| format!("{} REAL", name(output)))
        .collect();
    let design = if has_designs(plan) {
        "\"design\" TEXT NOT NULL, "
    } else {
        ""
    };
    format!(
        "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
         CREATE TABLE tests (\"row\" INTEGER PRIMARY KEY, {design}\"status\" TEXT NOT NULL, \"reason\" TEXT, \
         {inputs}{});",
        outputs.join(", ")
    )
}

fn insert(plan: &Plan) -> String {
    let (inputs, outputs) = plan.columns();
    let count = 3 + usize::from(has_designs(plan)) + inputs.len() + outputs.len();
    format!(
        "INSERT OR IGNORE INTO tests VALUES ({})",
        vec!["?"; count].join(", ")
    )
}

fn facts(keeping: &Keeping<'_>) -> [(&'static str, String); 6] {
    let study = keeping.plan.study();
    [
        ("format", FORMAT.to_owned()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("inputs_blake3", keeping.plan.inputs_blake3().to_owned()),
        ("shard", keeping.shard.to_string()),
        ("tests", keeping.plan.tests().to_string()),
        ("study.toml", study.text.clone()),
    ]
}

fn cells(plan: &Plan, test: &Test, result: &TestResult) -> Vec<Value> {
    let status = if result.is_ok() {
        Status::Done
    } else {
        Status::Failed
    };
    let text = |text: &str| Value::Text(text.to_owned());
    let reason = result
        .as_ref()
        .err()
        .map_or(Value::Null, |reason| text(reason));
    let mut cells = vec![Value::Integer(test.row as i64)];
    cells.extend(plan.design_of(test).map(text));
    cells.extend([text(status.word()), reason]);
    cells.extend(plan.written_values(test).into_iter().map(as_sql));
    let (_, outputs) = plan.columns();
    cells.extend((0..outputs.len()).map(|place| {
        let value = result.as_ref().ok().map(|values| values[place]);
        value
            .filter(|value| value.is_finite())
            .map_or(Value::Null, Value::Real)
    }));
    cells
}

fn as_sql(level: Option<Level>) -> Value {
    match level {
        Some(Level::Number(number)) => Value::Real(number),
        Some(Level::Word(word)) => Value::Text(word),
        None => Value::Null,
    }
}

/// A column of the table, a value a test; of a test that failed or is not there, not a number.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Column {
    /// Of words the place of each among `words`.
    pub values: Vec<f64>,
    /// In the order of the alphabet; none where all are numbers.
    pub words: Vec<String>,
}

impl Store {
    /// The column called `called` of every test that is done.
    pub(crate) fn column(&self, plan: &Plan, called: &str) -> Result<Column, StudyError> {
        let words = self.words(called)?;
        let query = format!(
            "SELECT \"row\", {} FROM tests WHERE status = 'done'",
            name(called)
        );
        self.checked(|connection| {
            let mut values = vec![f64::NAN; plan.tests() as usize];
            let mut statement = connection.prepare(&query)?;
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                let value = match row.get_ref(1)? {
                    ValueRef::Real(number) => number,
                    ValueRef::Integer(whole) => whole as f64,
                    ValueRef::Text(text) => {
                        let text = String::from_utf8_lossy(text);
                        words
                            .iter()
                            .position(|word| *word == text)
                            .map_or(f64::NAN, |place| place as f64)
                    }
                    ValueRef::Null | ValueRef::Blob(_) => f64::NAN,
                };
                if let Some(place) = values.get_mut(row.get::<_, i64>(0)? as usize) {
                    *place = value;
                }
            }
            Ok(Column { values, words })
        })
    }

    fn words(&self, called: &str) -> Result<Vec<String>, StudyError> {
        let column = name(called);
        let query = format!(
            "SELECT DISTINCT {column} FROM tests WHERE typeof({column}) = 'text' ORDER BY {column}"
        );
        self.checked(|connection| {
            let mut statement = connection.prepare(&query)?;
            let words = statement.query_map([], |row| row.get(0))?;
            words.collect()
        })
    }

    /// Tests that failed: how many by each reason, the most frequent first.
    pub(crate) fn reasons(&self) -> Result<Vec<(String, u64)>, StudyError> {
        let query = "SELECT coalesce(reason, ''), count(*) AS many FROM tests WHERE status = 'failed' \
                     GROUP BY reason ORDER BY many DESC, reason";
        self.checked(|connection| {
            let mut statement = connection.prepare(query)?;
            let reasons =
                statement.query_map([], |row| Ok((row.get(0)?, row.get::<_, i64>(1)? as u64)))?;
            reasons.collect()
        })
    }

    /// Tests that are kept.
    pub fn count(&self) -> Result<u64, StudyError> {
        self.checked(|connection| {
            let count = |row: &rusqlite::Row<'_>| row.get::<_, i64>(0);
            Ok(connection.query_row("SELECT count(*) FROM tests", [], count)? as u64)
        })
    }
}

impl Store {
    /// Writes every test that is kept, in the order of their numbers: the same bytes whoever ran them, and in which order.
    ///
    /// # Errors
    /// A database that cannot be read; what `out` says.
    pub fn write_csv(&self, out: &mut dyn Write) -> Result<io::Result<()>, StudyError> {
        self.checked(|connection| {
            let mut statement = connection.prepare("SELECT * FROM tests ORDER BY \"row\"")?;
            let names: Vec<String> = statement.column_names().map(cell).collect();
            let mut written = writeln!(out, "{}", names.join(","));
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                let cells = (0..names.len()).map(|place| Ok(text(row.get_ref(place)?)));
                let cells: Vec<String> = cells.collect::<rusqlite::Result<_>>()?;
                written = written.and_then(|()| writeln!(out, "{}", cells.join(",")));
                if written.is_err() {
                    break;
                }
            }
            Ok(written)
        })
    }
}

fn text(value: ValueRef<'_>) -> String {
    match value {
        ValueRef::Null => String::new(),
        ValueRef::Integer(whole) => whole.to_string(),
        ValueRef::Real(number) => number.to_string(),
        ValueRef::Text(bytes) | ValueRef::Blob(bytes) => cell(&String::from_utf8_lossy(bytes)),
    }
}

/// A cell of CSV, in quotes where it must be.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
