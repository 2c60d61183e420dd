//! Opens the files of a run: finds columns, compares clocks, and decides on resampling.

use overact::Code;

use crate::{
    bytes::byte_source::ByteSource,
    error::{Error, Problem},
    formats::{format, table::Table},
    mapping::{Mapping, transmission::Transmission},
    problems::shown,
    resampling,
    run::{
        rows::Joined,
        signals::Signals,
        source::{FileClock, Files, Resampling},
        time_range::TimeRange,
    },
};

impl Files {
    /// Opens the files of the run `name`, each with its own name, and finds their columns.
    ///
    /// Only samples in `range` are used, if it is given.
    ///
    /// # Errors
    /// An invalid mapping, files that cannot be read, missing columns, a range without samples.
    pub(crate) fn new(
        name: String,
        files: &[(String, ByteSource)],
        mapping: &Mapping,
        range: Option<TimeRange>,
    ) -> Result<Self, Error> {
        mapping.check()?;
        let (mut tables, mut numbers, mut problems) = (Vec::new(), Vec::new(), Vec::new());
        for ((file, medium), number) in files.iter().zip(1..) {
            match format::open(file.clone(), medium) {
                Ok(parts) => {
                    numbers.resize(numbers.len() + parts.len(), number);
                    tables.extend(parts);
                }
                Err(error) => problems.extend(error.problems),
            }
        }
        problems.extend(tables.iter().filter_map(Table::without_content));
        problems.extend(twice(files));
        Error::check(problems)?;
        Self::of_tables(name, tables, numbers, mapping, range)
    }

    /// The run `name` of tables, each with the number of its file.
    ///
    /// # Errors
    /// An invalid mapping, missing columns.
    pub(crate) fn of_tables(
        name: String,
        mut tables: Vec<Table>,
        mut numbers: Vec<usize>,
        mapping: &Mapping,
        range: Option<TimeRange>,
    ) -> Result<Self, Error> {
        mapping.check()?;
        if tables.iter().any(|table| table.is_part()) {
            let used = used(&name, &tables, &numbers, mapping)?;
            numbers = used.iter().map(|table| numbers[*table]).collect();
            tables = used.iter().map(|table| tables[*table].clone()).collect();
        }
        if let Some(origin) = tables.iter().find_map(|table| table.origin()) {
            tables.iter_mut().for_each(|table| table.set_origin(origin));
        }
        let signals = Signals::new(&name, &tables, &numbers, mapping)?;
        let mut files = Self {
            rotations: signals.rotations(&mapping.rotating),
            rotating_values: signals.rotating_values(&mapping.rotating),
            signals,
            name,
            tables,
            actuators: mapping.positions.len(),
            has_velocities: !mapping.velocities.is_empty(),
            clocks: Vec::new(),
            transmission: Transmission::new(&mapping.transmission, mapping.positions.len())?,
            resampling: None,
            range: None,
            spill: None,
        };
        files.clocks = files.differing_clocks()?;
        if let Some(range) = range {
            files.restrict(range, &mapping.time)?;
        }
        if let Some(rate) = mapping.resample {
            let step = files.usual_step()?;
            files.resampling = Some(Resampling { rate, step });
        }
        Error::check(files.unfit_rates())?;
        Ok(files)
    }

    /// Usual step of the run's samples, s: that of the first file if clocks differ.
    pub(super) fn usual_step(&self) -> Result<f64, Error> {
        if let Some(clock) = self.clocks.first() {
            return Ok(clock.step);
        }
        let mut joined = Joined::new(self)?;
        let mut row = vec![0.0; self.width()];
        let times = std::iter::from_fn(|| {
            // Errors in a row are reported when the run is read.
            joined.next(&mut row).ok().filter(|goes_on| *goes_on)?;
            self.signals.times(&row).next()
        });
        Ok(resampling::usual_step(times))
    }

    /// The problems of rates too far from those of the samples, and of files without times.
    fn unfit_rates(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        let run = (self.name.clone(), self.resampling.map(|own| own.step));
        let rate = match (self.resampling, self.clocks.first()) {
            (Some(own), _) => own.rate,
            (None, Some(clock)) => 1.0 / clock.step,
            (None, None) => return problems,
        };
        let followers = self
            .clocks
            .iter()
            .map(|clock| (self.tables[clock.table].label(), Some(clock.step)));
        for (name, step) in followers.chain([run]) {
            let step = step.filter(|step| *step > 0.0);
            let ratio = step.map_or(1.0, |step| rate * step);
            let what = match ratio {
                _ if ratio > resampling::MOST_HIGHER && self.resampling.is_some() => {
                    "more than ten times"
                }
                _ if ratio < 1.0 / resampling::MOST_LOWER => "less than a thousandth of",
                _ => continue,
            };
            let own = 1.0 / step.unwrap_or(f64::NAN);
            let message = format!(
                "{name} can't be resampled at {} Hz, which is {what} its {} Hz",
                round(rate),
                round(own)
            );
            let problem = Problem::new(Code::LOG_TIME, message)
                .file(self.name.as_str())
                .column("resample");
            problems.push(
                problem.help("choose a rate close to that of the samples, `resample` in [data]"),
            );
            break;
        }
        if self.resampling.is_some() && !self.clocks.is_empty() {
            let tables = self.tables.iter().zip(self.signals.columns());
            for (number, (table, columns)) in tables.enumerate() {
                let has_clock = self.clocks.iter().any(|own| own.table == number);
                if !has_clock && !columns.is_empty() {
                    let message = format!(
                        "{} has no times, while those of the other files differ",
                        shown(&table.label())
                    );
                    let problem = Problem::new(Code::LOG_FILES, message).file(table.file());
                    problems.push(
                        problem.help("give every file a column of the time, of the same name"),
                    );
                }
            }
        }
        problems
    }

    /// Clocks of the files; empty if they agree.
    fn differing_clocks(&self) -> Result<Vec<FileClock>, Error> {
        let columns: Vec<_> = self.signals.columns().collect();
        let open = |&(table, column): &(usize, usize)| {
            let clock = columns[table].get(column..=column).unwrap_or_default();
            self.tables[table].rows(clock)
        };
        let clocks = self.signals.clocks();
        let all: Result<Vec<_>, Error> = clocks.iter().map(open).collect();
        if clocks.is_empty() || !resampling::differ(all?) {
            return Ok(Vec::new());
        }
        let with_step = |clock: &(usize, usize)| {
            let &(table, column) = clock;
            let step = resampling::usual_step(resampling::times(open(clock)?));
            Ok(FileClock {
                table,
                column,
                step,
            })
        };
        clocks.iter().map(with_step).collect()
    }

    /// Note on resampling, and on files joined by time.
    pub(crate) fn note(&self, samples: usize, left_out: usize) -> Option<String> {
        let labels = |clocks: &[FileClock]| {
            let labels = clocks.iter().map(|own| self.tables[own.table].label());
            labels.collect::<Vec<_>>().join(", ")
        };
        let passed = |rate: f64, is_lower: bool| {
            if is_lower {
                format!(", after a low-pass filter at {} Hz", round(0.4 * rate))
            } else {
                String::new()
            }
        };
        if let Some(Resampling { rate, step }) = self.resampling {
            let mut steps = self.clocks.iter().map(|own| own.step).chain([step]);
            let low_pass = passed(rate, steps.any(|step| resampling::is_lower(step, rate)));
            let (what, from) = match &self.clocks[..] {
                [] => (
                    String::from("the run"),
                    format!("from about {} Hz", round(1.0 / step)),
                ),
                clocks => (labels(clocks), String::from("onto common times")),
            };
            return Some(format!(
                "{what} was resampled at {} Hz {from}, by polynomials of degree 5{low_pass}",
                round(rate)
            ));
        }
        let (first, others) = self.clocks.split_first()?;
        let left = match left_out {
            0 => String::new(),
            _ => format!(
                "; {left_out} of its {} samples, outside the times of the others, are skipped",
                samples + left_out
            ),
        };
        let rate = 1.0 / first.step;
        let is_lower = others
            .iter()
            .any(|own| resampling::is_lower(own.step, rate));
        Some(format!(
            "{} was interpolated onto the times of {}{}, since the clocks differ{left}",
            labels(others),
            self.tables[first.table].label(),
            passed(rate, is_lower)
        ))
    }
}

/// The problem of a file joined with itself.
fn twice(files: &[(String, ByteSource)]) -> Option<Problem> {
    let places: Vec<_> = files
        .iter()
        .map(|(_, medium)| std::fs::canonicalize(medium.path()?).ok())
        .collect();
    let mut all = places.iter().enumerate();
    let (number, _) = all.find(|(number, own)| own.is_some() && places[..*number].contains(own))?;
    let message = "the file is given twice in one run, so its columns are ambiguous";
    let problem = Problem::new(Code::LOG_FILES, message).file(files[number].0.as_str());
    Some(
        problem.help("give the file once, or the intended second one: `positions.csv+torques.csv`"),
    )
}

/// Rounds a rate for display.
fn round(rate: f64) -> f64 {
    (rate * 1e6).round() / 1e6
}

/// Indices of the tables without parts of files, such as topics, that have no signals of the run.
///
/// The parts of a file are in the order of the mapping.
fn used(
    name: &str,
    tables: &[Table],
    numbers: &[usize],
    mapping: &Mapping,
) -> Result<Vec<usize>, Error> {
    let used = Signals::used(name, tables, numbers, mapping)?;
    let place = |table: usize| used.iter().position(|own| *own == table);
    let is_kept = |table: usize| !tables[table].is_part() || place(table).is_some();
    let mut order: Vec<usize> = (0..tables.len()).filter(|table| is_kept(*table)).collect();
    // Files keep their order.
    order.sort_by_key(|table| (numbers[*table], place(*table)));
    Ok(order)
}

#[cfg(all(test, not(target_family = "wasm")))]
mod tests {
    use super::Files;
    use crate::{
        bytes::byte_source::ByteSource,
        mapping::{Gain, Mapping, Time},
        run::log::Log,
    };
    use std::fs;

    #[test]
    fn the_text_is_read_again_without_a_temporary_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("log.csv");
        let lines: String = (0..100).map(|k| format!("{k},{}\n", 2 * k)).collect();
        fs::write(&path, format!("q,tau\n{lines}")).expect("written");
        let mapping = Mapping {
            time: Time::Frequency(10.0),
            positions: vec![String::from("q")],
            torques: vec![String::from("tau")],
            velocities: Vec::new(),
            position_scale: vec![1.0],
            position_offset: Vec::new(),
            torque_gain: vec![Gain::Value(1.0)],
            resample: None,
            transmission: Vec::new(),
            rotating: Vec::new(),
        };
        let file = (String::from("log.csv"), ByteSource::Disk(path.clone()));
        let files = Files::new(String::from("run"), &[file], &mapping, None).expect("files");
        let log = Log::in_files(files, 10.0, 100, false);
        let (positions, torques) = log.load().expect("numbers");
        assert_eq!((positions[99], torques[50]), (99.0, 100.0));
        // The file is truncated while it is read.
        fs::write(&path, &lines[..100]).expect("written");
        let error = log.load().expect_err("shorter").to_string();
        assert!(error.contains("log.csv"), "{error}");
    }
}
