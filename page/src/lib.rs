//! overact in a browser: what the page's script calls, in a worker beside the page.
//!
//! Texts go in, texts and documents (JSON) come out; nothing here touches the page, a network or a disk. What is
//! wrong is thrown as a document, too: a list of problems, each with its line.
//!
//! - `description`: a description while it is written: its errors, its drawing;
//! - `model`: a description that is compiled: parameters, operations, Rust and C;
//! - `session`: a robot that runs: virtual runs, logs, identification;
//! - `values`: its functions at samples;
//! - `progress`: how far long work is, and defects of overact itself, told to the script.

mod description;
mod model;
mod problems;
mod progress;
mod session;
mod values;

pub use description::Description;
pub use model::Model;
pub use progress::listen;
pub use session::{Identified, Session};
