//! Exciting runs: periodic motions that determine the base parameters best within all limits.
//!
//! The criterion is the determinant of the information matrix Σ Wᵀ W / σ² of the base parameters
//! (D-optimality; Swevers, Ganseman, Tükel, De Schutter, Van Brussel 1997). For an overactuated
//! robot, the log-determinants of both projections are added. Each coordinate moves along a finite
//! Fourier series. The modules, from the bottom up:
//!
//! - `frame`: fixed settings of a run, and its series;
//! - `course`: evaluation of a run and its peaks;
//! - `kind`, `limits`: limited quantities, limits and their origins;
//! - `information`: information matrices of runs;
//! - `evolution`: derivative-free search;
//! - `search`: random series, evolution, and the check of limits on a fine grid;
//! - `text`: runs in a description.

mod course;
mod evolution;
mod fourier_run;
mod information;
mod kind;
mod limits;
mod search;
mod text;

pub use information::CaseOfRuns;
pub use kind::LimitKind;
pub use limits::{Limit, Origin};

use crate::{
    configuration::settings::settings,
    error::{Error, Problem},
    robot::Robot,
};
use course::Bench;
use fourier_run::FourierRun;
use information::{Question, TorqueMeasurement};
use nalgebra::DMatrix;
use overact::{Function, Info, Model};
use overact_codegen::diagnostic::Code;
use overact_simulation::Trajectory;
use rand_pcg::Pcg64;
use search::{Candidate, Deadlines, RANDOM, Search, added};
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Default torque noise relative to the largest torque.
const NOISE_SHARE: f64 = 0.01;

/// Smallest number of samples per period for judging runs.
const JUDGED_SAMPLES: usize = 256;

/// Default torque sampling frequency, Hz.
const SAMPLING: f64 = 5000.0;

/// Settings of the search for exciting runs.
#[derive(Debug, Clone, PartialEq)]
pub struct ExcitationEffort {
    /// Number of runs; that of the description if absent.
    pub runs: Option<usize>,
    /// Seed of the random numbers; equal seeds give equal runs.
    pub seed: u64,
    /// Largest number of generations for each run.
    pub generations: usize,
    /// Time limit of the search; results then depend on the machine.
    ///
    /// The minimum for each run is additional: one feasible random series, and the check of the
    /// limits.
    pub time: Option<Duration>,
}

impl Default for ExcitationEffort {
    fn default() -> Self {
        Self {
            runs: None,
            seed: 1,
            generations: 600,
            time: None,
        }
    }
}

/// Information of a set of runs, and their use of the limits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JudgedRuns {
    /// Both projections of an overactuated robot; otherwise one.
    pub cases: Vec<CaseOfRuns>,
    /// Largest ratio to each limit; 1 is at the limit.
    pub limits_used: Vec<f64>,
}

/// Exciting runs and those that they are compared with, all at equal duration.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Excitation {
    /// The limits.
    pub limits: Vec<Limit>,
    /// Number of base parameters.
    pub base_parameters: usize,
    /// Duration of all runs, s.
    pub duration: f64,
    /// Training runs of the description, if there are any.
    pub described: Option<JudgedRuns>,
    /// Best of the random runs, chosen run after run.
    pub random: JudgedRuns,
    /// All random sets, up to a hundred within the time limit: the first series of every run, the
    /// second, and so on.
    ///
    /// They are judged at fewer samples, as candidates are.
    #[serde(skip)]
    pub hundred: Vec<Vec<CaseOfRuns>>,
    /// Runs found by the search.
    pub found: JudgedRuns,
    /// Names of these runs.
    pub runs: Vec<String>,
    /// The runs as tables `[[experiment.run]]`.
    pub tables: String,
    /// Assumptions about settings that the description does not give.
    pub assumed: Vec<String>,
}

impl Robot {
    /// Searches exciting runs.
    ///
    /// `progress` is called with the completed fraction, from 0 to 1, and the name of a run.
    ///
    /// # Errors
    /// A robot without base parameters, limits that no motion keeps, or a description whose runs
    /// are not separate tables.
    pub fn excite(
        &self,
        effort: &ExcitationEffort,
        progress: &dyn Fn(f64, &str),
    ) -> Result<Excitation, Error> {
        let start = Instant::now();
        if !self.model().pulls().is_empty() {
            let message = "exciting runs of robots with cables are not supported";
            let help = "the search does not bound tensions: choose motions in the wrench-feasible workspace, such as slow circles in both directions";
            let problem = Problem::new(Code::EXCITATION, message);
            return Err(problem.file(self.file()).help(help).into());
        }
        // Reject a description that cannot take the runs before the search.
        text::description(self, "")?;
        let task = Task::new(self, effort, start)?;
        let chains = task.search(self, effort, start, progress)?;
        Ok(task.excitation(self, chains))
    }

    /// Description in which the found runs replace the training runs; validation runs stay.
    ///
    /// # Errors
    /// Runs that are not separate tables.
    pub fn with_runs(&self, found: &Excitation) -> Result<String, Error> {
        text::description(self, &found.tables)
    }
}

/// Search problem.
struct Task<'a> {
    bench: Bench<'a>,
    limits: Vec<Limit>,
    frames: Vec<FourierRun>,
    described: Vec<(FourierRun, Trajectory)>,
    question: Question,
    assumed: Vec<String>,
}

/// Runs that were found, and the best random ones.
#[derive(Default)]
struct Chains {
    random: Vec<Trajectory>,
    found: Vec<Trajectory>,
    /// Information of the first random series of all runs, of the second ones, and so on.
    hundred: Vec<Vec<DMatrix<f64>>>,
    /// Whether the time limit cut the random search of a run.
    hurried: bool,
}

impl<'a> Task<'a> {
    fn new(robot: &'a Robot, effort: &ExcitationEffort, start: Instant) -> Result<Self, Error> {
        let description = robot.description();
        let mut assumed = Vec::new();
        let truth = robot
            .true_values()
            .filter(|all| all.values().any(|value| *value != 0.0));
        if truth.is_none() {
            let words =
                "without [experiment.parameters] torques and standard deviations are not predicted";
            assumed.push(words.to_owned());
        }
        let bench = bench(robot, truth.as_ref())?;
        let described = fourier_run::described(description, bench.info.coordinates);
        let limits = limits::limits(&bench, description, &described);
        let frames = fourier_run::wanted(description, &described, effort.runs);
        let noise = noise(robot, &bench.info, &mut assumed);
        let sampling = description
            .experiment
            .as_ref()
            .map_or(SAMPLING, |e| e.sampling);
        let own = settings(description, &bench.info, sampling);
        let measurement = TorqueMeasurement { noise, sampling };
        let question = Question::new(&bench, &frames, &own, truth.as_ref(), measurement)?;
        let mut task = Self {
            bench,
            limits,
            frames,
            described,
            question,
            assumed,
        };
        let typical = task.typical(robot, effort, start)?;
        task.question.normalise(&typical);
        Ok(task)
    }

    /// Search with its inputs.
    fn of(&self, effort: &ExcitationEffort) -> Search<'_> {
        Search {
            bench: &self.bench,
            question: &self.question,
            limits: &self.limits,
            generations: effort.generations,
            deadlines: None,
        }
    }

    /// Mean information of random runs, with and without the payload, as needed.
    fn typical(
        &self,
        robot: &Robot,
        effort: &ExcitationEffort,
        start: Instant,
    ) -> Result<Vec<DMatrix<f64>>, Error> {
        let mut search = self.of(effort);
        // Half of the first run's time, for both cases together.
        let share = |time: Duration| start + time.div_f64(2.0 * self.frames.len() as f64);
        search.deadlines = effort.time.map(share).map(Deadlines::until);
        let mut typical = Vec::new();
        for payload in [false, true] {
            let Some(frame) = self.frames.iter().find(|frame| frame.payload == payload) else {
                continue;
            };
            let series = search.series(frame);
            let all = search.random(&series, &mut stream(effort.seed, u64::MAX));
            let count = all.len() as f64;
            let sum = all
                .iter()
                .fold(Vec::new(), |sum, one| added(&sum, &one.information));
            if sum.is_empty() {
                return Err(self.no_motion(robot));
            }
            let mean: Vec<DMatrix<f64>> = sum.into_iter().map(|matrix| matrix / count).collect();
            typical = added(&typical, &mean);
        }
        Ok(typical)
    }

    /// Searches one run after the other; each adds to the information of the earlier ones.
    fn search(
        &self,
        robot: &Robot,
        effort: &ExcitationEffort,
        start: Instant,
        progress: &dyn Fn(f64, &str),
    ) -> Result<Chains, Error> {
        let mut search = self.of(effort);
        let mut chains = Chains::default();
        let (mut random_information, mut run_information) = (Vec::new(), Vec::new());
        for (index, frame) in self.frames.iter().enumerate() {
            let part = 1.0 / self.frames.len() as f64;
            let tell = |generation: usize| {
                let done = generation as f64 / effort.generations.max(1) as f64;
                progress(part * (index as f64 + done), &frame.name);
            };
            tell(0);
            // Each run has its fraction of the time.
            let share = |time: Duration| start + time.mul_f64(part * (index + 1) as f64);
            search.deadlines = effort.time.map(share).map(Deadlines::until);
            let mut random = stream(effort.seed, index as u64);
            // A limit of zero for every coordinate was rejected, so each run has a series.
            let series = search.series(frame);
            let all = search.random(&series, &mut random);
            chains.hurried |= search.late().0;
            let best = search
                .best(&all, &random_information)
                .zip(search.best(&all, &run_information));
            let (of_random, start) = best.ok_or_else(|| self.no_motion(robot))?;
            let evolved = search.evolved(&series, start, &run_information, &mut random, &tell);
            let settled = search.settled(&series, &evolved);
            // A series may keep the limits at the samples while no scaled version keeps them
            // between samples; try another then.
            let settled =
                settled.or_else(|| search.settled_random(&series, &run_information, &mut random));
            let found: Candidate = settled.ok_or_else(|| self.no_motion(robot))?;
            let both = chains.hundred.iter().zip(&all);
            chains.hundred = match index {
                0 => all.iter().map(|one| one.information.clone()).collect(),
                _ => both
                    .map(|(sum, one)| added(sum, &one.information))
                    .collect(),
            };
            random_information = added(&random_information, &of_random.information);
            run_information = added(&run_information, &found.information);
            chains.random.push(of_random.trajectory.clone());
            chains.found.push(found.trajectory);
        }
        progress(1.0, "");
        Ok(chains)
    }

    /// Error for limits that no motion keeps.
    fn no_motion(&self, robot: &Robot) -> Error {
        let limits: Vec<String> = self
            .limits
            .iter()
            .map(|limit| format!("{} ({})", limit.kind.name(), limit.origin.words()))
            .collect();
        let message = format!(
            "no motion around home satisfies all limits: {}",
            limits.join(", ")
        );
        let help = "give wider limits in the table [excitation], a smaller `position` or a slower `fundamental`";
        let table = robot.description().excitation.as_ref();
        let line = table.map(|table| robot.source().position(&table.span).line);
        Problem::new(Code::EXCITATION, message)
            .file(robot.file())
            .line(line)
            .help(help)
            .into()
    }

    /// Judges all runs at equal duration.
    fn excitation(&self, robot: &Robot, chains: Chains) -> Excitation {
        let names = self.frames.iter().map(|frame| frame.name.clone()).collect();
        let with = |all: Vec<Trajectory>| self.frames.iter().cloned().zip(all).collect();
        let mut assumed = self.assumed.clone();
        let count = chains.hundred.len();
        if chains.hurried && count < RANDOM {
            let words = format!("the time sufficed for only {count} random series, not {RANDOM}");
            assumed.push(words);
        }
        let hundred = chains.hundred.iter();
        let hundred = hundred
            .map(|run_information| self.question.judge(run_information))
            .collect();
        let (random, found): (Vec<_>, Vec<_>) = (with(chains.random), with(chains.found));
        let duration =
            |runs: &[(FourierRun, Trajectory)]| runs.iter().map(|(f, _)| f.duration).sum::<f64>();
        assumed.extend(limits::unlimited_speeds(&self.bench, &self.limits, &found));
        let whole = duration(&found);
        let judged = |runs: &[(FourierRun, Trajectory)]| self.judged(runs, whole / duration(runs));
        let described = judged(&self.described);
        if described.is_none() && !self.described.is_empty() {
            assumed.push("the robot can't reach the runs of the description".to_owned());
        }
        let names_in = fourier_run::coordinates(robot.description()).into_iter();
        let coordinates = self.bench.info.coordinates.iter().zip(names_in);
        let coordinates: Vec<(&str, String, bool)> = coordinates
            .map(|(model, (name, length))| (*model, name, length))
            .collect();
        let nothing = || JudgedRuns {
            cases: Vec::new(),
            limits_used: Vec::new(),
        };
        Excitation {
            base_parameters: self.question.len(),
            duration: whole,
            described,
            hundred,
            random: judged(&random).unwrap_or_else(nothing),
            found: judged(&found).unwrap_or_else(nothing),
            runs: names,
            tables: text::tables(&found, &coordinates),
            assumed,
            limits: self.limits.clone(),
        }
    }

    /// Judges runs together, with their information times a factor.
    ///
    /// `None` if there is no run, or one that the robot cannot reach.
    fn judged(&self, runs: &[(FourierRun, Trajectory)], factor: f64) -> Option<JudgedRuns> {
        let (mut information, mut used) = (Vec::new(), vec![0.0; self.limits.len()]);
        for (frame, trajectory) in runs {
            let samples = JUDGED_SAMPLES.max(JUDGED_SAMPLES / 8 * frame.harmonics);
            let course = self.bench.course(frame, trajectory, samples).ok()?;
            let own = self.question.information(&self.bench, frame, &course)?;
            information = added(&information, &own);
            let uses = limits::uses(&course, &self.limits, false);
            used.iter_mut()
                .zip(uses)
                .for_each(|(most, own): (&mut f64, f64)| *most = most.max(own));
        }
        information.iter_mut().for_each(|matrix| *matrix *= factor);
        (!runs.is_empty()).then(|| JudgedRuns {
            cases: self.question.judge(&information),
            limits_used: used,
        })
    }
}

/// Random stream of a run.
fn stream(seed: u64, run: u64) -> Pcg64 {
    Pcg64::new(u128::from(seed), u128::from(run))
}

/// Robot on which runs are evaluated.
fn bench<'a>(robot: &'a Robot, truth: Option<&BTreeMap<String, f64>>) -> Result<Bench<'a>, Error> {
    let model = robot.model();
    let info = model.info();
    let sizes = info.sizes;
    let mut jacobian = vec![0.0; sizes.actuators * sizes.dof];
    model
        .evaluate(Function::InverseJacobian, &[info.home_pose], &mut jacobian)
        .map_err(|error| {
            Problem::new(Code::EXCITATION, format!("the home pose: {error}")).file(robot.file())
        })?;
    let norm = |column: usize| {
        let entries = jacobian.iter().skip(column).step_by(sizes.dof);
        entries.map(|entry| entry * entry).sum::<f64>().sqrt()
    };
    let all = || info.parameters.iter().chain(info.payload_parameters);
    let value = |truth: &BTreeMap<String, f64>, name: &str| truth.get(name).copied().unwrap_or(0.0);
    Ok(Bench {
        model,
        has_platform: robot.description().platform.is_some(),
        has_loop: !robot.model().model().mechanism.is_tree(),
        lengths: fourier_run::coordinates(robot.description())
            .into_iter()
            .map(|c| c.1)
            .collect(),
        kept: if sizes.actuators > sizes.dof {
            info.kept_actuators.to_vec()
        } else {
            (0..sizes.actuators).collect()
        },
        scales: (0..sizes.dof).map(|column| norm(column).recip()).collect(),
        parameters: truth.map(|truth| all().map(|p| value(truth, p.name)).collect()),
        info,
    })
}

/// Torque noise of the virtual experiment, else a fraction of the largest torques.
fn noise(robot: &Robot, info: &Info<'_>, assumed: &mut Vec<String>) -> Vec<f64> {
    let experiment = robot.description().experiment.as_ref();
    let described = experiment.map(|e| e.torque_noise.clone());
    if let Some(noise) = described.filter(|all| all.iter().all(|one| *one > 0.0)) {
        return noise;
    }
    let limits = experiment.and_then(|e| e.torque_limit.as_ref());
    match limits.filter(|all| all.iter().all(|one| *one > 0.0)) {
        Some(limits) => {
            assumed.push("the torque noise is assumed as 1 % of `torque_limit`".to_owned());
            limits.iter().map(|limit| NOISE_SHARE * limit).collect()
        }
        None => {
            assumed.push("the torque noise is assumed as 1 N m or 1 N".to_owned());
            vec![1.0; info.sizes.actuators]
        }
    }
}
