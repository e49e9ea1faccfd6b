//! A library of templates: read from data files, sized, subset.

use crate::error::WarpError;
use crate::registration::Deformation;
use crate::template::format::{File, Spec};
use crate::template::length::Sizes;
use crate::template::model::Template;
use std::sync::Arc;

/// The files of the standard library, in the order of preference at equal cost.
const STANDARD: &[(&str, &str)] = &[
    ("rows", include_str!("library/rows.toml")),
    ("corners", include_str!("library/corners.toml")),
    ("wedges", include_str!("library/wedges.toml")),
    ("parks", include_str!("library/parks.toml")),
    ("spikes", include_str!("library/spikes.toml")),
];

/// Templates with the sizes that their letters stand for.
///
/// ```
/// use template_warp::Library;
///
/// let library = Library::standard();
/// assert!(library.names().contains(&"double-row"));
/// // Narrow town-house plots on narrow streets.
/// let town = library.with_sizes(24.0, 7.0, 9.0);
/// assert_eq!(town.sizes().parcel_width, 7.0);
/// ```
#[derive(Clone, Debug)]
pub struct Library {
    specs: Vec<Spec>,
    sizes: Sizes,
    templates: Vec<Template>,
    mirrored: Vec<Option<Template>>,
    /// Deformation classes that replace the files' own, by face label.
    classes: Vec<(String, Arc<dyn Deformation>)>,
}

impl Library {
    /// The library that comes with the crate, for parcels of 30 x 18 m and
    /// streets of 15 m.
    #[must_use]
    pub fn standard() -> Self {
        let specs = STANDARD.iter().flat_map(|(name, text)| {
            let file: File =
                toml::from_str(text).unwrap_or_else(|e| unreachable!("embedded file {name}: {e}"));
            file.template
        });
        Self::build(specs.collect(), Sizes::default(), Vec::new())
            .unwrap_or_else(|e| unreachable!("the embedded templates are tested: {e}"))
    }

    /// Reads a library file; the format is described in `src/library/README.md`.
    ///
    /// # Errors
    ///
    /// [`WarpError::Format`] with line and column if the text is no such file,
    /// [`WarpError::BadTemplate`] if a template contradicts itself.
    pub fn from_toml(text: &str) -> Result<Self, WarpError> {
        let file: File = toml::from_str(text).map_err(|e| WarpError::Format {
            message: e.to_string(),
        })?;
        Self::build(file.template, Sizes::default(), Vec::new())
    }

    /// This library followed by another one, with this one's sizes.
    ///
    /// # Errors
    ///
    /// [`WarpError::BadTemplate`] if both have a template of the same name.
    pub fn join(&self, other: &Self) -> Result<Self, WarpError> {
        let specs = self.specs.iter().chain(&other.specs).cloned().collect();
        Self::build(specs, self.sizes, self.classes.clone())
    }

    fn build(
        specs: Vec<Spec>,
        sizes: Sizes,
        classes: Vec<(String, Arc<dyn Deformation>)>,
    ) -> Result<Self, WarpError> {
        let mut templates: Vec<Template> = Vec::with_capacity(specs.len());
        for spec in &specs {
            let mut template = Template::build(spec, &sizes)?;
            for face in &mut template.faces {
                if let Some((_, class)) = classes.iter().find(|(label, _)| *label == face.label) {
                    face.class = class.clone();
                }
            }
            if templates.iter().any(|t| t.name == template.name) {
                return Err(WarpError::BadTemplate {
                    template: template.name,
                    problem: "two templates have this name; rename one".into(),
                });
            }
            templates.push(template);
        }
        let mirrored = templates
            .iter()
            .map(|t| t.mirror.then(|| t.mirrored()))
            .collect();
        Ok(Self {
            specs,
            sizes,
            templates,
            mirrored,
            classes,
        })
    }

    /// The templates with these names and those that they need as children, in
    /// the order of the library.
    ///
    /// # Errors
    ///
    /// [`WarpError::UnknownTemplate`] if a name is not in the library.
    pub fn subset(&self, names: &[&str]) -> Result<Self, WarpError> {
        let mut keep = vec![false; self.templates.len()];
        let mut queue: Vec<&str> = names.to_vec();
        while let Some(name) = queue.pop() {
            let k = self.index(name)?;
            if !std::mem::replace(&mut keep[k], true) {
                queue.extend(
                    self.templates[k]
                        .faces
                        .iter()
                        .flat_map(|f| f.child.iter().map(String::as_str)),
                );
            }
        }
        let specs = self
            .specs
            .iter()
            .zip(&keep)
            .filter(|(_, &k)| k)
            .map(|(s, _)| s.clone())
            .collect();
        Self::build(specs, self.sizes, self.classes.clone())
    }

    /// The same templates for other sizes, in metres.
    ///
    /// Sizes that are not positive and finite, or for which a template cannot be
    /// drawn (a bulb wider than its block, for instance), leave the library as it
    /// is: see [`Library::try_with_sizes`] for the reason.
    #[must_use]
    pub fn with_sizes(&self, parcel_length: f64, parcel_width: f64, street_width: f64) -> Self {
        self.try_with_sizes(Sizes {
            parcel_length,
            parcel_width,
            street_width,
        })
        .unwrap_or_else(|_| self.clone())
    }

    /// The same templates for other sizes.
    ///
    /// # Errors
    ///
    /// [`WarpError::BadOption`] for a size that is not positive and finite;
    /// [`WarpError::BadTemplate`] if a template cannot be drawn with them.
    pub fn try_with_sizes(&self, sizes: Sizes) -> Result<Self, WarpError> {
        for (option, value) in [
            ("parcel_length", sizes.parcel_length),
            ("parcel_width", sizes.parcel_width),
            ("street_width", sizes.street_width),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(WarpError::BadOption { option, value });
            }
        }
        Self::build(self.specs.clone(), sizes, self.classes.clone())
    }

    /// The same templates with another deformation class for all faces of a
    /// label.
    ///
    /// # Errors
    ///
    /// None at present; the signature leaves room for checks.
    pub fn with_deformation(
        &self,
        label: &str,
        class: Arc<dyn Deformation>,
    ) -> Result<Self, WarpError> {
        let mut classes = self.classes.clone();
        classes.retain(|c| c.0 != label);
        classes.push((label.to_owned(), class));
        Self::build(self.specs.clone(), self.sizes, classes)
    }

    /// Names of all templates, children included, in the order of the library.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        self.templates.iter().map(|t| t.name.as_str()).collect()
    }

    /// Names of the templates that match regions with the given label.
    #[must_use]
    pub fn names_for(&self, label: &str) -> Vec<&str> {
        self.templates
            .iter()
            .filter(|t| t.label == label)
            .map(|t| t.name.as_str())
            .collect()
    }

    /// All templates.
    #[must_use]
    pub fn templates(&self) -> &[Template] {
        &self.templates
    }

    /// The sizes that the letters in the files stand for.
    #[must_use]
    pub fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn index(&self, name: &str) -> Result<usize, WarpError> {
        self.templates
            .iter()
            .position(|t| t.name == name)
            .ok_or_else(|| WarpError::UnknownTemplate {
                name: name.to_owned(),
                known: self.names().join(", "),
            })
    }

    pub(crate) fn find(&self, name: &str) -> Result<&Template, WarpError> {
        self.index(name).map(|k| &self.templates[k])
    }

    /// A template or its mirror image.
    pub(crate) fn variant(&self, k: usize, mirrored: bool) -> Result<&Template, WarpError> {
        let stray = || WarpError::BadCandidate {
            problem: format!("it names template {k}, mirrored: {mirrored}"),
        };
        if mirrored {
            self.mirrored
                .get(k)
                .and_then(Option::as_ref)
                .ok_or_else(stray)
        } else {
            self.templates.get(k).ok_or_else(stray)
        }
    }
}
