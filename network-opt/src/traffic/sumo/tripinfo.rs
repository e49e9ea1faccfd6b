//! What SUMO says of each trip, read.

/// A trip that has ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TripInfo {
    /// Metres.
    pub(super) length: f64,
    /// Seconds on the way.
    pub(super) duration: f64,
    /// Seconds before there was room to set off.
    pub(super) delay: f64,
}

/// The trips of a file that `tripinfo-output` wrote; the first element that is
/// not as it should be otherwise.
///
/// A scanner and no parser of XML: SUMO writes one element a trip, with quoted
/// attributes and ids that this crate gave.
pub(super) fn read(text: &str) -> Result<Vec<TripInfo>, String> {
    let mut trips = Vec::new();
    for element in text.split("<tripinfo ").skip(1) {
        let element = element.split('>').next().unwrap_or_default();
        let value = |name: &str| -> Result<f64, String> {
            attribute(element, name)
                .and_then(|value| value.parse::<f64>().ok())
                .filter(|value| value.is_finite())
                .ok_or_else(|| format!("no number `{name}` in: <tripinfo {element}>"))
        };
        trips.push(TripInfo {
            length: value("routeLength")?,
            duration: value("duration")?,
            delay: value("departDelay")?,
        });
    }
    Ok(trips)
}

/// The value of an attribute.
fn attribute<'t>(element: &'t str, wanted: &str) -> Option<&'t str> {
    let mut rest = element;
    loop {
        let (name, after) = rest.split_once('=')?;
        let after = after.trim_start();
        let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''))?;
        let (value, left) = after[1..].split_once(quote)?;
        if name.trim() == wanted {
            return Some(value);
        }
        rest = left;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_told_apart() {
        let text = "<tripinfos>\n <tripinfo id=\"t duration='1'\" depart=\"0.00\" departDelay=\"0.50\"\n duration='60' routeLength=\"512.25\"/>\n</tripinfos>";
        let trip = TripInfo {
            length: 512.25,
            duration: 60.0,
            delay: 0.5,
        };
        assert_eq!(read(text), Ok(vec![trip]));
        assert_eq!(read("<tripinfos></tripinfos>"), Ok(vec![]));
        assert_eq!(read(""), Ok(vec![]));
    }

    #[test]
    fn what_is_cut_off_is_an_error() {
        for text in [
            "<tripinfo id=\"t0\" duration=\"6",
            "<tripinfo duration=\"x\" routeLength=\"1\" departDelay=\"0\"/>",
            "<tripinfo duration=\"NaN\" routeLength=\"1\" departDelay=\"0\"/>",
            "<tripinfo =",
        ] {
            assert!(read(text).is_err(), "{text}");
        }
    }
}
