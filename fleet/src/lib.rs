//! Parameters of many robots by SQL over their factor files and logs.
//!
//! Factors of the R factorisation merge: qr([R_1; R_2]) is the factor of the equations of both. So the identification
//! of a fleet is an aggregate of a database, on one machine or on many:
//!
//! ```sql
//! SELECT serial, date_trunc('week', time) AS week, estimate(factor) AS e FROM factors GROUP BY serial, week
//! ```
//!
//! | function | what |
//! |---|---|
//! | `estimate(factor [, groups])` | aggregate: the parameters with their deviations, and what was left out |
//! | `merge_r(factor [, groups])` | aggregate: a factor that `merge_r` and `estimate` take on |
//! | `factor(robot, columns)` | aggregate over the rows of a log: its factor |
//! | `parameter(e, name)` | of an estimate one parameter |
//! | `f_test(e, e, names)` | whether parameters of two estimates differ |
//!
//! - [`functions`]: these; [`robots`]: the descriptions that `factor` knows by name.
//! - [`catalog`]: which files can be read, and what is there twice.
//! - [`store`]: where files are, in folders and buckets.
//! - `days`: logs of a bucket around those that can't be read.
//! - [`session`]: a query on one machine or on many; `distributed`: scheduler and executors,
//!   [`logging`]: what they tell.
//! - [`chart`]: control charts with a stated rate of false alarms; [`report`]: the page of a fleet;
//!   [`power`]: which drifts are found when.

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
