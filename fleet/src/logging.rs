//! What scheduler and executors tell of themselves, on stderr: the engine has much to say where a query goes wrong,
//! and without this nobody hears it.

use log::{LevelFilter, Log, Metadata, Record};
use std::{io::Write, time::Instant};

/// Packages that are heard beside this one; those below them tell of each frame that they send.
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
            // A closed stderr is no reason to stop.
            let _ = std::io::stderr().write_all(text.as_bytes());
        }
    }

    fn flush(&self) {}
}

/// Tells on stderr what is at least as urgent as this.
pub fn on_stderr(level: LevelFilter) {
    let start = Instant::now();
    let logger = Box::leak(Box::new(Stderr { level, start }));
    // A second logger is none: the first one goes on.
    if log::set_logger(logger).is_ok() {
        log::set_max_level(level);
    }
}
