//! Laws of the language: what is printed is read as it was, and no text, however
//! broken, makes the parser panic or hang.

mod common;

use park_grammar::syntax::ast::{
    Argument, BinaryOp, Block, Body, Branch, Expr, ExprKind, File, Head, Item, ItemKind, Meaning,
    Name, Operation, Size, Span, Text, UnaryOp, Unit,
};
use park_grammar::syntax::{parse, print, Sources, RESERVED, VERSION};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;

use common::config;

fn read(text: &str) -> Result<File, park_grammar::syntax::Diagnostics> {
    let mut sources = Sources::default();
    sources.add("random.park", text);
    parse(&sources, 0)
}

/// Words that mean something elsewhere are among them: units, marks of angles,
/// first words of items.
fn word() -> impl Strategy<Value = String> {
    prop_oneof![
        "[A-Za-z_][A-Za-z0-9_]{0,6}",
        Just("a".to_owned()),
        Just("m".to_owned()),
        Just("grammar".to_owned()),
        Just("Ärea".to_owned()),
    ]
    .prop_filter("reserved", |w| !RESERVED.contains(&w.as_str()))
}

fn name() -> impl Strategy<Value = Name> {
    word().prop_map(|text| Name {
        text,
        span: Span::default(),
    })
}

fn of(kind: ExprKind) -> Expr {
    Expr {
        kind,
        span: Span::default(),
    }
}

fn number() -> impl Strategy<Value = Expr> {
    let unit = prop_oneof![
        Just(Unit::None),
        Just(Unit::Metres),
        Just(Unit::Degrees),
        Just(Unit::Percent)
    ];
    let value = prop_oneof![
        0.0..100.0_f64,
        (0..100_u32).prop_map(f64::from),
        0.0..1e300_f64
    ];
    (value, unit).prop_map(|(value, unit)| of(ExprKind::Number(value, unit)))
}

fn text() -> impl Strategy<Value = String> {
    "[ -~é]{0,8}"
}

fn expr() -> impl Strategy<Value = Expr> {
    let leaf = prop_oneof![
        4 => number(),
        4 => word().prop_map(|w| of(ExprKind::Name(w))),
        1 => text().prop_map(|t| of(ExprKind::Text(t))),
    ];
    leaf.prop_recursive(3, 20, 3, |inner| {
        let pair = (inner.clone(), inner.clone());
        let item = prop_oneof![
            4 => inner.clone(),
            1 => pair.clone().prop_map(|(a, b)| of(ExprKind::Span(Box::new([a, b])))),
        ];
        let items = vec(item, 0..3);
        let angle = prop_oneof![
            number(),
            vec(inner.clone(), 0..3).prop_map(|l| of(ExprKind::List(l)))
        ];
        let size = (option::of(inner.clone()), option::of(angle))
            .prop_filter("a size", |(length, angle)| {
                length.is_some() || angle.is_some()
            })
            .prop_map(|(length, angle)| Size { length, angle });
        // What has sizes cannot be the number of sizes.
        let counted = inner.clone().prop_filter("a number of sizes", |e| {
            !matches!(e.kind, ExprKind::Sizes { .. })
        });
        let argument = (option::of(name()), inner.clone(), option::of(inner.clone()));
        let argument = argument.prop_map(|(name, value, at)| Argument { name, value, at });
        let unary = prop_oneof![Just(UnaryOp::Negate), Just(UnaryOp::Not)];
        prop_oneof![
            (name(), vec(argument, 0..3)).prop_map(|(name, arguments)| of(ExprKind::Call {
                name,
                arguments,
                blocks: Vec::new(),
            })),
            items.clone().prop_map(|list| of(ExprKind::List(list))),
            pair.clone()
                .prop_map(|(a, b)| of(ExprKind::Point(Box::new([a, b])))),
            (inner.clone(), items)
                .prop_map(|(base, list)| of(ExprKind::Index(Box::new(base), list))),
            (option::of(counted.prop_map(Box::new)), vec(size, 1..3))
                .prop_map(|(count, sizes)| of(ExprKind::Sizes { count, sizes })),
            (unary, inner.clone()).prop_map(|(op, e)| of(ExprKind::Unary(op, Box::new(e)))),
            (prop::sample::select(BinaryOp::ALL.to_vec()), pair)
                .prop_map(|(op, (a, b))| of(ExprKind::Binary(op, Box::new([a, b])))),
        ]
    })
}

fn comments() -> impl Strategy<Value = Vec<String>> {
    vec("[a-z]{1,5}( [a-z*/]{1,5})?", 0..2)
}

fn body() -> impl Strategy<Value = Body> {
    let argument = (option::of(name()), expr(), option::of(expr()));
    let argument = argument.prop_map(|(name, value, at)| Argument { name, value, at });
    let arguments = option::of(vec(argument, 0..3)).boxed();
    let leaf =
        (comments(), name(), arguments.clone()).prop_map(|(comments, name, arguments)| Operation {
            comments,
            name,
            arguments,
            blocks: Vec::new(),
            otherwise: None,
            span: Span::default(),
        });
    let operation = leaf.prop_recursive(2, 12, 3, move |inner| {
        let head = prop_oneof![
            expr().prop_map(Head::Value),
            Just(Head::Else(Span::default()))
        ];
        let branch = (option::of(head), vec(inner, 0..3)).prop_map(|(head, operations)| Branch {
            head,
            body: Body { operations },
            span: Span::default(),
        });
        let block = vec(branch, 0..3)
            // One empty branch is written as no branch.
            .prop_filter("an empty branch", |branches| {
                !matches!(branches.as_slice(), [only] if only.head.is_none() && only.body.operations.is_empty())
            })
            .prop_map(|branches| Block {
                branches,
                span: Span::default(),
            });
        (comments(), name(), arguments.clone(), vec(block.clone(), 0..3), option::of(block)).prop_map(
            |(comments, name, arguments, blocks, otherwise)| Operation {
                comments,
                name,
                arguments,
                blocks,
                otherwise,
                span: Span::default(),
            },
        )
    });
    vec(operation, 0..3).prop_map(|operations| Body { operations })
}

fn file() -> impl Strategy<Value = File> {
    let kind = prop_oneof![
        text().prop_map(|text| ItemKind::Include(Text {
            text,
            span: Span::default()
        })),
        (name(), expr()).prop_map(|(name, value)| ItemKind::Param { name, value }),
        (name(), vec(name(), 0..3), body()).prop_map(|(name, places, body)| ItemKind::Rule {
            name,
            places,
            body
        }),
        (name(), vec(name(), 0..3), body()).prop_map(|(name, places, body)| ItemKind::Function {
            name,
            places,
            meaning: Meaning::Body(body)
        }),
        (name(), vec(name(), 0..3), expr()).prop_map(|(name, places, value)| ItemKind::Function {
            name,
            places,
            meaning: Meaning::Value(value)
        }),
    ];
    let item = (comments(), kind).prop_map(|(comments, kind)| Item {
        comments,
        kind,
        span: Span::default(),
    });
    (comments(), vec(item, 0..4), comments()).prop_map(|(head, items, foot)| File {
        version: VERSION,
        head,
        items,
        foot,
    })
}

/// Pieces of texts, in any order.
fn token() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "grammar 1\n",
        "Region",
        "->",
        "Grid",
        "(",
        ")",
        "{",
        "}",
        "[",
        "]",
        "|",
        ",",
        ":",
        "=",
        "..",
        "-",
        "+",
        "*",
        "/",
        "<",
        "==",
        "and",
        "or",
        "not",
        "minus",
        "else",
        "a",
        "a[",
        "2",
        "0.5",
        "3 m",
        "30 deg",
        "\"x\"",
        "\"",
        "//c\n",
        "/*",
        "*/",
        "param",
        "fun",
        "include",
        "\n",
        "→",
        "é",
        "\u{0}",
        "1e999",
        "..",
        ".",
    ])
}

proptest! {
    #![proptest_config(config(400, 20_000))]

    #[test]
    fn what_is_printed_is_read_as_it_was(tree in file()) {
        let printed = print(&tree);
        let again = match read(&printed) {
            Ok(again) => again,
            Err(faults) => return Err(TestCaseError::fail(format!("{faults}\n{printed}"))),
        };
        prop_assert_eq!(&again, &tree, "{}", printed);
        prop_assert_eq!(print(&again), printed);
    }
}

proptest! {
    #![proptest_config(config(2_000, 100_000))]

    /// Every fault lies within the text, and can be shown.
    #[test]
    fn no_text_is_too_strange(tokens in vec(token(), 0..60), spaced in any::<bool>()) {
        let text = tokens.join(if spaced { " " } else { "" });
        if let Err(faults) = read(&text) {
            prop_assert!(!faults.all.is_empty());
            for fault in &faults.all {
                prop_assert!(fault.span.start <= fault.span.end && fault.span.end <= text.len());
            }
            prop_assert!(!faults.to_string().is_empty());
        }
    }
}
