//! Messages of a topic as rows of numbers, one message at a time.

use overact::Code;
use std::{fs::File, sync::Arc};

use super::{
    joint_state::JointState,
    records::{MAGIC, Record, Records},
    topic::{LISTS, Source, Topic, broken},
};
use crate::{
    error::{Error, Problem},
    formats::table_file::RowReader,
    problems::{legible, shown},
};

/// A requested column, with its name for messages.
#[derive(Debug)]
pub(super) struct Wanted<'a> {
    pub(super) source: Source,
    pub(super) name: &'a str,
}

/// The remaining rows of a topic.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    topic: &'a Topic,
    records: Records,
    wanted: Vec<Wanted<'a>>,
    content: Vec<u8>,
    /// Times of the last message, if they are requested.
    last: [Option<f64>; 2],
    /// Number of messages returned so far.
    samples: usize,
    is_broken: bool,
}

impl<'a> Rows<'a> {
    /// Starts at the first message of a topic; `length` is the size of its file.
    pub(super) fn new(topic: &'a Topic, file: File, length: u64, wanted: Vec<Wanted<'a>>) -> Self {
        Self {
            topic,
            records: Records::new(&Arc::new(file), MAGIC.len() as u64, length),
            wanted,
            content: Vec::new(),
            last: [None; 2],
            samples: 0,
            is_broken: false,
        }
    }

    /// Reads the next message and returns its recording time, ns; `None` at the end.
    fn advance(&mut self) -> Result<Option<u64>, Problem> {
        let channels = &self.topic.channels;
        let wants = |channel| channels.contains(&channel);
        loop {
            let record = self.records.next(&mut self.content, &wants);
            match record.map_err(|why| broken(&self.topic.file, &why))? {
                None => return Ok(None),
                Some(Record::Message(channel, time)) if wants(channel) => return Ok(Some(time)),
                Some(_) => {}
            }
        }
    }

    /// Writes the numbers of a message to `values`.
    fn take(&mut self, recorded: u64, values: &mut [f64]) -> Result<(), Error> {
        let topic = self.topic;
        let problem = |what: String| {
            let message = format!(
                "message {} of `{}` {what}",
                self.samples,
                shown(&topic.topic)
            );
            Problem::new(Code::LOG_FORMAT, message).file(topic.file.as_str())
        };
        let state = JointState::read(&self.content).map_err(|why| problem(legible(&why)))?;
        if state.names != topic.joints {
            return Err(other_joints(problem, &topic.joints, &state.names).into());
        }
        let mut problems = Vec::new();
        for (wanted, value) in self.wanted.iter().zip(values) {
            *value = match wanted.source {
                Source::Stamp if self.samples > 0 && state.stamp == (0, 0) => {
                    let help = "use the time of the recorder, `time = \"log_time\"`";
                    problems.push(problem(String::from("has no stamp: it is zero")).help(help));
                    continue;
                }
                Source::Stamp => seconds(i64::from(state.stamp.0), state.stamp.1, topic.origin),
                Source::Recorded => {
                    let (whole, parts) = (recorded / 1_000_000_000, recorded % 1_000_000_000);
                    seconds(whole.cast_signed(), parts as u32, topic.recorded_from)
                }
                Source::Joint(list, joint) => {
                    let numbers = state.lists[list];
                    match numbers.get(joint) {
                        Some(value) if value.is_finite() => value,
                        Some(_) => {
                            let what = format!("has no finite number in `{}`", shown(wanted.name));
                            problems.push(problem(what).column(wanted.name));
                            f64::NAN
                        }
                        None => {
                            let (count, what) = (numbers.len(), LISTS[list]);
                            let what = format!(
                                "has {count} numbers of the kind `{what}`, too few for `{}`",
                                shown(wanted.name)
                            );
                            problems.push(problem(what).column(wanted.name));
                            f64::NAN
                        }
                    }
                }
            };
            let last = match wanted.source {
                Source::Stamp => &mut self.last[0],
                Source::Recorded => &mut self.last[1],
                Source::Joint(..) => continue,
            };
            if let Some(before) = last.replace(*value)
                && *value <= before
            {
                let what = format!(
                    "has the time {value} s, which is not later than the previous message, {before} s"
                );
                let help = "its clock stopped or was reset, or messages are out of order: cut the log there, or use the other one of `time` and `log_time`";
                problems.push(problem(what).column(wanted.name).help(help));
            }
        }
        Error::check(problems)
    }
}

impl RowReader for Rows<'_> {
    fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        if self.wanted.is_empty() || self.is_broken {
            return Ok(false);
        }
        let recorded = self.advance();
        self.is_broken |= recorded.is_err();
        let Some(recorded) = recorded? else {
            return Ok(false);
        };
        let taken = self.take(recorded, values);
        self.samples += 1;
        taken.map(|()| true)
    }

    fn is_broken(&self) -> bool {
        self.is_broken
    }

    // Each topic reads the whole file.
    fn bytes(&self) -> u64 {
        self.records.position() / self.topic.parts
    }
}

/// A time in seconds from an origin.
fn seconds(whole: i64, nanos: u32, origin: i64) -> f64 {
    // A single rounding.
    (i128::from(whole - origin) * 1_000_000_000 + i128::from(nanos)) as f64 / 1e9
}

/// The problem of a message with other joints than the first one.
fn other_joints(problem: impl Fn(String) -> Problem, first: &[String], own: &[&str]) -> Problem {
    let mut sorted: Vec<&str> = first.iter().map(String::as_str).collect();
    let mut others = own.to_vec();
    sorted.sort_unstable();
    others.sort_unstable();
    let what = if sorted == others {
        "has the joints of the first message in another order"
    } else {
        "has other joints than the first message"
    };
    let names =
        |names: &mut dyn Iterator<Item = &str>| names.map(shown).collect::<Vec<_>>().join(", ");
    let (first, own) = (
        names(&mut first.iter().map(String::as_str)),
        names(&mut own.iter().copied()),
    );
    let message = format!("{what}: {}, and not {}", legible(&own), legible(&first));
    problem(message).help("several publishers seem to share this topic: record each on a separate topic, or export CSV")
}
