//! Names of actuators and joints in sentences.

/// Name of an actuator in a sentence: in backticks, or `joint 1` for a bare number.
///
/// Unnamed joints of serial robots are numbers.
#[must_use]
pub fn called(name: &str) -> String {
    let is_number = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_digit());
    if is_number {
        format!("joint {name}")
    } else {
        format!("`{name}`")
    }
}

/// Name of an actuator as a heading.
#[must_use]
pub fn titled(name: &str) -> String {
    called(name).replace('`', "")
}

/// Replaces bare numbers in backticks by `joint` and the number.
#[must_use]
pub fn with_joints(words: &str) -> String {
    let marks = words.matches('`').count();
    let mut text = String::new();
    for (number, piece) in words.split('`').enumerate() {
        match number % 2 {
            0 => text.push_str(piece),
            // An unpaired backtick.
            _ if number == marks => text.extend(["`", piece]),
            _ => text.push_str(&called(piece)),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{called, titled, with_joints};

    #[test]
    fn only_bare_numbers_in_sentences_become_joints() {
        let words = "the torques of `3` and `leg2` by `fv_3`";
        assert_eq!(
            with_joints(words),
            "the torques of joint 3 and `leg2` by `fv_3`"
        );
        assert_eq!(with_joints("a lone ` stays"), "a lone ` stays");
        assert_eq!(titled("leg2"), "leg2");
        assert_eq!(titled("12"), "joint 12");
    }

    #[test]
    fn bare_numbers_are_displayed_as_joints() {
        assert_eq!(called("3"), "joint 3");
        assert_eq!(called("leg3"), "`leg3`");
        assert_eq!(called("1_2"), "`1_2`");
    }
}
