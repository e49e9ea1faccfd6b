//! Classes of streets: speed, lanes, capacity and priority.

/// A mile per hour in metres per second.
pub const MPH: f64 = 0.447_04;

/// What streets of one class have in common.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RoadClass {
    /// What it is called; any text.
    pub name: String,
    /// Speed of free traffic, metres per second. Positive.
    pub speed: f64,
    /// Lanes each way, 1 or more.
    pub lanes: usize,
    /// Vehicles per hour and lane at which congestion sets in: that of
    /// [`EquilibriumOptions`](super::EquilibriumOptions). Positive; infinite for
    /// a street that is never congested.
    pub capacity: f64,
    /// Which street has the right of way where two meet: the higher one. SUMO
    /// takes 0 to 99 well.
    pub priority: u32,
}

impl RoadClass {
    /// The four classes of the paper, with its speed limits (section 5.1):
    /// major roads 40 mph, collectors 30, local roads and cul-de-sacs 20.
    ///
    /// Lanes and capacities are ours, since the paper names none: one lane each
    /// way, and 900, 700, 500 and 300 vehicles per hour, streets whose junctions
    /// take half of the time of a lane or more.
    ///
    /// ```
    /// use network_opt::traffic::{RoadClass, MPH};
    ///
    /// let speeds = RoadClass::paper().map(|class| (class.speed / MPH).round());
    /// assert_eq!(speeds, [40.0, 30.0, 20.0, 20.0]);
    /// ```
    #[must_use]
    pub fn paper() -> [Self; 4] {
        let class = |name: &str, mph: f64, capacity: f64, priority: u32| Self {
            name: name.to_owned(),
            speed: mph * MPH,
            lanes: 1,
            capacity,
            priority,
        };
        [
            class("major", 40.0, 900.0, 9),
            class("collector", 30.0, 700.0, 7),
            class("local", 20.0, 500.0, 4),
            class("cul-de-sac", 20.0, 300.0, 2),
        ]
    }
}
