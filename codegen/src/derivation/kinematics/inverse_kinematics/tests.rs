//! Tests of which equations determine an unknown at home, and of the sign of the root.

use super::super::configuration::Unknown;
use super::Task;
use super::peeling::{Step, root_at_home, slide};
use super::polynomial::{Linear, Quadratic};
use crate::cas::{Arena, Direction, Number, Vector3};
use crate::mechanism::{Home, Mechanism, check};
use overact_description::diagnostic::Source;
use std::f64::consts::FRAC_PI_3;

/// A robot whose longest length is below a metre, so that its legs are compared by squares of
/// lengths.
fn five_bar() -> Mechanism {
    let source = Source::new(
        "robots/five_bar.toml",
        include_str!("../../../../../robots/five_bar.toml"),
    );
    let description = overact_description::parse(&source).expect("a right description");
    check(&description).expect("a right mechanism")
}

/// Runs `look` on the first leg with its first joint at `angle`; the unknown is that joint's turn.
fn with_task<T>(angle: f64, look: impl FnOnce(&Arena, Task<'_, '_>, &Unknown) -> T) -> T {
    let (arena, mechanism) = (Arena::new(), five_bar());
    let home = Home {
        joints: vec![angle, 0.0],
        ..Home::default()
    };
    let turn: Direction = arena.input_angle("joints", 0);
    let task = Task {
        blocks: false,
        arena: &arena,
        leg: &mechanism.legs[0],
        first_joint: 0,
        home: &home,
        target: Vector3::zero(&arena),
        axes: None,
    };
    look(&arena, task, &Unknown::Turn(turn))
}

/// w = ∂(a c + b s)/∂(turn) at home, if it determines the turn.
fn root(a: f64, b: f64, angle: f64) -> Option<f64> {
    with_task(angle, |arena, task, unknown| {
        let number = |value: f64| arena.number(Number::float(value));
        let equation = Linear {
            a: number(a),
            b: number(b),
            d: number(a * angle.cos() + b * angle.sin()),
        };
        root_at_home(task, &equation, unknown)
    })
}

#[test]
fn the_root_at_home_equals_the_derivative_of_its_equation() {
    // The cosine of 60° is 1/2, its sine √3/2.
    let w = root(2.0, 3.0, FRAC_PI_3).expect("a root");
    assert!((w - (1.5 - 3.0_f64.sqrt())).abs() < 1e-15, "{w}");
    let w = root(-2.0, 3.0, FRAC_PI_3).expect("a root");
    assert!((w - (1.5 + 3.0_f64.sqrt())).abs() < 1e-15, "{w}");
}

#[test]
fn equations_at_an_extremum_or_of_rounding_size_have_no_root() {
    // (a, b) along the turn: w vanishes except for its perpendicular part, which is relative to (a,
    // b).
    let along = |length: f64, across: f64| {
        let (s, c) = FRAC_PI_3.sin_cos();
        root(
            length * (c - across * s),
            length * (s + across * c),
            FRAC_PI_3,
        )
    };
    for length in [1e-3, 1.0, 1e3] {
        assert_eq!(along(length, 1e-7), None, "{length}");
        assert!(along(length, 1e-5).is_some(), "{length}");
    }
    assert_eq!(root(2e-13, 3e-13, FRAC_PI_3), None);
}

#[test]
fn linear_slide_equations_are_solved_without_a_root() {
    let found = |a: f64, b: f64, e: f64| {
        with_task(0.0, |arena, task, _| {
            let number = |value: f64| arena.number(Number::float(value));
            let (a, b, e) = (number(a), number(b), number(e));
            match slide(task, Quadratic { a, b, e }) {
                Some(Step::Slide(_)) => "at once",
                Some(Step::SlideRoot(_)) => "by a root",
                Some(Step::Pair(..) | Step::Root(_)) => "as a turn",
                None => "not at all",
            }
        })
    };
    assert_eq!(found(0.0, 0.5, 1.0), "at once");
    assert_eq!(found(0.0, -0.5, 1.0), "at once");
    assert_eq!(found(0.0, 1e-9, 1.0), "not at all");
    // q² - 3 q + 2 = 0 has roots, q² - 2 q + 1 = 0 is at its extreme, q² + 1 = 0 has none.
    assert_eq!(found(1.0, -3.0, 2.0), "by a root");
    assert_eq!(found(1.0, -2.0, 1.0), "not at all");
    assert_eq!(found(1.0, 0.0, 1.0), "not at all");
}
