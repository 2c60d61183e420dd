//! Log messages of scheduler and executors on stderr.
//!
//! The engine only explains failed queries in its log.

use log::{LevelFilter, Log, Metadata, Record};
use std::{io::Write, time::Instant};

/// Packages whose messages are printed; their dependencies log every network frame.
const HEARD: [&str; 3] = ["ballista", "datafusion", "overact"];

struct Stderr {
    level: LevelFilter,
    start: Instant,
}

impl Log for Stderr {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.level() <= self.level && HEARD.iter().any(|own| metadata.target().starts_with(own))
    }

    fn log(&self, record: &Record<'_>) {
        if self.enabled(record.metadata()) {
            let seconds = self.start.elapsed().as_secs_f64();
            let (level, target, text) = (record.level(), record.target(), record.args());
            let text = format!("{seconds:9.3} s {level} {target}: {text}\n");
            // A closed stderr is ignored.
            let _ = std::io::stderr().write_all(text.as_bytes());
        }
    }

    fn flush(&self) {}
}

/// Prints messages of at least this level on stderr.
pub fn on_stderr(level: LevelFilter) {
    let start = Instant::now();
    let logger = Box::leak(Box::new(Stderr { level, start }));
    // If a logger is already set, it is kept.
    if log::set_logger(logger).is_ok() {
        log::set_max_level(level);
    }
}
