//! Forward kinematics, in closed form and by iteration, and forward dynamics.

pub(crate) mod closed_form;
pub(crate) mod forward_dynamics;
pub(crate) mod pose_step;
#[cfg(test)]
mod tests;
