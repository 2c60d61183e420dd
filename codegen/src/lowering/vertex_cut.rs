//! Smallest vertex cut of a directed acyclic graph, by Dinic's maximum flow (Dinic 1970) on split
//! vertices.

use std::collections::VecDeque;

/// An arc of the residual graph; the index of the opposite arc differs in the last bit.
struct Arc {
    to: usize,
    capacity: u32,
}

/// A graph whose smallest vertex set that separates sources from sinks is computed.
pub(super) struct VertexCut {
    arcs: Vec<Arc>,
    /// The arcs of each half of a vertex: 2 v is the entrance, 2 v + 1 the exit.
    from: Vec<Vec<usize>>,
    vertices: usize,
}

const UNBOUNDED: u32 = u32::MAX;

impl VertexCut {
    /// A graph without edges.
    pub(super) fn new(vertices: usize) -> Self {
        let mut cut = Self {
            arcs: Vec::new(),
            from: vec![Vec::new(); 2 * vertices + 2],
            vertices,
        };
        for vertex in 0..vertices {
            cut.arc(2 * vertex, 2 * vertex + 1, 1);
        }
        cut
    }

    /// Adds an edge.
    pub(super) fn edge(&mut self, from: usize, to: usize) {
        self.arc(2 * from + 1, 2 * to, UNBOUNDED);
    }

    /// Makes a vertex a source.
    pub(super) fn source(&mut self, vertex: usize) {
        self.arc(self.begin(), 2 * vertex, UNBOUNDED);
    }

    /// Makes a vertex a sink.
    pub(super) fn sink(&mut self, vertex: usize) {
        self.arc(2 * vertex + 1, self.end(), UNBOUNDED);
    }

    /// The smallest set of vertices on every path from a source to a sink, in ascending order.
    ///
    /// Of several sets it is the one closest to the sinks.
    pub(super) fn smallest(mut self) -> Vec<usize> {
        while let Some(levels) = self.levels() {
            self.block(&levels);
        }
        let reaches_end = self.reaching_end();
        let is_cut = |v: &usize| reaches_end[2 * v + 1] && !reaches_end[2 * v];
        (0..self.vertices).filter(is_cut).collect()
    }

    const fn begin(&self) -> usize {
        2 * self.vertices
    }

    const fn end(&self) -> usize {
        2 * self.vertices + 1
    }

    fn arc(&mut self, from: usize, to: usize, capacity: u32) {
        for (from, to, capacity) in [(from, to, capacity), (to, from, 0)] {
            self.from[from].push(self.arcs.len());
            self.arcs.push(Arc { to, capacity });
        }
    }

    /// Distance of each half from the source, in arcs; `None` if no path to the sink is left.
    fn levels(&self) -> Option<Vec<Option<usize>>> {
        let mut levels = vec![None; self.from.len()];
        levels[self.begin()] = Some(0);
        let mut queue = VecDeque::from([self.begin()]);
        while let Some(at) = queue.pop_front() {
            for &arc in &self.from[at] {
                let Arc { to, capacity } = self.arcs[arc];
                if capacity > 0 && levels[to].is_none() {
                    levels[to] = levels[at].map(|level: usize| level + 1);
                    queue.push_back(to);
                }
            }
        }
        levels[self.end()].is_some().then_some(levels)
    }

    /// Finds a blocking flow: augments unit paths along the levels until none is left.
    fn block(&mut self, levels: &[Option<usize>]) {
        let mut next = vec![0; self.from.len()];
        let mut path: Vec<usize> = Vec::new();
        loop {
            let at = path.last().map_or(self.begin(), |&arc| self.arcs[arc].to);
            if at == self.end() {
                self.send(&path);
                path.clear();
                continue;
            }
            let is_up = |arc: &usize| {
                let Arc { to, capacity } = self.arcs[*arc];
                capacity > 0 && levels[to] == levels[at].map(|level| level + 1)
            };
            let found = self.from[at][next[at]..].iter().position(is_up);
            if let Some(skipped) = found {
                next[at] += skipped;
                path.push(self.from[at][next[at]]);
            } else {
                // A dead end: its arcs are not tried again.
                next[at] = self.from[at].len();
                let Some(arc) = path.pop() else {
                    return;
                };
                let before = self.arcs[arc ^ 1].to;
                next[before] += 1;
            }
        }
    }

    fn send(&mut self, path: &[usize]) {
        for &arc in path {
            if self.arcs[arc].capacity != UNBOUNDED {
                self.arcs[arc].capacity -= 1;
            }
            if self.arcs[arc ^ 1].capacity != UNBOUNDED {
                self.arcs[arc ^ 1].capacity += 1;
            }
        }
    }

    /// The halves from which flow can still reach the sink.
    fn reaching_end(&self) -> Vec<bool> {
        let mut reaches = vec![false; self.from.len()];
        reaches[self.end()] = true;
        let mut stack = vec![self.end()];
        while let Some(at) = stack.pop() {
            for &arc in &self.from[at] {
                // The arc that comes from there.
                let (there, towards) = (self.arcs[arc].to, &self.arcs[arc ^ 1]);
                if towards.capacity > 0 && !reaches[there] {
                    reaches[there] = true;
                    stack.push(there);
                }
            }
        }
        reaches
    }
}

#[cfg(test)]
mod tests {
    use super::VertexCut;

    #[test]
    fn the_smallest_vertex_cut_is_found() {
        // Three sources meet in two vertices, which four sinks follow.
        let mut cut = VertexCut::new(9);
        (0..3).for_each(|v| cut.source(v));
        (5..9).for_each(|v| cut.sink(v));
        for (from, to) in [
            (0, 3),
            (1, 3),
            (1, 4),
            (2, 4),
            (3, 5),
            (3, 6),
            (4, 7),
            (4, 8),
            (3, 8),
        ] {
            cut.edge(from, to);
        }
        assert_eq!(cut.smallest(), [3, 4]);
    }

    #[test]
    fn the_minimum_cut_nearest_to_the_sinks_is_chosen() {
        let mut cut = VertexCut::new(3);
        cut.source(0);
        cut.sink(2);
        cut.edge(0, 1);
        cut.edge(1, 2);
        assert_eq!(cut.smallest(), [2]);
        let mut alone = VertexCut::new(1);
        alone.source(0);
        alone.sink(0);
        assert_eq!(alone.smallest(), [0]);
        assert_eq!(VertexCut::new(2).smallest(), []);
    }

    #[test]
    fn augmenting_paths_may_reverse_flow() {
        let mut cut = VertexCut::new(6);
        cut.source(0);
        cut.source(1);
        cut.sink(4);
        cut.sink(5);
        for (from, to) in [(0, 2), (0, 3), (1, 2), (2, 4), (3, 5), (3, 4)] {
            cut.edge(from, to);
        }
        assert_eq!(cut.smallest().len(), 2);
    }
}
