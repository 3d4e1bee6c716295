//! Text in HTML, and numbers as people read them.

use serde_json::Value;

/// Text that may stand in an element or between the quotes of an attribute.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c => safe.push(c),
        }
    }
    safe
}

/// A time with the unit that suits it.
pub fn time(milliseconds: f64) -> String {
    match milliseconds {
        t if t < 10.0 => format!("{t:.1} ms"),
        t if t < 1e3 => format!("{t:.0} ms"),
        t if t < 12e4 => format!("{:.1} s", t / 1e3),
        t if t < 72e5 => format!("{:.0} min", t / 6e4),
        t => format!("{:.1} h", t / 36e5),
    }
}

/// A parameter's value as typed.
pub fn value(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), Into::into)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_a_text_is_markup() {
        assert_eq!(escape("<a href=\"x\">'&'"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;");
    }

    #[test]
    fn times_have_few_digits() {
        assert_eq!(
            [0.25, 41.4, 999.0, 1500.0, 6e5, 36e6].map(time),
            ["0.2 ms", "41 ms", "999 ms", "1.5 s", "10 min", "10.0 h"]
        );
    }
}
