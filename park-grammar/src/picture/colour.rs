//! Colours as they are mixed.

/// So much of a second colour in a first; both `#rrggbb`.
pub(super) fn mixed(first: &str, second: &str, share: f64) -> String {
    let (a, b) = (parts(first), parts(second));
    let part = |k: usize| (a[k] + (b[k] - a[k]) * share).round().clamp(0.0, 255.0) as u8;
    format!("#{:02x}{:02x}{:02x}", part(0), part(1), part(2))
}

pub(crate) fn darker(colour: &str, share: f64) -> String {
    mixed(colour, "#1e2a16", share)
}

pub(crate) fn lighter(colour: &str, share: f64) -> String {
    mixed(colour, "#ffffff", share)
}

/// Red, green and blue from 0 to 255; grey for what is no colour.
pub(crate) fn parts(colour: &str) -> [f64; 3] {
    let digits = colour.strip_prefix('#').unwrap_or_default();
    [0, 2, 4].map(|k| {
        let part = digits.get(k..k + 2);
        let part = part.and_then(|hex| u8::from_str_radix(hex, 16).ok());
        f64::from(part.unwrap_or(128))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_mixed() {
        assert_eq!(mixed("#000000", "#ff8040", 0.5), "#804020");
        assert_eq!(lighter("#102030", 0.0), "#102030");
        assert_eq!(mixed("grey", "#808080", 0.3), "#808080");
    }
}
