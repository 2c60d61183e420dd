//! Messages `sensor_msgs/msg/JointState` of ROS 2 in the Common Data Representation.
//!
//! A message has a header with a stamp, joint names, and three lists of numbers, possibly empty.

/// A message.
#[derive(Debug)]
pub(super) struct JointState<'a> {
    /// Time of measurement: s, and ns after that.
    pub(super) stamp: (i32, u32),
    pub(super) names: Vec<&'a str>,
    /// Positions, velocities, efforts.
    pub(super) lists: [Numbers<'a>; 3],
}

/// Numbers of 64 bits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbers<'a> {
    bytes: &'a [u8],
    order: Order,
}

/// Byte order of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    Highest,
    Lowest,
}

impl Numbers<'_> {
    pub(super) const fn len(self) -> usize {
        self.bytes.len() / 8
    }

    pub(super) fn get(self, index: usize) -> Option<f64> {
        let bytes = self.bytes.get(8 * index..8 * index + 8)?.try_into().ok()?;
        Some(match self.order {
            Order::Highest => f64::from_be_bytes(bytes),
            Order::Lowest => f64::from_le_bytes(bytes),
        })
    }
}

impl<'a> JointState<'a> {
    /// Reads a message.
    ///
    /// # Errors
    /// A description of the defect, to follow `it`.
    pub(super) fn read(message: &'a [u8]) -> Result<Self, String> {
        let (start, rest) = message
            .split_at_checked(4)
            .ok_or("is truncated in its first four bytes")?;
        let order = match start {
            [0, 0, ..] => Order::Highest,
            [0, 1, ..] => Order::Lowest,
            _ => {
                return Err(format!(
                    "has the representation {:#04x} {:#04x} instead of plain CDR",
                    start[0], start[1]
                ));
            }
        };
        let mut fields = Fields {
            bytes: rest,
            place: 0,
            order,
        };
        let cut_off = || String::from("is truncated, or not a JointState");
        let stamp = (
            fields.word().ok_or_else(cut_off)?.cast_signed(),
            fields.word().ok_or_else(cut_off)?,
        );
        fields.text()?;
        let count = fields.word().ok_or_else(cut_off)? as usize;
        // Each name needs at least four bytes.
        let most = fields.bytes.len() / 4;
        let mut names = Vec::with_capacity(count.min(most));
        for _ in 0..count {
            names.push(fields.text()?);
        }
        let mut list = || fields.numbers().ok_or_else(cut_off);
        let lists = [list()?, list()?, list()?];
        Ok(Self {
            stamp,
            names,
            lists,
        })
    }
}

/// The remaining fields of a message.
struct Fields<'a> {
    bytes: &'a [u8],
    place: usize,
    order: Order,
}

impl<'a> Fields<'a> {
    /// The next bytes, aligned to a multiple of `align` bytes.
    fn take(&mut self, align: usize, count: usize) -> Option<&'a [u8]> {
        let start = self.place.next_multiple_of(align);
        let end = start.checked_add(count)?;
        let own = self.bytes.get(start..end)?;
        self.place = end;
        Some(own)
    }

    fn word(&mut self) -> Option<u32> {
        let bytes = self.take(4, 4)?.try_into().ok()?;
        Some(match self.order {
            Order::Highest => u32::from_be_bytes(bytes),
            Order::Lowest => u32::from_le_bytes(bytes),
        })
    }

    /// A text, whose length includes the terminating zero byte.
    fn text(&mut self) -> Result<&'a str, String> {
        let bytes = self.word().and_then(|count| self.take(1, count as usize));
        let bytes = bytes.ok_or("is truncated, or not a JointState")?;
        let bytes = bytes.strip_suffix(b"\0").unwrap_or(bytes);
        std::str::from_utf8(bytes).map_err(|_| String::from("has a name that is not UTF-8"))
    }

    /// A list of numbers; an empty one is not aligned.
    fn numbers(&mut self) -> Option<Numbers<'a>> {
        let count = self.word()? as usize;
        let bytes = match count {
            0 => &[][..],
            _ => self.take(8, count.checked_mul(8)?)?,
        };
        Some(Numbers {
            bytes,
            order: self.order,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::JointState;

    /// A big-endian message of two joints without velocities.
    fn message() -> Vec<u8> {
        let mut bytes = vec![0, 0, 0, 0];
        // 7 s and 500 ns, a frame without a name, two joints.
        for value in [7_u32, 500, 0, 2] {
            bytes.extend(value.to_be_bytes());
        }
        bytes.extend([0, 0, 0, 2, b'a', 0, 0, 0, 0, 0, 0, 2, b'b', 0, 0, 0]);
        // Two numbers, aligned to eight bytes.
        bytes.extend([0, 0, 0, 2, 0, 0, 0, 0]);
        bytes.extend(0.5_f64.to_be_bytes());
        bytes.extend((-3.0_f64).to_be_bytes());
        bytes.extend([0, 0, 0, 0]);
        bytes.extend([0, 0, 0, 1]);
        bytes.extend(8.0_f64.to_be_bytes());
        bytes
    }

    #[test]
    fn messages_are_read_in_both_byte_orders() {
        let bytes = message();
        let found = JointState::read(&bytes).expect("a message");
        assert_eq!(found.stamp, (7, 500));
        assert_eq!(found.names, ["a", "b"]);
        assert_eq!(found.lists.map(super::Numbers::len), [2, 0, 1]);
        assert_eq!(found.lists[0].get(1), Some(-3.0));
        assert_eq!(found.lists[0].get(2), None);
        assert_eq!(found.lists[2].get(0), Some(8.0));
        for end in 0..bytes.len() {
            assert!(JointState::read(&bytes[..end]).is_err(), "{end}");
        }
        let mut other = bytes;
        other[1] = 7;
        let error_text = JointState::read(&other).expect_err("another representation");
        assert_eq!(
            error_text,
            "has the representation 0x00 0x07 instead of plain CDR"
        );
    }
}
