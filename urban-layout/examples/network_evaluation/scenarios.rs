//! Specifications that ask for different things of one site.

/// What is asked of the site, and how that is written.
pub(crate) struct Scenario {
    pub(crate) name: &'static str,
    pub(crate) asks: &'static str,
    /// What the first level has that others have not.
    first: &'static str,
    /// What the second has.
    second: &'static str,
    /// Where the first level's things are.
    places: &'static str,
}

/// Streets that lead to few places: no streets along the boundary, and so that
/// there may be a way at all, dead ends and narrow blocks where they must be.
const EXITS: &str = "length = 0.1\ntravel = 1.0\nrim = \"closed\"\n\
                     dead-ends = { weighted = 2.0 }\ntoo-close = { weighted = 5.0 }";

/// All of them, on `kotka_east`.
pub(crate) const SCENARIOS: [Scenario; 9] = [
    Scenario {
        name: "short",
        asks: "as few streets as will do",
        first: "length = 1.0\ntravel = 1e-4",
        second: "length = 1.0\ntravel = 1e-4",
        places: "",
    },
    Scenario {
        name: "mixed",
        asks: "short and quick",
        first: "length = 1.0\ntravel = 0.5",
        second: "length = 1.0\ntravel = 0.5",
        places: "",
    },
    Scenario {
        name: "quick",
        asks: "short ways to the boundary",
        first: "length = 0.1\ntravel = 1.0",
        second: "length = 0.1\ntravel = 1.0",
        places: "",
    },
    Scenario {
        name: "trees",
        asks: "short, dead ends allowed",
        first: "length = 1.0\ntravel = 1e-4\ndead-ends = \"free\"",
        second: "length = 1.0\ntravel = 1e-4\ndead-ends = \"free\"",
        places: "",
    },
    Scenario {
        name: "dense",
        asks: "a local street beside every place",
        first: "length = 1.0\ntravel = 0.5",
        second: "length = 1.0\ntravel = 0.5\ncoverage = { hops = 1 }",
        places: "",
    },
    Scenario {
        name: "through",
        asks: "short, with a collector from north to south",
        first: "length = 1.0\ntravel = 1e-4\ntoo-close = { weighted = 20.0 }",
        second: "length = 1.0\ntravel = 1e-4",
        places: "routes = [[[26.95973, 60.52205], [26.96016, 60.53059]]]",
    },
    Scenario {
        name: "park and lake",
        asks: "short, round two obstacles",
        first: "length = 1.0\ntravel = 1e-4",
        second: "length = 1.0\ntravel = 1e-4",
        places: "obstacles = [[[26.9545, 60.5235], [26.9580, 60.5235], [26.9580, 60.5248], [26.9545, 60.5248]], \
                 [[26.9610, 60.5265], [26.9635, 60.5265], [26.9635, 60.5280], [26.9610, 60.5280]]]",
    },
    Scenario {
        name: "three exits",
        asks: "three ways out, no streets along the boundary",
        first: EXITS,
        second: EXITS,
        places: "sinks = { at = [[26.95089, 60.52317], [26.96016, 60.53059], [26.95973, 60.52205]] }",
    },
    Scenario {
        name: "one exit",
        asks: "a single way out in the west, no streets along the boundary",
        first: EXITS,
        second: EXITS,
        places: "sinks = { at = [[26.95089, 60.52317]] }",
    },
];

impl Scenario {
    /// The specification, as `urban-layout network --spec` reads it: collectors,
    /// and local streets between them.
    pub(crate) fn spec(&self) -> String {
        let Self {
            first,
            second,
            places,
            ..
        } = self;
        format!(
            "edge-length = 70.0\n\
             [[level]]\nclass = \"collector\"\nwidth = 14.0\n[level.network]\n{first}\n\
             [level.places]\n{places}\n\
             [[level]]\nclass = \"local\"\nwidth = 9.0\n[level.network]\nsinks = \"streets\"\n{second}\n"
        )
    }
}
