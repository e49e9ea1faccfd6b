//! The whole way: a site in, a layout out.

use std::time::Instant;

use crate::assemble::assemble;
use crate::error::{Error, Result};
use crate::layout::Layout;
use crate::metrics::Seconds;
use crate::options::PlanOptions;
use crate::park;
use crate::planner::{self, seed::Path, Pending, Tree};
use crate::progress::{Progress, Stage};
use crate::site::Site;
use crate::splitter::{
    Action, NetworkSplitter, ParkFill, ReachSplitter, SkeletonParceler, Splitter,
    StreamlineSplitter, TemplateSplitter,
};

/// A finished plan: the layout, and the state from which regions of it can be
/// re-rolled.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The layout.
    pub layout: Layout,
    /// Where the time went.
    pub seconds: Seconds,
    tree: Tree,
    site: Site,
    options: PlanOptions,
}

/// Lays out a site.
///
/// # Errors
/// [`Error::is_usage`] for options out of range, [`Error::is_cancelled`] if
/// `progress` asks to stop.
pub fn generate(site: &Site, options: &PlanOptions, progress: &mut dyn Progress) -> Result<Plan> {
    let splitters = standard_splitters(options)?;
    generate_with(site, options, &splitters, progress)
}

/// The splitters that [`generate`] uses, in order of preference.
///
/// # Errors
/// If the options name a template that does not exist.
pub fn standard_splitters(options: &PlanOptions) -> Result<Vec<Box<dyn Splitter>>> {
    validate(options)?;
    let mut splitters: Vec<Box<dyn Splitter>> = vec![Box::new(TemplateSplitter::new(options)?)];
    if let Some(network) = &options.network {
        splitters.push(Box::new(NetworkSplitter::new(network.clone())));
    }
    splitters.extend::<[Box<dyn Splitter>; 4]>([
        Box::new(StreamlineSplitter),
        Box::new(ReachSplitter),
        Box::new(SkeletonParceler),
        Box::new(ParkFill),
    ]);
    Ok(splitters)
}

/// Lays out a site with splitters of one's own.
///
/// # Errors
/// As [`generate`].
pub fn generate_with(
    site: &Site,
    options: &PlanOptions,
    splitters: &[Box<dyn Splitter>],
    progress: &mut dyn Progress,
) -> Result<Plan> {
    validate(options)?;
    let start = Instant::now();
    let (mut tree, roots) = Tree::new(site)?;
    grow(&mut tree, site, roots, splitters, options, progress)?;
    let split = start.elapsed().as_secs_f64();
    planner::backtrack(&mut tree, site, splitters, options, progress)?;
    if options.network.is_some() && !planner::is_connected(&tree, site) {
        if let Some(other) = without_network(site, splitters, options, progress)? {
            tree = other;
        }
    }
    let begun = Begun {
        start,
        split,
        backtrack: start.elapsed().as_secs_f64() - split,
    };
    let everything = Path::everything();
    finish(
        tree,
        site,
        &everything,
        splitters,
        options,
        progress,
        &begun,
    )
}

/// The site split without networks, if that gives what they could not: streets
/// that are connected and lead out.
fn without_network(
    site: &Site,
    splitters: &[Box<dyn Splitter>],
    options: &PlanOptions,
    progress: &mut dyn Progress,
) -> Result<Option<Tree>> {
    let none = PlanOptions {
        network: None,
        ..options.clone()
    };
    let (mut tree, roots) = Tree::new(site)?;
    grow(&mut tree, site, roots, splitters, &none, progress)?;
    planner::backtrack(&mut tree, site, splitters, &none, progress)?;
    if !planner::is_connected(&tree, site) {
        return Ok(None);
    }
    tree.warnings.insert(
        Path::everything(),
        "the networks of the site's regions could not be joined to one that leads out; all streets follow a field \
         instead. Try another seed, or ask less of the levels"
            .to_owned(),
    );
    Ok(Some(tree))
}

/// When a run began, and the seconds that its search took.
struct Begun {
    start: Instant,
    split: f64,
    backtrack: f64,
}

/// Optimises and fills what lies below `root`, and assembles the layout.
fn finish(
    mut tree: Tree,
    site: &Site,
    root: &Path,
    splitters: &[Box<dyn Splitter>],
    options: &PlanOptions,
    progress: &mut dyn Progress,
    begun: &Begun,
) -> Result<Plan> {
    let begin = Instant::now();
    if options.optimize {
        planner::improve(&mut tree, root, options, progress)?;
    }
    let optimize = begin.elapsed().as_secs_f64();
    let begin = Instant::now();
    fill(&mut tree, root, splitters, options, progress)?;
    let filling = begin.elapsed().as_secs_f64();
    let begin = Instant::now();
    let mut layout = assemble(
        &tree,
        site,
        options.seed,
        options.street_width,
        options.min_frontage,
    );
    let assembling = begin.elapsed().as_secs_f64();
    let begin = Instant::now();
    park::design(&mut layout, options);
    let others = vec![
        ("fill".to_owned(), filling),
        ("assemble".to_owned(), assembling),
        ("parks".to_owned(), begin.elapsed().as_secs_f64()),
    ];
    let seconds = Seconds {
        split: begun.split,
        backtrack: begun.backtrack,
        optimize,
        total: begun.start.elapsed().as_secs_f64(),
        others,
        ..Seconds::default()
    };
    Ok(Plan {
        layout,
        seconds,
        tree,
        site: site.clone(),
        options: options.clone(),
    })
}

/// Splits regions to the end, and joins the network.
fn grow(
    tree: &mut Tree,
    site: &Site,
    pending: Vec<Pending>,
    splitters: &[Box<dyn Splitter>],
    options: &PlanOptions,
    progress: &mut dyn Progress,
) -> Result<()> {
    planner::split(tree, pending, splitters, options, progress)?;
    let more = planner::connect(tree, site, options);
    planner::split(tree, more, splitters, options, progress)
}

/// Fills the leaves below `root` for the shape that they now have: the
/// splitter that filled each is asked first.
fn fill(
    tree: &mut Tree,
    root: &Path,
    splitters: &[Box<dyn Splitter>],
    options: &PlanOptions,
    progress: &mut dyn Progress,
) -> Result<()> {
    if !progress.report(Stage::Fill, 0.0) {
        return Err(Error::cancelled());
    }
    let leaves: Vec<_> = tree.within(root).cloned().collect();
    let filled = planner::parallel::map(&leaves, options.threads, |leaf| {
        let region = tree.region(leaf.face, &leaf.path, options.seed);
        let scene = crate::splitter::Scene {
            network: &tree.network,
            options,
            draft: false,
        };
        let first = splitters.iter().filter(|s| s.name() == leaf.lineage.by);
        let rest = splitters.iter().filter(|s| s.name() != leaf.lineage.by);
        first.chain(rest).find_map(|s| {
            s.propose(&scene, &region)
                .into_iter()
                .find_map(|p| match p.action {
                    Action::Fill(fill) => Some((fill, p.lineage)),
                    Action::Cut(_) => None,
                })
        })
    });
    for (mut leaf, filled) in leaves.into_iter().zip(filled) {
        if let Some((fill, lineage)) = filled {
            leaf.fill = fill;
            leaf.lineage = lineage;
        }
        tree.leaves.insert(leaf.path.clone(), leaf);
    }
    Ok(())
}

/// Options in their ranges.
fn validate(options: &PlanOptions) -> Result<()> {
    let lengths = [
        ("parcel-length", options.parcel_length, 5.0, 500.0),
        ("parcel-width", options.parcel_width, 3.0, 500.0),
        ("street-width", options.street_width, 2.0, 100.0),
        (
            "min-frontage",
            options.min_frontage,
            0.0,
            options.parcel_width,
        ),
        (
            "block-length",
            options.block_length,
            2.0 * options.parcel_width,
            10_000.0,
        ),
    ];
    for (name, value, low, high) in lengths {
        if !(low..=high).contains(&value) {
            return Err(Error::usage(format!(
                "{name} is {value} m; it must lie between {low} and {high} m"
            )));
        }
    }
    if let Some(network) = &options.network {
        network.check()?;
    }
    if !(options.temperature >= 0.0 && options.temperature.is_finite()) {
        return Err(Error::usage(format!(
            "temperature is {}; it must be 0 or more",
            options.temperature
        )));
    }
    Ok(())
}

impl Plan {
    /// The site that the plan is of.
    #[must_use]
    pub fn site(&self) -> &Site {
        &self.site
    }

    /// The options that the plan was made with.
    #[must_use]
    pub fn options(&self) -> &PlanOptions {
        &self.options
    }

    /// The plan with the region at `path` (the `split` of a layout's features)
    /// split anew under another seed. Every other region keeps its result: its
    /// tiles do not change by a bit; the streets around the region keep their
    /// lines, but their junctions with what was and is inside come and go.
    ///
    /// # Errors
    /// [`Error::is_usage`] if no region has that path or a given road divides
    /// it, else as [`generate`].
    pub fn reroll(&self, path: &Path, seed: u64, progress: &mut dyn Progress) -> Result<Self> {
        let start = Instant::now();
        let splitters = standard_splitters(&self.options)?;
        let mut tree = self.tree.clone();
        let pending = planner::clear(&mut tree, path)?;
        tree.rerolled.insert(path.clone(), seed);
        planner::split(
            &mut tree,
            vec![pending],
            &splitters,
            &self.options,
            progress,
        )?;
        let begun = Begun {
            start,
            split: start.elapsed().as_secs_f64(),
            backtrack: 0.0,
        };
        finish(
            tree,
            &self.site,
            path,
            &splitters,
            &self.options,
            progress,
            &begun,
        )
    }

    /// What the user should know of how the plan came about, such as regions
    /// whose streets could not be laid as was asked for; empty as a rule.
    pub fn warnings(&self) -> impl Iterator<Item = &str> + '_ {
        self.tree.warnings.values().map(String::as_str)
    }

    /// The split tree and network behind the layout.
    #[must_use]
    pub fn tree(&self) -> &Tree {
        &self.tree
    }
}
