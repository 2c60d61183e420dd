//! Derives a skeleton and chains from bodies and closures.

pub(crate) mod blocks;
pub(crate) mod free_bodies;
pub(crate) mod home;
pub(crate) mod idle;
pub(crate) mod layout;
pub(crate) mod misfit;
pub(crate) mod motion;
pub(crate) mod network;
mod parallel;
pub(crate) mod platform;
mod platform_search;
pub(crate) mod simple;
pub(crate) mod solvable_chains;
