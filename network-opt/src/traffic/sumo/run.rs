//! Runs of SUMO's programs.

use std::path::Path;
use std::process::Command;

use super::files::SumoFiles;
use super::tripinfo;
use crate::traffic::TrafficError;

/// What SUMO says of the trips.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Simulated {
    /// One run for each seed.
    pub runs: Vec<SimulatedRun>,
    /// Mean metres of a trip, over all runs; 0 if there is none.
    pub mean_distance: f64,
    /// Mean seconds of a trip, over all runs; 0 if there is none.
    pub mean_time: f64,
}

/// What SUMO says of the trips with one seed.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SimulatedRun {
    /// The seed.
    pub seed: u64,
    /// Trips that have arrived.
    pub arrived: usize,
    /// Trips that should have.
    pub wanted: usize,
    /// Mean metres of a trip that has arrived; 0 if there is none.
    pub mean_distance: f64,
    /// Mean seconds on the way.
    pub mean_time: f64,
    /// Mean seconds before there was room on the street to set off, not part of
    /// the time on the way.
    pub mean_delay: f64,
}

/// Whether SUMO's three programs can be run here.
#[must_use]
pub fn is_installed() -> bool {
    ["netconvert", "duarouter", "sumo"].iter().all(|program| {
        let told = Command::new(program).arg("--version").output();
        told.is_ok_and(|output| output.status.success())
    })
}

impl SumoFiles {
    /// Writes the files into a folder that is there, builds the network, finds
    /// the ways, and simulates the trips once for each seed. What the programs
    /// write stays in the folder.
    ///
    /// # Errors
    ///
    /// [`TrafficError::NoSumo`] if a program is not installed;
    /// [`TrafficError::SumoFailed`] with what it said if one fails, or says what
    /// cannot be read; [`TrafficError::Io`].
    pub fn simulate(&self, folder: &Path, seeds: &[u64]) -> Result<Simulated, TrafficError> {
        self.write(folder)?;
        let file = |end: &str| format!("{}.{end}", self.name);
        // Schemas to check the files by would be looked for on the net.
        let unchecked = ["-X", "never", "--xml-validation.net", "never"];
        let routes = ["--xml-validation.routes", "never"];
        let words = |config: &str| -> Vec<String> {
            let mut words = vec!["-c".to_owned(), file(config)];
            words.extend(unchecked.map(str::to_owned));
            words
        };
        let route_words = |config: &str| {
            let mut words = words(config);
            words.extend(routes.map(str::to_owned));
            words
        };
        run(folder, "netconvert", &words("netccfg"))?;
        run(folder, "duarouter", &route_words("duarcfg"))?;
        let mut all = Simulated::default();
        let mut arrived = 0;
        for &seed in seeds {
            // SUMO takes signed 32 bits.
            let dice = (seed % (1 << 31)).to_string();
            let mut words = route_words("sumocfg");
            words.extend(["--seed".to_owned(), dice]);
            run(folder, "sumo", &words)?;
            let path = folder.join(file("tripinfo.xml"));
            let text = std::fs::read_to_string(&path)
                .map_err(|source| TrafficError::Io { path, source })?;
            let trips = tripinfo::read(&text).map_err(|what| TrafficError::SumoFailed {
                program: "sumo",
                what,
            })?;
            let count = trips.len();
            let mean = |of: fn(&tripinfo::TripInfo) -> f64| {
                trips.iter().map(of).sum::<f64>() / count.max(1) as f64
            };
            let found = SimulatedRun {
                seed,
                arrived: count,
                wanted: self.trips,
                mean_distance: mean(|t| t.length),
                mean_time: mean(|t| t.duration),
                mean_delay: mean(|t| t.delay),
            };
            all.mean_distance += found.mean_distance * count as f64;
            all.mean_time += found.mean_time * count as f64;
            arrived += count;
            all.runs.push(found);
        }
        all.mean_distance /= arrived.max(1) as f64;
        all.mean_time /= arrived.max(1) as f64;
        Ok(all)
    }
}

fn run(folder: &Path, program: &'static str, words: &[String]) -> Result<(), TrafficError> {
    let output = Command::new(program)
        .args(words)
        .current_dir(folder)
        .output();
    let failed = |what: String| TrafficError::SumoFailed { program, what };
    match output {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Err(TrafficError::NoSumo { program }),
        Err(e) => Err(failed(e.to_string())),
        Ok(output) if !output.status.success() => {
            let said = String::from_utf8_lossy(&output.stderr);
            let lines = said.lines().filter(|line| !line.trim().is_empty());
            let lines: Vec<&str> = lines.take(8).collect();
            Err(failed(lines.join("; ")))
        }
        Ok(_) => Ok(()),
    }
}
