//! Restores a node's derived form if the search changed it without saving operations.

use crate::lowering::SearchLimits;
use crate::lowering::dag::Dag;

/// Restores the derivation's form of nodes where that costs nothing.
pub(super) fn run(dag: &mut Dag, _: &SearchLimits) {
    loop {
        let mut count = 0;
        for node in 0..dag.len() {
            let Some(own) = dag.own_form(node).filter(|_| dag.is_live(node)) else {
                continue;
            };
            let is_there = own.operands().all(|operand| dag.is_live(operand));
            if is_there && dag.saving(node, own) >= 0 && !dag.depend(own.operands(), node) {
                dag.replace(node, own);
                count += 1;
            }
        }
        if count == 0 {
            return;
        }
    }
}
