//! Derivatives along displacements of the pose, and with respect to the twist.
//!
//! A displacement δ moves the pose along the twist coordinates. Joints follow by the reduced
//! Jacobians, ∂q_t/∂δ = ∂q̇_t/∂v, so no closed form of a leg's joints is differentiated. The
//! orientation R of a platform follows as ∂R/∂δ_k = [e_k]× R for the base axis e_k.

use crate::cas::jacobian::{Edges, LinearisedGraph, VertexId};
use crate::cas::{Expr, Vector3};
use crate::derivation::robot::Robot;
use crate::mechanism::{Motion, TwistCoordinate};

impl<'a> Robot<'a> {
    /// A graph in which the directions are displacements of the pose.
    pub(crate) fn along_displacements(&self) -> LinearisedGraph<'a> {
        let mut graph = LinearisedGraph::new(self.arena, self.mechanism.dof());
        if let Some(platform) = &self.mechanism.platform {
            self.move_platform(&mut graph, platform.motion.of_pose());
        }
        self.move_joints(&mut graph);
        graph
    }

    /// A graph in which the directions are the elements of a twist, which are inputs.
    pub(crate) fn along_twist(&self, twist: &[Expr<'a>]) -> LinearisedGraph<'a> {
        let mut graph = LinearisedGraph::new(self.arena, twist.len());
        for (k, symbol) in twist.iter().filter_map(|input| input.symbol()).enumerate() {
            graph.set_symbol(symbol, LinearisedGraph::direction(k));
        }
        graph
    }

    /// Moves the pose of a platform along its velocity components.
    fn move_platform(&self, graph: &mut LinearisedGraph<'a>, motion: Motion) {
        let components = match &self.parasitic_motion {
            None => (0..self.free.len())
                .map(|k| Some(LinearisedGraph::direction(k)))
                .collect::<Vec<_>>(),
            Some(parasitic) => {
                let rows = parasitic.platform_jacobian(self.arena).into_iter();
                rows.map(|row| along(graph, &row)).collect()
            }
        };
        let count = motion.pose_coordinates().len();
        let mut turns = Vec::new();
        for (at, (coordinate, component)) in self.free.iter().zip(components).enumerate() {
            match (coordinate, component) {
                (TwistCoordinate::Angular(axis), Some(vertex)) if motion.has_quaternion() => {
                    turns.push((*axis, vertex));
                }
                (TwistCoordinate::Angular(_), Some(vertex)) => {
                    graph.set_symbol(self.arena.input_symbol("pose", count - 1), vertex);
                }
                (TwistCoordinate::Linear(_), Some(vertex)) => {
                    graph.set_symbol(self.arena.input_symbol("pose", at), vertex);
                }
                (_, None) => {}
            }
        }
        if motion.has_quaternion() {
            self.turn_quaternion(graph, &turns, count - 4);
        }
    }

    /// Rotates a platform's quaternion, whose first entry is `pose[first]`, about base axes.
    fn turn_quaternion(
        &self,
        graph: &mut LinearisedGraph<'a>,
        turns: &[(usize, VertexId)],
        first: usize,
    ) {
        let Some(platform) = &self.platform else {
            return;
        };
        let arena = self.arena;
        // q̇ = (0, ω) q / 2.
        let [w, x, y, z] = std::array::from_fn(|k| arena.input("pose", first + k));
        // 2 q̇ of each entry by axis of ω.
        let doubled = [[-x, -y, -z], [w, z, -y], [-z, w, x], [y, -x, w]];
        for (entry, by_axis) in doubled.into_iter().enumerate() {
            let edge =
                |(axis, vertex): &(usize, VertexId)| (*vertex, by_axis[*axis] / arena.integer(2));
            if let Some(vertex) = graph.add(turns.iter().map(edge).collect()) {
                graph.set_symbol(arena.input_symbol("pose", first + entry), vertex);
            }
        }
        for column in 0..3 {
            let own = platform.rotation.column(column);
            let moved: Vec<(VertexId, Vector3<'a>)> = { turns.iter() }
                .map(|(axis, vertex)| (*vertex, Vector3::unit(arena, *axis).cross(own)))
                .collect();
            for row in 0..3 {
                let edges = moved
                    .iter()
                    .map(|(vertex, change)| (*vertex, change.0[row]));
                graph.set(own.0[row], edges.collect());
            }
        }
    }

    /// Moves all joints by the reduced Jacobians.
    fn move_joints(&self, graph: &mut LinearisedGraph<'a>) {
        let mut of_joint = Vec::new();
        for (index, row) in self.joint_rows().iter().enumerate() {
            let vertex = along(graph, row);
            if let Some(vertex) = vertex {
                graph.set_symbol(self.configuration.joint_symbol(index), vertex);
            }
            of_joint.push(vertex);
        }
        for solved in self.configuration.solved() {
            let edge = |(symbol, label)| Some((graph.of_symbol(symbol)?, label));
            let edges: Edges<'a> = solved.by.into_iter().filter_map(edge).collect();
            graph.set(solved.value, edges);
        }
        for (index, vertex) in of_joint.into_iter().enumerate() {
            if let Some(position) = self.joint_position(index) {
                let edge = vertex.map(|vertex| (vertex, self.arena.one()));
                graph.set(position, edge.into_iter().collect());
            }
        }
    }
}

/// The quantity whose derivatives along the directions are a row; `None` if all are zero.
fn along<'a>(graph: &mut LinearisedGraph<'a>, row: &[Expr<'a>]) -> Option<VertexId> {
    let mut present = row.iter().enumerate().filter(|(_, entry)| !entry.is_zero());
    if let (Some((k, entry)), None) = (present.next(), present.next())
        && entry.is_one()
    {
        return Some(LinearisedGraph::direction(k));
    }
    let entries = row.iter().enumerate();
    graph.add(
        entries
            .map(|(k, &entry)| (LinearisedGraph::direction(k), entry))
            .collect(),
    )
}
