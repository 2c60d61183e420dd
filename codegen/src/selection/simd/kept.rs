//! Columns and parameters of the first leg that represent those of all legs.

use crate::derivation::BodyParameter;
use crate::lowering::{Column, OfLegs};

/// The kept columns of a function, and the places of these and of the other legs' columns.
///
/// Columns of the last legs may be missing, since an elimination keeps those of the first ones.
/// `None` if the legs' columns do not have a constant stride.
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
        let place = OfLegs {
            first: at,
            stride: match of(1) {
                Some(next) => next.checked_sub(at)?,
                None => 0,
            },
            count: (0..legs).take_while(|&leg| of(leg).is_some()).count(),
        };
        if !(0..legs).all(|leg| of(leg) == place.of(leg)) {
            return None;
        }
        kept.push((at, Column::OfLegs(place)));
    }
    let counts = kept.iter().map(|(_, column)| match column {
        Column::Shared(_) => 1,
        Column::OfLegs(place) => place.count,
    });
    let whole = counts.sum::<usize>() == parameters.len();
    whole.then(|| kept.into_iter().unzip())
}

#[cfg(test)]
mod tests {
    use super::kept_columns;
    use crate::derivation::BodyParameter;
    use crate::lowering::{Column, OfLegs};
    use overact_core::StandardParameter as Symbol;

    fn of(leg: usize, symbol: Symbol) -> BodyParameter {
        BodyParameter::Leg {
            leg,
            joint: 0,
            symbol,
        }
    }

    #[test]
    fn only_the_last_legs_may_lack_a_column() {
        let masses = [0, 1, 2].map(|leg| of(leg, Symbol::M));
        let offsets = [0, 1].map(|leg| of(leg, Symbol::Off));
        let all = [&masses[..], &offsets[..]].concat();
        let (kept, columns) = kept_columns(&all, 3).expect("regular columns");
        assert_eq!(kept, [0, 3]);
        let of_legs = |first, stride, count| {
            Column::OfLegs(OfLegs {
                first,
                stride,
                count,
            })
        };
        assert_eq!(columns, [of_legs(0, 1, 3), of_legs(3, 1, 2)]);
        let only_last = [&masses[..], &[of(2, Symbol::Off)]].concat();
        assert_eq!(kept_columns(&only_last, 3), None);
        let between = [&masses[..], &[of(0, Symbol::Off), of(2, Symbol::Off)]].concat();
        assert_eq!(kept_columns(&between, 3), None);
    }
}
