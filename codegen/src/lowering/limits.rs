//! Limits of the search for fewer operations.

use overact_description::Effort;

/// Limits of the search for one function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SearchLimits {
    /// Whether nodes that are one operation from others are replaced.
    pub replaces: bool,
    /// Whether forms are compared at regular states, too, and not only near singular ones.
    pub compares_regular_states: bool,
    /// Largest number of rounds of the search for pairs.
    ///
    /// It searches nodes that are two operations from others of their heading, and operations that
    /// serve several of these. A later round only examines what earlier ones made possible.
    pub pair_rounds: usize,
    /// Number of nodes above which a function is searched in smaller pieces and without a walk.
    pub large_nodes: usize,
    /// Number of nodes that are searched for pairs at once; larger headings are searched in pieces.
    pub piece_nodes: usize,
    /// The same in a function of more than [`large_nodes`](Self::large_nodes) nodes.
    pub small_piece_nodes: usize,
    /// Number of nodes up to which pairs of a function are searched as a whole, not heading by
    /// heading.
    pub whole_nodes: usize,
    /// Largest number of steps of a walk among forms of equal cost.
    pub walk_steps: usize,
    /// Number of nodes up to which a function has such a walk.
    pub walk_nodes: usize,
    /// Largest number of consecutive steps of the walk that save nothing.
    pub walk_patience: usize,
    /// Rounds of the search for pairs after a step of the walk.
    pub walk_pair_rounds: usize,
}

impl SearchLimits {
    /// Limits of the most important functions.
    #[must_use]
    pub const fn of(effort: Effort) -> Self {
        match effort {
            Effort::None => Self::NONE,
            Effort::Quick => Self::QUICK,
            Effort::Thorough => Self::THOROUGH,
        }
    }

    /// No search.
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

    /// Single replacements only.
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

    /// Pairs until nothing is found, in small functions across headings, and a long walk.
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

    /// Number of nodes that are searched for pairs at once, in a function of `nodes` nodes.
    #[must_use]
    pub(crate) const fn piece(&self, nodes: usize) -> usize {
        if nodes <= self.large_nodes {
            self.piece_nodes
        } else {
            self.small_piece_nodes
        }
    }

    /// Limits of a controller's function: quick if the search is thorough.
    #[must_use]
    pub(crate) const fn of_control(self) -> Self {
        if self.is_thorough() {
            Self::QUICK
        } else {
            self.of_lesser_functions()
        }
    }

    /// Limits of a second, different search of such a function; `None` if one is enough.
    ///
    /// It searches pairs several times, in small functions across headings.
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

    /// Whether the limits exceed those of a quick search.
    #[must_use]
    pub(crate) const fn is_thorough(&self) -> bool {
        self.pair_rounds > Self::QUICK.pair_rounds
    }

    /// Limits of less important functions: at most single replacements.
    #[must_use]
    pub(crate) const fn of_lesser_functions(self) -> Self {
        if self.replaces {
            Self::SINGLE_REPLACEMENTS
        } else {
            Self::NONE
        }
    }
}
