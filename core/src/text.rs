//! Invisible characters, which are not allowed in output for readers.

/// Whether a character is a control or a format character.
///
/// Such a character has no glyph, changes the writing direction, or makes different names look
/// alike.
#[must_use]
pub fn is_invisible(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{00ad}' | '\u{061c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}'
            | '\u{fffe}'..='\u{ffff}' | '\u{e0000}'..='\u{e0fff}')
}

#[cfg(test)]
mod tests {
    use super::is_invisible;

    #[test]
    fn only_characters_with_a_glyph_are_visible() {
        for c in "α², Γ¹ — Gautier’s 6-UPS \u{a0}م中".chars() {
            assert!(!is_invisible(c), "{c:?}");
        }
        for c in [
            '\u{1b}', '\n', '\u{7f}', '\u{202e}', '\u{2028}', '\u{2066}', '\u{200b}', '\u{feff}',
        ] {
            assert!(is_invisible(c), "{c:?}");
        }
    }
}
