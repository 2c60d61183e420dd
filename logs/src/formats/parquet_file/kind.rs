//! Meaning of a column's values: numbers, times in some unit, or unsupported.

use parquet::{
    basic::{ConvertedType, LogicalType, TimeUnit, Type},
    schema::types::ColumnDescriptor,
};

/// Conversion of a column's values to numbers in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Numbers without conversion.
    Number,
    /// Unsigned integers.
    Unsigned,
    /// Integers with this number of units per one: durations, decimals.
    Parts(i64),
    /// Times with this number of units per second, counted from 1970.
    ///
    /// They are converted to seconds from a later origin, since a double from 1970 is too coarse
    /// for sampling at some kHz.
    Instant(i64),
}

impl Kind {
    /// Conversion of a column.
    ///
    /// # Errors
    /// Description of values that are no numbers, to follow the column's name.
    pub(super) fn of(column: &ColumnDescriptor) -> Result<Self, String> {
        match column.physical_type() {
            Type::DOUBLE | Type::FLOAT | Type::BOOLEAN => Ok(Self::Number),
            Type::INT32 | Type::INT64 => Self::whole(column),
            // Nanoseconds after conversion; the type has no other use.
            Type::INT96 => Ok(Self::Instant(1_000_000_000)),
            Type::BYTE_ARRAY => Err(String::from("has texts or bytes, not numbers")),
            Type::FIXED_LEN_BYTE_ARRAY => Err(match column.logical_type_ref() {
                Some(LogicalType::Float16) => {
                    String::from("has 16-bit numbers, which are not supported")
                }
                Some(LogicalType::Decimal(_)) => {
                    String::from("has long decimals, which are not supported")
                }
                _ => String::from("has bytes, not numbers"),
            }),
        }
    }

    /// Meaning of integers.
    fn whole(column: &ColumnDescriptor) -> Result<Self, String> {
        let decimal = |scale: i32| {
            let scale = u32::try_from(scale).ok();
            let parts = scale.and_then(|scale| 10_i64.checked_pow(scale));
            parts
                .map(Self::Parts)
                .ok_or_else(|| String::from("has decimals with too many places"))
        };
        match column.logical_type_ref() {
            Some(LogicalType::Timestamp(time)) => return Ok(Self::Instant(per_second(&time.unit))),
            Some(LogicalType::Time(time)) => return Ok(Self::Parts(per_second(&time.unit))),
            Some(LogicalType::Decimal(decimals)) => return decimal(decimals.scale),
            Some(LogicalType::Date) => return Err(String::from("has days, not numbers")),
            Some(LogicalType::Integer(kind)) if !kind.is_signed => return Ok(Self::Unsigned),
            _ => {}
        }
        // Equivalent in files of the first version.
        match column.converted_type() {
            ConvertedType::TIMESTAMP_MILLIS => Ok(Self::Instant(1000)),
            ConvertedType::TIMESTAMP_MICROS => Ok(Self::Instant(1_000_000)),
            ConvertedType::TIME_MILLIS => Ok(Self::Parts(1000)),
            ConvertedType::TIME_MICROS => Ok(Self::Parts(1_000_000)),
            ConvertedType::DECIMAL => decimal(column.type_scale()),
            ConvertedType::DATE => Err(String::from("has days, not numbers")),
            ConvertedType::UINT_8
            | ConvertedType::UINT_16
            | ConvertedType::UINT_32
            | ConvertedType::UINT_64 => Ok(Self::Unsigned),
            _ => Ok(Self::Number),
        }
    }

    /// Converts a 64-bit value; instants become seconds from `origin`, s since 1970.
    pub(super) fn long(self, value: i64, origin: i64) -> f64 {
        match self {
            Self::Number => value as f64,
            Self::Unsigned => value.cast_unsigned() as f64,
            Self::Parts(parts) => value as f64 / parts as f64,
            Self::Instant(parts) => {
                let start = i128::from(origin) * i128::from(parts);
                (i128::from(value) - start) as f64 / parts as f64
            }
        }
    }

    /// Converts a 32-bit value.
    pub(super) fn short(self, value: i32, origin: i64) -> f64 {
        match self {
            Self::Unsigned => f64::from(value.cast_unsigned()),
            _ => self.long(i64::from(value), origin),
        }
    }
}

const fn per_second(unit: &TimeUnit) -> i64 {
    match unit {
        TimeUnit::MILLIS => 1000,
        TimeUnit::MICROS => 1_000_000,
        TimeUnit::NANOS => 1_000_000_000,
    }
}

#[cfg(test)]
mod tests {
    use super::Kind;

    #[test]
    fn integer_values_are_converted_without_loss() {
        assert_eq!(Kind::Number.long(-3, 7), -3.0);
        assert_eq!(Kind::Unsigned.long(-1, 0), 18_446_744_073_709_551_615.0);
        assert_eq!(Kind::Unsigned.short(-1, 0), 4_294_967_295.0);
        assert_eq!(Kind::Parts(1_000_000_000).long(100_000_000, 7), 0.1);
        let start = 1_700_000_000_i64;
        let now = start * 1_000_000_000 + 200_000;
        assert_eq!(Kind::Instant(1_000_000_000).long(now, start), 0.0002);
        assert_eq!(Kind::Instant(1).long(i64::MIN, i64::MAX), -(2_f64.powi(64)));
    }
}
