//! Text for motions along and about axes.

use crate::mechanism::{Mechanism, TwistCoordinate};

/// Motions of the platform along and about axes.
pub(super) struct Motions {
    along: Vec<String>,
    about: Vec<String>,
}

impl Motions {
    /// The motions whose components exceed `least`.
    pub(super) fn new(mechanism: &Mechanism, sizes: &[f64], least: f64) -> Self {
        let axis = |axis: usize| ["x", "y", "z"][axis].to_owned();
        let twist = mechanism.platform.as_ref().map(|p| p.motion.twist());
        let (mut along, mut about) = (Vec::new(), Vec::new());
        for (coordinate, size) in twist.iter().flatten().zip(sizes) {
            match coordinate {
                _ if *size <= least => {}
                TwistCoordinate::Linear(a) => along.push(axis(*a)),
                TwistCoordinate::Angular(a) => about.push(axis(*a)),
            }
        }
        Self { along, about }
    }

    /// The motions with components in six directions, three along and three about the axes.
    pub(super) fn of_directions(parts: &[f64; 6]) -> Self {
        let there = |parts: &[f64]| -> Vec<String> {
            let axes = ["x", "y", "z"].iter().zip(parts);
            let there = axes.filter(|(_, part)| **part > 1e-3);
            there.map(|(axis, _)| (*axis).to_owned()).collect()
        };
        Self {
            along: there(&parts[..3]),
            about: there(&parts[3..]),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.along.len() + self.about.len()
    }

    /// "motion along x and y, and rotation about z".
    pub(super) fn words(&self, along: &str, about: &str) -> String {
        let part = |word: &str, axes: &[String]| match axes {
            [] => None,
            _ => Some(format!("{word} {}", listed(axes))),
        };
        let parts = [part(along, &self.along), part(about, &self.about)];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        parts.join(", and ")
    }
}

/// "a, b and c".
pub(super) fn listed(words: &[String]) -> String {
    match words {
        [] => "nothing".to_owned(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
