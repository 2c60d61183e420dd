//! Operations saved by a replacement.

use super::{Dag, Definition};
use crate::cas::hasher::QuickSet;

impl Dag {
    /// Removes one use of a node, and nodes that become unused with it; returns their operations.
    pub(super) fn release(&mut self, node: usize) -> i32 {
        self.uses[node] -= 1;
        if self.uses[node] > 0 {
            return 0;
        }
        self.cost(node) + self.release_operands(self.definitions[node])
    }

    fn release_operands(&mut self, definition: Definition) -> i32 {
        definition.operands().map(|o| self.release(o)).sum()
    }

    /// Adds one use of a node, and restores nodes that it needs again; returns their operations.
    pub(crate) fn hold(&mut self, node: usize) -> i32 {
        self.uses[node] += 1;
        if self.uses[node] > 1 {
            return 0;
        }
        self.cost(node) + self.hold_operands(self.definitions[node])
    }

    fn hold_operands(&mut self, definition: Definition) -> i32 {
        definition.operands().map(|o| self.hold(o)).sum()
    }

    /// Operations, its own included, that would become unused if the node were free.
    pub(crate) fn cone(&mut self, node: usize) -> i32 {
        let definition = self.definitions[node];
        let released = self.release_operands(definition);
        self.hold_operands(definition);
        released + self.cost(node)
    }

    /// Operations that a node's replacement would save; new nodes count if they are not used yet.
    pub(crate) fn saving(&mut self, node: usize, by: Definition) -> i32 {
        let definition = self.definitions[node];
        let before = self.cost(node) + self.release_operands(definition);
        let after = self.cost_of(by) + self.hold_operands(by);
        self.release_operands(by);
        self.hold_operands(definition);
        before - after
    }

    /// Replaces a node's definition.
    pub(crate) fn replace(&mut self, node: usize, by: Definition) {
        self.redefine(node, by);
        if self.depth_of(by) != self.depths[node] {
            self.measure_depths();
        }
    }

    /// Replaces a node's definition; the caller updates depths.
    pub(crate) fn redefine(&mut self, node: usize, by: Definition) {
        let definition = self.definitions[node];
        let is_live = self.is_live(node);
        if is_live {
            self.release_operands(definition);
        }
        self.definitions[node] = by;
        if is_live {
            self.hold_operands(by);
        }
    }

    /// Length of the longest path from an input to a definition.
    pub(super) fn depth_of(&self, definition: Definition) -> u32 {
        let deepest = definition.operands().map(|o| self.depths[o] + 1).max();
        deepest.unwrap_or(0)
    }

    /// Whether one of some nodes depends on another, or equals it.
    ///
    /// Nodes that are not deeper do not depend on it.
    pub(crate) fn depend(&self, nodes: impl Iterator<Item = usize>, on: usize) -> bool {
        let depth = self.depths[on];
        let mut seen = QuickSet::default();
        let mut stack: Vec<usize> = nodes.collect();
        while let Some(node) = stack.pop() {
            if node == on {
                return true;
            }
            if self.depths[node] > depth && seen.insert(node) {
                stack.extend(self.definitions[node].operands());
            }
        }
        false
    }

    /// Recomputes the depths after a replacement: zero for leaves, others greater than those of
    /// their operands.
    pub(crate) fn measure_depths(&mut self) {
        let mut done = vec![false; self.len()];
        let mut stack = Vec::new();
        for start in 0..self.len() {
            stack.push(start);
            while let Some(&top) = stack.last() {
                let open = self.definitions[top].operands().find(|&o| !done[o]);
                if let Some(open) = open.filter(|_| !done[top]) {
                    stack.push(open);
                    continue;
                }
                if !std::mem::replace(&mut done[top], true) {
                    self.depths[top] = self.depth_of(self.definitions[top]);
                }
                stack.pop();
            }
        }
    }

    /// Whether a definition equals the node, also at the second point and at the sample.
    pub(crate) fn means(&self, definition: Definition, node: usize) -> bool {
        self.fingerprint_of(definition)
            .agrees(&self.fingerprints[node])
    }
}
