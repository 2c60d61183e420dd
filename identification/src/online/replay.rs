//! One pass over the runs, sample by sample.

use overact::{
    Code, Model,
    online::{Change, ChangeTest, Innovation, SliceFilter, Whitening},
};

use super::{OnlineChange, OnlineEstimate, timeline::Timeline};
use crate::{
    blocks::BLOCK,
    filters::Decimation,
    kinematics::{Motion, Motions},
    online_settings::OnlineSettings,
    regression::{columns::ColumnSet, observer::Observer, projection::Projection},
    result::Estimate,
    settings::Settings,
};
use overact_logs::{Error, Log, Problem};

/// A replay of runs.
pub(crate) struct Replay<'a> {
    pub(crate) model: &'a dyn Model,
    pub(crate) columns: &'a ColumnSet,
    /// Columns of the base parameters.
    pub(crate) base: &'a [usize],
    pub(crate) projection: &'a Projection,
    /// Batch estimate with weights of the lines and ratios of standard deviations.
    pub(crate) estimate: &'a Estimate,
    pub(crate) settings: &'a Settings,
    pub(crate) online: &'a OnlineSettings,
}

/// Filter, tests and estimates of all runs so far.
struct State<'a> {
    filter: SliceFilter<'a>,
    /// One test for each line.
    tests: Vec<LineTest>,
    timeline: Timeline,
    /// Time at the start of the run, s.
    start: f64,
}

/// Change test of a line.
#[derive(Clone)]
struct LineTest {
    whitening: Whitening,
    test: ChangeTest,
}

impl LineTest {
    /// Adds the innovation of an equation, if it has one.
    fn update(&mut self, innovation: &Innovation) -> Option<Change> {
        if !innovation.is_determined {
            return None;
        }
        let white = self.whitening.update(innovation.normalised);
        self.test.update(white)
    }
}

/// Decimated equations of one line of a run that have not entered the filter.
struct Line {
    decimation: Decimation,
    /// Decimated rows: columns and Y.
    rows: Vec<f64>,
    /// Exclusion of equations at standstill of the line's joint.
    standstill: Option<Standstill>,
    /// Standard deviation of an equation.
    sigma: f64,
}

/// Decimated velocities of a line's joint.
struct Standstill {
    decimation: Decimation,
    velocities: Vec<f64>,
    /// Velocity (rad/s, m/s) below which the joint is at standstill.
    limit: f64,
}

impl Line {
    /// Whether the equation at a place counts.
    fn is_moving(&self, place: usize) -> bool {
        let velocity = |own: &Standstill| own.velocities.get(place).copied();
        self.standstill
            .as_ref()
            .is_none_or(|own| velocity(own).is_none_or(|velocity| velocity.abs() >= own.limit))
    }

    /// Number of complete equations of `width` numbers.
    fn complete(&self, width: usize) -> usize {
        let rows = self.rows.len() / width;
        let known = self.standstill.as_ref().map(|own| own.velocities.len());
        rows.min(known.unwrap_or(rows))
    }

    /// Removes the first equations.
    fn drain(&mut self, count: usize, width: usize) {
        self.rows.drain(..count * width);
        if let Some(own) = &mut self.standstill {
            own.velocities.drain(..count);
        }
    }
}

impl Replay<'_> {
    /// Estimates over time; the last is that of all equations.
    ///
    /// # Errors
    /// A log that cannot be read, or settings out of range.
    pub(crate) fn run(&self, runs: &[Log]) -> Result<Vec<OnlineEstimate>, Error> {
        let [squared, all] = SliceFilter::<f64>::lengths(self.estimate.parameters.len());
        let (mut factor, mut vectors) = (vec![0.0; squared], vec![0.0; all]);
        let mut filter = SliceFilter::without_prior(&mut factor, &mut vectors).map_err(invalid)?;
        let rule = self.online.forgetting.rule();
        filter.set_forgetting(rule).map_err(invalid)?;
        let (shift, samples) = (self.online.shift, self.online.samples_per_false_alarm);
        let fresh = LineTest {
            whitening: Whitening::new(),
            test: ChangeTest::new(shift, samples).map_err(invalid)?,
        };
        let duration = runs.iter().map(duration).sum::<f64>();
        let step = duration / self.online.points.max(1) as f64;
        let mut state = State {
            filter,
            tests: vec![fresh; self.estimate.weights.len()],
            timeline: Timeline::new(step, self.ratios()),
            start: 0.0,
        };
        for log in runs {
            self.replay(log, &mut state)?;
            state.start += self::duration(log);
        }
        if let Some(log) = runs.last() {
            let (filter, time) = (&mut state.filter, state.start);
            state.timeline.add(filter, log.name(), time, None);
        }
        Ok(state.timeline.into_estimates())
    }

    /// Ratio of correlated to white standard deviation of each parameter.
    fn ratios(&self) -> Vec<f64> {
        let parameters = self.estimate.parameters.iter();
        let ratio = parameters.map(|one| {
            if one.standard_deviation > 0.0 {
                one.correlated_standard_deviation / one.standard_deviation
            } else {
                1.0
            }
        });
        ratio.collect()
    }

    /// Replays a run.
    fn replay(&self, log: &Log, state: &mut State<'_>) -> Result<(), Error> {
        let projections = [self.projection.clone()];
        let observer = Observer {
            model: self.model,
            columns: self.columns,
            base: self.base,
            projections: &projections,
            settings: self.settings,
        };
        let mut motions = Motions::new(self.model, log, self.settings)?;
        let mut lines = self.lines(log, motions.samples())?;
        let decimation = self.settings.decimation;
        let mut sample = motions.samples().saturating_sub(1) % decimation;
        let mut first = None;
        while let Some(motion) = motions.next()? {
            let first = *first.get_or_insert(motion.first_sample);
            let blocks = motion.samples.div_ceil(BLOCK);
            let mut failed = vec![None];
            let chunks = observer.chunks(&motion, 0..blocks, &mut failed)?;
            if let Some(error) = failed.into_iter().flatten().next() {
                return Err(error);
            }
            for (number, line) in lines.iter_mut().enumerate() {
                for chunk in &chunks {
                    let rows = &chunk.lines[0][number];
                    line.decimation.push(rows, &mut line.rows);
                }
                self.push_velocities(&motion, number, line);
            }
            let width = self.base.len() + 1;
            let complete = lines.iter().map(|line| line.complete(width)).min();
            let complete = complete.unwrap_or(0);
            for place in 0..complete {
                let time = state.start + (first + sample) as f64 / log.sampling_frequency();
                let change = self.add(place, &lines, state)?;
                let filter = &mut state.filter;
                state.timeline.advance(filter, log.name(), time, change);
                sample += decimation;
            }
            lines
                .iter_mut()
                .for_each(|line| line.drain(complete, width));
        }
        Ok(())
    }

    /// Lines of a run, without equations.
    fn lines(&self, log: &Log, samples: usize) -> Result<Vec<Line>, Error> {
        let settings = self.settings;
        let decimator = settings.decimator(settings.decimation, log.sampling_frequency())?;
        // Without any residual the deviation is arbitrary.
        let deviation = self.estimate.residual_deviation;
        let deviation = if deviation > 0.0 { deviation } else { 1.0 };
        let line = |(number, weight): (usize, &f64)| {
            let standstill = match settings.standstill_velocity.get(number) {
                Some(limit) => Some(Standstill {
                    decimation: decimator.stream(1, samples)?,
                    velocities: Vec::new(),
                    limit: *limit,
                }),
                None => None,
            };
            Ok(Line {
                decimation: decimator.stream(self.base.len() + 1, samples)?,
                rows: Vec::new(),
                standstill,
                sigma: deviation / weight,
            })
        };
        self.estimate.weights.iter().enumerate().map(line).collect()
    }

    /// Decimates the velocities of a line's joint, if equations at standstill are excluded.
    fn push_velocities(&self, motion: &Motion, number: usize, line: &mut Line) {
        if let Some(own) = &mut line.standstill {
            let n = self.model.info().sizes.actuators;
            let velocities = motion.velocities[number..].iter().step_by(n);
            let velocities: Vec<f64> = velocities.copied().collect();
            own.decimation.push(&velocities, &mut own.velocities);
        }
    }

    /// Adds the equations of one decimated sample, and tests the innovations.
    fn add(
        &self,
        place: usize,
        lines: &[Line],
        state: &mut State<'_>,
    ) -> Result<Option<OnlineChange>, Error> {
        let width = self.base.len() + 1;
        let (mut rows, mut y, mut sigma, mut numbers) = (vec![], vec![], vec![], vec![]);
        let moving = lines.iter().enumerate();
        for (number, line) in moving.filter(|(_, line)| line.is_moving(place)) {
            let row = &line.rows[place * width..(place + 1) * width];
            let selected = self.estimate.parameters.iter().map(|one| row[one.column]);
            rows.extend(selected);
            y.push(row[width - 1]);
            sigma.push(line.sigma);
            numbers.push(number);
        }
        let mut innovations = vec![Innovation::default(); y.len()];
        let filter = &mut state.filter;
        filter
            .update_block(&rows, &y, &sigma, &mut innovations)
            .map_err(invalid)?;
        let mut found = None;
        for (number, innovation) in numbers.into_iter().zip(innovations) {
            if let Some(change) = state.tests[number].update(&innovation) {
                found.get_or_insert_with(|| OnlineChange {
                    line: self.line_name(number),
                    increase: change == Change::Increase,
                });
            }
        }
        Ok(found)
    }

    /// Name of a line of Γ.
    fn line_name(&self, number: usize) -> String {
        let line = self.estimate.lines.get(number);
        line.map_or_else(String::new, |line| line.name.clone())
    }
}

/// Duration of a log, s.
fn duration(log: &Log) -> f64 {
    log.samples() as f64 / log.sampling_frequency()
}

/// The problem of settings or numbers that the filter rejects.
fn invalid(error: overact::online::Error) -> Error {
    Problem::new(Code::SETTINGS, format!("online estimation: {error}"))
        .help("check the options of `--online`, and the units of positions and torques")
        .into()
}
