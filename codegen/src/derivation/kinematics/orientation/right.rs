//! Constant right angles between rotations about z.
//!
//! If the tilts of a leg's base and of the body that carries it cancel, or flip the axis, the
//! rotations before and after are about parallel axes and merge into one.

use super::OrientationFactor;
use crate::cas::{Angle, Direction, Ratio};

/// A rotation by right angles, as a matrix.
type Right = [[i8; 3]; 3];

const IDENTITY: Right = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/// The same orientation with merged rotations about parallel axes; `None` if a constant overflows.
pub(super) fn merged(parts: &[OrientationFactor]) -> Option<Vec<OrientationFactor>> {
    let mut all: Vec<OrientationFactor> = Vec::new();
    let mut at = 0;
    while at < parts.len() {
        let run = parts[at..].iter().map_while(rotation);
        let rotations: Vec<Right> = run.collect();
        let whole = rotations
            .iter()
            .fold(IDENTITY, |sum, next| product(&sum, next));
        let count = rotations.len();
        match (count, whole[2]) {
            (0, _) => {
                push(&mut all, parts[at].clone())?;
                at += 1;
                continue;
            }
            (_, [0, 0, 1]) => push(&mut all, about_z(whole))?,
            (_, [0, 0, -1]) => {
                // Rz(a) Rx(180°) is Rx(180°) Rz(-a).
                let before = match all.pop_if(|part| matches!(part, OrientationFactor::Turn(_))) {
                    Some(OrientationFactor::Turn(turn)) => turn.negative(),
                    _ => Direction::constant(Angle::ZERO),
                };
                all.push(OrientationFactor::Tilt([half()?, Angle::ZERO, Angle::ZERO]));
                all.push(OrientationFactor::Turn(before));
                let over = [[1, 0, 0], [0, -1, 0], [0, 0, -1]];
                push(&mut all, about_z(product(&over, &whole)))?;
            }
            _ => all.extend_from_slice(&parts[at..at + count]),
        }
        at += count;
    }
    Some(all)
}

/// Appends a part; consecutive rotations about z are merged.
fn push(all: &mut Vec<OrientationFactor>, part: OrientationFactor) -> Option<()> {
    match (all.last_mut(), part) {
        (Some(OrientationFactor::Turn(last)), OrientationFactor::Turn(next)) => {
            *last = last.plus(&next)?
        }
        (_, part) => all.push(part),
    }
    Some(())
}

/// A part as a constant rotation by right angles.
fn rotation(part: &OrientationFactor) -> Option<Right> {
    match part {
        OrientationFactor::Tilt([rx, ry, rz]) => {
            let [x, y, z] = [about(0, *rx)?, about(1, *ry)?, about(2, *rz)?];
            Some(product(&product(&z, &y), &x))
        }
        OrientationFactor::Turn(turn) if turn.is_constant() => about(2, turn.offset()),
        OrientationFactor::Turn(_) => None,
    }
}

fn about(axis: usize, angle: Angle) -> Option<Right> {
    let (cosine, sine) = angle.cosine_and_sine();
    let whole = |value: f64| match value {
        0.0 => Some(0),
        1.0 => Some(1),
        -1.0 => Some(-1),
        _ => None,
    };
    let (c, s): (i8, i8) = (whole(cosine.value())?, whole(sine.value())?);
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turn = IDENTITY;
    (turn[i][i], turn[j][j], turn[i][j], turn[j][i]) = (c, c, -s, s);
    Some(turn)
}

fn product(a: &Right, b: &Right) -> Right {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// A rotation about z.
fn about_z(turn: Right) -> OrientationFactor {
    let quarters = match (turn[0][0], turn[1][0]) {
        (0, 1) => 1,
        (-1, _) => 2,
        (0, _) => 3,
        _ => 0,
    };
    let angle = Ratio::new(quarters, 2).map_or(Angle::ZERO, Angle::half_turns);
    OrientationFactor::Turn(Direction::constant(angle))
}

fn half() -> Option<Angle> {
    Some(Angle::half_turns(Ratio::integer(1)))
}
