//! Derivatives of the dynamics of robots of `robots/`, in 64 and 32 bits.

/// The modules of a robot in 64 and 32 bits.
macro_rules! derived {
    ($stem:ident: $robot:ident) => {
        #[doc = concat!("Derivatives of `", stringify!($robot), "`.")]
        pub mod $stem {
            mod double {
                include!(concat!(
                    env!("OUT_DIR"),
                    "/derived_",
                    stringify!($stem),
                    ".rs"
                ));
            }
            mod single {
                include!(concat!(
                    env!("OUT_DIR"),
                    "/derived_",
                    stringify!($stem),
                    "_f32.rs"
                ));
            }
            pub use double::$robot;
            pub use single::$robot as Single;
        }
    };
}

derived!(ankle: Ankle);
derived!(dualv: DualV);
derived!(rx90: Rx90);
