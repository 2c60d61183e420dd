//! Checks of parameters: signs, consistency, payload labels and missing effects.

pub(crate) mod consistency;
pub(crate) mod known_values;
pub(crate) mod missing_parameters;
pub(crate) mod negative_parameters;
pub(crate) mod payload_labels;
