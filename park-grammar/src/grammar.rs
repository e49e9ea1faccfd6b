//! A grammar: its rules, functions and parameters, read and checked.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::derive::{mesh_file, OBJECT};
use crate::error::ParkError;
use crate::mesh::Mesh;
use crate::rule;
use crate::syntax::ast::{
    Argument, Block, Body, Expr, ExprKind, File, Head, ItemKind, Meaning, Name, Operation, Size,
    Text,
};
use crate::syntax::{nearest, parse, Diagnostic, Diagnostics, Sources};

/// A rule: a name for operations on a region.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rule {
    pub(crate) name: Name,
    /// The name, to be shared by what the rule leaves.
    pub(crate) label: Arc<str>,
    pub(crate) places: Vec<Name>,
    pub(crate) body: Body,
}

/// A function: a name for operations or a value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Function {
    pub(crate) name: Name,
    pub(crate) places: Vec<Name>,
    pub(crate) meaning: Meaning,
}

/// A grammar that has been read and checked.
///
/// # Examples
///
/// ```
/// use park_grammar::Grammar;
///
/// let grammar = Grammar::new("grammar 1\nRegion -> Lawn")?;
/// assert_eq!(grammar.start(), "Region");
///
/// // All faults are reported at once, each where it is and with what to do.
/// let error = Grammar::new("grammar 1\nRegion -> Gird(2, 2) { Lawn }").unwrap_err();
/// assert!(error.to_string().contains("did you mean Grid?"));
/// # Ok::<(), park_grammar::ParkError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Grammar {
    sources: Sources,
    start: String,
    rules: BTreeMap<String, Rule>,
    functions: BTreeMap<String, Function>,
    /// In the order in which they are evaluated.
    params: Vec<(Name, Expr)>,
    /// By the names of their files.
    meshes: BTreeMap<String, Mesh>,
}

/// Gives the text of an included file, by the name that stands in `include`.
pub type Loader<'l> = dyn Fn(&str) -> Result<String, String> + 'l;

impl Grammar {
    /// A grammar from its text; it may not include others.
    ///
    /// # Errors
    ///
    /// [`ParkError::Grammar`] with all faults of the text.
    pub fn new(text: &str) -> Result<Self, ParkError> {
        Self::with_includes("grammar", text, &|name| {
            Err(format!(
                "{name} cannot be read: this grammar is a text without a place"
            ))
        })
    }

    /// A grammar from a file; what it includes lies beside it.
    ///
    /// # Errors
    ///
    /// [`ParkError::Grammar`] with all faults of the file and of those that it
    /// includes, a file that cannot be read among them.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ParkError> {
        let path = path.as_ref();
        let folder = path.parent().map(PathBuf::from).unwrap_or_default();
        let load =
            |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|e| e.to_string());
        let text = std::fs::read_to_string(path).map_err(|e| ParkError::File {
            what: format!("{}: {e}", path.display()),
        })?;
        Self::with_includes(&path.display().to_string(), &text, &load)
    }

    /// A grammar from its text, with the texts that it includes.
    ///
    /// # Errors
    ///
    /// [`ParkError::Grammar`] with all faults.
    pub fn with_includes(name: &str, text: &str, load: &Loader<'_>) -> Result<Self, ParkError> {
        let mut sources = Sources::default();
        let file = sources.add(name, text);
        let mut draft = Draft {
            grammar: Self {
                sources,
                start: String::new(),
                rules: BTreeMap::new(),
                functions: BTreeMap::new(),
                params: Vec::new(),
                meshes: BTreeMap::new(),
            },
            found: Vec::new(),
        };
        draft.file(file, load);
        draft.check();
        let Draft { grammar, mut found } = draft;
        if found.is_empty() {
            return Ok(grammar);
        }
        found.sort_by_key(|fault| (fault.span.file, fault.span.start));
        Err(ParkError::Grammar(Diagnostics {
            all: found,
            sources: grammar.sources,
        }))
    }

    /// The rule that a park begins with: `Region` if there is one, else the first.
    #[must_use]
    pub fn start(&self) -> &str {
        &self.start
    }

    /// The names of its parameters, which a caller may set.
    pub fn params(&self) -> impl Iterator<Item = &str> {
        self.params.iter().map(|(name, _)| name.text.as_str())
    }

    /// The texts that it was read from.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    pub(crate) fn param_values(&self) -> &[(Name, Expr)] {
        &self.params
    }

    pub(crate) fn mesh(&self, file: &str) -> Option<&Mesh> {
        self.meshes.get(file)
    }

    pub(crate) fn rule(&self, name: &str) -> Option<&Rule> {
        self.rules.get(name)
    }

    pub(crate) fn function(&self, name: &str) -> Option<&Function> {
        self.functions.get(name)
    }
}

struct Draft {
    grammar: Grammar,
    found: Vec<Diagnostic>,
}

impl Draft {
    fn file(&mut self, file: usize, load: &Loader<'_>) {
        match parse(&self.grammar.sources, file) {
            Ok(tree) => self.items(tree, load),
            Err(faults) => self.found.extend(faults.all),
        }
    }

    fn items(&mut self, tree: File, load: &Loader<'_>) {
        for item in tree.items {
            match item.kind {
                ItemKind::Include(text) => self.include(&text, load),
                ItemKind::Param { name, value } => {
                    if let Some(old) = self
                        .grammar
                        .params
                        .iter()
                        .find(|(n, _)| n.text == name.text)
                    {
                        let before = old.0.clone();
                        self.twice(&name, &before);
                    }
                    if let Some(file) = mesh_file(&value) {
                        self.mesh(&file, load);
                    }
                    self.grammar.params.push((name, value));
                }
                ItemKind::Function {
                    name,
                    places,
                    meaning,
                } => {
                    if let Some(old) = self.grammar.functions.get(&name.text) {
                        let before = old.name.clone();
                        self.twice(&name, &before);
                    }
                    let function = Function {
                        name: name.clone(),
                        places,
                        meaning,
                    };
                    self.grammar.functions.insert(name.text, function);
                }
                ItemKind::Rule { name, places, body } => {
                    if let Some(old) = self.grammar.rules.get(&name.text) {
                        let before = old.name.clone();
                        self.twice(&name, &before);
                    }
                    if self.grammar.start.is_empty() && name.span.file == 0 || name.text == "Region"
                    {
                        self.grammar.start.clone_from(&name.text);
                    }
                    let rule = Rule {
                        label: name.text.as_str().into(),
                        name: name.clone(),
                        places,
                        body,
                    };
                    self.grammar.rules.insert(name.text, rule);
                }
            }
        }
    }

    fn twice(&mut self, name: &Name, before: &Name) {
        let (line, _) = self.grammar.sources.position(before.span);
        let file = self.grammar.sources.name(before.span.file).unwrap_or("");
        let error = Diagnostic::new(name.span, format!("{} has been defined before", name.text));
        self.found.push(error.hint(format!(
            "it stands in line {line} of {file} too; rename one of them"
        )));
    }

    fn include(&mut self, text: &Text, load: &Loader<'_>) {
        let known = (0..).map_while(|k| self.grammar.sources.name(k));
        if known.into_iter().any(|name| name == text.text) {
            // Included once is enough, by whichever way.
            return;
        }
        match load(&text.text) {
            Ok(inner) => {
                let file = self.grammar.sources.add(&text.text, inner);
                self.file(file, load);
            }
            Err(what) => {
                let error = Diagnostic::new(text.span, format!("{} cannot be included", text.text));
                self.found.push(error.hint(what));
            }
        }
    }

    /// Reads the mesh of an object.
    fn mesh(&mut self, file: &Text, load: &Loader<'_>) {
        let read =
            load(&file.text).and_then(|text| Mesh::from_obj(&text).map_err(|e| e.to_string()));
        match read {
            Ok(mesh) => {
                self.grammar.meshes.insert(file.text.clone(), mesh);
            }
            Err(what) => {
                let error = Diagnostic::new(file.span, format!("{} is no mesh", file.text));
                self.found.push(error.hint(what));
            }
        }
    }

    /// That every name means something.
    fn check(&mut self) {
        if self.grammar.rules.is_empty() && self.found.is_empty() {
            let error = Diagnostic::new(Default::default(), "this grammar has no rule");
            self.found
                .push(error.hint("write Region -> and what a park is made of"));
        }
        let grammar = &self.grammar;
        let mut check = Check {
            grammar,
            found: Vec::new(),
        };
        for (_, value) in &grammar.params {
            check.expr(value, &[]);
        }
        for function in grammar.functions.values() {
            match &function.meaning {
                Meaning::Value(value) => check.expr(value, &function.places),
                Meaning::Body(body) => check.body(body, &function.places),
            }
        }
        for rule in grammar.rules.values() {
            check.body(&rule.body, &rule.places);
        }
        let found = check.found;
        self.found.extend(found);
    }
}

struct Check<'g> {
    grammar: &'g Grammar,
    found: Vec<Diagnostic>,
}

impl Check<'_> {
    fn body(&mut self, body: &Body, places: &[Name]) {
        for one in &body.operations {
            self.operation(one, places);
        }
    }

    fn operation(&mut self, one: &Operation, places: &[Name]) {
        let grammar = self.grammar;
        let name = one.name.text.as_str();
        let mut known: Vec<&str> = rule::names().collect();
        known.extend(grammar.rules.keys().map(String::as_str));
        known.extend(grammar.functions.keys().map(String::as_str));
        known.extend(grammar.params.iter().map(|(n, _)| n.text.as_str()));
        known.extend(places.iter().map(|p| p.text.as_str()));
        if !known.contains(&name) {
            let error = Diagnostic::new(one.name.span, format!("there is nothing called {name}"));
            self.found.push(match nearest(name, known.into_iter()) {
                Some(near) => error.hint(format!("did you mean {near}?")),
                None => error.hint(format!("write a rule for it: {name} -> ...")),
            });
        }
        for argument in one.arguments.iter().flatten() {
            self.argument(argument, places);
        }
        for block in one.blocks.iter().chain(&one.otherwise) {
            self.block(block, places);
        }
    }

    fn block(&mut self, block: &Block, places: &[Name]) {
        for branch in &block.branches {
            if let Some(Head::Value(value)) = &branch.head {
                self.expr(value, places);
            }
            self.body(&branch.body, places);
        }
    }

    fn argument(&mut self, argument: &Argument, places: &[Name]) {
        self.expr(&argument.value, places);
        if let Some(at) = &argument.at {
            self.expr(at, places);
        }
    }

    fn expr(&mut self, expr: &Expr, places: &[Name]) {
        match &expr.kind {
            ExprKind::Name(name) => self.word(name, expr, places),
            ExprKind::Call {
                name,
                arguments,
                blocks,
            } => {
                let mut known: Vec<&str> = rule::names().collect();
                known.extend(self.grammar.functions.keys().map(String::as_str));
                known.extend(crate::select::CALLS);
                known.extend(crate::derive::FUNCTIONS);
                known.push(OBJECT);
                if !known.contains(&name.text.as_str()) {
                    let error = Diagnostic::new(
                        name.span,
                        format!("there is nothing called {}", name.text),
                    );
                    self.found
                        .push(match nearest(&name.text, known.into_iter()) {
                            Some(near) => error.hint(format!("did you mean {near}?")),
                            None => error,
                        });
                }
                arguments.iter().for_each(|a| self.argument(a, places));
                blocks.iter().for_each(|b| self.block(b, places));
            }
            ExprKind::List(items) => items.iter().for_each(|e| self.expr(e, places)),
            ExprKind::Point(parts) | ExprKind::Span(parts) | ExprKind::Binary(_, parts) => {
                parts.iter().for_each(|e| self.expr(e, places));
            }
            ExprKind::Index(base, items) => {
                self.expr(base, places);
                items.iter().for_each(|e| self.expr(e, places));
            }
            ExprKind::Sizes { count, sizes } => {
                count.iter().for_each(|e| self.expr(e, places));
                for Size { length, angle } in sizes {
                    length
                        .iter()
                        .chain(angle)
                        .for_each(|e| self.expr(e, places));
                }
            }
            ExprKind::Unary(_, inner) => self.expr(inner, places),
            ExprKind::Number(..) | ExprKind::Text(_) => {}
        }
    }

    fn word(&mut self, name: &str, expr: &Expr, places: &[Name]) {
        let grammar = self.grammar;
        let mut known: Vec<&str> = rule::names().collect();
        known.extend(grammar.params.iter().map(|(n, _)| n.text.as_str()));
        known.extend(places.iter().map(|p| p.text.as_str()));
        known.extend(grammar.rules.keys().map(String::as_str));
        known.extend(rule::WORDS);
        known.extend(crate::select::NAMES);
        known.extend(crate::derive::ATTRIBUTES);
        if known.contains(&name) {
            return;
        }
        let error = Diagnostic::new(expr.span, format!("there is nothing called {name}"));
        self.found.push(match nearest(name, known.into_iter()) {
            Some(near) => error.hint(format!("did you mean {near}?")),
            None => error.hint(format!("give it a value: param {name} = ...")),
        });
    }
}
