//! Which columns or parameters of the first leg stand for those of all.

use crate::derivation::BodyParameter;
use crate::lowering::Column;

/// Which columns of a function stay, and where they and those of the other legs stand. None if the legs' columns do
/// not follow one another at a distance of their own.
pub(super) fn kept_columns(
    parameters: &[BodyParameter],
    legs: usize,
) -> Option<(Vec<usize>, Vec<Column>)> {
    let mut kept = Vec::new();
    for (at, &parameter) in parameters.iter().enumerate() {
        let BodyParameter::Leg { leg, joint, symbol } = parameter else {
            kept.push((at, Column::Shared(at)));
            continue;
        };
        if leg > 0 {
            continue;
        }
        let of = |leg| {
            let same = BodyParameter::Leg { leg, joint, symbol };
            parameters.iter().position(|other| *other == same)
        };
        let stride = of(1)?.checked_sub(at)?;
        if !(0..legs).all(|leg| of(leg) == Some(at + leg * stride)) {
            return None;
        }
        kept.push((at, Column::OfLegs { first: at, stride }));
    }
    let of_first = kept
        .iter()
        .filter(|(_, column)| matches!(column, Column::OfLegs { .. }));
    let shared = kept.len() - of_first.clone().count();
    let whole = of_first.count() * legs + shared == parameters.len();
    whole.then(|| kept.into_iter().unzip())
}
