//! Merges runs of blanks and tabs, so that one blank separates two columns.

use std::io::{BufRead, BufReader, Read, Result};

/// Replaces each run of blanks and tabs by one blank, and removes those at line ends.
#[derive(Debug)]
pub(super) struct CollapsedBlanks<R> {
    input: BufReader<R>,
    /// Whether nothing of this line has been output.
    at_start: bool,
    /// Whether a blank is to be output before the next character of the line.
    waiting: bool,
}

impl<R: Read> CollapsedBlanks<R> {
    pub(super) fn new(input: R, buffer: usize) -> Self {
        Self {
            input: BufReader::with_capacity(buffer, input),
            at_start: true,
            waiting: false,
        }
    }
}

impl<R: Read> Read for CollapsedBlanks<R> {
    fn read(&mut self, output: &mut [u8]) -> Result<usize> {
        let mut written = 0;
        while written < output.len() {
            let available = self.input.fill_buf()?;
            if available.is_empty() {
                break;
            }
            let mut used = 0;
            while used < available.len() && written < output.len() {
                let byte = available[used];
                let passed = match byte {
                    b' ' | b'\t' => {
                        self.waiting = !self.at_start;
                        used += 1;
                        continue;
                    }
                    b'\r' | b'\n' => {
                        (self.at_start, self.waiting) = (true, false);
                        used += 1;
                        byte
                    }
                    // The byte itself follows its blank.
                    _ if std::mem::take(&mut self.waiting) => b' ',
                    _ => {
                        self.at_start = false;
                        used += 1;
                        byte
                    }
                };
                output[written] = passed;
                written += 1;
            }
            self.input.consume(used);
        }
        Ok(written)
    }
}

#[cfg(test)]
mod tests {
    use super::CollapsedBlanks;
    use std::io::Read;

    #[test]
    fn blanks_are_collapsed_and_trimmed_from_lines() {
        let text = "  1.0 \t 2.0  \r\n\t3.0 4.0\n\n   \n5";
        for buffer in [1, 3, 64] {
            let mut squeezed = String::new();
            let mut input = CollapsedBlanks::new(text.as_bytes(), buffer);
            input.read_to_string(&mut squeezed).expect("text");
            assert_eq!(squeezed, "1.0 2.0\r\n3.0 4.0\n\n\n5");
        }
    }
}
