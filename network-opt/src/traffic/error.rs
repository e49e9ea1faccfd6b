//! What can go wrong with graphs, demand and simulation.

use std::path::PathBuf;

use crate::error::MeshError;

/// Why traffic could not be predicted or simulated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrafficError {
    /// A graph, a road or a class is not what it should be.
    #[error("the street graph does not fit together: {what}")]
    BadGraph {
        /// What is wrong, and where.
        what: String,
    },
    /// Demand names what does not exist, or is not a number.
    #[error("the demand does not fit the street graph: {what}")]
    BadDemand {
        /// What is wrong, and where.
        what: String,
    },
    /// An option is out of its range.
    #[error("an option is out of its range: {what}")]
    BadOption {
        /// Which, what it is, and what it may be.
        what: String,
    },
    /// The lines of the roads make no planar graph.
    #[error("the roads cannot be joined to a graph: {0}")]
    Linework(#[from] MeshError),
    /// No way leads from an origin to its destination.
    #[error("no way leads {}{}; join the streets, or check the one-way ones", list(.pairs), more(.pairs.len(), *.count))]
    Unreachable {
        /// Some of the pairs of nodes, origin first, ascending.
        pairs: Vec<(usize, usize)>,
        /// How many there are in all.
        count: usize,
    },
    /// A program of SUMO is not there.
    #[error(
        "the program {program} is not installed; it comes with SUMO (Debian: apt-get install sumo)"
    )]
    NoSumo {
        /// Its name.
        program: &'static str,
    },
    /// A program of SUMO failed.
    #[error("{program} failed: {what}")]
    SumoFailed {
        /// Its name.
        program: &'static str,
        /// What it said.
        what: String,
    },
    /// A file could not be written or read.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

/// Pairs that are named in a message.
pub(super) const NAMED: usize = 8;

fn list(pairs: &[(usize, usize)]) -> String {
    let words: Vec<String> = pairs
        .iter()
        .map(|(from, to)| format!("from node {from} to node {to}"))
        .collect();
    words.join(", ")
}

fn more(named: usize, count: usize) -> String {
    if count > named {
        format!(" and for {} pairs more", count - named)
    } else {
        String::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_pairs_and_packages() {
        let one = TrafficError::Unreachable {
            pairs: vec![(3, 5)],
            count: 1,
        };
        assert!(one
            .to_string()
            .starts_with("no way leads from node 3 to node 5; join"));
        let many = TrafficError::Unreachable {
            pairs: vec![(0, 1), (0, 2)],
            count: 7,
        };
        assert!(many.to_string().contains("and for 5 pairs more"));
        let none = TrafficError::NoSumo {
            program: "netconvert",
        };
        assert!(none.to_string().contains("apt-get install sumo"));
    }
}
