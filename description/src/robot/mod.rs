//! The robot of a description: joints, legs, platform, motors, springs and their parameters.

pub(crate) mod actuator_names;
pub(crate) mod cable;
pub(crate) mod frame;
pub(crate) mod friction;
pub(crate) mod geometry;
pub(crate) mod inventory;
pub(crate) mod joint_shape;
pub(crate) mod leg;
pub(crate) mod model;
pub(crate) mod motion;
pub(crate) mod motor;
pub(crate) mod parameters;
pub(crate) mod payload;
pub(crate) mod platform;
pub(crate) mod point_spring;
pub(crate) mod shape;
pub(crate) mod spring;
pub(crate) mod warnings;
