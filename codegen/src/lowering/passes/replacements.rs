//! Alternates single replacements and pairs as long as that saves operations.

use super::{shared_pairs, single_replacements};
use crate::lowering::SearchLimits;
use crate::lowering::dag::Dag;

/// Replaces nodes until nothing is saved.
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if !limits.replaces {
        return;
    }
    settle(dag, limits, limits.pair_rounds);
}

/// Replaces nodes as long as that saves operations, with at most `rounds` rounds of pairs.
pub(super) fn settle(dag: &mut Dag, limits: &SearchLimits, mut rounds: usize) {
    loop {
        let mut saved = single_replacements::improve(dag);
        if rounds > 0 {
            rounds -= 1;
            saved += shared_pairs::improve(dag, limits);
        }
        if saved == 0 {
            return;
        }
    }
}
