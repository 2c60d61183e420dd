//! Parameters of many robots by SQL over their factor files and logs.
//!
//! R factors can be merged: qr([R_1; R_2]) is the factor of the equations of both. The
//! identification of a fleet is therefore a database aggregate, on one machine or on many:
//!
//! ```sql
//! SELECT serial, date_trunc('week', time) AS week, estimate(factor) AS e FROM factors GROUP BY serial, week
//! ```
//!
//! | function | result |
//! |---|---|
//! | `estimate(factor [, groups])` | aggregate: parameters with standard deviations, and counts of ignored runs |
//! | `merge_r(factor [, groups])` | aggregate: a merged factor for `merge_r` and `estimate` |
//! | `factor(robot, columns)` | aggregate over the rows of a log: its factor |
//! | `parameter(e, name)` | one parameter of an estimate |
//! | `f_test(e, e, names)` | test whether parameters of two estimates differ |
//!
//! - [`functions`]: these functions; [`robots`]: descriptions that `factor` knows by name.
//! - [`catalog`]: readable files, and duplicates.
//! - [`store`]: files in folders and buckets.
//! - `days`: logs of a bucket without unreadable days.
//! - [`session`]: queries on one machine or on many; `distributed`: scheduler and executors,
//!   [`logging`]: their log messages.
//! - [`chart`]: control charts with a stated false alarm rate; [`report`]: the page of a fleet;
//!   [`power`]: detection rates of drifts.

pub mod catalog;
pub mod chart;
mod days;
#[cfg(feature = "distributed")]
pub mod distributed;
pub mod functions;
pub mod logging;
#[cfg(feature = "distributed")]
mod lost;
pub mod power;
pub mod report;
pub mod robots;
pub mod session;
pub mod store;
