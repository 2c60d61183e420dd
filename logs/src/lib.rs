//! Logs of robots: a file of any supported format as blocks of samples in SI units by joint.
//!
//! A [`Log`] has the actuator positions and torques of one run, uniformly sampled, and velocities
//! if measured. A [`Mapping`] assigns the columns of a file to them and converts these to SI units.
//! [`read`] is the first function to call:
//!
//! ```
//! use overact_logs::{Gain, Mapping, Time, read_bytes};
//!
//! let mapping = Mapping {
//!     time: Time::Column("t".into()),
//!     positions: vec!["q".into()],
//!     torques: vec!["tau".into()],
//!     velocities: Vec::new(),
//!     position_scale: vec![1.0],
//!     position_offset: Vec::new(),
//!     torque_gain: vec![Gain::Value(1.0)],
//!     resample: None,
//!     transmission: Vec::new(),
//!     rotating: Vec::new(),
//! };
//! let text = b"t,q,tau\n0.0,0.10,1.0\n0.1,0.11,1.5\n0.2,0.13,2.0\n".as_slice();
//! let log = read_bytes("log.csv", &text.into(), &mapping, false)?;
//! assert_eq!(log.samples(), 3);
//! # Ok::<(), overact_logs::Error>(())
//! ```
//!
//! Text, JSON Lines, MATLAB's `.mat` files, NumPy's files, Parquet, HDF5 and MCAP are recognised by their
//! first bytes. Columns of text are separated by commas, semicolons, tabs or blanks. Decimal commas, a
//! header, names in a comment or no names are supported.
//!
//! Readers report every missing column, every cell that is not a number, and the first non-uniform
//! time step. At most twenty different cell problems of a file are listed. Large files stay on disk
//! and are read block by block. The numbers of a large text are cached in a temporary file.
//!
//! Each folder imports only from those above it in this table, and a test checks the order:
//!
//! | folder | content |
//! |---|---|
//! | `error`, `problems` | problems with location and remedy |
//! | `significant`, `display_names` | numbers and names of drives in sentences |
//! | `samples` | a block of samples |
//! | `bytes` | sources of bytes, limits, temporary storage |
//! | `formats` | readers of file formats |
//! | `mapping` | columns, units, gears and loads of signals |
//! | `unwrapping`, `resampling` | positions of rotating joints; separate or irregular clocks |
//! | `period_sums` | sums of a periodic run by phase |
//! | `run` | one run, read from its files |
//! | [`periods`] | finds the period of a motion, and sums its periods |
//! | [`monitor`] | statistics and plausibility of raw numbers |
//! | `read` | reads runs |

mod bytes;
mod display_names;
mod error;
mod formats;
mod mapping;
pub mod monitor;
mod period_sums;
pub mod periods;
mod problems;
mod read;
mod resampling;
mod run;
mod samples;
mod significant;
mod unwrapping;

pub use display_names::{called, titled, with_joints};
pub use error::{Column, Error, Problem, suggestion};
pub use formats::{arrays::Array, parquet_file::write_parquet};
pub use mapping::{
    Gain, Mapping, Time,
    load::{Load, carried_payloads},
    scales::Scales,
};
pub use period_sums::Periods;
pub use read::{
    NeededSamples, parts, read, read_arrays, read_bytes, read_runs, runs_of_arrays, runs_of_bytes,
    time_range,
};
pub use run::{
    dataset::{Dataset, Variant},
    log::{Log, Reader},
    time_range::TimeRange,
};
pub use samples::Samples;
pub use significant::significant;
