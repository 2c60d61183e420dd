//! Constants for the computation of sines and cosines of many angles at once.
//!
//! An angle x is reduced to r in [-π/4, π/4] by a multiple n of π/2, subtracted in three parts
//! (Cody and Waite). The first two parts have 33 bits, so that their products with n are exact.
//! Sine and cosine of r are the minimax polynomials of fdlibm. The two lowest bits of n exchange
//! them and set their signs.
//!
//! The compiled backend uses vector types and the interpreter loops over blocks; both use these
//! constants.

/// Largest angle (rad) for this reduction; larger ones use the library's functions.
pub const LARGEST: f64 = 1e5;

/// Adding and subtracting 1.5 × 2⁵² rounds to an integer, which is then in the lowest bits.
pub const ROUND: f64 = 6_755_399_441_055_744.0;

/// π/2 in three parts: 33 bits, 33 bits, the rest.
pub const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E03_7073),
];

/// (sin x - x) / x³ in powers of x², the highest first.
pub const SINE: [f64; 6] = [
    1.589_690_995_211_55e-10,
    -2.505_076_025_340_686_3e-8,
    2.755_731_370_707_006_8e-6,
    -1.984_126_982_985_795e-4,
    8.333_333_333_322_49e-3,
    -1.666_666_666_666_663_2e-1,
];

/// (cos x - 1 + x²/2) / x⁴ in powers of x², the highest first.
pub const COSINE: [f64; 6] = [
    -1.135_964_755_778_819_5e-11,
    2.087_572_321_298_175e-9,
    -2.755_731_435_139_066_3e-7,
    2.480_158_728_947_673e-5,
    -1.388_888_888_887_411e-3,
    4.166_666_666_666_66e-2,
];

/// Constants for single precision: π/2 in four parts, the first three with 11 bits, and polynomials
/// of three terms.
///
/// The polynomials minimise the largest relative error up to π/4 (0.06 units in the last place).
pub mod single {
    /// Largest angle (rad) for this reduction; larger ones use the library's functions.
    pub const LARGEST: f32 = 8192.0;

    /// Adding and subtracting 1.5 × 2²³ rounds to an integer, which is then in the lowest bits.
    pub const ROUND: f32 = 12_582_912.0;

    /// π/2 in four parts: three of 11 bits, whose products with a multiple below 2¹³ are exact, and the rest.
    pub const HALF_PI: [f32; 4] = [
        f32::from_bits(0x3FC9_0000),
        f32::from_bits(0x39FD_A000),
        f32::from_bits(0x33A2_2000),
        f32::from_bits(0x2C34_611A),
    ];

    /// (sin x - x) / x³ in powers of x², the highest first.
    pub const SINE: [f32; 3] = [-1.951_528_1e-4, 8.332_16e-3, -1.666_665_5e-1];

    /// (cos x - 1 + x²/2) / x⁴ in powers of x², the highest first.
    pub const COSINE: [f32; 3] = [2.443_315_5e-5, -1.388_731_6e-3, 4.166_664_6e-2];
}
