//! The tests of a study in one SQLite file, which Python's standard library reads.

mod table;

use std::{
    fs, io,
    path::{Path, PathBuf},
    time::Duration,
};

use condyle_case::{config::Level, study::Design};
use condyle_results::{FolderLock, ResultsFolder};
use rusqlite::{Connection, params_from_iter, types::Value};

pub(crate) use self::table::Column;
use crate::{
    error::StudyError,
    plan::{Plan, Shard, Test, TestOutputs, TestResult},
};

/// Name of the file in the study's folder.
pub(crate) const DATABASE: &str = "study.db";
/// Name of the file under which a new database is created.
const NEW_DATABASE: &str = "study.db.part";
const FORMAT: &str = "3";
/// The last column of the tests: the checksum of the others, so that damage to the file is no result.
const CHECKSUM: &str = "checksum";
/// Longest time for which a reading process may delay a write.
const MAX_WAIT: Duration = Duration::from_secs(60);

/// The database of a study; it locks the folder of the study against other writers.
pub struct Store {
    connection: Connection,
    path: PathBuf,
    _lock: Option<FolderLock>,
}

impl Store {
    /// Takes the folder `out` for a plan; folder and database are created if they do not exist.
    ///
    /// # Errors
    /// The folder holds another study or other files, is in use, or cannot be written.
    pub fn take(plan: &Plan, out: &Path) -> Result<Self, StudyError> {
        Self::take_shard(plan, Shard::WHOLE, out)
    }

    pub(crate) fn take_shard(plan: &Plan, shard: Shard, out: &Path) -> Result<Self, StudyError> {
        fs::create_dir_all(out).map_err(StudyError::refused(out))?;
        let lock = ResultsFolder::lock(out)?;
        let path = out.join(DATABASE);
        if !path.exists() && holds_anything(out)? {
            return Err(StudyError::folder(
                out,
                "the folder is not empty and holds no study; give another one with --out",
            ));
        }
        if !path.exists() {
            Self::create(plan, shard, &out.join(NEW_DATABASE))?;
            fs::rename(out.join(NEW_DATABASE), &path).map_err(StudyError::refused(&path))?;
        }
        let mut store = Self::connect(path)?;
        store._lock = lock;
        store.checked(|connection| {
            // In this mode a commit survives the end of the program at once, and a power failure within seconds, for a
            // fraction of the time of a synchronous commit.
            connection.execute_batch("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;")
        })?;
        store.check_tests(out, plan)?;
        if store.fact("shard")? != Some(shard.to_string()) {
            let problem = "the folder holds another study, or another shard of this one; give another one with --out, \
                           or remove it";
            return Err(StudyError::folder(out, problem));
        }
        store.grow(plan)?;
        Ok(store)
    }

    /// Opens the database of any study in `folder` for reading.
    ///
    /// # Errors
    /// The folder holds no study.
    pub fn read(folder: &Path) -> Result<Self, StudyError> {
        let path = folder.join(DATABASE);
        if !path.is_file() {
            let problem = "the folder holds no study; give one that `condyle study` wrote";
            return Err(StudyError::folder(folder, problem));
        }
        Self::connect(path)
    }

    pub(crate) fn existing(folder: &Path, plan: &Plan) -> Result<Self, StudyError> {
        let store = Self::read(folder)?;
        store.check_tests(folder, plan)?;
        Ok(store)
    }

    fn connect(path: PathBuf) -> Result<Self, StudyError> {
        let connection = Connection::open(&path).map_err(StudyError::refused(&path))?;
        let store = Self {
            connection,
            path,
            _lock: None,
        };
        store.checked(|connection| connection.busy_timeout(MAX_WAIT))?;
        store.check_rows()?;
        Ok(store)
    }

    /// Rejects a database without tables, and one whose tests are not those that were stored.
    fn check_rows(&self) -> Result<(), StudyError> {
        let damaged = |what: &str| {
            let problem = format!(
                "{what}: the file is damaged; restore it from a copy, or remove it and run the study again"
            );
            StudyError::folder(&self.path, &problem)
        };
        let Some(tables) = self.tables()? else {
            return Err(damaged("it holds no study"));
        };
        if self.fact("format")?.as_deref() != Some(FORMAT) {
            let problem = "it was written by another version of condyle; read it with that version, or remove it";
            return Err(StudyError::folder(&self.path, problem));
        }
        let wrong = self.checked(|connection| {
            let mut statement = connection.prepare("SELECT * FROM tests ORDER BY \"row\"")?;
            let places = statement.column_count();
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                let cells: rusqlite::Result<Vec<Value>> =
                    (0..places).map(|place| row.get(place)).collect();
                let mut cells = cells?;
                if cells.pop() != Some(Value::Text(checksum(&tables, &cells))) {
                    return Ok(Some(row.get_ref(0)?.as_i64().unwrap_or(-1)));
                }
            }
            Ok(None)
        })?;
        match wrong {
            Some(row) => Err(damaged(&format!("row {row} does not have its checksum"))),
            None => Ok(()),
        }
    }

    /// Returns the declaration of the table of tests, in bytes that need not be text; none if there is no such table.
    fn tables(&self) -> Result<Option<Vec<u8>>, StudyError> {
        let query = "SELECT sql FROM sqlite_schema WHERE name = ?1";
        self.first_row(query, "tests", |row| {
            Ok(row.get_ref(0)?.as_bytes().unwrap_or_default().to_vec())
        })
    }

    /// Adds the name of the file to errors of `work`.
    fn checked<T>(
        &self,
        work: impl FnOnce(&Connection) -> rusqlite::Result<T>,
    ) -> Result<T, StudyError> {
        work(&self.connection).map_err(StudyError::refused(&self.path))
    }

    /// Creates the database of a study without tests at `path`; what a killed study has left there is removed.
    fn create(plan: &Plan, shard: Shard, path: &Path) -> Result<(), StudyError> {
        let refused = StudyError::refused(path);
        match fs::remove_file(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(refused(error)),
            _ => {}
        }
        let study = plan.study();
        let (inputs, outputs) = plan.columns();
        let mut columns = vec!["\"row\" INTEGER PRIMARY KEY".to_owned()];
        if !study.alternatives.is_empty() {
            columns.push("\"design\" TEXT NOT NULL".to_owned());
        }
        columns.extend(["\"status\" TEXT NOT NULL", "\"reason\" TEXT"].map(str::to_owned));
        columns.extend(inputs.iter().map(|key| quoted(key)));
        columns.extend(outputs.iter().map(|key| format!("{} REAL", quoted(key))));
        columns.push(format!("{} TEXT NOT NULL", quoted(CHECKSUM)));
        let tables = format!(
            "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
             CREATE TABLE tests ({});",
            columns.join(", ")
        );
        let facts = [
            ("format", FORMAT),
            ("version", env!("CARGO_PKG_VERSION")),
            ("inputs_blake3", plan.inputs_blake3()),
            ("shard", &shard.to_string()),
            ("tests", &plan.tests().to_string()),
            ("study.toml", &study.text),
        ];
        let created = || {
            let connection = Connection::open(path)?;
            // A journal beside the file would outlive a killed study; what is unfinished is created again.
            connection.execute_batch("PRAGMA journal_mode = MEMORY;")?;
            let transaction = connection.unchecked_transaction()?;
            transaction.execute_batch(&tables)?;
            for (name, value) in facts {
                transaction.execute("INSERT INTO study VALUES (?1, ?2)", [name, value])?;
            }
            transaction.commit()
        };
        created().map_err(|error: rusqlite::Error| StudyError::refused(path)(error))
    }

    /// Rejects a database with the tests of another plan.
    fn check_tests(&self, folder: &Path, plan: &Plan) -> Result<(), StudyError> {
        if self.fact("inputs_blake3")?.as_deref() == Some(plan.inputs_blake3()) {
            let stored = self.fact("tests")?.and_then(|tests| tests.parse().ok());
            let stored: u64 = stored.unwrap_or_default();
            if stored <= plan.tests() {
                return Ok(());
            }
            let problem = format!(
                "the folder holds this study with {stored} tests, more than the {} of the file; raise its number of tests again, \
                 or give another folder with --out",
                plan.tests()
            );
            return Err(StudyError::folder(folder, &problem));
        }
        // The size of its smallest hypercube is among the inputs of a study.
        let rule = match plan.study().design {
            Design::LatinHypercube(_) => {
                " (only twice the size, four times the size and so on continue a Latin hypercube)"
            }
            _ => "",
        };
        let problem = format!(
            "the folder holds another study{rule}; give another one with --out, or remove it"
        );
        Err(StudyError::folder(folder, &problem))
    }

    /// Takes the text and the number of tests of a plan that has more of them than the study in the folder had, or aims at
    /// smaller errors.
    fn grow(&self, plan: &Plan) -> Result<(), StudyError> {
        let facts = [
            ("tests", plan.tests().to_string()),
            ("study.toml", plan.study().text.clone()),
        ];
        let mut is_known = true;
        for (name, value) in &facts {
            is_known &= self.fact(name)?.as_ref() == Some(value);
        }
        if is_known {
            return Ok(());
        }
        let update = "UPDATE study SET value = ?2 WHERE name = ?1";
        self.checked(|connection| {
            for (name, value) in facts {
                connection.execute(update, [name, &value])?;
            }
            Ok(())
        })
    }

    fn fact(&self, name: &str) -> Result<Option<String>, StudyError> {
        let query = "SELECT value FROM study WHERE name = ?1";
        self.first_row(query, name, |row| row.get(0))
    }

    fn first_row<T>(
        &self,
        query: &str,
        parameter: impl rusqlite::ToSql,
        read: impl FnOnce(&rusqlite::Row<'_>) -> rusqlite::Result<T>,
    ) -> Result<Option<T>, StudyError> {
        self.checked(
            |connection| match connection.query_row(query, [parameter], read) {
                Err(rusqlite::Error::QueryReturnedNoRows) => Ok(None),
                found => found.map(Some),
            },
        )
    }

    /// Returns the numbers of the tests that are not stored.
    ///
    /// # Errors
    /// The tests of a sequential design are not known in advance.
    pub fn missing(&self, plan: &Plan) -> Result<Vec<u64>, StudyError> {
        if plan.is_sequential() {
            return Err(StudyError::no_shards());
        }
        let rows = (0..).zip(self.kept(plan)?);
        Ok(rows.filter(|(_, is)| !is).map(|(row, _)| row).collect())
    }

    /// Stores the results of tests in one transaction; a test that is stored already does not change.
    ///
    /// # Errors
    /// The database cannot be written, for instance because the disk is full.
    pub fn keep(&self, plan: &Plan, found: &[(Test, TestResult)]) -> Result<(), StudyError> {
        let tables = self.tables()?.unwrap_or_default();
        let row = |(test, result): &(Test, TestResult)| {
            let mut cells = cells(plan, test, result);
            cells.push(Value::Text(checksum(&tables, &cells)));
            cells
        };
        let rows: Vec<Vec<Value>> = found.iter().map(row).collect();
        let Some(first) = rows.first() else {
            return Ok(());
        };
        let places = vec!["?"; first.len()].join(", ");
        // Two machines may have run the same test; both results are the same.
        let insert = format!("INSERT OR IGNORE INTO tests VALUES ({places})");
        self.checked(|connection| {
            let transaction = connection.unchecked_transaction()?;
            let mut statement = transaction.prepare(&insert)?;
            for row in rows {
                statement.execute(params_from_iter(row))?;
            }
            drop(statement);
            transaction.commit()
        })
    }

    /// Returns a test with its stored inputs, which for a sequential design are stored only here, and its result; none if it is not
    /// stored.
    fn stored(&self, row: u64, plan: &Plan) -> Result<Option<(Test, TestResult)>, StudyError> {
        let (inputs, outputs) = plan.columns();
        let columns = inputs.iter().chain(&outputs).map(|name| quoted(name));
        let query = format!(
            "SELECT status, reason, {} FROM tests WHERE \"row\" = ?1",
            columns.collect::<Vec<_>>().join(", ")
        );
        self.first_row(&query, row as i64, |cells| {
            let places = 2..2 + inputs.len();
            let levels = places
                .clone()
                .map(|place| cells.get(place).map(Level::Number));
            let test = Test {
                row,
                alternative: 0,
                values: levels
                    .map(|level| level.map(Some))
                    .collect::<Result<_, _>>()?,
            };
            // An output that a test does not have, such as a motion of another joint, is empty.
            let values = (places.end..places.end + outputs.len())
                .map(|place| Ok(cells.get::<_, Option<f64>>(place)?.unwrap_or(f64::NAN)));
            let outputs = TestOutputs {
                values: values.collect::<rusqlite::Result<_>>()?,
                doubts: cells.get::<_, Option<String>>(1)?.unwrap_or_default(),
            };
            let is_done = cells.get_ref(0)?.as_str() == Ok("done");
            let result = match is_done {
                true => Ok(outputs),
                false => Err(outputs.doubts),
            };
            Ok((test, result))
        })
    }

    /// Returns the stored tests from row `first` on, up to the first row that is not stored.
    pub(crate) fn known(
        &self,
        plan: &Plan,
        first: u64,
    ) -> Result<Vec<(Test, TestResult)>, StudyError> {
        let stored = (first..).map(|row| self.stored(row, plan));
        stored.map_while(Result::transpose).collect()
    }

    /// Adds the tests of another database; tests that are already stored do not change.
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

    /// Returns the number of stored tests.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn count(&self) -> Result<u64, StudyError> {
        let count = |row: &rusqlite::Row<'_>| row.get::<_, i64>(0);
        self.checked(|one| Ok(one.query_row("SELECT count(*) FROM tests", [], count)? as u64))
    }

    /// Returns the reasons of tests of a status, `failed` or doubtful ones that are `done`, with their counts, the most
    /// frequent first.
    pub(crate) fn reasons(&self, status: &str) -> Result<Vec<(String, u64)>, StudyError> {
        let query = "SELECT coalesce(reason, ''), count(*) AS many FROM tests WHERE status = ?1 \
                     AND (status = 'failed' OR reason IS NOT NULL) GROUP BY reason ORDER BY many DESC, reason";
        self.checked(|connection| {
            let mut statement = connection.prepare(query)?;
            let reasons = statement.query_map([status], |row| {
                Ok((row.get(0)?, row.get::<_, i64>(1)? as u64))
            })?;
            reasons.collect()
        })
    }

    /// Returns whether each test is stored, done or failed.
    pub(crate) fn kept(&self, plan: &Plan) -> Result<Vec<bool>, StudyError> {
        let mut stored = vec![false; plan.tests() as usize];
        self.checked(|connection| {
            let mut statement = connection.prepare("SELECT \"row\" FROM tests")?;
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                if let Some(one) = stored.get_mut(row.get::<_, i64>(0)? as usize) {
                    *one = true;
                }
            }
            Ok(())
        })?;
        Ok(stored)
    }
}

impl Plan {
    /// Test `row`; that of a sequential design as it is stored in `folder`.
    ///
    /// # Errors
    /// A row that the study does not have, or a sequential design has not reached.
    pub fn row(&self, row: u64, folder: Option<&Path>) -> Result<Test, StudyError> {
        let tests = self.tests();
        if row >= tests {
            let last = tests - 1;
            return Err(StudyError::Plan(format!(
                "the study has no row {row}; its rows are 0 to {last}"
            )));
        }
        let mut test = self.test(row);
        if let (None, Some(folder)) = (&test, folder) {
            let stored = Store::existing(folder, self)?.stored(row, self)?;
            test = stored.map(|(test, _)| test);
        }
        test.ok_or_else(|| {
            StudyError::Plan(format!(
                "row {row} depends on the results of earlier tests, which have not reached it; run the study first"
            ))
        })
    }
}

/// Returns whether a folder exists and holds anything besides the lock of a study or run and a database that was
/// not completed.
pub(crate) fn holds_anything(folder: &Path) -> Result<bool, StudyError> {
    let own = ["in_use", NEW_DATABASE];
    match fs::read_dir(folder) {
        Ok(mut entries) => Ok(entries
            .any(|entry| entry.is_ok_and(|one| !own.iter().any(|own| one.file_name() == *own)))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(source) => Err(StudyError::refused(folder)(source)),
    }
}

fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}

fn cells(plan: &Plan, test: &Test, result: &TestResult) -> Vec<Value> {
    let text = |text: &str| Value::Text(text.to_owned());
    let mut cells = vec![Value::Integer(test.row as i64)];
    let design = plan.study().alternatives.get(test.alternative);
    cells.extend(design.map(|design| text(&design.name)));
    cells.extend(match result {
        Ok(outputs) if outputs.doubts.is_empty() => [text("done"), Value::Null],
        Ok(outputs) => [text("done"), text(&outputs.doubts)],
        Err(reason) => [text("failed"), text(reason)],
    });
    let inputs = plan.study().inputs.iter().zip(&test.values);
    cells.extend(inputs.map(|(input, value)| {
        // An input that the test does not set has the value of the case.
        let value = value.clone();
        match value.or_else(|| plan.study().value_of_case(input)) {
            Some(Level::Number(number)) => Value::Real(number),
            Some(Level::Word(word)) => Value::Text(word),
            None => Value::Null,
        }
    }));
    let (_, outputs) = plan.columns();
    cells.extend((0..outputs.len()).map(|place| {
        let value = result.as_ref().ok().map(|outputs| outputs.values[place]);
        value
            .filter(|value| value.is_finite())
            .map_or(Value::Null, Value::Real)
    }));
    cells
}

/// Returns the checksum of a row: of the declaration of its table and of the type and value of every cell.
fn checksum(tables: &[u8], cells: &[Value]) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(tables);
    for cell in cells {
        let cell = match cell {
            // SQLite stores -0 as 0.
            Value::Real(number) => Value::Real(number + 0.0),
            other => other.clone(),
        };
        hasher.update(format!("{cell:?}").as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STUDY: &str = "case = \"case.toml\"\n[design]\nsize = 3\n\
        [[vary]]\nkey = \"contact.friction\"\nlow = 0.02\nhigh = 0.1\n";

    /// Returns a folder with a study of one stored test, and its plan.
    fn stored() -> (tempfile::TempDir, Plan) {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.toml"), "").unwrap();
        fs::write(folder.path().join("study.toml"), STUDY).unwrap();
        let plan = Plan::read(&folder.path().join("study.toml")).unwrap();
        let store = Store::take(&plan, &folder.path().join("out")).unwrap();
        let outputs = TestOutputs {
            values: (0..plan.columns().1.len())
                .map(|one| -0.0 + one as f64)
                .collect(),
            doubts: String::new(),
        };
        store
            .keep(&plan, &[(plan.test(0).unwrap(), Ok(outputs))])
            .unwrap();
        drop(store);
        (folder, plan)
    }

    /// Returns why a study is refused after `damage` to its database.
    fn refusal(damage: impl Fn(&Path)) -> String {
        let (folder, plan) = stored();
        let out = folder.path().join("out");
        assert!(Store::existing(&out, &plan).is_ok());
        damage(&out.join(DATABASE));
        let taken = Store::take(&plan, &out).err().unwrap().to_string();
        assert_eq!(Store::read(&out).err().unwrap().to_string(), taken);
        taken
    }

    #[test]
    fn a_damaged_database_is_an_error_and_neither_a_result_nor_a_new_study() {
        let changed = |change: &'static str| {
            refusal(move |path| {
                let changed = Connection::open(path).unwrap().execute(change, []);
                assert_eq!(changed.unwrap(), 1);
            })
        };
        for change in [
            "UPDATE tests SET mass_loss_mg = mass_loss_mg + 1e-9",
            "UPDATE tests SET \"contact.friction\" = 0.05",
            "UPDATE tests SET \"row\" = 1",
        ] {
            let said = changed(change);
            assert!(said.contains("does not have its checksum"), "{said}");
        }
        let said = refusal(|path| fs::write(path, "").unwrap());
        assert!(said.contains("it holds no study"), "{said}");
    }

    #[test]
    fn a_study_grows_but_does_not_shrink() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.toml"), "").unwrap();
        let plan = |kind: &str, size: u32| {
            let text = STUDY.replace("size = 3", &format!("kind = \"{kind}\"\nsize = {size}"));
            fs::write(folder.path().join("study.toml"), text).unwrap();
            Plan::read(&folder.path().join("study.toml")).unwrap()
        };
        let take = |kind: &str, size| Store::take(&plan(kind, size), &folder.path().join(kind));
        for kind in ["sobol", "saltelli", "latin-hypercube"] {
            let (small, large) = (plan(kind, 4), plan(kind, 8));
            assert!((0..small.tests()).all(|row| small.test(row) == large.test(row)));
            drop(take(kind, 4).unwrap());
            let missing = take(kind, 8).unwrap().missing(&large).unwrap();
            assert_eq!(missing.len() as u64, large.tests());
            let said = take(kind, 4).err().unwrap().to_string();
            assert!(said.contains("raise its number of tests again"), "{said}");
        }
        // Only a hypercube of twice the size begins with the same tests.
        let said = take("latin-hypercube", 12).err().unwrap().to_string();
        assert!(said.contains("another study"), "{said}");
        assert!(said.contains("only twice the size, four times"), "{said}");
    }

    #[test]
    fn a_damaged_name_of_a_column_is_an_error() {
        let said = refusal(|path| {
            let mut bytes = fs::read(path).unwrap();
            let place = bytes.windows(12).position(|name| name == b"mass_loss_mg");
            bytes[place.unwrap() + 5] = 0xff;
            fs::write(path, bytes).unwrap();
        });
        assert!(said.contains("does not have its checksum"), "{said}");
    }
}
