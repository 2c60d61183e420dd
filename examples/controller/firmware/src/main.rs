//! The DualV's controller at 5 kHz on a Cortex-M7.
//!
//! The system timer ticks 5000 times per second. Each tick reads the encoders, computes the torques
//! and sends them to the drives. Encoders and drives are four numbers each, in place of a board's
//! timers and converters. Nothing else depends on the board except its clock and `memory.x`.
//!
//! This program cannot panic: `panic-never` makes the linker fail if a panic is reachable.
#![no_std]
#![no_main]

use core::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use cortex_m::{Peripherals, asm, peripheral::syst::SystClkSource};
use cortex_m_rt::{entry, exception};
use overact::math::sin_cos;
use overact_controller::{ACTUATORS, Controller, Load, Motion, SAMPLING_HZ};
use panic_never as _;

/// Core frequency, Hz.
const CORE_HZ: u32 = 400_000_000;
/// Encoder resolution, rad, as in the description.
const COUNT: f64 = 1e-5;
/// Resolution of a drive's torque command, N m.
const STEP: f64 = 1e-3;
/// Frequency of the desired motion, Hz.
const MOTION_HZ: f64 = 1.0;
/// Its amplitudes: m, m, rad.
const AMPLITUDES: [f64; 3] = [0.03, 0.06, 0.1];

/// Positions of the motors, counts.
static ENCODERS: [AtomicI32; ACTUATORS] = [const { AtomicI32::new(0) }; ACTUATORS];
/// Torques for the drives, steps.
static TORQUES: [AtomicI32; ACTUATORS] = [const { AtomicI32::new(0) }; ACTUATORS];
/// Whether a sample is due.
static DUE: AtomicBool = AtomicBool::new(false);
/// Whether the motors are held because the controller returned an error.
static HELD: AtomicBool = AtomicBool::new(false);

#[exception]
fn SysTick() {
    DUE.store(true, Ordering::Release);
}

#[entry]
fn main() -> ! {
    if let Some(peripherals) = Peripherals::take() {
        let mut timer = peripherals.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(CORE_HZ / SAMPLING_HZ as u32 - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();
    }
    let mut controller = Controller::new(Load::Loaded);
    let mut sample = 0;
    loop {
        while !DUE.swap(false, Ordering::Acquire) {
            asm::wfi();
        }
        let motion = desired(sample);
        sample = (sample + 1) % PERIOD;
        period(&mut controller, &motion);
    }
}

/// Samples in a period of the desired motion.
const PERIOD: u32 = (SAMPLING_HZ / MOTION_HZ) as u32;

/// One period of the controller: encoders in, torques out. After an error the torques are zero.
fn period(controller: &mut Controller, motion: &Motion) {
    let mut measured = [0.0; ACTUATORS];
    for (angle, count) in measured.iter_mut().zip(&ENCODERS) {
        *angle = f64::from(count.load(Ordering::Relaxed)) * COUNT;
    }
    let found = controller.step(motion, &measured);
    HELD.store(found.is_err(), Ordering::Relaxed);
    let torques = found.unwrap_or([0.0; ACTUATORS]);
    for (torque, command) in torques.iter().zip(&TORQUES) {
        command.store((torque / STEP) as i32, Ordering::Relaxed);
    }
}

/// A motion about home in which each coordinate oscillates.
fn desired(sample: u32) -> Motion {
    let rate = core::f64::consts::TAU * MOTION_HZ;
    let (sine, cosine) = sin_cos(rate * f64::from(sample) / SAMPLING_HZ);
    Motion {
        pose: AMPLITUDES.map(|amplitude| amplitude * sine),
        twist: AMPLITUDES.map(|amplitude| amplitude * rate * cosine),
        acceleration: AMPLITUDES.map(|amplitude| -amplitude * rate * rate * sine),
    }
}
