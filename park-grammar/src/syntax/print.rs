//! The one way to write a tree.

use std::fmt::Write as _;

use super::ast::{
    Argument, BinaryOp, Block, Body, Branch, Expr, ExprKind, File, Head, Item, ItemKind, Meaning,
    Operation, Size, UnaryOp,
};

/// Longest line, characters, that is not broken where it could be.
const WIDEST: usize = 96;
const STEP: &str = "    ";

/// Writes a tree: what `parse` reads from it is the same tree, and printing that
/// gives the same text.
#[must_use]
pub fn print(file: &File) -> String {
    let mut out = String::new();
    comments(&mut out, &file.head, "");
    let _ = writeln!(out, "grammar {}", file.version);
    let mut before: Option<&ItemKind> = None;
    for entry in &file.items {
        // Parameters and includes keep together.
        let short = |kind| matches!(kind, &ItemKind::Param { .. } | &ItemKind::Include(_));
        let together = before.is_some_and(|b| short(b) && short(&entry.kind));
        if !together || !entry.comments.is_empty() {
            out.push('\n');
        }
        item(&mut out, entry);
        before = Some(&entry.kind);
    }
    if !file.foot.is_empty() {
        out.push('\n');
    }
    comments(&mut out, &file.foot, "");
    out
}

fn comments(out: &mut String, lines: &[String], indent: &str) {
    for comment in lines {
        if comment.contains('\n') {
            let _ = writeln!(out, "{indent}/* {comment} */");
        } else if comment.is_empty() {
            let _ = writeln!(out, "{indent}//");
        } else {
            let _ = writeln!(out, "{indent}// {comment}");
        }
    }
}

fn item(out: &mut String, item: &Item) {
    comments(out, &item.comments, "");
    match &item.kind {
        ItemKind::Include(text) => {
            let _ = write!(out, "include {}", quoted(&text.text));
        }
        ItemKind::Param { name, value } => {
            let _ = write!(out, "param {} = {}", name.text, expr(value));
        }
        ItemKind::Function {
            name,
            places,
            meaning,
        } => {
            let places: Vec<&str> = places.iter().map(|p| p.text.as_str()).collect();
            let _ = write!(out, "fun {}({})", name.text, places.join(", "));
            match meaning {
                Meaning::Value(value) => {
                    let _ = write!(out, " = {}", expr(value));
                }
                Meaning::Body(inner) => arrow(out, inner),
            }
        }
        ItemKind::Rule { name, places, body } => {
            out.push_str(&name.text);
            if !places.is_empty() {
                let places: Vec<&str> = places.iter().map(|p| p.text.as_str()).collect();
                let _ = write!(out, "({})", places.join(", "));
            }
            arrow(out, body);
        }
    }
    out.push('\n');
}

/// The arrow and what follows it, on its line if one operation fits there.
fn arrow(out: &mut String, inner: &Body) {
    out.push_str(" ->");
    let line = out.rsplit('\n').next().map_or(0, |l| l.chars().count());
    if let [only] = inner.operations.as_slice() {
        if only.comments.is_empty() {
            out.push(' ');
            operation(out, only, "", line + 1);
            return;
        }
    }
    body_lines(out, inner, STEP);
}

/// Each operation on a line of its own, after a line break.
fn body_lines(out: &mut String, inner: &Body, indent: &str) {
    for one in &inner.operations {
        out.push('\n');
        comments(out, &one.comments, indent);
        out.push_str(indent);
        operation(out, one, indent, indent.len());
    }
}

/// An operation whose first character is at `column`; further lines begin with
/// `indent`.
fn operation(out: &mut String, one: &Operation, indent: &str, column: usize) {
    let flat = flat_operation(one);
    if let Some(flat) = flat.filter(|flat| column + flat.chars().count() <= WIDEST) {
        out.push_str(&flat);
        return;
    }
    out.push_str(&opening(one));
    for inner in &one.blocks {
        out.push(' ');
        block(out, inner, indent);
    }
    if let Some(inner) = &one.otherwise {
        out.push_str(" else ");
        block(out, inner, indent);
    }
}

/// A block, broken into lines if it holds anything.
fn block(out: &mut String, inner: &Block, indent: &str) {
    if inner.branches.is_empty() {
        out.push_str("{}");
        return;
    }
    let deeper = format!("{indent}{STEP}");
    out.push('{');
    for (k, branch) in inner.branches.iter().enumerate() {
        let bar = if k > 0 { "| " } else { "" };
        match (flat_branch(branch), &branch.head) {
            (Some(flat), _) if deeper.len() + bar.len() + flat.chars().count() <= WIDEST => {
                let _ = write!(out, "\n{deeper}{bar}{flat}");
            }
            (_, head) => {
                let words = head.as_ref().map(head_words).unwrap_or_default();
                let opening = format!("{bar}{words}");
                if opening.is_empty() {
                    body_lines(out, &branch.body, &deeper);
                } else {
                    let _ = write!(out, "\n{deeper}{}", opening.trim_end());
                    body_lines(out, &branch.body, &format!("{deeper}{STEP}"));
                }
            }
        }
    }
    let _ = write!(out, "\n{indent}}}");
}

fn head_words(head: &Head) -> String {
    match head {
        Head::Value(value) => format!("{}: ", expr(value)),
        Head::Else(_) => "else: ".to_owned(),
    }
}

/// An operation on one line; `None` if it holds comments.
fn flat_operation(one: &Operation) -> Option<String> {
    let mut out = opening(one);
    for inner in &one.blocks {
        out.push(' ');
        out += &flat_block(inner)?;
    }
    if let Some(inner) = &one.otherwise {
        out.push_str(" else ");
        out += &flat_block(inner)?;
    }
    Some(out)
}

fn flat_block(inner: &Block) -> Option<String> {
    let branches: Option<Vec<String>> = inner.branches.iter().map(flat_branch).collect();
    let branches = branches?;
    Some(match branches.as_slice() {
        [] => "{}".to_owned(),
        [only] if only.is_empty() => EMPTY_BRANCH.to_owned(),
        _ => format!("{{ {} }}", branches.join(" | ")),
    })
}

/// A block with one branch without anything in it is not one without branches;
/// both read as the same, so that the printer writes the one that is.
const EMPTY_BRANCH: &str = "{}";

fn flat_branch(branch: &Branch) -> Option<String> {
    let mut out = branch.head.as_ref().map(head_words).unwrap_or_default();
    for (k, one) in branch.body.operations.iter().enumerate() {
        if !one.comments.is_empty() {
            return None;
        }
        if k > 0 {
            out.push(' ');
        }
        out += &flat_operation(one)?;
    }
    Some(out.trim_end().to_owned())
}

/// Name and arguments.
fn opening(one: &Operation) -> String {
    match &one.arguments {
        Some(list) => format!("{}({})", one.name.text, arguments(list)),
        None => one.name.text.clone(),
    }
}

fn arguments(list: &[Argument]) -> String {
    let words = list.iter().map(|argument| {
        let mut out = String::new();
        if let Some(name) = &argument.name {
            let _ = write!(out, "{} = ", name.text);
        }
        out += &expr(&argument.value);
        if let Some(at) = &argument.at {
            let _ = write!(out, ": {}", expr(at));
        }
        out
    });
    words.collect::<Vec<_>>().join(", ")
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

fn expr(value: &Expr) -> String {
    match &value.kind {
        ExprKind::Number(number, unit) => match unit.as_str() {
            "" | "%" => format!("{number}{}", unit.as_str()),
            word => format!("{number} {word}"),
        },
        ExprKind::Text(text) => quoted(text),
        ExprKind::Name(name) => name.clone(),
        ExprKind::Call {
            name,
            arguments: list,
            blocks,
        } => {
            let mut out = format!("{}({})", name.text, arguments(list));
            for inner in blocks {
                out.push(' ');
                // Comments cannot stand within a value: parsing moves them out.
                out += &flat_block(inner).unwrap_or_default();
            }
            out
        }
        ExprKind::List(items) => format!("[{}]", listed(items)),
        ExprKind::Point(parts) => format!("({}, {})", expr(&parts[0]), expr(&parts[1])),
        ExprKind::Index(base, items) => format!("{}[{}]", tight(base, false), listed(items)),
        ExprKind::Span(ends) => format!("{}..{}", expr(&ends[0]), expr(&ends[1])),
        ExprKind::Sizes { count, sizes } => {
            let sizes: Vec<String> = sizes.iter().map(size).collect();
            let sizes = format!("{{{}}}", sizes.join(", "));
            match count {
                Some(count) => format!("{} {sizes}", tight(count, true)),
                None => sizes,
            }
        }
        ExprKind::Unary(UnaryOp::Negate, inner) => format!("-{}", loose(inner, u8::MAX)),
        ExprKind::Unary(UnaryOp::Not, inner) => {
            format!("not {}", loose(inner, BinaryOp::Equal.strength()))
        }
        ExprKind::Binary(op, sides) => {
            // Those of the same strength are done from the left; comparisons
            // do not follow each other.
            let right = op.strength() + 1;
            let left = if op.compares() { right } else { op.strength() };
            format!(
                "{} {} {}",
                loose(&sides[0], left),
                op.as_str(),
                loose(&sides[1], right)
            )
        }
    }
}

/// Items of a list; a difference that stands alone is in brackets, as it would
/// be a range.
fn listed(items: &[Expr]) -> String {
    if let [only] = items {
        if matches!(only.kind, ExprKind::Binary(BinaryOp::Subtract, _)) {
            return format!("({})", expr(only));
        }
    }
    items.iter().map(expr).collect::<Vec<_>>().join(", ")
}

fn size(one: &Size) -> String {
    let mut out = String::new();
    if let Some(length) = &one.length {
        let words = expr(length);
        // A name that could be the mark of an angle.
        let marked = words.strip_prefix('a').is_some_and(|rest| {
            rest.trim_start().starts_with(['[', '-']) || rest.starts_with(" -")
        });
        out += &if marked { format!("({words})") } else { words };
    }
    if let Some(angle) = &one.angle {
        if !out.is_empty() && !out.ends_with(']') {
            out.push(' ');
        }
        let words = expr(angle);
        let gap = if words.starts_with(['[', '-']) {
            ""
        } else {
            " "
        };
        let _ = write!(out, "a{gap}{words}");
    }
    out
}

/// A value that is done before an operator of strength `least`.
fn loose(value: &Expr, least: u8) -> String {
    let binds = match &value.kind {
        ExprKind::Binary(op, _) => op.strength() >= least,
        // `not` would take what follows it.
        ExprKind::Unary(UnaryOp::Not, _) => least < BinaryOp::Equal.strength(),
        _ => true,
    };
    if binds {
        expr(value)
    } else {
        format!("({})", expr(value))
    }
}

/// A value that something in brackets follows; calls take braces for blocks.
fn tight(value: &Expr, braces: bool) -> String {
    let open = match &value.kind {
        ExprKind::Unary(..) | ExprKind::Binary(..) | ExprKind::Sizes { .. } => true,
        ExprKind::Call { .. } => braces,
        _ => false,
    };
    if open {
        format!("({})", expr(value))
    } else {
        expr(value)
    }
}
