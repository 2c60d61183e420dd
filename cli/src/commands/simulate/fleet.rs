//! `overact simulate --fleet`: writes logs or factors of many virtual robots over many days.
//!
//! Logs are written to `serial=…/day=…/RUN.parquet`, factors of up to a thousand robots to
//! `day=…/robots-….parquet`. Databases derive the columns `serial` and `day` from such names.
//! `truth.csv` and `parameters.csv` describe the robots, `left_out.csv` lists runs without factors.
//! These three are written last, so their presence means that the output is complete.

use crate::{
    failure::{Failure, Problem},
    measurements::dates::{date, instant},
    output::{self, counted, json, print},
    progress::Progress,
};
use overact::Model;
use overact_codegen::diagnostic::Code;
use overact_identification::factors::write_factors;
use overact_logs::write_parquet;
use overact_robot::{Error, Robot, VirtualExperiment};
use overact_simulation::{Fault, Fleet, Member, Record};
use std::path::{Path, PathBuf};

/// Number of robots whose factors share a file.
const ROBOTS_OF_A_FILE: usize = 1000;

/// Microseconds of a day, and time of day at which runs begin.
const DAY: i64 = 86_400_000_000;
const MORNING: i64 = DAY / 3;

/// Arguments of a fleet.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct Arguments {
    /// Make runs of so many robots with spread, drifts, wrong payloads and dead encoders, one a day
    #[arg(
        long,
        value_name = "ROBOTS",
        requires = "output",
        conflicts_with = "parameters"
    )]
    pub(super) fleet: Option<usize>,
    /// Days of the fleet
    #[arg(long, default_value_t = 30, requires = "fleet")]
    days: usize,
    /// Write R factors in place of logs
    #[arg(long, requires = "fleet")]
    factors: bool,
    /// First day of the fleet
    #[arg(
        long,
        value_name = "DAY",
        default_value = "2026-03-02",
        requires = "fleet"
    )]
    begin: String,
    /// Percent of the robots that suffer from each fault
    #[arg(
        long,
        value_name = "PERCENT",
        default_value_t = 5.0,
        requires = "fleet"
    )]
    faults: f64,
    /// Percent by which viscous friction drifts
    #[arg(
        long,
        value_name = "PERCENT",
        default_value_t = 10.0,
        requires = "fleet"
    )]
    friction_drift: f64,
    /// Percent by which a first moment of mass drifts
    #[arg(
        long,
        value_name = "PERCENT",
        default_value_t = 1.0,
        requires = "fleet"
    )]
    moment_drift: f64,
}

/// Task of simulating a fleet.
struct Work<'a> {
    robot: &'a Robot,
    experiment: &'a VirtualExperiment<'a>,
    fleet: Fleet,
    members: Vec<Member>,
    folder: &'a Path,
    /// First day, µs since 1970.
    begin: i64,
}

/// Result of the simulation.
#[derive(Default)]
struct Made {
    runs: usize,
    bytes: usize,
    files: usize,
    left_out: Vec<[String; 3]>,
}

/// Simulates the runs.
///
/// # Errors
/// A folder that is not empty, numbers out of range, or runs that fail.
pub(super) fn run(
    arguments: &Arguments,
    robot: &Robot,
    experiment: &VirtualExperiment<'_>,
    folder: &Path,
    as_json: bool,
) -> Result<(), Failure> {
    let robots = arguments.fleet.unwrap_or(0);
    check(arguments, robots)?;
    let seed = experiment.plan().seed;
    let fleet = Fleet {
        days: arguments.days,
        seed,
        share: arguments.faults / 100.0,
        friction_drift: arguments.friction_drift / 100.0,
        moment_drift: arguments.moment_drift / 100.0,
    };
    let begin = instant(&arguments.begin)?;
    new_folder(folder)?;
    let members = (0..robots).map(|number| experiment.member(&fleet, number));
    let work = Work {
        robot,
        experiment,
        fleet,
        members: members.collect(),
        folder,
        begin,
    };
    let bar = Progress::new("simulating", as_json);
    let mut made = Made::default();
    for day in 0..arguments.days {
        for (file, members) in work.members.chunks(ROBOTS_OF_A_FILE).enumerate() {
            if arguments.factors {
                work.factors(day, file, members, &mut made)?
            } else {
                work.logs(day, members, &mut made)?
            }
            let done = (day * robots + file * ROBOTS_OF_A_FILE) as f64;
            bar.at(done / (arguments.days * robots) as f64, &work.day(day));
        }
    }
    drop(bar);
    work.tell(&made)?;
    if as_json {
        return print(&json(&serde_json::json!({
            "robot": robot.model().info().name,
            "robots": robots,
            "days": arguments.days,
            "runs": made.runs,
            "files": made.files,
            "bytes": made.bytes,
            "left_out": made.left_out.len(),
        }))?);
    }
    print(&format!(
        "{} of {} over {}, {} bytes in {}; {} left out",
        counted(made.runs, "run", "runs"),
        counted(robots, "robot", "robots"),
        counted(arguments.days, "day", "days"),
        made.bytes,
        counted(made.files, "file", "files"),
        made.left_out.len(),
    ))
}

fn check(arguments: &Arguments, robots: usize) -> Result<(), Failure> {
    let usage = |message: &str| Err(Failure::Usage(message.to_owned()));
    if !(1..=1_000_000).contains(&robots) || !(1..=3660).contains(&arguments.days) {
        return usage("a fleet has 1 to 1000000 robots and 1 to 3660 days");
    }
    if !(0.0..=25.0).contains(&arguments.faults) {
        return usage("there are four faults: each concerns 0 to 25 percent of the robots");
    }
    let drifts = [arguments.friction_drift, arguments.moment_drift];
    if drifts
        .iter()
        .any(|drift| drift.is_nan() || drift.abs() >= 100.0)
    {
        return usage("a drift is less than 100 percent");
    }
    Ok(())
}

/// Creates the folder; fails if it is not empty.
fn new_folder(folder: &Path) -> Result<(), Failure> {
    let refuse = |message: String| {
        let problem = Problem::new(Code::OUTPUT, message).file(folder.display().to_string());
        Failure::from(problem.help("give the name of a new folder"))
    };
    std::fs::create_dir_all(folder)
        .map_err(|error| refuse(format!("the folder can't be created: {error}")))?;
    let mut entries = std::fs::read_dir(folder)
        .map_err(|error| refuse(format!("the folder can't be read: {error}")))?;
    match entries.next() {
        None => Ok(()),
        Some(_) => Err(refuse("the folder is not empty".to_owned())),
    }
}

/// Serial number of a robot.
fn serial(member: &Member) -> String {
    format!("R{:05}", member.number)
}

impl Work<'_> {
    fn day(&self, day: usize) -> String {
        date(self.begin + day as i64 * DAY)
    }

    /// Start of a robot's run on a day; robots start at intervals of a minute.
    fn time(&self, member: &Member, day: usize) -> i64 {
        let minute = (member.number % 480) as i64;
        self.begin + day as i64 * DAY + MORNING + minute * 60_000_000
    }

    fn logs(&self, day: usize, members: &[Member], made: &mut Made) -> Result<(), Failure> {
        let file = |_: &Member, record: Record| {
            let name = format!("{}.parquet", crate::names::file_stem(&record.name));
            Ok((name, write_parquet(&columns(&record))?))
        };
        let logs = self.experiment.days(&self.fleet, members, day, &file);
        for (member, log) in members.iter().zip(logs) {
            let (name, bytes) = log?;
            let folder = self.folder.join(format!("serial={}", serial(member)));
            let folder = folder.join(format!("day={}", self.day(day)));
            write(folder.join(name), bytes, made)?;
            made.runs += 1;
        }
        Ok(())
    }

    fn factors(
        &self,
        day: usize,
        file: usize,
        members: &[Member],
        made: &mut Made,
    ) -> Result<(), Failure> {
        let settings = self.robot.settings(self.experiment.plan().sampling_hz);
        let factory = self.robot.factory(&settings)?;
        let one = |member: &Member, record: Record| -> Result<_, Error> {
            let log = self.experiment.log_of(record)?;
            let time = Some(self.time(member, day));
            // An invalid log of one robot must not stop those of the others.
            Ok(factory.run(&log, &serial(member), time))
        };
        let mut runs = Vec::new();
        let found = self.experiment.days(&self.fleet, members, day, &one);
        for (member, run) in members.iter().zip(found) {
            match run? {
                Ok(run) => runs.push(run),
                Err(error) => {
                    let messages = error.problems.into_iter().map(|one| one.message);
                    let why = messages.collect::<Vec<_>>().join("; ");
                    made.left_out.push([serial(member), self.day(day), why]);
                }
            }
        }
        made.runs += runs.len();
        let folder = self.folder.join(format!("day={}", self.day(day)));
        write(
            folder.join(format!("robots-{file:05}.parquet")),
            write_factors(&runs)?,
            made,
        )
    }

    /// Writes the files on the robots and on omitted runs.
    fn tell(&self, made: &Made) -> Result<(), Failure> {
        let info = self.experiment.robot().model().info();
        let names: Vec<&str> = { info.parameters.iter().chain(info.payload_parameters) }
            .map(|parameter| parameter.name)
            .collect();
        let concerned = |member: &Member| match member.fault {
            Fault::None => "",
            Fault::Encoder => info.actuators.get(member.place).copied().unwrap_or(""),
            _ => names.get(member.place).copied().unwrap_or(""),
        };
        let truth = self.members.iter().map(|member| {
            let last = self.fleet.days.saturating_sub(1);
            [
                serial(member),
                member.build.to_string(),
                member.fault.name().to_owned(),
                concerned(member).to_owned(),
                self.day(member.begin),
                self.fleet.size(member, last).to_string(),
            ]
        });
        let parameters = self.members.iter().flat_map(|member| {
            let own = names.iter().zip(&member.parameters);
            own.map(|(name, value)| [serial(member), (*name).to_owned(), value.to_string()])
        });
        let truth = table(
            &["serial", "build", "fault", "concerns", "begin", "size"],
            truth,
        );
        let parameters = table(&["serial", "parameter", "value"], parameters);
        let left_out = table(&["serial", "day", "why"], made.left_out.iter().cloned());
        let files = [
            ("truth", truth),
            ("parameters", parameters),
            ("left_out", left_out),
        ];
        let files = files.map(|(name, text)| {
            let text = text.map_err(|error| Problem::new(Code::NO_RESULT_TEXT, error.to_string()));
            text.map(|text| (self.folder.join(format!("{name}.csv")), text))
        });
        output::write(files.into_iter().collect::<Result<_, _>>()?)
    }
}

/// Columns of a log: time, positions and torques.
fn columns(record: &Record) -> Vec<(String, Vec<f64>)> {
    let count = record.actuators.len();
    let of = |prefix: &str, all: &[f64]| -> Vec<(String, Vec<f64>)> {
        let actuators = record.actuators.iter().enumerate();
        let column = |(at, name): (usize, &String)| {
            let values = all.iter().skip(at).step_by(count).copied();
            (format!("{prefix}_{name}"), values.collect())
        };
        actuators.map(column).collect()
    };
    let mut all = vec![("time".to_owned(), record.time.clone())];
    all.extend(of("q", &record.positions));
    all.extend(of("tau", &record.torques));
    all
}

fn table<const N: usize>(
    header: &[&str; N],
    rows: impl Iterator<Item = [String; N]>,
) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for row in rows {
        writer.write_record(row)?;
    }
    writer
        .into_inner()
        .map_err(|error| error.into_error().into())
}

fn write(file: PathBuf, bytes: Vec<u8>, made: &mut Made) -> Result<(), Failure> {
    made.bytes += bytes.len();
    made.files += 1;
    let files = vec![(file, bytes)];
    output::make_folders(&files)?;
    output::write(files)
}
