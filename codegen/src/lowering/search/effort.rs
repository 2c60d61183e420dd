//! How far the search of a function goes by the effort that is asked for.

use crate::effort::Effort;

impl Effort {
    /// How far the search of the functions that matter most goes.
    #[must_use]
    pub const fn reach(self) -> Reach {
        match self {
            Self::None => Reach::Nothing,
            Self::Quick => Reach::Headings,
            Self::Thorough => Reach::Everything,
        }
    }
}

/// How far the search of one function goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord)]
pub enum Reach {
    /// No node is looked at.
    #[default]
    Nothing,
    /// Nodes that are one operation away from others.
    Singles,
    /// Once, in functions that are not too large, also those that are two operations away from nodes of
    /// the same heading, and operations that serve several of these.
    Headings,
    /// These again until nothing is found, in small functions among the nodes of all headings.
    Everything,
}

impl Reach {
    /// How often the pairs of a function of so many nodes are searched at most: a later round has only
    /// what the earlier ones opened up.
    pub(super) const fn rounds(self, nodes: usize) -> usize {
        match self {
            Self::Headings if nodes <= 3000 => 1,
            Self::Everything => 4,
            _ => 0,
        }
    }

    /// How many steps a walk among forms of equal cost has at most, by the nodes of the function.
    pub(super) const fn steps(self, nodes: usize) -> usize {
        match self {
            Self::Everything => 40,
            Self::Headings if nodes <= 1000 => 10,
            _ => 0,
        }
    }

    /// How often pairs are searched after a step.
    pub(super) const fn rounds_after_a_step(self) -> usize {
        match self {
            Self::Everything => 1,
            _ => 0,
        }
    }

    /// How many steps in a row may bring nothing.
    pub(super) const fn patience(self) -> usize {
        match self {
            Self::Everything => 3,
            _ => 1,
        }
    }

    /// Up to so many nodes a function's pairs are searched as a whole.
    pub(super) const fn whole(self) -> usize {
        match self {
            Self::Everything => 700,
            _ => 0,
        }
    }
}
