//! The RX90 with the parameters of its virtual experiment as constants.

mod module {
    include!(concat!(env!("OUT_DIR"), "/known_rx90.rs"));
}
pub use module::Rx90;

include!(concat!(env!("OUT_DIR"), "/known_parameters.rs"));
