//! Robots of `robots/` with frames: functions of the frames and of all masses, in 64 and 32 bits.

/// A robot with frames: the text of its frames, and its modules in 64 and 32 bits.
macro_rules! framed {
    ($stem:ident: $robot:ident) => {
        #[doc = concat!("`", stringify!($robot), "` with frames.")]
        pub mod $stem {
            mod double {
                include!(concat!(
                    env!("OUT_DIR"),
                    "/framed_",
                    stringify!($stem),
                    ".rs"
                ));
            }
            mod single {
                include!(concat!(
                    env!("OUT_DIR"),
                    "/framed_",
                    stringify!($stem),
                    "_f32.rs"
                ));
            }
            pub use double::$robot;
            pub use single::$robot as Single;

            /// The tables of the frames.
            pub const FRAMES: &str =
                include_str!(concat!("../framed/", stringify!($stem), ".toml"));
        }
    };
}

framed!(ankle: Ankle);
framed!(delta: Delta);
framed!(dualv: DualV);
framed!(hexapod: Hexapod);
framed!(rx90: Rx90);
