//! Sums, products and quotients of two nodes that equal a node.

use super::candidate_prefilter::CandidatePrefilter;
use super::{Dag, Definition, Edge};
use crate::cas::field::Element;
use crate::cas::hasher::QuickMap;

/// Sums and products of two nodes that equal a node, for the nodes examined so far.
///
/// Single replacements neither add nor restore nodes, so the forms found once stay complete; some
/// may become unused. Code that adds or restores nodes has to invalidate them.
#[derive(Debug, Clone, Default)]
pub(super) struct Forms(Option<DefinitionTable>);

#[derive(Debug, Clone)]
struct DefinitionTable {
    pairs: QuickMap<usize, Vec<Definition>>,
    prefilter: CandidatePrefilter,
    inverses: Vec<Element>,
}

impl DefinitionTable {
    fn new(dag: &Dag) -> Self {
        let inverse = |node| dag.value(Edge::to(node)).inverse();
        Self {
            pairs: QuickMap::default(),
            prefilter: CandidatePrefilter::new(dag),
            inverses: (0..dag.len()).map(inverse).collect(),
        }
    }

    /// All sums and products of two live nodes that equal the node.
    fn pairs(&self, dag: &Dag, node: usize) -> Vec<Definition> {
        let target = dag.value(Edge::to(node));
        let mut found = Vec::new();
        for other in (0..dag.len()).filter(|&n| n != node && dag.is_live(n)) {
            for negative in [false, true] {
                if !self.prefilter.may_be_sum(node, other, negative) {
                    continue;
                }
                let a = Edge::new(other, negative);
                let b = dag.find(target + -dag.value(a));
                let b = b.filter(|b| b.node() >= other && b.node() != node);
                found.extend(b.map(|b| Definition::Sum(a, b)));
            }
            if !self.prefilter.may_be_product(node, other) {
                continue;
            }
            let b = dag.find(target * self.inverses[other]);
            let b = b.filter(|b| b.node() >= other && b.node() != node);
            found.extend(b.map(|b| Definition::Product(Edge::to(other), b)));
        }
        found
    }

    /// All quotients of a live node by a divisor that equal the node.
    fn quotients(&self, dag: &Dag, node: usize, divisors: &[usize]) -> Vec<Definition> {
        let target = dag.value(Edge::to(node));
        let quotient = |&divisor: &usize| {
            let by = Edge::to(divisor);
            let a = dag.find(target * dag.value(by))?;
            (a.node() != node).then_some(Definition::Quotient(a, by))
        };
        let is_candidate =
            |&&divisor: &&usize| divisor != node && self.prefilter.may_be_quotient(node, divisor);
        let divisors = divisors.iter().filter(is_candidate);
        divisors.filter_map(quotient).collect()
    }
}

impl Dag {
    /// All sums, products and quotients of two live nodes that probably equal a node.
    pub(crate) fn forms(&mut self, node: usize, divisors: &[usize]) -> Vec<Definition> {
        let mut found = self
            .forms
            .0
            .take()
            .unwrap_or_else(|| DefinitionTable::new(self));
        if !found.pairs.contains_key(&node) {
            let pairs = found.pairs(self, node);
            found.pairs.insert(node, pairs);
        }
        let quotients = found.quotients(self, node, divisors);
        let all = found.pairs[&node].iter().copied().chain(quotients);
        let is_there = |by: &Definition| by.operands().all(|operand| self.is_live(operand));
        let forms = all.filter(is_there).collect();
        self.forms.0 = Some(found);
        forms
    }

    /// Invalidates the forms.
    pub(crate) fn forget_forms(&mut self) {
        self.forms = Forms::default();
    }

    /// A copy for [`restore`](Self::restore), without cached forms.
    pub(crate) fn snapshot(&mut self) -> Self {
        let forms = std::mem::take(&mut self.forms);
        let copy = self.clone();
        self.forms = forms;
        copy
    }

    /// Restores a copy. Forms are invalidated only if nodes have been added since.
    pub(crate) fn restore(&mut self, copy: Self) {
        let had_more_nodes = self.len() > copy.len();
        let forms = std::mem::take(&mut self.forms);
        *self = copy;
        if !had_more_nodes {
            self.forms = forms;
        }
    }
}
