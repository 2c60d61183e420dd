//! Single replacements and pairs in turn, as long as that saves anything.

use super::{shared_pairs, single_replacements};
use crate::lowering::SearchLimits;
use crate::lowering::dag::Dag;

/// Replaces nodes until nothing is saved.
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if !limits.replaces {
        return;
    }
    let rounds = if dag.len() <= limits.pair_nodes {
        limits.pair_rounds
    } else {
        0
    };
    settle(dag, limits, rounds);
}

/// Replaces nodes as long as that saves anything, with so many rounds of pairs at most.
pub(super) fn settle(dag: &mut Dag, limits: &SearchLimits, mut rounds: usize) {
    loop {
        let mut saved = single_replacements::improve(dag);
        if rounds > 0 {
            rounds -= 1;
            saved += shared_pairs::improve(dag, limits.whole_nodes);
        }
        if saved == 0 {
            return;
        }
    }
}
