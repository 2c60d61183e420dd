//! Kinematics of legs and platform: configuration, rotations and frames, rates, pose, inverse
//! kinematics.

pub(crate) mod centres;
pub(crate) mod configuration;
pub(crate) mod frames;
pub(crate) mod inverse_kinematics;
pub(crate) mod joint;
pub(crate) mod orientation;
pub(crate) mod path;
pub(crate) mod platform;
pub(crate) mod quaternion;
pub(crate) mod rates;
pub(crate) mod spatial;
pub(crate) mod turn;
