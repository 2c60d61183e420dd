//! Detects parameters that are not physically consistent.
//!
//! Masses, moments of inertia and friction are not negative. The ten inertial parameters of a body
//! belong to a positive density exactly if the pseudo-inertia ∫ [p; 1] [p; 1]ᵀ dm is positive
//! definite (Wensing, Kim, Slotine 2018). For a planar body, which has fewer columns, the condition
//! is zz m ≥ mx² + my². Estimates may violate this, so it is not an error.

use nalgebra::Matrix4;
use overact_codegen::{
    description::{Body, StandardParameter as P, TrueParameter},
    diagnostic::Source,
};

/// Tolerance for negative eigenvalues relative to the largest, since files contain rounded numbers.
const ROUNDING: f64 = 1e-6;

/// Sentence with file and line for each inconsistent value or body.
pub(crate) fn doubts(source: &Source, all: &[TrueParameter]) -> Vec<String> {
    let mut doubts: Vec<String> = all.iter().filter_map(|one| negative(source, one)).collect();
    let mut bodies: Vec<Body> = Vec::new();
    for one in all.iter().filter(|one| one.symbol.is_inertial()) {
        if !bodies.contains(&one.body) {
            bodies.push(one.body);
        }
    }
    doubts.extend(bodies.iter().filter_map(|&body| {
        let own: Vec<&TrueParameter> = all.iter().filter(|one| one.body == body).collect();
        impossible(source, &own)
    }));
    doubts
}

fn place(source: &Source, one: &TrueParameter) -> String {
    let line = source.position(&one.name.span).line;
    format!("{}:{line}", source.name)
}

fn negative(source: &Source, one: &TrueParameter) -> Option<String> {
    let TrueParameter { name, value, .. } = one;
    (one.symbol.is_nonnegative() && *value < 0.0).then(|| {
        format!(
            "{}: `{}` = {value} is negative, which is not physically consistent",
            place(source, one),
            name.value
        )
    })
}

/// Problem of a body's inertia, if its parameters are not negative.
fn impossible(source: &Source, own: &[&TrueParameter]) -> Option<String> {
    if own
        .iter()
        .any(|one| one.symbol.is_nonnegative() && one.value < 0.0)
    {
        return None;
    }
    let find = |symbol: P| own.iter().find(|one| one.symbol == symbol);
    let value = |symbol: P| find(symbol).map(|one| one.value);
    let first = own.iter().find(|one| one.symbol.is_inertial())?;
    let body = match find(P::M) {
        Some(mass) => &mass.name.value,
        None => return None,
    };
    let all: Option<Vec<f64>> = P::INERTIA.into_iter().map(value).collect();
    let wrong = match all {
        Some(_) => {
            let at = |symbol: P| value(symbol).unwrap_or_default();
            let eigenvalues = pseudo_inertia(&at).symmetric_eigenvalues();
            let (least, most) = (eigenvalues.min(), eigenvalues.amax());
            (least < -ROUNDING * most).then(|| {
                "its moments of inertia are too small for its mass and first moments, or one of them is \
                 larger than the sum of the others"
                    .to_owned()
            })
        }
        None => {
            let (zz, mass) = (value(P::Zz)?, value(P::M)?);
            let (mx, my) = (value(P::Mx)?, value(P::My).unwrap_or_default());
            let least = mx * mx + my * my;
            (zz * mass < least * (1.0 - ROUNDING)).then(|| {
                format!(
                    "zz m = {:.6} is less than mx² + my² = {least:.6}",
                    zz * mass
                )
            })
        }
    }?;
    Some(format!(
        "{}: the inertia of the body with `{body}` is not physically consistent: {wrong}",
        place(source, first)
    ))
}

/// Pseudo-inertia ∫ [p; 1] [p; 1]ᵀ dm.
fn pseudo_inertia(value: &dyn Fn(P) -> f64) -> Matrix4<f64> {
    let half = 0.5 * (value(P::Xx) + value(P::Yy) + value(P::Zz));
    let (xy, xz, yz) = (-value(P::Xy), -value(P::Xz), -value(P::Yz));
    let (mx, my, mz) = (value(P::Mx), value(P::My), value(P::Mz));
    Matrix4::new(
        half - value(P::Xx),
        xy,
        xz,
        mx,
        xy,
        half - value(P::Yy),
        yz,
        my,
        xz,
        yz,
        half - value(P::Zz),
        mz,
        mx,
        my,
        mz,
        value(P::M),
    )
}
