//! The dominator tree agrees with counting uses.

use super::build::{Start, build};
use super::random::function;
use crate::lowering::dag::Dominators;

#[test]
fn cones_are_the_nodes_removed_with_a_node() {
    let mut shared = 0;
    for seed in 0..20 {
        let mut dag = build(&function(seed), Start::Arena).dag;
        let tree = Dominators::new(&dag);
        let nodes = dag.operands_first();
        for &kept in &nodes {
            assert_eq!(tree.cone(kept), dag.cone(kept), "function {seed}: {kept}");
            let mut with_another_use = dag.clone();
            with_another_use.hold(kept);
            for &of in nodes.iter().filter(|&&of| of != kept) {
                // A node that both need belongs to neither cone: it stays, too, and is not counted.
                let stays = dag.cone(of) - with_another_use.cone(of);
                let counted = tree.shared(of, kept);
                assert!(counted <= stays, "function {seed}: {kept} of {of}");
                shared += usize::from(counted > 0 && counted == stays);
            }
        }
    }
    assert!(shared > 100, "{shared}");
}
