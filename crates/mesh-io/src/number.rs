//! Numbers as text, both ways, bit for bit.

/// Powers of ten that an f64 holds exactly.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// The value of a whole token: what [`str::parse`] gives, bit for bit, only sooner. Hexadecimal, `1,5` and `1d3` are
/// no numbers. `inf` and `nan` are; the caller decides about them.
pub(crate) fn parse_f64(token: &[u8]) -> Option<f64> {
    match plain_decimal(token) {
        Some((value, length)) if length == token.len() => Some(value),
        _ => std::str::from_utf8(token).ok()?.parse().ok(),
    }
}

/// Reads a decimal number at the start of `text` where one exact multiplication or division gives it correctly
/// rounded: at most 19 digits that fit 53 bits, and a power of ten up to 22 (\[Clinger1990\]). Returns the value and
/// the number of bytes read.
#[inline]
pub(crate) fn plain_decimal(text: &[u8]) -> Option<(f64, usize)> {
    let mut at = 0;
    let negative = match text.first()? {
        b'-' => {
            at = 1;
            true
        }
        b'+' => {
            at = 1;
            false
        }
        _ => false,
    };
    let (mut mantissa, mut digits, mut exponent) = (0u64, 0usize, 0i32);
    let whole = at;
    while let Some(d) = digit(text, at) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(d);
        at += 1;
    }
    digits += at - whole;
    if text.get(at) == Some(&b'.') {
        at += 1;
        let fraction = at;
        while let Some(eight) = eight_digits(text, at) {
            mantissa = mantissa.wrapping_mul(100_000_000).wrapping_add(eight);
            at += 8;
        }
        while let Some(d) = digit(text, at) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(d);
            at += 1;
        }
        digits += at - fraction;
        exponent = -i32::try_from(at - fraction).ok()?;
    }
    if let Some(b'e' | b'E') = text.get(at) {
        at += 1;
        let minus = match text.get(at) {
            Some(b'-') => {
                at += 1;
                true
            }
            Some(b'+') => {
                at += 1;
                false
            }
            _ => false,
        };
        let (start, mut power) = (at, 0i32);
        while let Some(d) = digit(text, at) {
            power = power.saturating_mul(10).saturating_add(d as i32);
            at += 1;
        }
        if at == start {
            return None;
        }
        exponent = exponent.saturating_add(if minus { -power } else { power });
    }
    if digits == 0 || digits > 19 || mantissa > 1 << 53 || exponent.unsigned_abs() > 22 {
        return None;
    }
    let power = EXACT_POWERS[exponent.unsigned_abs() as usize];
    let value = if exponent < 0 { mantissa as f64 / power } else { mantissa as f64 * power };
    Some((if negative { -value } else { value }, at))
}

#[inline]
fn digit(text: &[u8], at: usize) -> Option<u64> {
    let d = text.get(at)?.wrapping_sub(b'0');
    (d < 10).then_some(u64::from(d))
}

/// Eight digits at once, where eight stand: pairs of digits, of pairs and of fours are joined in the lanes of one word.
#[inline]
fn eight_digits(text: &[u8], at: usize) -> Option<u64> {
    let word = u64::from_le_bytes(*text.get(at..)?.first_chunk()?);
    let digits = word.wrapping_sub(0x3030_3030_3030_3030);
    // A byte below `0` borrows and one above `9` carries into the high half of its own or the next.
    if (digits | word.wrapping_add(0x4646_4646_4646_4646)) & 0x8080_8080_8080_8080 != 0 {
        return None;
    }
    let pairs = (digits.wrapping_mul(10) + (digits >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs.wrapping_mul(100) + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    Some((fours.wrapping_mul(10_000) + (fours >> 32)) & 0xffff_ffff)
}

/// Appends the shortest decimal that reads back as `x`, bit for bit.
pub(crate) fn push_f64(out: &mut Vec<u8>, x: f64) {
    // Most coordinates were typed or exported with six digits. A quotient of integers below 2^53 and 10^6 is
    // correctly rounded, so this decimal reads back as `x`; below 16 digits no shorter one can.
    let millionths = x * 1e6;
    if millionths.abs() < 1e15 {
        let rounded = millionths.round();
        if rounded / 1e6 == x && rounded != 0.0 {
            if x < 0.0 {
                out.push(b'-');
            }
            let n = rounded.abs() as u64;
            push_u64(out, n / 1_000_000);
            let (mut fraction, mut places) = (n % 1_000_000, 6);
            if fraction != 0 {
                while fraction.is_multiple_of(10) {
                    fraction /= 10;
                    places -= 1;
                }
                let mut text = [b'0'; 6];
                for slot in text[..places].iter_mut().rev() {
                    *slot = b'0' + (fraction % 10) as u8;
                    fraction /= 10;
                }
                out.push(b'.');
                out.extend_from_slice(&text[..places]);
            }
            return;
        }
    }
    let start = out.len();
    // serde_json prints the shortest round-trip form and writing to a Vec cannot fail.
    let _ = serde_json::to_writer(&mut *out, &x);
    if out[start..].ends_with(b".0") {
        out.truncate(out.len() - 2);
    }
}

/// Appends a decimal integer.
pub(crate) fn push_u64(out: &mut Vec<u8>, mut n: u64) {
    let mut text = [0u8; 20];
    let mut at = text.len();
    loop {
        at -= 1;
        text[at] = b'0' + (n % 10) as u8;
        n /= 10;
        if n == 0 {
            break;
        }
    }
    out.extend_from_slice(&text[at..]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn printed(x: f64) -> String {
        let mut out = vec![];
        push_f64(&mut out, x);
        String::from_utf8(out).unwrap()
    }

    proptest! {
        #[test]
        fn parses_as_std_does(text in "[+-]?[0-9]{0,22}(\\.[0-9]{0,22})?([eE][+-]?[0-9]{0,4})?") {
            let (ours, std) = (parse_f64(text.as_bytes()), text.parse::<f64>().ok());
            prop_assert_eq!(ours.map(f64::to_bits), std.map(f64::to_bits), "{}", text);
        }

        #[test]
        fn eight_digits_are_as_one_by_one(text in prop::collection::vec(prop_oneof![9 => b'0'..=b'9', 1 => 0u8..=255], 8)) {
            let one_by_one = text.iter().try_fold(0, |n, &b| b.is_ascii_digit().then(|| 10 * n + u64::from(b - b'0')));
            prop_assert_eq!(eight_digits(&text, 0), one_by_one);
        }

        #[test]
        fn every_double_survives(bits: u64) {
            let x = f64::from_bits(bits);
            prop_assume!(x.is_finite());
            prop_assert_eq!(parse_f64(printed(x).as_bytes()).unwrap().to_bits(), bits);
        }

        #[test]
        fn short_decimals_print_as_typed(n in -999_999_999_999_999i64..999_999_999_999_999, places in 0i32..7) {
            let x = n as f64 / 10f64.powi(places);
            prop_assert_eq!(parse_f64(printed(x).as_bytes()).unwrap().to_bits(), x.to_bits());
            if x.abs() >= 1e-5 {
                let std = format!("{x}");
                prop_assert!(printed(x).len() <= std.len());
            }
        }
    }

    #[test]
    fn odd_spellings() {
        for text in ["1.", ".5", "+2.e1", "-0", "1E+2", "1e0", "00012.500"] {
            assert_eq!(
                parse_f64(text.as_bytes()).map(f64::to_bits),
                Some(text.parse::<f64>().unwrap().to_bits()),
                "{text}"
            );
        }
        for text in ["", "-", ".", "e5", "3.1+e2", "1,5", "0x10", "1d3", "1e"] {
            assert_eq!(parse_f64(text.as_bytes()), None, "{text}");
        }
        assert_eq!([0.0, -0.0, 1.0, -0.1, 2.5e14].map(printed), ["0", "-0", "1", "-0.1", "250000000000000"]);
    }
}
