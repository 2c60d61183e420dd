//! Which nodes only one node needs.
//!
//! A node *dominates* another if every way from an entry to it leads through the first: without the
//! first, nothing would need it. The nodes form a tree in which each stands below those that dominate it,
//! so the operations that go with a node, its maximal fan-out free cone, are those of its branch.

use super::Dag;

/// A node that several need, or an entry.
const ROOT: u32 = u32::MAX;

/// The tree of a graph's live nodes.
pub(crate) struct Dominators {
    /// Operations of each node's branch.
    cones: Vec<i32>,
    /// The node's place in an order in which every branch is one range.
    first: Vec<u32>,
    /// The end of its branch.
    end: Vec<u32>,
}

impl Dominators {
    pub(crate) fn new(dag: &Dag) -> Self {
        let count = dag.len();
        let mut order: Vec<usize> = (0..count).filter(|&n| dag.is_live(n)).collect();
        // What is computed from a node is deeper than the node, and so comes first.
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

    /// Gives each branch a range: a node's comes at the front of what its parent's has left.
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

    /// How many operations would go, its own included, if the node were there for nothing.
    pub(crate) fn cone(&self, node: usize) -> i32 {
        self.cones[node]
    }

    /// Operations of `of`'s cone that stay if `kept` is needed by others, too: those of its own cone. What
    /// it has in common with other nodes of `of`'s cone would stay as well.
    pub(crate) fn shared(&self, of: usize, kept: usize) -> i32 {
        let is_below = (self.first[of]..self.end[of]).contains(&self.first[kept]);
        if is_below { self.cones[kept] } else { 0 }
    }
}

/// Each node's parent in the tree: the nearest node that all its users have in common. `order` has users
/// first.
fn parents(dag: &Dag, order: &[usize]) -> Vec<u32> {
    let mut parents = vec![ROOT; dag.len()];
    let mut levels = vec![0_u32; dag.len()];
    let mut seen = vec![0_u32; dag.len()];
    for &user in order {
        // The node's own users have all come before: its parent is known by now, unless an entry needs it.
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

/// The nearest node above two nodes, or one of them.
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
