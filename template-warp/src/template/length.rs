//! Lengths in template files: numbers of metres, or sums such as `"2l + 0.5s"`
//! of multiples of the parcel length `l`, the parcel width `w` and the street
//! width `s`, so that one drawing serves every size.

/// The sizes that the letters in a template file stand for, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// Parcel length (depth, away from the street), `l`. Default 30.
    pub parcel_length: f64,
    /// Parcel width (along the street), `w`. Default 18.
    pub parcel_width: f64,
    /// Street width, `s`. Default 15.
    pub street_width: f64,
}

impl Default for Sizes {
    fn default() -> Self {
        Self {
            parcel_length: 30.0,
            parcel_width: 18.0,
            street_width: 15.0,
        }
    }
}

impl Sizes {
    /// Area of the ideal parcel, square metres.
    #[must_use]
    pub fn parcel_area(&self) -> f64 {
        self.parcel_length * self.parcel_width
    }
}

/// A linear form in the sizes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(try_from = "Written")]
pub(crate) struct Length {
    metres: f64,
    l: f64,
    w: f64,
    s: f64,
}

/// The two ways to write a length.
#[derive(serde::Deserialize)]
#[serde(untagged)]
enum Written {
    Number(f64),
    Text(String),
}

impl TryFrom<Written> for Length {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        match written {
            Written::Number(metres) => Ok(Self {
                metres,
                l: 0.0,
                w: 0.0,
                s: 0.0,
            }),
            Written::Text(text) => Self::parse(&text),
        }
    }
}

impl Length {
    pub(crate) fn metres(&self, sizes: &Sizes) -> f64 {
        self.metres
            + self.l * sizes.parcel_length
            + self.w * sizes.parcel_width
            + self.s * sizes.street_width
    }

    fn parse(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "`{text}` is no length; write metres or a sum such as `2l + 0.5s` of l, w and s"
            )
        };
        let mut sum = Self {
            metres: 0.0,
            l: 0.0,
            w: 0.0,
            s: 0.0,
        };
        let compact: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let mut rest = compact.as_str();
        if rest.is_empty() {
            return Err(wrong());
        }
        while !rest.is_empty() {
            let sign = if rest.starts_with('-') { -1.0 } else { 1.0 };
            rest = rest.trim_start_matches(['+', '-']);
            let end = rest.find(['+', '-']).unwrap_or(rest.len());
            let (term, tail) = rest.split_at(end);
            rest = tail;
            let digits = term.trim_end_matches(['l', 'w', 's']);
            let factor = if digits.is_empty() {
                1.0
            } else {
                digits.parse::<f64>().map_err(|_| wrong())?
            };
            let value = sign * factor;
            match &term[digits.len()..] {
                "" if !digits.is_empty() => sum.metres += value,
                "l" => sum.l += value,
                "w" => sum.w += value,
                "s" => sum.s += value,
                _ => return Err(wrong()),
            }
        }
        Ok(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_read() {
        let sizes = Sizes::default();
        let of = |t: &str| Length::parse(t).unwrap().metres(&sizes);
        assert_eq!(of("2l + 0.5s"), 67.5);
        assert_eq!(of("-w"), -18.0);
        assert_eq!(of("3 - 2w+l"), -3.0);
        assert_eq!(of("0"), 0.0);
    }

    #[test]
    fn nonsense_is_refused_with_the_text_in_the_message() {
        for text in ["", "2x", "l w", "2ll", "+", "1.2.3w"] {
            assert!(Length::parse(text).unwrap_err().contains(text), "{text}");
        }
    }
}
