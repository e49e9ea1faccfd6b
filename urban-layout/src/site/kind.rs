//! The vocabulary of a site's file: units, road classes, elements.

use std::fmt;

/// What the numbers of a file are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Units {
    /// Longitude and latitude, unless the file says
    /// `"coordinate_units": "metres"`. Numbers that cannot be degrees are an
    /// error then, never a guess.
    #[default]
    Auto,
    /// Metres of any projection, whatever the file says.
    Metres,
    /// Longitude and latitude in degrees, whatever the file says.
    Degrees,
}

/// The class of a street or road.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum RoadClass {
    /// A through road: gives no frontage, and takes junctions at least 150 m
    /// apart.
    Major,
    /// Gathers local streets.
    Collector,
    /// A street to live in.
    Local,
    /// A street with one end.
    CulDeSac,
}

impl RoadClass {
    /// The word for it in files.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Major => "major",
            Self::Collector => "collector",
            Self::Local => "local",
            Self::CulDeSac => "cul_de_sac",
        }
    }

    /// The class of a word in a file; `None` for any other word.
    #[must_use]
    pub fn parse(word: &str) -> Option<Self> {
        [Self::Major, Self::Collector, Self::Local, Self::CulDeSac]
            .into_iter()
            .find(|class| class.as_str() == word)
    }

    /// The width of a given road that has none of its own, in metres.
    #[must_use]
    pub fn default_width(self) -> f64 {
        match self {
            Self::Major => 22.0,
            Self::Collector => 16.0,
            Self::Local | Self::CulDeSac => 12.0,
        }
    }
}

impl fmt::Display for RoadClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// What a given piece of land is. The order is that of precedence: where two
/// overlap, the first keeps the common part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ElementKind {
    /// Water.
    Lake,
    /// A park.
    Park,
    /// A landmark: a church, a school, a square.
    Landmark,
    /// Shops and offices.
    Commercial,
    /// Land kept for a use that is not planned here.
    Reserved,
}

impl ElementKind {
    /// The word for it in files.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Lake => "lake",
            Self::Park => "park",
            Self::Landmark => "landmark",
            Self::Commercial => "commercial",
            Self::Reserved => "reserved",
        }
    }

    /// The kind of a word in a file; `None` for any other word.
    #[must_use]
    pub fn parse(word: &str) -> Option<Self> {
        [
            Self::Lake,
            Self::Park,
            Self::Landmark,
            Self::Commercial,
            Self::Reserved,
        ]
        .into_iter()
        .find(|kind| kind.as_str() == word)
    }
}

impl fmt::Display for ElementKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_come_back() {
        for word in ["major", "collector", "local", "cul_de_sac"] {
            assert_eq!(RoadClass::parse(word).map(RoadClass::as_str), Some(word));
        }
        for word in ["lake", "park", "landmark", "commercial", "reserved"] {
            assert_eq!(
                ElementKind::parse(word).map(ElementKind::as_str),
                Some(word)
            );
        }
        assert_eq!(RoadClass::parse("Major"), None);
        assert_eq!(ElementKind::parse("site"), None);
    }
}
