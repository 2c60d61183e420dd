//! Parts of a description other than the robot: experiments, logs, priors and settings.

pub(crate) mod controller;
pub(crate) mod data;
pub(crate) mod drives;
pub(crate) mod excitation;
pub(crate) mod experiment;
pub(crate) mod gears;
pub(crate) mod gravity;
pub(crate) mod held;
pub(crate) mod known;
pub(crate) mod payloads;
pub(crate) mod per_actuator;
pub(crate) mod prior;
pub(crate) mod settings;
pub(crate) mod signals;
pub(crate) mod stribeck;
pub(crate) mod transmission;
