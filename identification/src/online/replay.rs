//! One pass over the runs, sample by sample.

use overact::{
    Code, Model,
    online::{Change, ChangeTest, Innovation, SliceFilter, Whitening},
};

use super::{OnlineChange, OnlineEstimate};
use crate::{
    blocks::BLOCK,
    filters::Decimation,
    kinematics::Motions,
    online_settings::OnlineSettings,
    regression::{columns::ColumnSet, observer::Observer, projection::Projection},
    result::Estimate,
    settings::Settings,
};
use overact_logs::{Error, Log, Problem};

/// Largest number of reported changes.
const CHANGES: usize = 200;

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

/// Decimated equations of one line that have not entered the filter.
struct Line {
    decimation: Decimation,
    /// Decimation of the joint's velocity, with the limit of standstill.
    standstill: Option<(Decimation, f64)>,
    rows: Vec<f64>,
    velocities: Vec<f64>,
    whitening: Whitening,
    test: ChangeTest,
    sigma: f64,
}

impl Replay<'_> {
    /// Estimates over time; the last is that of all equations.
    ///
    /// # Errors
    /// A log that cannot be read, or settings out of range.
    pub(crate) fn run(&self, runs: &[Log]) -> Result<Vec<OnlineEstimate>, Error> {
        let selected = self.estimate.columns();
        let [squared, all] = SliceFilter::<f64>::lengths(selected.len());
        let (mut factor, mut vectors) = (vec![0.0; squared], vec![0.0; all]);
        let mut filter =
            SliceFilter::without_prior(&mut factor, &mut vectors).map_err(|e| invalid(&e))?;
        filter
            .set_forgetting(self.online.forgetting.rule())
            .map_err(|e| invalid(&e))?;
        let total: f64 = runs.iter().map(duration).sum();
        let mut report = Report {
            step: total / self.online.points.max(1) as f64,
            next: 0.0,
            changes: 0,
            ratios: self.ratios(),
            estimates: Vec::new(),
        };
        let mut tests = Vec::new();
        let mut before = 0.0;
        for log in runs {
            self.replay(log, before, &selected, &mut filter, &mut tests, &mut report)?;
            before += duration(log);
        }
        if let Some(log) = runs.last() {
            report.add(&mut filter, log.name(), before, None);
        }
        Ok(report.estimates)
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

    /// Name of a line of Γ.
    fn line_name(&self, number: usize) -> String {
        let lines = &self.estimate.lines;
        lines
            .get(number)
            .map_or_else(String::new, |line| line.name.clone())
    }

    /// Standard deviation of each line's equations.
    fn deviations(&self) -> Vec<f64> {
        let deviation = self.estimate.residual_deviation;
        let deviation = if deviation > 0.0 { deviation } else { 1.0 };
        let weights = self.estimate.weights.iter();
        weights.map(|weight| deviation / weight).collect()
    }

    fn replay(
        &self,
        log: &Log,
        before: f64,
        selected: &[usize],
        filter: &mut SliceFilter<'_>,
        tests: &mut Vec<(Whitening, ChangeTest)>,
        report: &mut Report,
    ) -> Result<(), Error> {
        let n = self.model.info().sizes.actuators;
        let projections = [self.projection.clone()];
        let observer = Observer {
            model: self.model,
            columns: self.columns,
            base: self.base,
            projections: &projections,
            settings: self.settings,
        };
        let mut motions = Motions::new(self.model, log, self.settings)?;
        let mut lines = self.lines(log, motions.samples(), tests)?;
        let frequency = log.sampling_frequency();
        let factor = self.settings.decimation;
        let first = motions.samples().saturating_sub(1) % factor;
        let (mut sample, mut start) = (first, None);
        while let Some(motion) = motions.next()? {
            let start = *start.get_or_insert(motion.first_sample);
            let blocks = motion.samples.div_ceil(BLOCK);
            let mut failed = vec![None];
            let chunks = observer.chunks(&motion, 0..blocks, &mut failed)?;
            if let Some(error) = failed.into_iter().flatten().next() {
                return Err(error);
            }
            for (number, line) in lines.iter_mut().enumerate() {
                for chunk in &chunks {
                    line.decimation
                        .push(&chunk.lines[0][number], &mut line.rows);
                }
                if let Some((decimation, _)) = &mut line.standstill {
                    let own: Vec<f64> = motion.velocities[number..]
                        .iter()
                        .step_by(n)
                        .copied()
                        .collect();
                    decimation.push(&own, &mut line.velocities);
                }
            }
            let count = self.complete(&lines);
            for place in 0..count {
                let time = before + (start + sample) as f64 / frequency;
                let change = self.add(place, selected, filter, &mut lines)?;
                report.note(filter, log.name(), time, change);
                sample += factor;
            }
            let width = self.base.len() + 1;
            for line in &mut lines {
                line.rows.drain(..count * width);
                line.velocities.drain(..count.min(line.velocities.len()));
            }
        }
        *tests = lines
            .into_iter()
            .map(|line| (line.whitening, line.test))
            .collect();
        Ok(())
    }

    /// Lines of a run, with the tests of the run before.
    fn lines(
        &self,
        log: &Log,
        samples: usize,
        tests: &[(Whitening, ChangeTest)],
    ) -> Result<Vec<Line>, Error> {
        let decimator = self
            .settings
            .decimator(self.settings.decimation, log.sampling_frequency())?;
        let online = self.online;
        let fresh = ChangeTest::new(online.shift, online.samples_per_false_alarm)
            .map_err(|error| invalid(&error))?;
        let line = |(number, sigma): (usize, f64)| {
            let limit = self.settings.standstill_velocity.get(number);
            let standstill = match limit {
                Some(limit) => Some((decimator.stream(1, samples)?, *limit)),
                None => None,
            };
            let (whitening, test) = tests
                .get(number)
                .copied()
                .unwrap_or_else(|| (Whitening::new(), fresh));
            Ok(Line {
                decimation: decimator.stream(self.base.len() + 1, samples)?,
                standstill,
                rows: Vec::new(),
                velocities: Vec::new(),
                whitening,
                test,
                sigma,
            })
        };
        self.deviations()
            .into_iter()
            .enumerate()
            .map(line)
            .collect()
    }

    /// Number of samples of which all lines have their equations.
    fn complete(&self, lines: &[Line]) -> usize {
        let width = self.base.len() + 1;
        let of_line = |line: &Line| {
            let rows = line.rows.len() / width;
            let velocities = line.standstill.as_ref().map(|_| line.velocities.len());
            rows.min(velocities.unwrap_or(rows))
        };
        lines.iter().map(of_line).min().unwrap_or(0)
    }

    /// Adds the equations of one decimated sample, and tests the innovations.
    fn add(
        &self,
        place: usize,
        selected: &[usize],
        filter: &mut SliceFilter<'_>,
        lines: &mut [Line],
    ) -> Result<Option<OnlineChange>, Error> {
        let width = self.base.len() + 1;
        let (mut rows, mut y, mut sigma, mut numbers) = (vec![], vec![], vec![], vec![]);
        for (number, line) in lines.iter().enumerate() {
            let limit = line.standstill.as_ref().map_or(0.0, |(_, limit)| *limit);
            let velocity = line.velocities.get(place).copied();
            if velocity.is_some_and(|velocity| velocity.abs() < limit) {
                continue;
            }
            let row = &line.rows[place * width..(place + 1) * width];
            rows.extend(selected.iter().map(|column| row[*column]));
            y.push(row[width - 1]);
            sigma.push(line.sigma);
            numbers.push(number);
        }
        let mut innovations = vec![Innovation::default(); y.len()];
        filter
            .update_block(&rows, &y, &sigma, &mut innovations)
            .map_err(|error| invalid(&error))?;
        let mut found = None;
        for (number, innovation) in numbers.into_iter().zip(innovations) {
            if !innovation.is_determined {
                continue;
            }
            let line = &mut lines[number];
            let white = line.whitening.update(innovation.normalised);
            if let Some(change) = line.test.update(white) {
                found.get_or_insert_with(|| OnlineChange {
                    line: self.line_name(number),
                    increase: change == Change::Increase,
                });
            }
        }
        Ok(found)
    }
}

/// Estimates at regular times and at changes.
struct Report {
    /// Time between two estimates, s.
    step: f64,
    /// Time of the next estimate, s.
    next: f64,
    /// Number of changes so far.
    changes: usize,
    ratios: Vec<f64>,
    estimates: Vec<OnlineEstimate>,
}

impl Report {
    /// Adds an estimate if it is due, or at a change.
    fn note(
        &mut self,
        filter: &mut SliceFilter<'_>,
        run: &str,
        time: f64,
        change: Option<OnlineChange>,
    ) {
        let is_due = time >= self.next;
        let is_change = change.is_some() && self.changes < CHANGES;
        if is_due {
            self.next = time + self.step;
        }
        if is_change {
            self.changes += 1;
        }
        if is_due || is_change {
            self.add(filter, run, time, change);
        }
    }

    fn add(
        &mut self,
        filter: &mut SliceFilter<'_>,
        run: &str,
        time: f64,
        change: Option<OnlineChange>,
    ) {
        let count = self.ratios.len();
        let (mut values, mut deviations) = (vec![f64::NAN; count], vec![f64::NAN; count]);
        // The lengths are those of the filter.
        let _ = filter.determined(&mut values, &mut deviations);
        let deviations = deviations.into_iter().zip(&self.ratios);
        self.estimates.push(OnlineEstimate {
            run: run.to_owned(),
            time,
            values: values.into_iter().map(known).collect(),
            standard_deviations: deviations.map(|(one, ratio)| known(one * ratio)).collect(),
            change,
        });
    }
}

/// A number that is not NaN.
fn known(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

/// Duration of a log, s.
fn duration(log: &Log) -> f64 {
    log.samples() as f64 / log.sampling_frequency()
}

/// The problem of settings or numbers that the filter rejects.
fn invalid(error: &overact::online::Error) -> Error {
    Problem::new(Code::SETTINGS, format!("online estimation: {error}"))
        .help("check the options of `--online`, and the units of positions and torques")
        .into()
}
