//! Numbers as people write them along an axis.

/// `value` with `decimals` digits after the point and a true minus sign.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().any(|c| c.is_ascii_digit() && c != '0') => {
            format!("\u{2212}{digits}")
        }
        Some(zero) => zero.to_owned(),
        None => text,
    }
}

/// 10 to the power of `exponent`.
pub(super) fn power_of_ten(exponent: i32) -> String {
    let mut text = String::from("10");
    for c in exponent.to_string().chars() {
        text.push(match c {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            digit => char::from_u32(0x2070 + (digit as u32 - '0' as u32)).unwrap_or(digit),
        });
    }
    text
}

/// `digit` (1 to 9) times 10 to the power of `exponent`, as short as it can be read.
pub(super) fn rounded(digit: i32, exponent: i32) -> String {
    match exponent {
        -3..0 => fixed(f64::from(digit) * 10f64.powi(exponent), exponent.unsigned_abs() as usize),
        0..5 => fixed(f64::from(digit) * 10f64.powi(exponent), 0),
        _ if digit == 1 => power_of_ten(exponent),
        _ => format!("{digit}·{}", power_of_ten(exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(fixed(-0.25, 2), "\u{2212}0.25");
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(power_of_ten(-12), "10⁻¹²");
        assert_eq!(rounded(2, -2), "0.02");
        assert_eq!(rounded(5, 4), "50000");
        assert_eq!(rounded(5, -6), "5·10⁻⁶");
    }
}
