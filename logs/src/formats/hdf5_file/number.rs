//! Numbers of a file: integers of any size, floats of 32 and 64 bits, and booleans.
//!
//! Booleans are enumerations of two integers.

use hdf5_reader::{
    ByteOrder, Datatype, H5Type, dtype_element_size,
    error::{Error, Result},
};

/// A number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Number(pub(super) f64);

/// Checks that elements are numbers.
///
/// # Errors
/// Description of other elements, to follow a name.
pub(super) fn is_number(kind: &Datatype) -> std::result::Result<(), &'static str> {
    match kind {
        Datatype::FixedPoint { size: 1..=8, .. } => Ok(()),
        Datatype::FloatingPoint { size: 4 | 8, .. } => Ok(()),
        Datatype::FixedPoint { .. } => {
            Err("has integers of more than 64 bits, which are not supported")
        }
        Datatype::FloatingPoint { .. } => Err(
            "has floating-point numbers of other sizes than 32 and 64 bits, which are not supported",
        ),
        Datatype::Enum { base, .. } => is_number(base),
        Datatype::String { .. } | Datatype::VarLen { .. } => {
            Err("has texts or lists of variable length, not numbers")
        }
        Datatype::Compound { .. } => {
            Err("has structures (a table, or complex numbers), not single numbers")
        }
        Datatype::Reference { .. } => Err("has references (a cell array?), not numbers"),
        _ => Err("has no single numbers"),
    }
}

impl H5Type for Number {
    fn hdf5_type() -> Datatype {
        f64::hdf5_type()
    }

    fn from_bytes(bytes: &[u8], kind: &Datatype) -> Result<Self> {
        let bad = || Error::InvalidData(String::from("an element is not a number"));
        let found = match kind {
            Datatype::FixedPoint {
                size,
                signed,
                byte_order,
            } => bytes
                .get(..usize::from(*size))
                .and_then(|bytes| whole(bytes, *signed, *byte_order)),
            Datatype::FloatingPoint { byte_order, .. } => floating(bytes, *byte_order),
            Datatype::Enum { base, .. } => return Self::from_bytes(bytes, base),
            _ => None,
        };
        found.map(Self).ok_or_else(bad)
    }

    fn element_size(kind: &Datatype) -> usize {
        dtype_element_size(kind).unwrap_or(0)
    }
}

/// An integer of up to eight bytes.
fn whole(bytes: &[u8], signed: bool, order: ByteOrder) -> Option<f64> {
    let mut eight = [0; 8];
    let count = bytes.len();
    let own = eight.get_mut(..count)?;
    own.copy_from_slice(bytes);
    if order == ByteOrder::BigEndian {
        own.reverse();
    }
    let value = u64::from_le_bytes(eight);
    // Sign extension from the highest bit of the stored bytes.
    let unused = 64 - 8 * u32::try_from(count).ok()?;
    Some(if signed && count > 0 {
        (value.cast_signed() << unused >> unused) as f64
    } else {
        value as f64
    })
}

/// A float of four or eight bytes.
fn floating(bytes: &[u8], order: ByteOrder) -> Option<f64> {
    let is_highest_first = order == ByteOrder::BigEndian;
    match bytes.len() {
        4 => {
            let bytes = bytes.try_into().ok()?;
            let value = if is_highest_first {
                f32::from_be_bytes(bytes)
            } else {
                f32::from_le_bytes(bytes)
            };
            Some(f64::from(value))
        }
        8 => {
            let bytes = bytes.try_into().ok()?;
            Some(if is_highest_first {
                f64::from_be_bytes(bytes)
            } else {
                f64::from_le_bytes(bytes)
            })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use hdf5_reader::{ByteOrder, Datatype, H5Type};

    use super::Number;

    #[test]
    fn numbers_of_all_sizes_and_byte_orders_are_read() {
        let whole = |size, signed, byte_order| Datatype::FixedPoint {
            size,
            signed,
            byte_order,
        };
        let value =
            |bytes: &[u8], kind: &Datatype| Number::from_bytes(bytes, kind).expect("a number").0;
        use ByteOrder::{BigEndian, LittleEndian};
        assert_eq!(value(&[0xfe, 0xff], &whole(2, true, LittleEndian)), -2.0);
        assert_eq!(value(&[0xff, 0xfe], &whole(2, true, BigEndian)), -2.0);
        assert_eq!(value(&[0xff, 0xfe], &whole(2, false, BigEndian)), 65534.0);
        assert_eq!(value(&[0xff; 8], &whole(8, true, BigEndian)), -1.0);
        assert_eq!(
            value(&[0xff; 8], &whole(8, false, BigEndian)),
            2.0_f64.powi(64)
        );
        let floating = |size, byte_order| Datatype::FloatingPoint { size, byte_order };
        assert_eq!(value(&0.5_f32.to_be_bytes(), &floating(4, BigEndian)), 0.5);
        assert_eq!(
            value(&0.1_f64.to_le_bytes(), &floating(8, LittleEndian)),
            0.1
        );
        assert!(Number::from_bytes(&[1, 2], &floating(8, LittleEndian)).is_err());
    }
}
