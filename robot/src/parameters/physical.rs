//! Detects parameters that are not physically consistent.
//!
//! Masses, moments of inertia and friction are not negative. The ten inertial parameters of a body
//! are those of a mass distribution if and only if the pseudo-inertia ∫ [p; 1] [p; 1]ᵀ dm is
//! positive definite (Wensing, Kim, Slotine 2018). A planar body has fewer parameters; the condition
//! is then zz m ≥ mx² + my². Estimates may violate it, so a violation is only a warning.

use nalgebra::Matrix4;
use overact_codegen::{
    description::{Body, StandardParameter as P, TrueParameter},
    diagnostic::Source,
};

/// Tolerance of negative eigenvalues relative to the largest, for rounded numbers of files.
const ROUNDING: f64 = 1e-6;

/// Warning, with file and line, for each inconsistent value or body.
pub(crate) fn physical_warnings(source: &Source, all: &[TrueParameter]) -> Vec<String> {
    let negative = all.iter().filter_map(|one| negative_value(source, one));
    let mut warnings: Vec<String> = negative.collect();
    let mut bodies: Vec<Body> = Vec::new();
    for one in all.iter().filter(|one| one.symbol.is_inertial()) {
        if !bodies.contains(&one.body) {
            bodies.push(one.body);
        }
    }
    warnings.extend(bodies.iter().filter_map(|&body| {
        let own: Vec<&TrueParameter> = all.iter().filter(|one| one.body == body).collect();
        inconsistent_inertia(source, &own)
    }));
    warnings
}

/// File and line of a parameter.
fn location(source: &Source, one: &TrueParameter) -> String {
    let line = source.position(&one.name.span).line;
    format!("{}:{line}", source.name)
}

/// Warning about a negative value that must not be negative.
fn negative_value(source: &Source, one: &TrueParameter) -> Option<String> {
    let TrueParameter { name, value, .. } = one;
    (one.symbol.is_nonnegative() && *value < 0.0).then(|| {
        format!(
            "{}: `{}` = {value} is negative, which is not physically consistent",
            location(source, one),
            name.value
        )
    })
}

/// Warning about the inertia of a body; `None` if a negative value is reported already.
fn inconsistent_inertia(source: &Source, own: &[&TrueParameter]) -> Option<String> {
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
        location(source, first)
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
