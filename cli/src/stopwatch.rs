//! Times of the stages of a command.

use overact_identification::{Progress as Doing, StageTime};
use std::{cell::RefCell, fs, time::Instant};

/// Measures the stages of an identification, one after the other.
#[derive(Debug, Default)]
pub(crate) struct Stopwatch {
    done: RefCell<Vec<StageTime>>,
    current: RefCell<Option<Running>>,
}

/// A stage that has begun.
#[derive(Debug)]
struct Running {
    name: String,
    is_check: bool,
    since: Instant,
    processors: Option<f64>,
}

impl Stopwatch {
    /// Begins a stage, which ends the one before.
    ///
    /// A stage that begins again continues.
    pub(crate) fn begin(&self, name: &str) {
        self.next(name, false);
    }

    /// Begins the stage that a progress belongs to.
    pub(crate) fn hear(&self, doing: &Doing<'_>) {
        match doing {
            Doing::Base => self.begin("base parameters"),
            Doing::Run { .. } => self.begin("motion, regressor, decimation"),
            Doing::Estimation { .. } => self.begin("estimates and intervals"),
            Doing::Validation { .. } => self.begin("cross-validation"),
            Doing::Stage { name } => self.begin(name),
            Doing::Check { name } => self.next(name, true),
            _ => {}
        }
    }

    fn next(&self, name: &str, is_check: bool) {
        let mut current = self.current.borrow_mut();
        let is_same = |own: &Running| own.name == name && own.is_check == is_check;
        if current.as_ref().is_some_and(is_same) {
            return;
        }
        self.close(current.take());
        *current = Some(Running {
            name: name.to_owned(),
            is_check,
            since: Instant::now(),
            processors: processor_seconds(),
        });
    }

    /// Adds the time of a stage to its earlier ones.
    fn close(&self, stage: Option<Running>) {
        let Some(Running {
            name,
            is_check,
            since,
            processors,
        }) = stage
        else {
            return;
        };
        let seconds = since.elapsed().as_secs_f64();
        let now = processor_seconds().zip(processors);
        let processor_seconds = now.map(|(now, before)| (now - before).max(0.0));
        let mut done = self.done.borrow_mut();
        let earlier = { done.iter_mut() }.find(|own| own.stage == name && own.is_check == is_check);
        if let Some(own) = earlier {
            own.seconds += seconds;
            let both = own.processor_seconds.zip(processor_seconds);
            own.processor_seconds = both.map(|(own, more)| own + more);
            return;
        }
        done.push(StageTime {
            stage: name,
            is_check,
            seconds,
            processor_seconds,
        });
    }

    /// Ends the last stage; times of all stages in the order of their beginnings.
    pub(crate) fn finish(&self) -> Vec<StageTime> {
        self.close(self.current.borrow_mut().take());
        self.done.take()
    }
}

/// Processor time of all threads so far, s, on Linux.
fn processor_seconds() -> Option<f64> {
    let threads = fs::read_dir("/proc/self/task").ok()?;
    let of_thread = |thread: fs::DirEntry| -> Option<f64> {
        let text = fs::read_to_string(thread.path().join("schedstat")).ok()?;
        let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
        Some(1e-9 * nanoseconds)
    };
    threads.flatten().map(of_thread).sum()
}
