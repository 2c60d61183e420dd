//! Bridges, cut vertices and biconnected blocks of the network's graph.
//!
//! Depth-first search with low points (Hopcroft and Tarjan 1973, "Algorithm 447: efficient
//! algorithms for graph manipulation"), in time linear in the number of edges.

/// Bridges, cut vertices and biconnected blocks of a graph.
#[derive(Debug, Clone)]
pub(crate) struct Blocks {
    /// Whether each edge is the only connection between two parts of the graph.
    pub(crate) is_bridge: Vec<bool>,
    /// Whether each vertex alone connects others to vertex 0.
    pub(crate) is_cut: Vec<bool>,
    /// Blocks that each vertex belongs to, in ascending order.
    blocks: Vec<Vec<usize>>,
}

/// A vertex on the path of the search.
struct Visit {
    vertex: usize,
    /// Edge by which the search entered the vertex.
    entry: Option<usize>,
    /// Number of its edges that were already followed.
    followed: usize,
}

impl Blocks {
    /// Analyses a graph; `edges_at` lists the edges of each vertex, `ends` the vertices of each edge.
    pub(crate) fn new(edges_at: &[Vec<usize>], ends: &[[usize; 2]]) -> Self {
        let count = edges_at.len();
        let mut own = Self {
            is_bridge: vec![false; ends.len()],
            is_cut: vec![false; count],
            blocks: vec![Vec::new(); count],
        };
        let mut search = Search {
            edges_at,
            ends,
            order: vec![None; count],
            low: vec![0; count],
            clock: 0,
            open: Vec::new(),
            blocks: 0,
        };
        for root in 0..count {
            if search.order[root].is_none() {
                search.run(root, &mut own);
            }
        }
        own
    }

    /// Whether two vertices belong to a common block: no other vertex separates them.
    pub(crate) fn are_together(&self, a: usize, b: usize) -> bool {
        let mut own = self.blocks[a].iter();
        own.any(|block| self.blocks[b].contains(block))
    }
}

impl Blocks {
    /// Block of an edge between two vertices; `None` if no block contains both.
    pub(crate) fn of_edge(&self, [a, b]: [usize; 2]) -> Option<usize> {
        let mut own = self.blocks[a].iter();
        own.find(|block| self.blocks[b].contains(block)).copied()
    }
}

struct Search<'s> {
    edges_at: &'s [Vec<usize>],
    ends: &'s [[usize; 2]],
    /// Time of the first visit to each vertex.
    order: Vec<Option<usize>>,
    /// Earliest visit that the vertex or those after it reach by one edge backwards.
    low: Vec<usize>,
    clock: usize,
    /// Visited vertices whose block is not complete.
    open: Vec<usize>,
    /// Number of complete blocks.
    blocks: usize,
}

impl Search<'_> {
    fn enter(&mut self, vertex: usize) {
        self.order[vertex] = Some(self.clock);
        self.low[vertex] = self.clock;
        self.clock += 1;
        self.open.push(vertex);
    }

    fn run(&mut self, root: usize, found: &mut Blocks) {
        self.enter(root);
        let mut path = vec![Visit {
            vertex: root,
            entry: None,
            followed: 0,
        }];
        while let Some(visit) = path.last_mut() {
            let vertex = visit.vertex;
            if let Some(&edge) = self.edges_at[vertex].get(visit.followed) {
                visit.followed += 1;
                if visit.entry == Some(edge) {
                    continue;
                }
                let [a, b] = self.ends[edge];
                let next = if a == vertex { b } else { a };
                match self.order[next] {
                    Some(order) => self.low[vertex] = self.low[vertex].min(order),
                    None => {
                        self.enter(next);
                        path.push(Visit {
                            vertex: next,
                            entry: Some(edge),
                            followed: 0,
                        });
                    }
                }
                continue;
            }
            let entry = visit.entry;
            path.pop();
            let (Some(before), Some(entry)) = (path.last(), entry) else {
                continue;
            };
            let parent = before.vertex;
            self.low[parent] = self.low[parent].min(self.low[vertex]);
            let parent_order = self.order[parent].unwrap_or(0);
            found.is_bridge[entry] = self.low[vertex] > parent_order;
            if self.low[vertex] >= parent_order {
                found.is_cut[parent] |= parent != root;
                self.close(vertex, parent, found);
            }
        }
        self.open.clear();
    }

    /// Completes the block of all open vertices from `first` on, together with `parent`.
    fn close(&mut self, first: usize, parent: usize, found: &mut Blocks) {
        let start = self.open.iter().rposition(|&own| own == first);
        let own = self.open.split_off(start.unwrap_or(self.open.len()));
        for vertex in own.into_iter().chain([parent]) {
            found.blocks[vertex].push(self.blocks);
        }
        self.blocks += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::Blocks;

    fn blocks(count: usize, ends: &[[usize; 2]]) -> Blocks {
        let mut edges_at = vec![Vec::new(); count];
        for (edge, own) in ends.iter().enumerate() {
            own.iter().for_each(|&vertex| edges_at[vertex].push(edge));
        }
        Blocks::new(&edges_at, ends)
    }

    #[test]
    fn blocks_bridges_and_cut_vertices_are_found() {
        // Triangle 0 1 2, double edge 2 3, tail 3 4.
        let found = blocks(5, &[[0, 1], [1, 2], [2, 0], [2, 3], [3, 2], [3, 4]]);
        assert_eq!(found.is_bridge, [false, false, false, false, false, true]);
        assert_eq!(found.is_cut, [false, false, true, true, false]);
        let together = |a, b| found.are_together(a, b);
        assert!(together(0, 1) && together(1, 2) && together(2, 3) && together(3, 4));
        assert!(!together(0, 3) && !together(2, 4) && !together(0, 4));
    }

    #[test]
    fn block_search_does_not_overflow_the_stack() {
        let ends: Vec<[usize; 2]> = (0..100_000).map(|at| [at, at + 1]).collect();
        let found = blocks(100_001, &ends);
        assert!(found.is_bridge.iter().all(|is_bridge| *is_bridge));
    }
}
