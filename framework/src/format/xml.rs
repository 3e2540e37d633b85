use super::FormatError;

/// `text` as the value of an attribute.
pub(super) fn attribute(text: &str) -> Result<String, FormatError> {
    if text.is_empty() || text.chars().any(is_forbidden) {
        return Err(FormatError::Name { name: text.to_string() });
    }
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            _ => escaped.push(character),
        }
    }
    Ok(escaped)
}

/// XML knows no way to write most of these; the others (tab, line ends) have no place in a name.
fn is_forbidden(character: char) -> bool {
    character.is_control() || matches!(character, '\u{fffe}' | '\u{ffff}')
}

/// `value` as text that reads back to the same number.
pub(super) fn number(key: &'static str, value: f64) -> Result<String, FormatError> {
    if value.is_finite() {
        Ok(format!("{value:?}"))
    } else {
        Err(FormatError::Value { key, value, must: "finite" })
    }
}
