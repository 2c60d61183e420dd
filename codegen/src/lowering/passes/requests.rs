//! Requests of nodes: the values from which one more operation gives them.

use super::repeated_values::RepeatedValues;
use crate::cas::field::{ByValue, Element, canonical};
use crate::lowering::dag::{Dag, Definition, Dominators, Edge};

/// How a target follows from an existing node and the requested value.
#[derive(Debug, Clone, Copy)]
pub(super) enum Form {
    Plus,
    Times,
    Over,
}

/// A target that requests a value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Request {
    pub(super) target: u32,
    pub(super) with: Edge,
    pub(super) form: Form,
    /// Whether the negative of the value is requested.
    pub(super) negative: bool,
    /// The previous request for the same value.
    next: Option<u32>,
}

/// A live node of a group.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    pub(super) node: usize,
    pub(super) value: Element,
    pub(super) projection: u64,
}

/// Live nodes of a group, and its targets.
pub(super) struct Candidates<'d> {
    dag: &'d Dag,
    tree: &'d Dominators,
    targets: Vec<usize>,
    members: Vec<Member>,
}

/// Requests of the targets, without those that cannot save anything.
#[derive(Debug, Default)]
pub(super) struct Requests {
    all: Vec<Request>,
    heads: ByValue<u32>,
}

impl<'d> Candidates<'d> {
    /// The live nodes among `all`, and those among `own` that may be replaced.
    pub(super) fn new(dag: &'d Dag, tree: &'d Dominators, own: &[usize], all: &[usize]) -> Self {
        let is_target = |node: &usize| dag.is_open(*node) && tree.cone(*node) > 1;
        let live = all.iter().copied().filter(|&node| dag.is_live(node));
        let member = |node| {
            let value = dag.value(Edge::to(node));
            Member {
                node,
                value,
                projection: value.projection(),
            }
        };
        Self {
            dag,
            tree,
            targets: own.iter().copied().filter(is_target).collect(),
            members: live.map(member).collect(),
        }
    }

    /// Calls a function for all pairs of members, the first of which may be the second.
    pub(super) fn for_each_pair(&self, mut visit: impl FnMut(&Member, &Member)) {
        for (place, first) in self.members.iter().enumerate() {
            for second in &self.members[place..] {
                visit(first, second);
            }
        }
    }

    /// Counts the values of all pairs, and the quotients that are requested.
    ///
    /// A sum, difference or product is requested by the pair that has this value. So a value is of
    /// use only if it is counted twice.
    pub(super) fn repeated_values(&self) -> RepeatedValues {
        let count = self.members.len();
        let mut values = RepeatedValues::new(count * (3 * count / 2 + self.targets.len()));
        self.for_each_pair(|a, b| {
            let of_sum =
                |negative| Element::projected_difference(a.projection, b.projection, negative);
            values.count(of_sum(true));
            values.count((a.value * b.value).projection());
            if a.node != b.node {
                values.count(of_sum(false));
            }
        });
        let inverses = self.inverses();
        self.for_each_request(|target, place, _| {
            values.count((target.value * inverses[place]).projection());
        });
        values
    }

    fn inverses(&self) -> Vec<Element> {
        self.members.iter().map(|m| m.value.inverse()).collect()
    }

    /// Calls a function for each target, with the place of each member that may help to replace it.
    fn for_each_request(&self, mut visit: impl FnMut(&Member, usize, &Member)) {
        for &target in &self.targets {
            let value = self.dag.value(Edge::to(target));
            let target = Member {
                node: target,
                value,
                projection: value.projection(),
            };
            let cone = self.tree.cone(target.node);
            for (place, member) in self.members.iter().enumerate() {
                let saved = cone - self.tree.shared(target.node, member.node);
                if member.node != target.node && saved > 1 {
                    visit(&target, place, member);
                }
            }
        }
    }

    /// The requests for values that may be of use.
    pub(super) fn requests(&self, repeated: &RepeatedValues) -> Requests {
        let divisors = self.dag.divisors();
        let inverses = self.inverses();
        let mut requests = Requests::default();
        self.for_each_request(|target, place, member| {
            let target_node = target.node as u32;
            let with = Edge::to(member.node);
            for negative in [false, true] {
                let (from, by) = (target.projection, member.projection);
                if repeated.may_repeat(Element::projected_difference(from, by, negative)) {
                    let of = if negative {
                        -member.value
                    } else {
                        member.value
                    };
                    let wanted = target.value + -of;
                    requests.add(target_node, with.times(negative), Form::Plus, wanted);
                }
            }
            let factor = target.value * inverses[place];
            if repeated.may_repeat(factor.projection()) {
                requests.add(target_node, with, Form::Times, factor);
            }
            if divisors.binary_search(&member.node).is_ok() {
                let dividend = target.value * member.value;
                if repeated.may_repeat(dividend.projection()) {
                    requests.add(target_node, with, Form::Over, dividend);
                }
            }
        });
        requests
    }
}

impl Requests {
    fn add(&mut self, target: u32, with: Edge, form: Form, wanted: Element) {
        let ([key], negative) = canonical([wanted]);
        let number = self.all.len() as u32;
        let next = self.heads.insert(key, number);
        self.all.push(Request {
            target,
            with,
            form,
            negative,
            next,
        });
    }

    /// The last request for a canonical value.
    pub(super) fn head(&self, value: &Element) -> Option<u32> {
        self.heads.get(value).copied()
    }

    /// The target of a request.
    pub(super) fn target(&self, head: u32) -> usize {
        self.all[head as usize].target as usize
    }

    /// All requests for a value, the last one first; those of one target are adjacent.
    pub(super) fn of(&self, head: u32) -> impl Iterator<Item = &Request> {
        let at = |number: u32| &self.all[number as usize];
        std::iter::successors(Some(at(head)), move |request| request.next.map(at))
    }

    /// Whether only the nodes of a definition request its value.
    ///
    /// t = c + m requests m = t - c, and the pair of t and c has that value. Such a pair saves
    /// nothing.
    pub(super) fn are_own(&self, head: u32, definition: Definition) -> bool {
        self.of(head).all(|request| request.is_of(definition))
    }
}

impl Request {
    /// Whether target and existing node are the operands of the definition.
    fn is_of(&self, definition: Definition) -> bool {
        let target = Edge::to(self.target as usize);
        let is_pair = |a: Edge, b: Edge| {
            let pair = [target.node(), self.with.node()];
            pair == [a.node(), b.node()] || pair == [b.node(), a.node()]
        };
        match (self.form, definition) {
            // The request for t - c is that of the difference, the one for t + c that of the sum.
            (Form::Plus, Definition::Sum(a, b)) => {
                is_pair(a, b) && self.with.is_negative() != b.is_negative()
            }
            (Form::Over, Definition::Product(a, b)) => is_pair(a, b),
            _ => false,
        }
    }
}
