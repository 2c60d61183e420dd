//! Invariants of a DAG between two passes.

use super::{Constant, Dag, Definition, Edge};

impl Dag {
    /// Checks the invariants that every pass keeps.
    ///
    /// # Errors
    /// Describes the first violated invariant.
    pub(crate) fn verify(&self) -> Result<(), String> {
        self.verify_edges()?;
        self.verify_order()?;
        self.verify_uses()?;
        self.verify_groups()?;
        self.verify_values()
    }

    /// Every edge leads to an existing node.
    fn verify_edges(&self) -> Result<(), String> {
        let guards = self.guards.iter().map(|guard| guard.value);
        let definitions = self.definitions.iter().flat_map(|d| d.edges());
        let mut edges = self
            .entries
            .iter()
            .copied()
            .chain(guards)
            .chain(definitions);
        match edges.find(|edge| edge.node() >= self.len()) {
            Some(edge) => Err(format!(
                "an edge leads to node {}, which is none",
                edge.node()
            )),
            None => Ok(()),
        }
    }

    /// No node depends on itself: each is deeper than its operands.
    fn verify_order(&self) -> Result<(), String> {
        for node in (0..self.len()).filter(|&node| self.is_live(node)) {
            let mut operands = self.definitions[node].operands();
            if let Some(operand) = operands.find(|&o| self.depths[o] >= self.depths[node]) {
                return Err(format!(
                    "node {node} uses node {operand}, which is not known to come before it"
                ));
            }
        }
        Ok(())
    }

    /// Use counts equal the uses by entries, guards and used nodes.
    fn verify_uses(&self) -> Result<(), String> {
        let guards = self.guards.iter().map(|guard| guard.value);
        let held: Vec<Edge> = self.entries.iter().copied().chain(guards).collect();
        let needed = self.needed(held.iter().map(|edge| edge.node()));
        let mut uses = vec![0_u32; self.len()];
        held.iter().for_each(|edge| uses[edge.node()] += 1);
        for node in (0..self.len()).filter(|&node| needed[node]) {
            self.definitions[node].operands().for_each(|o| uses[o] += 1);
        }
        match (0..self.len()).find(|&node| uses[node] != self.uses[node]) {
            Some(node) => Err(format!(
                "node {node} is used {} times and counted as used {} times",
                uses[node], self.uses[node]
            )),
            None => Ok(()),
        }
    }

    /// Each node belongs to one group at most.
    fn verify_groups(&self) -> Result<(), String> {
        let mut seen = vec![false; self.len()];
        let mut nodes = self.together.iter().flatten();
        match nodes.find(|&&node| std::mem::replace(&mut seen[node], true)) {
            Some(node) => Err(format!("node {node} is computed with two groups")),
            None => Ok(()),
        }
    }

    /// Every definition is a number and has the value of its node.
    fn verify_values(&self) -> Result<(), String> {
        for node in (0..self.len()).filter(|&node| self.is_live(node)) {
            let definition = self.definitions[node];
            if let Definition::Constant(constant) = definition
                && !Constant::value(constant).is_finite()
            {
                return Err(format!("the constant of node {node} is no number"));
            }
            let is = self.fingerprint_of(definition);
            if !definition.is_leaf() && !is.resembles(&self.fingerprints[node]) {
                return Err(format!("node {node}, {definition:?}, has lost its value"));
            }
        }
        Ok(())
    }
}
