//! A topic as a table: its columns by the joints of its first message.

use overact::Code;
use std::path::{Path, PathBuf};

use super::{joint_state::JointState, topics::Found};
use crate::{
    data::problems::{legible, shown},
    error::Problem,
};

/// What a list of a message is called in the name of a column.
pub(super) const LISTS: [&str; 3] = ["position", "velocity", "effort"];

/// Times of recorder and drivers that are further apart, s, are those of different clocks.
const SAME_CLOCK: i64 = 86_400;

/// A topic of a file.
#[derive(Debug)]
pub(in crate::data) struct Topic {
    /// The file as the caller named it.
    pub(super) file: String,
    pub(super) path: PathBuf,
    pub(super) topic: String,
    pub(super) channels: Vec<u16>,
    pub(super) joints: Vec<String>,
    pub(super) columns: Vec<Column>,
    /// What stamps, and what times of the recorder, are counted from, s since 1970.
    pub(super) origin: i64,
    pub(super) recorded_from: i64,
    /// Number of topics of the file that can be read.
    pub(super) parts: u64,
}

/// A column of a topic.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) name: String,
    /// The name behind that of the topic.
    pub(super) full: String,
    pub(super) source: Source,
}

/// Where a number of a message stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    Stamp,
    Recorded,
    /// A list, and a joint's place in it.
    Joint(usize, usize),
}

impl Topic {
    /// A topic with the joints of its first message; none where no message came.
    pub(super) fn new(file: &str, path: &Path, found: Found) -> Result<Option<Self>, Problem> {
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
            // Joints without names are called by their numbers.
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

/// What is said of a file that can't be read.
pub(super) fn broken(file: &str, why: &str) -> Problem {
    let message = format!(
        "the file starts as MCAP does, but can't be read: {}",
        legible(why)
    );
    Problem::new(Code::LOG_FORMAT, message).file(file).help(
        "if its writer was stopped, `mcap recover FILE -o NEW.mcap` saves what there is; if it was copied, copy it again",
    )
}
