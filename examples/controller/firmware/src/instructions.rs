//! Work of one sample in functions of their own, so that an emulator can count their instructions.
//!
//! `instructions.py` runs this program and prints the counts. Like the firmware it cannot panic:
//! `panic-never` makes the linker fail if a panic is reachable, here in the estimators, too.
#![no_std]
#![no_main]

use core::hint::black_box;
use cortex_m::asm;
use cortex_m_rt::entry;
use overact::StandardParameter;
use overact::math::sin_cos;
use overact::online::{Filter, Forgetting, PayloadEstimator, PayloadSize};
use overact_controller::payload::PayloadObserver;
use overact_controller::{ACTUATORS, Controller, Load, Motion, SAMPLING_HZ, platform};
use panic_never as _;

/// Samples of the controller and the observer; the filters of the observer settle in 500.
const SAMPLES: u32 = 521;
/// Blocks of rows for each filter.
const BLOCKS: u32 = 5;
/// Parameters of a payload, and joints of a serial robot.
const PARAMETERS: usize = 10;
const ROWS: usize = 6;
/// Base parameters of the DualV, and rows of its regressor.
const BASE: usize = 49;
const DOF: usize = 3;

/// Pseudo-random numbers of xorshift, in [-1, 1).
struct Random(u32);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        (self.0 >> 8) as f32 / 8_388_608.0 - 1.0
    }

    fn rows<const P: usize, const M: usize>(&mut self) -> [[f32; P]; M] {
        let mut rows = [[0.0; P]; M];
        rows.as_flattened_mut()
            .iter_mut()
            .for_each(|number| *number = self.next());
        rows
    }
}

fn wide<const P: usize, const M: usize>(rows: [[f32; P]; M]) -> [[f64; P]; M] {
    rows.map(|row| row.map(f64::from))
}

#[inline(never)]
fn controller_step(controller: &mut Controller, motion: &Motion, measured: &[f64; ACTUATORS]) {
    let _ = black_box(controller.step(motion, measured));
}

#[inline(never)]
fn observer_step(observer: &mut PayloadObserver, measured: &[f64; ACTUATORS]) {
    let _ = black_box(observer.step(measured, &[1.0, -1.0, 0.5, 0.0]));
}

#[inline(never)]
fn filter_10_update_block_64(filter: &mut Filter<PARAMETERS>, rows: &[[f64; PARAMETERS]; ROWS]) {
    let _ = black_box(filter.update_block(rows, &[1.0; ROWS], &[0.1; ROWS]));
}

#[inline(never)]
fn filter_10_no_forgetting_64(filter: &mut Filter<PARAMETERS>, rows: &[[f64; PARAMETERS]; ROWS]) {
    let _ = black_box(filter.update_block(rows, &[1.0; ROWS], &[0.2; ROWS]));
}

#[inline(never)]
fn filter_10_update_block_32(
    filter: &mut Filter<PARAMETERS, f32>,
    rows: &[[f32; PARAMETERS]; ROWS],
) {
    let _ = black_box(filter.update_block(rows, &[1.0; ROWS], &[0.1; ROWS]));
}

#[inline(never)]
fn filter_49_update_block_64(filter: &mut Filter<BASE>, rows: &[[f64; BASE]; DOF]) {
    let _ = black_box(filter.update_block(rows, &[1.0; DOF], &[0.1; DOF]));
}

#[inline(never)]
fn filter_49_no_forgetting_64(filter: &mut Filter<BASE>, rows: &[[f64; BASE]; DOF]) {
    let _ = black_box(filter.update_block(rows, &[1.0; DOF], &[0.2; DOF]));
}

#[inline(never)]
fn payload_update_64(
    estimator: &mut PayloadEstimator<PARAMETERS>,
    rows: &[[f64; PARAMETERS]; ROWS],
) {
    let _ = black_box(estimator.update(rows, &[1.0; ROWS], &[0.1; ROWS]));
}

#[inline(never)]
fn payload_update_32(
    estimator: &mut PayloadEstimator<PARAMETERS, f32>,
    rows: &[[f32; PARAMETERS]; ROWS],
) {
    let _ = black_box(estimator.update(rows, &[1.0; ROWS], &[0.1; ROWS]));
}

#[inline(never)]
fn payload_body_64(estimator: &PayloadEstimator<PARAMETERS>) {
    let _ = black_box(estimator.payload());
}

#[inline(never)]
fn payload_body_32(estimator: &PayloadEstimator<PARAMETERS, f32>) {
    let _ = black_box(estimator.payload());
}

/// The emulator stops here.
#[inline(never)]
fn finished() -> ! {
    loop {
        asm::wfi();
    }
}

fn control() {
    let mut controller = Controller::new(Load::Loaded);
    let Ok(mut observer) = PayloadObserver::new([0.0; DOF]) else {
        return;
    };
    let rate = core::f64::consts::TAU;
    for sample in 0..SAMPLES {
        let (sine, cosine) = sin_cos(rate * f64::from(sample) / SAMPLING_HZ);
        let motion = Motion {
            pose: [0.03, 0.06, 0.1].map(|amplitude| amplitude * sine),
            twist: [0.03, 0.06, 0.1].map(|amplitude| amplitude * rate * cosine),
            acceleration: [0.03, 0.06, 0.1].map(|amplitude| -amplitude * rate * rate * sine),
        };
        let Ok(measured) = platform::DualV::actuator_positions(&motion.pose) else {
            return;
        };
        controller_step(&mut controller, &motion, &measured);
        observer_step(&mut observer, &measured);
    }
}

fn base(random: &mut Random) {
    let filter = Filter::<BASE>::from_standard_deviations(&[0.0; BASE], &[10.0; BASE]);
    let Ok(mut filter) = filter else {
        return;
    };
    for _ in 0..BLOCKS {
        filter_49_no_forgetting_64(&mut filter, &wide(random.rows()));
    }
    let Ok(mut filter) = filter.with_forgetting(Forgetting::Directional(0.999)) else {
        return;
    };
    for _ in 0..BLOCKS {
        filter_49_update_block_64(&mut filter, &wide(random.rows()));
    }
}

fn rows(random: &mut Random) {
    let prior = (&[0.0; PARAMETERS], &[10.0; PARAMETERS]);
    let size = PayloadSize {
        mass: 10.0,
        length: 0.3,
    };
    let single_size = PayloadSize {
        mass: 10.0,
        length: 0.3_f32,
    };
    let (Ok(filter), Ok(payload), Ok(single_payload)) = (
        Filter::<PARAMETERS>::from_standard_deviations(prior.0, prior.1),
        PayloadEstimator::new(StandardParameter::INERTIA, size),
        PayloadEstimator::<PARAMETERS, f32>::new(StandardParameter::INERTIA, single_size),
    ) else {
        return;
    };
    let single = Filter::<PARAMETERS, f32>::from_standard_deviations(
        &[0.0; PARAMETERS],
        &[10.0; PARAMETERS],
    );
    let mut constant = filter.clone();
    let (Ok(mut filter), Ok(Ok(mut single)), Ok(mut payload), Ok(mut single_payload)) = (
        filter.with_forgetting(Forgetting::Directional(0.999)),
        single.map(|filter| filter.with_forgetting(Forgetting::Directional(0.999))),
        payload.with_forgetting(Forgetting::Directional(0.999)),
        single_payload.with_forgetting(Forgetting::Directional(0.999)),
    ) else {
        return;
    };
    for _ in 0..BLOCKS {
        let single_rows = random.rows();
        let rows = wide(single_rows);
        filter_10_no_forgetting_64(&mut constant, &rows);
        filter_10_update_block_64(&mut filter, &rows);
        filter_10_update_block_32(&mut single, &single_rows);
        payload_update_64(&mut payload, &rows);
        payload_update_32(&mut single_payload, &single_rows);
        payload_body_64(&payload);
        payload_body_32(&single_payload);
    }
}

#[entry]
fn main() -> ! {
    let mut random = Random(2_463_534_242);
    control();
    base(&mut random);
    rows(&mut random);
    finished()
}
