//! Comparison of accuracy, and the effect of repair.

use super::build::{Built, Start, build};
use super::language::parse;
use super::random::function;
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition};
use crate::lowering::passes::PASSES;

#[test]
fn derived_forms_have_no_digit_loss() {
    for seed in 0..20 {
        let mut built = build(&function(seed), Start::Arena);
        built.measure();
        let dag = &built.dag;
        for node in dag.operands_first() {
            let own = dag.definition(node);
            if !own.is_leaf() {
                assert_eq!(dag.loss(own, node), 1.0, "function {seed}: {own:?}");
            }
        }
    }
}

/// Runs the pass `repair`.
fn repair(dag: &mut Dag, limits: &SearchLimits) {
    let mut passes = PASSES.iter();
    let pass = passes.find(|pass| pass.name == "repair").expect("a pass");
    (pass.run)(dag, limits);
    dag.verify().expect("a sound graph");
}

/// A guard (a - b) (a + b) in the form a² - b², which is inaccurate near zero.
fn lossy() -> (Dag, usize) {
    let text = "
        input a b x
        home a = 2
        home b = 1
        let d = (a - b) * (a + b)
        guard d
        output a * a, b * b, x / d";
    let mut built = build(&parse(text), Start::Nodes);
    built.measure();
    let Built { mut dag, .. } = built;
    let (guard, squares) = (dag.guards()[0].value, &dag.entries()[..2]);
    let difference = Definition::Sum(squares[0], squares[1].times(true));
    let node = guard.node();
    assert!(dag.means(difference, node) && dag.loss(difference, node) > 100.0);
    dag.replace(node, difference);
    (dag, node)
}

#[test]
fn repair_restores_the_derived_form_of_a_cancelling_sum() {
    let (mut dag, node) = lossy();
    let own = dag.own_form(node).expect("another form");
    repair(&mut dag, &SearchLimits::QUICK);
    assert_eq!(dag.definition(node), own);
}

#[test]
fn nothing_is_repaired_without_a_search() {
    let (mut dag, node) = lossy();
    let before = dag.definition(node);
    repair(&mut dag, &SearchLimits::NONE);
    assert_eq!(dag.definition(node), before);
}
