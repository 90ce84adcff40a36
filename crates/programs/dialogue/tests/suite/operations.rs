//! Every block that the dialogue makes does what was entered; every block that stands in a program can be opened.

use std::fs;
use std::path::{Path, PathBuf};

use crate::desk::Desk;
use bahn_dialogue::Reaction;
use bahn_parameters::ControlModel;
use bahn_path::{Axis, Sense};
use bahn_program::{
    Block, Compensation, Coordinates, CycleBlock, CycleWord, Feed, MFunctions, Motion, MotionKind,
    NumberedBlock, Operation, Program, Value, Word,
};
use proptest::prelude::*;
use proptest::sample::select;

/// The side of a pocket is positive [003:5250].
fn side() -> impl Strategy<Value = (String, Value)> {
    value().prop_map(|(text, value)| match value {
        Value::Number(number) => (
            text.trim_start_matches('-').to_owned(),
            Value::Number(number.abs()),
        ),
        parameter => (text, parameter),
    })
}

/// A value with the keys that enter it.
fn value() -> impl Strategy<Value = (String, Value)> {
    prop_oneof![
        3 => (-9_999_999_i32..=9_999_999).prop_map(|thousandths| {
            let number = f64::from(thousandths) / 1000.0;
            (format!("{number}"), Value::Number(if number == 0.0 { 0.0 } else { number }))
        }),
        1 => (0..=113_u16, any::<bool>()).prop_map(|(number, negative)| {
            let sign = if negative { "SIGN " } else { "" };
            (format!("{sign}Q {number}"), Value::Q { number, negative })
        }),
    ]
}

fn word() -> impl Strategy<Value = (String, Word)> {
    (value(), any::<bool>()).prop_map(|((keys, value), incremental)| {
        let keys = if incremental { format!("I {keys}") } else { keys };
        (keys, Word { value, incremental })
    })
}

/// Axis words, `I` before the axis key.
fn coordinates(axes: &'static [Axis]) -> impl Strategy<Value = (String, Coordinates)> {
    let words = prop::collection::vec(prop::option::of((value(), any::<bool>())), axes.len());
    words.prop_map(move |words| {
        let (mut keys, mut coordinates) = (String::new(), Coordinates::default());
        for (axis, word) in axes.iter().zip(words) {
            if let Some(((number, value), incremental)) = word {
                let i = if incremental { "I " } else { "" };
                keys += &format!("{i}{axis} {number} ");
                coordinates.set(*axis, Word { value, incremental });
            }
        }
        (keys, coordinates)
    })
}

fn compensation() -> impl Strategy<Value = (&'static str, Option<Compensation>)> {
    select(vec![
        ("NO_ENT", None),
        ("ENT", Some(Compensation::Off)),
        ("RL ENT", Some(Compensation::Left)),
        ("SK2 ENT", Some(Compensation::Right)),
    ])
}

fn turn() -> impl Strategy<Value = (&'static str, Option<Sense>)> {
    select(vec![
        ("ENT", Some(Sense::Clockwise)),
        ("SK1 ENT", Some(Sense::CounterClockwise)),
        ("SIGN SIGN ENT", Some(Sense::Clockwise)),
    ])
}

fn feed() -> impl Strategy<Value = (String, Option<Feed>)> {
    prop_oneof![
        Just(("NO_ENT".to_owned(), None)),
        Just(("ENT".to_owned(), Some(Feed::Max))),
        (0..=29_999_u32).prop_map(|feed| (
            format!("{feed} ENT"),
            Some(Feed::Value(Value::Number(f64::from(feed))))
        )),
        (0..=113_u16).prop_map(|number| {
            (
                format!("Q {number} ENT"),
                Some(Feed::Value(Value::Q {
                    number,
                    negative: false,
                })),
            )
        }),
    ]
}

fn m() -> impl Strategy<Value = (String, MFunctions)> {
    prop::option::of(0..=102_u16).prop_map(|code| {
        let mut m = MFunctions::default();
        let Some(code) = code else {
            return ("NO_ENT".to_owned(), m);
        };
        m.push(code);
        (format!("{code} ENT"), m)
    })
}

/// Positioning blocks with their keys.
#[expect(clippy::too_many_lines, reason = "one step for each word")]
fn motion() -> impl Strategy<Value = (String, Motion)> {
    use MotionKind::{
        Circle, CirclePolar, CircleRadius, CircleTangential, CircleTangentialPolar, Line, LinePolar,
    };
    let kinds = vec![
        (Line, "L"),
        (Circle, "C"),
        (CircleRadius, "CR"),
        (CircleTangential, "CT"),
        (LinePolar, "L P"),
        (CirclePolar, "C P"),
        (CircleTangentialPolar, "CT P"),
    ];
    const PLANE: &[Axis] = &[Axis::X, Axis::Y, Axis::Z];
    let angle = (-360_i32..=360, any::<bool>()).prop_map(|(angle, incremental)| {
        let keys = if incremental {
            format!("I {angle}")
        } else {
            angle.to_string()
        };
        (
            keys,
            Word {
                value: Value::Number(f64::from(angle)),
                incremental,
            },
        )
    });
    (
        select(kinds),
        coordinates(PLANE),
        value(),
        (word(), angle),
        turn(),
        compensation(),
        feed(),
        m(),
    )
        .prop_map(
            |((kind, key), (axes, coordinates), radius, (pr, pa), turn, compensation, feed, m)| {
                let polar = matches!(kind, LinePolar | CirclePolar | CircleTangentialPolar);
                let arc = matches!(kind, Circle | CircleRadius | CirclePolar);
                let mut motion = Motion {
                    kind,
                    coordinates: Coordinates::default(),
                    polar_radius: None,
                    polar_angle: None,
                    radius: None,
                    direction: None,
                    compensation: compensation.1,
                    feed: feed.1,
                    normal: None,
                    m: m.1,
                    modal: None,
                };
                let mut keys = vec![key.to_owned()];
                if polar && kind != CirclePolar {
                    motion.polar_radius = Some(pr.1);
                    keys.push(format!("{} ENT", pr.0));
                }
                if polar {
                    motion.polar_angle = Some(pa.1);
                    keys.push(format!("{} ENT", pa.0));
                }
                match kind {
                    CirclePolar => keys.push("NO_ENT".to_owned()),
                    _ if polar => {}
                    Line if coordinates.is_empty() => keys.push("NO_ENT".to_owned()),
                    _ if coordinates.is_empty() => {
                        motion.coordinates.set(
                            Axis::X,
                            Word {
                                value: Value::Number(1.0),
                                incremental: false,
                            },
                        );
                        keys.push("X 1 ENT".to_owned());
                    }
                    _ => {
                        motion.coordinates = coordinates;
                        keys.push(format!("{axes} ENT"));
                    }
                }
                if kind == CircleRadius {
                    motion.radius = Some(radius.1);
                    keys.push(format!("{} ENT", radius.0));
                }
                if arc {
                    motion.direction = turn.1;
                    keys.push(turn.0.to_owned());
                }
                keys.extend([compensation.0.to_owned(), feed.0, m.0]);
                (keys.join(" "), motion)
            },
        )
}

fn operation(desk: &Desk, block: u32) -> Operation {
    desk.editor.program().decode(0).blocks[block as usize]
        .operation
        .clone()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn positioning_blocks_do_what_was_entered((keys, motion) in motion()) {
        let empty = motion.coordinates.is_empty() && motion.polar_angle.is_none();
        let bare = empty && motion.compensation.is_none() && motion.feed.is_none() && motion.m.is_empty();
        prop_assume!(!bare);
        let mut desk = Desk::new();
        desk.enter(&keys);
        prop_assert_eq!(desk.blocks().len(), 1, "{}", keys);
        prop_assert_eq!(operation(&desk, 1), Operation::Motion(motion), "{}", keys);
    }

    /// NO ENT takes out the highlighted word and nothing else; entering a word as it stands changes nothing.
    #[test]
    fn no_ent_takes_out_one_word((keys, motion) in motion(), at in any::<prop::sample::Index>()) {
        let words_meant = motion.coordinates.axes().len() + usize::from(motion.polar_angle.is_some());
        prop_assume!(words_meant > 0);
        let mut desk = Desk::new();
        desk.enter(&keys);
        let text = desk.blocks()[0].clone();
        let words: Vec<&str> = text.split(' ').collect();
        let at = at.index(words.len());
        desk.enter("RIGHT");
        desk.enter(&"RIGHT ".repeat(at));
        let shown = desk.editor.view(0, 0).words;
        let highlighted: Vec<_> = shown.iter().filter(|word| word.highlighted).map(|word| word.text.trim()).collect();
        prop_assert_eq!(highlighted, [words[at]]);
        let others: Vec<&str> = words.iter().enumerate().filter(|(index, _)| *index != at).map(|(_, word)| *word).collect();
        match desk.press("NO_ENT") {
            Reaction::Edited => prop_assert_eq!(&desk.blocks()[0], &others.join(" "), "{} of {}", words[at], text),
            Reaction::Refused(_) => {
                prop_assert_eq!(&desk.blocks()[0], &text);
                let needed = at == 0 || matches!(motion.kind, MotionKind::CirclePolar | MotionKind::CircleRadius)
                    || words[at].starts_with("DR") || motion.coordinates.axes().len() == 1;
                prop_assert!(needed, "{} of {}", words[at], text);
            }
            other => prop_assert!(false, "{:?}", other),
        }
    }

    #[test]
    fn pockets_do_what_was_entered(depths in prop::array::uniform3(1_u32..90_000), sides in prop::array::uniform2(side()), feeds in prop::array::uniform2(1..29_999_u32), radius in 0..99_u32) {
        let depths = depths.map(|depth| -f64::from(depth) / 1000.0);
        let keys = format!(
            "CYCL_DEF 4 ENT {} ENT {} ENT {} ENT {} ENT X {} ENT Y {} ENT {} ENT ENT {radius} ENT",
            depths[0], depths[1], depths[2], feeds[0], sides[0].0, sides[1].0, feeds[1]
        );
        let mut desk = Desk::new();
        desk.enter(&keys);
        let number = |value: f64| CycleWord::Number(Value::Number(value));
        let feed = |feed: u32| CycleWord::Feed(Feed::Value(Value::Number(f64::from(feed))));
        let side = |axis, value| CycleWord::Coordinate(axis, Word { value, incremental: false });
        let wanted = [
            vec![], vec![number(depths[0])], vec![number(depths[1])], vec![number(depths[2]), feed(feeds[0])],
            vec![side(Axis::X, sides[0].1)], vec![side(Axis::Y, sides[1].1)],
            vec![feed(feeds[1]), CycleWord::Sense(Sense::Clockwise), number(f64::from(radius))],
        ];
        for (sub, wanted) in (0..).zip(wanted) {
            let Operation::Cycle(block) = operation(&desk, u32::from(sub) + 1) else { panic!("{keys}") };
            let CycleBlock { number, sub: found, words } = *block;
            let words: Vec<_> = words.into_iter().filter(|word| !matches!(word, CycleWord::Text(_))).collect();
            prop_assert_eq!((number, found, words), (4, sub, wanted), "{}", keys);
        }
    }
}

/// All programs that stand beside the machines and examples.
fn shipped() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let mut folders = vec![root.join("machines"), root.join("examples")];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(folder) else {
            continue;
        };
        for path in entries.flatten().map(|entry| entry.path()) {
            match path.is_dir() {
                true => folders.push(path),
                false if path.extension().is_some_and(|end| end == "H") => files.push(path),
                false => {}
            }
        }
    }
    files
}

/// Opens a block and ends it without a change; then every word is entered anew as it stands.
fn open_and_close(file: &Path, program: &Program, numbered: &NumberedBlock) {
    let place = format!("{} block {}", file.display(), numbered.number);
    let mut text = program.text_of(numbered.number);
    if text.contains('\n') {
        text = bahn_program::format_block(&numbered.block, bahn_program::FormatOptions::default());
    }
    let mut desk = Desk::with(&text, ControlModel::Tnc425);
    let before: Block = desk.editor.program().decode(0).blocks[1].clone();
    desk.enter("DOWN RIGHT");
    let words = desk.editor.view(0, 0).words;
    let shown: String = words.iter().map(|word| word.text.as_str()).collect();
    let read = Desk::with(&shown, ControlModel::Tnc425)
        .editor
        .program()
        .decode(0)
        .blocks[1]
        .clone();
    assert_eq!(read, before, "{place}: shown as {shown}");
    desk.enter("END");
    assert_eq!(desk.editor.program().decode(0).blocks[1], before, "{place}");
    // What can be read is opened word by word: letters go on only with a line of text.
    let readable = !matches!(before.operation, Operation::Invalid(_) | Operation::Comment(_));
    desk.enter("RIGHT");
    let refused = matches!(desk.press("K"), Reaction::Refused(_));
    assert_eq!(refused, readable, "{place}: {words:?}");
}

#[test]
fn every_block_of_the_shipped_programs_can_be_opened() {
    let mut blocks = 0;
    for file in shipped() {
        let program = Program::from_bytes("7.H", fs::read(&file).unwrap());
        for numbered in program.blocks().take(400) {
            if !matches!(numbered.block.operation, Operation::Begin(_) | Operation::End(_)) {
                open_and_close(&file, &program, &numbered);
                blocks += 1;
            }
        }
    }
    assert!(blocks > 500, "only {blocks} blocks");
}
