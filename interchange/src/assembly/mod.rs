//! Derives a skeleton and chains from bodies and closures.

pub(crate) mod blocks;
pub(crate) mod coordinates;
pub(crate) mod fitting;
pub(crate) mod free_bodies;
pub(crate) mod home;
pub(crate) mod idle;
mod infinitesimal;
pub(crate) mod layout;
pub(crate) mod misfit;
pub(crate) mod motion;
mod nearest;
pub(crate) mod network;
mod parallel;
pub(crate) mod parasitic;
pub(crate) mod platform;
mod platform_search;
pub(crate) mod simple;
pub(crate) mod solvable_chains;
pub(crate) mod undriven;
mod unsolved;
