//! A topic as a table, with the joints of its first message as columns.

use overact::Code;
use std::path::{Path, PathBuf};

use super::{joint_state::JointState, topics::TopicChannels};
use crate::{
    error::Problem,
    problems::{legible, shown},
};

/// Names of the lists of a message in column names.
pub(super) const LISTS: [&str; 3] = ["position", "velocity", "effort"];

/// Recorder and driver times that differ by more than this (s) have different clocks.
const SAME_CLOCK: i64 = 86_400;

/// A topic of a file.
#[derive(Debug)]
pub(crate) struct Topic {
    /// The file as the caller named it.
    pub(super) file: String,
    pub(super) path: PathBuf,
    pub(super) topic: String,
    pub(super) channels: Vec<u16>,
    pub(super) joints: Vec<String>,
    pub(super) columns: Vec<Column>,
    /// Origins of stamps and of recording times, s since 1970.
    pub(super) origin: i64,
    pub(super) recorded_from: i64,
    /// Number of supported topics in the file.
    pub(super) parts: u64,
}

/// A column of a topic.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) name: String,
    /// The name prefixed by the topic.
    pub(super) full: String,
    pub(super) source: Source,
}

/// Position of a number in a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    Stamp,
    Recorded,
    /// A list, and the index of a joint in it.
    Joint(usize, usize),
}

impl Topic {
    /// A topic with the joints of its first message; `None` without a message.
    pub(super) fn new(
        file: &str,
        path: &Path,
        found: TopicChannels,
    ) -> Result<Option<Self>, Problem> {
        let Some((recorded, content)) = found.first else {
            return Ok(None);
        };
        let state = JointState::read(&content).map_err(|why| {
            let message = format!(
                "the first message of `{}` {}",
                shown(&found.topic),
                legible(&why)
            );
            Problem::new(Code::LOG_FORMAT, message).file(file)
        })?;
        let joints: Vec<String> = match &state.names[..] {
            // Joints without names are numbered.
            [] => (1..=state.lists[0].len()).map(|k| k.to_string()).collect(),
            names => names.iter().copied().map(String::from).collect(),
        };
        let times = [("time", Source::Stamp), ("log_time", Source::Recorded)];
        let mut names: Vec<_> = times.map(|(name, source)| (name.to_owned(), source)).into();
        for (list, (what, numbers)) in LISTS.iter().zip(&state.lists).enumerate() {
            let joints = joints.iter().take(numbers.len()).enumerate();
            names.extend(
                joints.map(|(joint, name)| (format!("{what}.{name}"), Source::Joint(list, joint))),
            );
        }
        let column = |(name, source)| Column {
            full: format!("{}.{name}", found.topic),
            name,
            source,
        };
        let (seconds, stamped) = (
            (recorded / 1_000_000_000).cast_signed(),
            i64::from(state.stamp.0),
        );
        let is_same = (seconds - stamped).abs() < SAME_CLOCK;
        Ok(Some(Self {
            file: file.to_owned(),
            path: path.to_owned(),
            columns: names.into_iter().map(column).collect(),
            topic: found.topic,
            channels: found.channels,
            origin: stamped,
            recorded_from: if is_same { stamped } else { seconds },
            joints: if state.names.is_empty() {
                Vec::new()
            } else {
                joints
            },
            parts: 1,
        }))
    }
}

/// The problem of a file that cannot be read.
pub(super) fn broken(file: &str, why: &str) -> Problem {
    let message = format!(
        "the file starts like MCAP, but can't be read: {}",
        legible(why)
    );
    Problem::new(Code::LOG_FORMAT, message).file(file).help(
        "if its writer was stopped, use `mcap recover FILE -o NEW.mcap`; if it was copied, copy it again",
    )
}
