//! Dynamics with given parameters: joint forces, mass matrices, and the Newton-Euler recursion.

pub(crate) mod actuated_joint_forces;
pub(crate) mod centre_of_mass;
pub(crate) mod composite;
pub(crate) mod energy;
mod formula;
pub(crate) mod friction;
pub(crate) mod masses;
pub(crate) mod motor;
pub(crate) mod newton_euler;
mod point_spring;
mod spring;
pub(crate) mod tree_masses;
