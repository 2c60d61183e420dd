//! Dominator tree of the live nodes.
//!
//! A node *dominates* another if every path from an entry to the other leads through it: without
//! it, the other would be unused. The nodes form a tree in which each node is a descendant of those
//! that dominate it. So the operations that are removed with a node, its maximal fan-out free cone,
//! are those of its branch.

use super::Dag;

/// Parent of a node that several nodes need, or of an entry.
const ROOT: u32 = u32::MAX;

/// The dominator tree of a graph's live nodes.
pub(crate) struct Dominators {
    /// Operations of each node's branch.
    cones: Vec<i32>,
    /// Position of each node in an order in which every branch is one range.
    first: Vec<u32>,
    /// End of each node's branch.
    end: Vec<u32>,
}

impl Dominators {
    pub(crate) fn new(dag: &Dag) -> Self {
        let count = dag.len();
        let mut order: Vec<usize> = (0..count).filter(|&n| dag.is_live(n)).collect();
        // A node's users are deeper than the node, and so come first.
        order.sort_by_key(|&node| std::cmp::Reverse(dag.depths[node]));
        let parents = parents(dag, &order);
        let mut cones = vec![0; count];
        let mut sizes = vec![0_u32; count];
        for &node in order.iter().rev() {
            cones[node] += dag.cost(node);
            sizes[node] += 1;
            if parents[node] != ROOT {
                let (cone, size) = (cones[node], sizes[node]);
                cones[parents[node] as usize] += cone;
                sizes[parents[node] as usize] += size;
            }
        }
        let mut tree = Self {
            cones,
            first: vec![0; count],
            end: vec![0; count],
        };
        tree.arrange(&order, &parents, &sizes);
        tree
    }

    /// Assigns a range to each branch: a node's is at the front of what remains of its parent's.
    fn arrange(&mut self, order: &[usize], parents: &[u32], sizes: &[u32]) {
        let mut free = vec![0; sizes.len()];
        let mut outside = 0;
        for &node in order {
            let next = match parents[node] {
                ROOT => &mut outside,
                parent => &mut free[parent as usize],
            };
            let first = *next;
            *next += sizes[node];
            free[node] = first + 1;
            self.first[node] = first;
            self.end[node] = first + sizes[node];
        }
    }

    /// Operations, its own included, that would become unused if the node were free.
    pub(crate) fn cone(&self, node: usize) -> i32 {
        self.cones[node]
    }

    /// Operations of `of`'s cone that stay if other nodes need `kept`: those of the cone of `kept`.
    ///
    /// Nodes that `kept` shares with others in `of`'s cone would stay as well, but are not counted.
    pub(crate) fn shared(&self, of: usize, kept: usize) -> i32 {
        let is_below = (self.first[of]..self.end[of]).contains(&self.first[kept]);
        if is_below { self.cones[kept] } else { 0 }
    }
}

/// Parent of each node in the tree: the nearest common dominator of its users.
///
/// `order` lists users first.
fn parents(dag: &Dag, order: &[usize]) -> Vec<u32> {
    let mut parents = vec![ROOT; dag.len()];
    let mut levels = vec![0_u32; dag.len()];
    let mut seen = vec![0_u32; dag.len()];
    for &user in order {
        // All users of the node precede it, so its parent is known here, unless an entry needs it.
        if seen[user] < dag.uses[user] {
            parents[user] = ROOT;
        }
        levels[user] = match parents[user] {
            ROOT => 1,
            parent => levels[parent as usize] + 1,
        };
        for operand in dag.definitions[user].operands() {
            parents[operand] = match seen[operand] {
                0 => user as u32,
                _ => common(&parents, &levels, parents[operand], user as u32),
            };
            seen[operand] += 1;
        }
    }
    parents
}

/// The nearest common ancestor of two nodes, or one of them.
fn common(parents: &[u32], levels: &[u32], mut a: u32, mut b: u32) -> u32 {
    let level = |node: u32| match node {
        ROOT => 0,
        node => levels[node as usize],
    };
    while a != b {
        if level(a) >= level(b) {
            a = parents[a as usize];
        } else {
            b = parents[b as usize];
        }
    }
    a
}
