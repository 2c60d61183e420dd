//! How far the search of a function goes: all its limits stand here.

use overact_description::Effort;

/// How far the search of one function goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SearchLimits {
    /// Whether nodes that are one operation away from others are replaced.
    pub replaces: bool,
    /// Whether forms are compared at regular states, too, and not only near singular ones.
    pub compares_regular_states: bool,
    /// How often the nodes that are two operations away from others of their heading are searched at
    /// most, and operations that serve several of these: a later round has only what the earlier ones
    /// opened up.
    pub pair_rounds: usize,
    /// A function of more nodes is large: it is searched in smaller pieces, and has no walk.
    pub large_nodes: usize,
    /// Up to so many nodes are searched for pairs at once; a heading with more is searched in pieces.
    pub piece_nodes: usize,
    /// The same in a large function.
    pub small_piece_nodes: usize,
    /// Up to so many nodes a function's pairs are searched as a whole, not heading by heading.
    pub whole_nodes: usize,
    /// How many steps a walk among forms of equal cost has at most.
    pub walk_steps: usize,
    /// Up to so many nodes a function has such a walk.
    pub walk_nodes: usize,
    /// How many steps of the walk in a row may bring nothing.
    pub walk_patience: usize,
    /// How often pairs are searched after a step of the walk.
    pub walk_pair_rounds: usize,
}

impl SearchLimits {
    /// The limits of the functions that matter most.
    #[must_use]
    pub const fn of(effort: Effort) -> Self {
        match effort {
            Effort::None => Self::NONE,
            Effort::Quick => Self::QUICK,
            Effort::Thorough => Self::THOROUGH,
        }
    }

    /// No node is looked at.
    pub(crate) const NONE: Self = Self {
        replaces: false,
        compares_regular_states: false,
        pair_rounds: 0,
        large_nodes: 0,
        piece_nodes: 0,
        small_piece_nodes: 0,
        whole_nodes: 0,
        walk_steps: 0,
        walk_nodes: 0,
        walk_patience: 0,
        walk_pair_rounds: 0,
    };

    /// Single replacements, one after the other.
    pub(crate) const SINGLE_REPLACEMENTS: Self = Self {
        replaces: true,
        ..Self::NONE
    };

    /// Pairs once, and a short walk in small functions.
    pub const QUICK: Self = Self {
        compares_regular_states: true,
        pair_rounds: 1,
        large_nodes: 3000,
        piece_nodes: 2500,
        small_piece_nodes: 300,
        walk_steps: 10,
        walk_nodes: 1000,
        walk_patience: 1,
        ..Self::SINGLE_REPLACEMENTS
    };

    /// Pairs until nothing is found, in small functions among the nodes of all headings, and a long walk.
    pub const THOROUGH: Self = Self {
        pair_rounds: 4,
        large_nodes: 12_000,
        small_piece_nodes: 1000,
        whole_nodes: 700,
        walk_steps: 40,
        walk_nodes: 12_000,
        walk_patience: 3,
        walk_pair_rounds: 1,
        ..Self::QUICK
    };

    /// Up to so many nodes of a function with so many are searched for pairs at once.
    #[must_use]
    pub(crate) const fn piece(&self, nodes: usize) -> usize {
        if nodes <= self.large_nodes {
            self.piece_nodes
        } else {
            self.small_piece_nodes
        }
    }

    /// The limits of a function that a controller calls: what is quick where the search is thorough.
    #[must_use]
    pub(crate) const fn of_control(self) -> Self {
        if self.is_thorough() {
            Self::QUICK
        } else {
            self.of_lesser_functions()
        }
    }

    /// The limits of a second search of such a function, which goes another way: pairs several times, in small
    /// functions among the nodes of all headings. `None` where one is enough.
    #[must_use]
    pub(crate) const fn of_control_again(self) -> Option<Self> {
        if !self.is_thorough() {
            return None;
        }
        Some(Self {
            pair_rounds: 3,
            whole_nodes: Self::THOROUGH.whole_nodes,
            walk_patience: 2,
            ..Self::QUICK
        })
    }

    /// Whether they are beyond those of a quick search.
    #[must_use]
    pub(crate) const fn is_thorough(&self) -> bool {
        self.pair_rounds > Self::QUICK.pair_rounds
    }

    /// The limits of a function that matters less: of these no more than single replacements.
    #[must_use]
    pub(crate) const fn of_lesser_functions(self) -> Self {
        if self.replaces {
            Self::SINGLE_REPLACEMENTS
        } else {
            Self::NONE
        }
    }
}
