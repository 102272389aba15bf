//! The tables of finished members put together: mean and standard error over seeds.
//!
//! A gathered table has the swept keys as its first columns; then `bin`, the number k of the interval at or after which
//! rows were due; `time` (R0²/D) and `time_over_jeans`, their means over the rows; the columns that tell rows of one time
//! from each other, if any; `runs`, how many runs have such a row; and for each other column `x` of the runs `x` and
//! `x_error`, mean and standard error of the mean over the runs in which there is a value, empty for no run, the error for
//! one. Rows are in the order of the sweep, then of bins, then of the columns that tell rows apart. Numbers are summed in
//! the order of seeds.
//!
//! All tables are made before the first is written: what refuses one, or stops, leaves those that were there.

use super::MEMBERS;
use super::bins::Bins;
use super::error::{EnsembleError, MemberError};
use super::member::{Member, Setting};
use super::standing::{Finished, Standing};
use super::sweep::Sweep;
use crate::configuration::{Configuration, Start};
use crate::files::atomic::write_atomically;
use crate::files::table::{Table, TableText};
use crate::files::{FileError, FormatError};
use crate::observables::series::{HEAD_COLUMNS, Series};
use crate::statistics::Sample;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering as Memory};
use std::time::Duration;

/// Name of the file that is locked while tables are gathered. It is empty, and stays.
const LOCK: &str = "lock";

/// Time between looks at the lock.
const LOOK: Duration = Duration::from_millis(50);

/// What was gathered.
#[derive(Debug)]
pub struct Gathered {
    /// How many members the sweep has.
    pub members: usize,
    /// How many have finished, and are in the tables.
    pub finished: usize,
    /// Numbers and errors of members whose directories are not theirs, or are damaged.
    pub damaged: Vec<(usize, MemberError)>,
    /// The tables written.
    pub tables: Vec<PathBuf>,
}

/// Gathers the tables of the ensemble in `directory`, whose sweep is read from there. Members that have not finished are
/// left out.
///
/// # Errors
/// [`EnsembleError`]; if a finished member's table is gone, cut or changed, nothing is written.
pub fn gather(directory: &Path) -> Result<Gathered, EnsembleError> {
    gather_sweep(&Sweep::of(directory)?, directory, &AtomicBool::new(false))
}

/// Gathers the tables of the members of `sweep` in `directory`, unless `stop` is raised before all are made.
///
/// # Errors
/// As [`gather`], and [`EnsembleError::Interrupted`].
pub fn gather_sweep(sweep: &Sweep, directory: &Path, stop: &AtomicBool) -> Result<Gathered, EnsembleError> {
    // Of two that gather at a time, the later sees what the earlier saw.
    let lock = directory.join(LOCK);
    let file = File::options().create(true).append(true).open(&lock);
    let file = file.map_err(|problem| FileError::Write { path: lock, problem })?;
    // A file system without locks must not keep anybody from gathering.
    while let Err(TryLockError::WouldBlock) = file.try_lock() {
        if stop.load(Memory::Relaxed) {
            return Err(EnsembleError::Interrupted(directory.to_owned()));
        }
        std::thread::sleep(LOOK);
    }

    let standings: Vec<_> = sweep.members().iter().map(|member| Standing::of(member, directory)).collect();
    let mut texts = vec![(directory.join(MEMBERS), Some(members_table(sweep, &standings)))];
    for series in Series::ALL {
        let text = series_table(series, sweep, &standings, directory, stop)?;
        texts.push((directory.join(series.file_name()), text));
    }
    let mut tables = Vec::new();
    for (path, text) in texts {
        match text {
            Some(text) => {
                write_atomically(&path, &text)?;
                tables.push(path);
            }
            // Of another sweep, perhaps.
            None if path.exists() => {
                fs::remove_file(&path).map_err(|problem| FileError::Write { path, problem })?;
            }
            None => {}
        }
    }
    let finished = standings.iter().filter(|standing| matches!(standing, Ok(Standing::Finished(_)))).count();
    let damaged =
        (1..).zip(standings).filter_map(|(index, standing)| Some((index, standing.err()?))).collect();
    Ok(Gathered { members: sweep.members().len(), finished, damaged, tables })
}

/// `members.csv`.
fn members_table(sweep: &Sweep, standings: &[Result<Standing, MemberError>]) -> Vec<u8> {
    let keys = sweep.keys();
    let mut text = TableText::new(
        ["index", "seed"].into_iter().chain(keys).chain(["hash", "status", "steps", "digest"]),
    );
    for (member, standing) in sweep.members().iter().zip(standings) {
        let status = standing.as_ref().map_or("damaged", Standing::word);
        let (steps, digest) = match standing {
            Ok(Standing::Finished(Finished { step, digest, .. })) => (step.to_string(), digest.clone()),
            _ => Default::default(),
        };
        let mut cells = vec![member.index.to_string(), member.seed.to_string()];
        cells.extend(member.settings.iter().map(|setting| setting.value.clone()));
        cells.extend([member.hash.clone(), status.to_owned(), steps, digest]);
        text.row(cells);
    }
    text.into_bytes()
}

/// The gathered table of a series; None if no finished member has it.
fn series_table(
    series: Series,
    sweep: &Sweep,
    standings: &[Result<Standing, MemberError>],
    directory: &Path,
    stop: &AtomicBool,
) -> Result<Option<Vec<u8>>, EnsembleError> {
    let mut text: Option<TableText> = None;
    for combination in sweep.combinations() {
        let mut members: Vec<&Member> = combination.iter().collect();
        members.sort_by_key(|member| member.seed);
        let mut groups = Groups::default();
        for member in members {
            let Some(Ok(Standing::Finished(finished))) = standings.get(member.index - 1) else { continue };
            let Some(bins) = Bins::of(series, &member.configuration.output, finished.time_unit) else {
                continue;
            };
            if stop.load(Memory::Relaxed) {
                return Err(EnsembleError::Interrupted(directory.to_owned()));
            }
            text.get_or_insert_with(|| TableText::new(header(series, sweep)));
            let path = member.directory(directory).join(series.file_name());
            let mut add = || {
                let table = Table::parse(File::open(&path).map_err(FormatError::Input)?)?;
                refuse_columns(series, &table)?;
                refuse_cut(&table, bins, finished, &member.configuration)?;
                groups.add(&table, series, bins, member)
            };
            add().map_err(|problem| EnsembleError::Table { path: path.clone(), problem })?;
        }
        if let (Some(text), Some(member)) = (&mut text, combination.first()) {
            groups.write(&member.settings, text);
        }
    }
    Ok(text.map(TableText::into_bytes))
}

/// The names of the columns of a gathered table.
fn header(series: Series, sweep: &Sweep) -> Vec<String> {
    let mut columns: Vec<String> = sweep.keys().map(str::to_owned).collect();
    columns.extend(["bin", "time", "time_over_jeans"].map(str::to_owned));
    columns.extend(series.key_columns().iter().map(|&key| key.to_owned()));
    columns.push("runs".to_owned());
    let values = series.value_columns().iter();
    columns.extend(values.flat_map(|&name| [name.to_owned(), format!("{name}_error")]));
    columns
}

/// Refuses a table whose columns are not those of the series.
fn refuse_columns(series: Series, table: &Table) -> Result<(), FormatError> {
    let [expected, found] = [series.header(), table.columns().collect::<Vec<_>>().join(",")];
    if found == expected {
        return Ok(());
    }
    let [found, expected] = [found, expected].map(|columns| format!("columns {columns}"));
    Err(FormatError::Whole { found, expected })
}

/// Refuses a table of a finished run that lacks its last rows.
fn refuse_cut(
    table: &Table,
    bins: Bins,
    finished: &Finished,
    configuration: &Configuration,
) -> Result<(), FormatError> {
    let expected = bins.last_due(finished.time);
    let last = table.len().checked_sub(1).map(|row| time(table, row));
    match last.transpose()?.map(|time| bins.last_due(time)) {
        Some(found) if found == expected => Ok(()),
        // A run that goes on from a file may have ended before anything was due.
        None if matches!(configuration.start, Start::File { .. }) => Ok(()),
        found => Err(FormatError::Whole {
            found: found.map_or("no row".to_owned(), |found| format!("a last row of bin {found}")),
            expected: format!("one of bin {expected}"),
        }),
    }
}

/// The time of a row, R0²/D.
fn time(table: &Table, row: usize) -> Result<f64, FormatError> {
    required(table, row, 1)
}

/// A number that has to be there.
fn required(table: &Table, row: usize, column: usize) -> Result<f64, FormatError> {
    table.number(row, column)?.ok_or_else(|| FormatError::Line {
        line: table.line(row),
        found: "an empty cell".to_owned(),
        expected: format!("a number in column {}", table.columns().nth(column).unwrap_or_default()),
    })
}

/// A cell that tells rows of one time from each other: numbers in their order, then words.
#[derive(Clone, Debug)]
struct Key {
    text: String,
    number: f64,
}

impl Key {
    fn new(text: &str) -> Self {
        Self { text: text.to_owned(), number: text.parse().unwrap_or(f64::INFINITY) }
    }
}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> Ordering {
        self.number.total_cmp(&other.number).then_with(|| self.text.cmp(&other.text))
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Key {}

/// The rows of one bin and key, over the seeds.
#[derive(Debug, Default)]
struct Group {
    /// The member that was added last.
    last: usize,
    runs: u64,
    time: Sample,
    time_over_jeans: Sample,
    values: Vec<Sample>,
}

/// The rows of one combination of swept values.
#[derive(Debug, Default)]
struct Groups(BTreeMap<(u64, Vec<Key>), Group>);

impl Groups {
    /// Takes the rows of another member.
    fn add(&mut self, table: &Table, series: Series, bins: Bins, member: &Member) -> Result<(), FormatError> {
        let (first, all) = (HEAD_COLUMNS.len(), table.width());
        let first_value = first + series.key_columns().len();
        for row in 0..table.len() {
            let time = time(table, row)?;
            let bin = bins.last_due(time);
            let keys: Vec<Key> =
                (first..first_value).map(|column| Key::new(table.cell(row, column))).collect();
            let group = self.0.entry((bin, keys)).or_default();
            if group.last == member.index {
                return Err(FormatError::Line {
                    line: table.line(row),
                    found: format!("a second row of bin {bin}"),
                    expected: "one".to_owned(),
                });
            }
            group.last = member.index;
            group.runs += 1;
            group.time.add(time);
            if let Some(time) = table.number(row, 2)? {
                group.time_over_jeans.add(time);
            }
            group.values.resize(all - first_value, Sample::default());
            for (sample, column) in group.values.iter_mut().zip(first_value..) {
                if let Some(value) = table.number(row, column)? {
                    sample.add(value);
                }
            }
        }
        Ok(())
    }

    /// Writes a row for each bin and key.
    fn write(&self, settings: &[Setting], text: &mut TableText) {
        let cell = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        for ((bin, keys), group) in &self.0 {
            let mut cells: Vec<String> = settings.iter().map(|setting| setting.value.clone()).collect();
            cells.extend([bin.to_string(), cell(group.time.mean()), cell(group.time_over_jeans.mean())]);
            cells.extend(keys.iter().map(|key| key.text.clone()));
            cells.push(group.runs.to_string());
            cells.extend(group.values.iter().flat_map(|sample| [cell(sample.mean()), cell(sample.error())]));
            text.row(cells);
        }
    }
}
