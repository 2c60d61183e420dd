//! Limit on the unpacked size of a file: a few megabytes may contain gigabytes of zeros.

use std::io::{Read, Take};

/// Unpacked bytes in addition to the size of the file.
const UNPACKED: u64 = 1 << 28;

/// Remaining bytes that the members of a file may unpack to.
#[derive(Debug)]
pub(crate) struct Budget {
    left: u64,
}

impl Budget {
    /// Budget of a file with these bytes; stored members are limited by the file itself.
    pub(crate) const fn of_file(bytes: &[u8]) -> Self {
        Self {
            left: UNPACKED + bytes.len() as u64,
        }
    }

    /// A budget of `left` bytes.
    #[cfg(test)]
    pub(crate) const fn with(left: u64) -> Self {
        Self { left }
    }

    /// Takes bytes from the budget.
    ///
    /// # Errors
    /// A sentence, if fewer are left.
    pub(crate) fn take(&mut self, bytes: u64) -> Result<(), String> {
        self.left = self.left.checked_sub(bytes).ok_or_else(too_large)?;
        Ok(())
    }

    /// Limits an input to the budget; [`settle`](Self::settle) then takes what was read.
    pub(crate) fn limited<R: Read>(&self, input: R) -> Take<R> {
        input.take(self.left + 1)
    }

    /// Takes the bytes read from a limited input.
    ///
    /// # Errors
    /// A sentence, if the input was longer than the budget.
    pub(crate) fn settle<R>(&mut self, input: &Take<R>) -> Result<(), String> {
        self.take(self.left + 1 - input.limit())
    }

    /// Reads to the end.
    ///
    /// # Errors
    /// A sentence, if the input is broken or longer than the budget.
    pub(crate) fn unpack(&mut self, input: impl Read) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let read = self.limited(input).read_to_end(&mut bytes);
        read.map_err(|_| String::from("it is damaged"))?;
        self.take(bytes.len() as u64)?;
        Ok(bytes)
    }
}

fn too_large() -> String {
    format!(
        "uncompressed it has more than {} MB: save it without compression, or as Parquet, which is read block by block",
        UNPACKED >> 20
    )
}

#[cfg(test)]
mod tests {
    use super::{Budget, UNPACKED};

    #[test]
    fn the_unpacking_budget_limits_endless_input() {
        let mut budget = Budget::of_file(&[]);
        assert!(budget.take(UNPACKED - 1).is_ok());
        assert_eq!(budget.unpack(&[7_u8][..]), Ok(vec![7]));
        let refused = budget
            .unpack(std::io::repeat(0))
            .expect_err("nothing is left");
        assert!(refused.contains("256 MB"), "{refused}");
        assert!(budget.take(1).is_err());
    }
}
