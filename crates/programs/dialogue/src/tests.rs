//! Whether the dialogue can enter all that the language has: every block and word of the registry of each control model,
//! every parameter of every cycle, by keys alone. What it does not ask stands in `data/not-asked.tsv` with the reason.

use std::collections::BTreeSet;
use std::sync::Arc;

use bahn_parameters::conformance::{Kind, entries};
use bahn_parameters::{ControlModel, ParameterList};
use bahn_path::{Axis, AxisSet};
use bahn_program::{CycleFunction, Program, assigned_parameters, cycle};

use crate::blocks::BLOCKS;
use crate::cycles::cycle_lines;
use crate::editor::Open;
use crate::field::{Ask, Field, Need, Word};
use crate::line::Line;
use crate::reading::line_of_block;
use crate::{BuilderCycle, Editor, Key, Reaction, Setting};

/// Blocks for each row of the registry, with every word that it may have.
#[rustfmt::skip]
const SAMPLES: &[(&str, &[&str])] = &[
    ("BLK FORM", &["BLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+100 Y+100 IZ+20"]),
    ("TOOL DEF", &["TOOL DEF 1 L-2.5 R+5", "TOOL DEF 2"]),
    ("TOOL CALL", &["TOOL CALL 1 Z S1000", "TOOL CALL S500", "TOOL CALL Q5"]),
    ("TOOL CALL DL DR", &["TOOL CALL 1 Z S1000 DL+0.1 DR-0.2", "TOOL CALL DR+1"]),
    ("L", &["L X+10 IY-5.5 Z+0 RL F200 M3", "L Z+2 R0 FMAX", "L X+1 RR F100 M118 X1 Y0.5 Z2"]),
    ("C", &["C X+1 IY+2 DR- RL F100 M8"]),
    ("C (in three axes)", &["C X+1 Y+2 Z+3 DR+ R0 F5"]),
    ("CR", &["CR X+1 Y+2 R-5 DR- R0 FMAX M9"]),
    ("CT", &["CT X+1 Y+2 RR F100 M9"]),
    ("LP", &["LP PR+10 IPA-30 RL F200 M5"]),
    ("CP", &["CP IPA+720 IZ-5 DR+ RL F100 M9"]),
    ("CTP", &["CTP PR+10 PA-30 RR F200 M5"]),
    ("CC", &["CC X+10 IY-2", "CC"]),
    ("RND", &["RND R5 F20"]),
    ("CHF", &["L5"]),
    ("paraxial blocks, R+ and R-", &["X+5 R+ F100 M8", "IY-5 R- FMAX", "Z+1 R0 F5"]),
    ("RL RR R0", &["L X+1 RL", "L X+1 RR", "L X+1 R0"]),
    ("F FMAX", &["L X+1 FMAX", "L X+1 FQ5", "L X+1 F12.5"]),
    ("STOP", &["STOP M8", "STOP"]),
    ("LBL", &["LBL 7", "LBL 0"]),
    ("CALL LBL", &["CALL LBL 3", "CALL LBL 3 REP 5/5"]),
    ("CALL PGM", &["CALL PGM 12"]),
    ("CYCL CALL", &["CYCL CALL M3", "CYCL CALL"]),
    ("Q (in place of a number)", &["L X+Q1 IY-Q2 R0 FQ3", "RND RQ5"]),
    ("/ (optional block)", &["/ L X+5"]),
    ("DLG-DEF", &["DLG-DEF 0/2/8"]),
    ("DLG-CALL", &["DLG-CALL 0/1/127"]),
    ("CYCL DEF # (line of a datum table)", &["CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #5", "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #Q5"]),
    ("LN (surface normals)", &["LN X+1 Y+2 Z+3 NX+0 NY-0.6 NZ+0.8 R0 F100 M3"]),
    // Functions of Q parameters and M functions with words.
    ("FN0", &["FN0: Q1 = -5.5"]), ("FN1", &["FN1: Q1 = +Q2 + -5"]), ("FN2", &["FN2: Q1 = +Q2 - +5"]),
    ("FN3", &["FN3: Q1 = +Q2 * +5"]), ("FN4", &["FN4: Q1 = +Q2 DIV +5"]), ("FN5", &["FN5: Q1 = SQRT +2"]),
    ("FN6", &["FN6: Q1 = SIN +30"]), ("FN7", &["FN7: Q1 = COS -Q3"]), ("FN8", &["FN8: Q1 = +3 LEN +4"]),
    ("FN9", &["FN9: IF +Q1 EQU -5 GOTO LBL 3"]), ("FN10", &["FN10: IF +Q1 NE -5 GOTO LBL 3"]),
    ("FN11", &["FN11: IF +Q1 GT -5 GOTO LBL 3"]), ("FN12", &["FN12: IF +Q1 LT -5 GOTO LBL 3"]),
    ("FN13", &["FN13: Q1 = +3 ANG +4"]), ("FN14", &["FN14: ERROR = 100"]), ("FN15", &["FN15: PRINT 1/Q5/20"]),
    ("FN19", &["FN19: PLC = +5/-Q2"]), ("FORMULA", &["Q1 = (SIN 30 + Q2) * 5"]),
    ("M103", &["L X+1 M103 F25.5"]), ("M112", &["M112 T0.01 A10"]), ("M120", &["M120 LA5"]),
    ("M200", &["M200 VQ5"]), ("M203", &["M203 V5 TIME2.5"]),
    ("M8", &["M8"]),
];

fn reasons() -> Vec<&'static str> {
    let lines = include_str!("../data/not-asked.tsv").lines();
    lines
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.split('\t').next())
        .collect()
}

fn setting(model: ControlModel) -> Setting {
    let mut setting = Setting::of(&ParameterList::reference(model));
    setting.inhibited_cycles.clear();
    setting.paraxial_inhibited = false;
    setting.axes = AxisSet::from_iter([Axis::X, Axis::Y, Axis::Z, Axis::C]);
    setting
}

/// The program of a cycle of the machine builder, in which all blocks may stand; label 3 is there.
fn editor(setting: &Setting) -> Editor {
    let text = b"BEGIN PGM 99999968 MM\nLBL 3\nEND PGM 99999968 MM\n".to_vec();
    let mut editor = Editor::new(Arc::new(Program::from_bytes("99999968.H", text)), setting.clone());
    assert!(editor.go_to(1));
    editor
}

fn press(editor: &mut Editor, key: Key) {
    let reaction = editor.key(key);
    assert!(
        !matches!(reaction, Reaction::Refused(_)),
        "{key}: {reaction:?} {:?}",
        editor.view(0, 0).question
    );
}

fn digits(editor: &mut Editor, text: &str) {
    let negative = text.starts_with('-');
    for character in text.trim_start_matches('-').chars() {
        press(editor, Key::of_character(character).unwrap());
    }
    if negative {
        press(editor, Key::Sign);
    }
}

fn letters(editor: &mut Editor, text: &str) {
    assert!(!matches!(editor.type_text(text), Reaction::Refused(_)), "{text}");
}

fn axis_key(setting: &Setting, letter: u8) -> Key {
    let axis = Axis::from_letter(letter).unwrap();
    let mut keys = Key::ALL.iter().copied();
    keys.find(|key| setting.axis(*key) == Some(axis)).unwrap()
}

fn soft(editor: &mut Editor, label: &str) {
    for _ in 0..9 {
        if let Some(place) = editor.view(0, 0).soft_keys.iter().position(|key| key == label) {
            press(editor, Key::from_name(&format!("SK{}", place + 1)).unwrap());
            return;
        }
        press(editor, Key::SkRight);
    }
    panic!("no soft key {label}");
}

/// Answers the question with a word of a field.
fn answer(editor: &mut Editor, field: &Field, word: &Word) {
    let setting = editor.setting().clone();
    let letter = word.address.bytes().last().unwrap_or_default();
    match field.slot.ask {
        Ask::Coordinates { .. } if word.address == "#" => {
            soft(editor, "#");
            digits(editor, &word.value);
        }
        Ask::Coordinates { .. } => {
            if word.incremental {
                press(editor, Key::I);
            }
            press(editor, axis_key(&setting, letter));
            digits(editor, &word.value);
        }
        Ask::Axes(_) => press(editor, axis_key(&setting, letter)),
        Ask::Direction => {
            press(editor, axis_key(&setting, letter));
            if word.value == "-" {
                press(editor, Key::Sign);
            }
        }
        Ask::Choice(choices) => {
            let choice = choices.iter().find(|choice| choice.value == word.value).unwrap();
            match choice.key {
                Some(Key::NoEnt) => {}
                Some(key) => press(editor, key),
                None => soft(editor, &format!("{}{}", field.slot.address, choice.value)),
            }
        }
        Ask::Feed { .. } if word.value == "MAX" => soft(editor, &format!("F {}", setting.rapid())),
        Ask::M => {
            let mut words = word.value.split(' ');
            digits(editor, words.next().unwrap());
            for word in words {
                press(editor, Key::of_character(word.chars().next().unwrap()).unwrap());
                digits(editor, word.trim_start_matches(crate::field::is_address));
            }
        }
        Ask::Name | Ask::Text => letters(editor, &word.value),
        _ => {
            if word.incremental {
                press(editor, Key::I);
            }
            digits(editor, &word.value);
        }
    }
}

/// Opens the dialogue that makes such blocks.
fn open(editor: &mut Editor, first: &Line, text: &str) {
    let number = |prefix: &str| text.strip_prefix(prefix)?.split(['.', ':']).next();
    let menu = [
        ("CYCL DEF ", Key::CyclDef),
        ("TCH PROBE ", Key::TouchProbe),
        ("FN", Key::Q),
    ];
    if let Some((prefix, key)) = menu.iter().find(|(prefix, _)| number(prefix).is_some()) {
        press(editor, *key);
        digits(editor, number(prefix).unwrap());
        return press(editor, Key::Ent);
    }
    if first.fields().len() == 2 && first.field(1).is_some_and(|field| field.slot.prompt == "formula") {
        press(editor, Key::Q);
        (0..99).for_each(|_| press(editor, Key::Down));
        return press(editor, Key::Ent);
    }
    let keys: &[Key] = match first.field(0).map(|field| field.slot.prompt) {
        Some("dialog") => &[Key::LblSet, Key::NoEnt],
        Some("chamfer") => &[Key::Chf],
        _ => match first.head() {
            "LP" => &[Key::L, Key::P],
            "CP" => &[Key::C, Key::P],
            "CTP" => &[Key::Ct, Key::P],
            "LN" => &[Key::L, Key::N],
            // The axis key of a paraxial block, the M of a block of M functions open their dialogue themselves.
            "" if text.starts_with('M') => &[Key::M],
            "" => &[],
            head => {
                let row = BLOCKS
                    .iter()
                    .find(|row| row.lines.first().is_some_and(|line| line.head == head));
                press(editor, row.and_then(|row| row.key).unwrap());
                return;
            }
        },
    };
    keys.iter().for_each(|key| press(editor, *key));
}

/// Enters blocks by keys; they must come out as they are.
fn enter(setting: &Setting, text: &str) {
    // Some models have a feed for rapid traverse.
    let text = &text.replace("FMAX", &format!("F{}", setting.rapid()));
    let mut editor = editor(setting);
    let language = Arc::clone(editor.program());
    let language = language.language();
    let optional = text.starts_with("/ ");
    let bare = text.trim_start_matches("/ ");
    let wanted: Vec<_> = bare.lines().map(|line| language.parse_block(line)).collect();
    assert!(
        wanted.iter().all(|read| read.faults.is_empty()),
        "{text}: {wanted:?}"
    );
    let lines: Vec<Line> = wanted
        .iter()
        .filter_map(|read| line_of_block(&read.block, language))
        .collect();
    assert!(lines.iter().all(|line| !line.is_text()), "{text} is read as text");
    open(&mut editor, &lines[0], bare);
    // An axis key that opens a block is its first answer.
    while !matches!(editor.open, Open::Nothing) || editor.cursor() == 1 {
        let Open::Dialogue(dialogue) = &editor.open else {
            let first = lines[0].field(0).unwrap();
            answer(&mut editor, first, &first.words[0]);
            press(&mut editor, Key::Ent);
            continue;
        };
        let (line, field) = (dialogue.line, dialogue.field);
        let words = lines.get(line).and_then(|line| line.field(field)).cloned();
        let Some(words) = words.filter(|field| !field.words.is_empty()) else {
            let end = lines.get(line).is_none();
            press(&mut editor, if end { Key::End } else { Key::NoEnt });
            continue;
        };
        let list = words.slot.ask.is_list();
        for word in &words.words {
            answer(&mut editor, &words, word);
            if list {
                press(&mut editor, Key::Ent);
            }
        }
        let refused = words.words.iter().any(|word| word.value == "DLG-CALL");
        let full = list && words.words.len() >= words.slot.ask.most(setting.model.limits());
        if !full {
            press(&mut editor, if refused { Key::NoEnt } else { Key::Ent });
        }
    }
    if optional {
        soft(&mut editor, "/ BLOCK");
    }
    for (place, read) in (2..).zip(&wanted) {
        let made = language.parse_block(&editor.program().text_of(place)).block;
        assert_eq!(made.operation, read.block.operation, "{text}");
        assert_eq!(made.skip, optional, "{text}");
    }
    assert_eq!(
        editor.program().block_count() as usize,
        3 + wanted.len(),
        "{text}"
    );
}

/// How many axes a straight line moves: versions F and W of the TNC 151/155 have none in three [001:132-136].
fn axes_of_line(block: &str) -> usize {
    let words = block.strip_prefix("L ").unwrap_or_default().split(' ');
    words
        .filter(|word| word.trim_start_matches('I').starts_with(['X', 'Y', 'Z', 'C']))
        .count()
}

#[test]
fn every_block_of_every_model_is_entered_by_keys() {
    let reasons = reasons();
    let mut needed = BTreeSet::new();
    for model in ControlModel::ALL {
        let mut setting = setting(model);
        setting.tongue = crate::Tongue::English;
        for entry in entries(model).filter(|entry| matches!(entry.kind, Kind::Word | Kind::Fn)) {
            let samples = SAMPLES.iter().filter(|(name, _)| match entry.kind {
                Kind::Word => *name == entry.name,
                _ => name.starts_with('F') && entry.covers(name),
            });
            let blocks: Vec<&str> = samples.flat_map(|(_, blocks)| blocks.iter().copied()).collect();
            if blocks.is_empty() {
                assert!(
                    reasons.contains(&entry.name),
                    "{model:?} {}: neither asked nor a reason",
                    entry.name
                );
                needed.insert(entry.name);
            }
            for block in blocks {
                // Words after M functions that the model lacks are tried with it below.
                if !block.contains(" M118 ") && axes_of_line(block) <= model.limits().line_axes_max.into() {
                    enter(&setting, block);
                }
            }
        }
        for (name, blocks) in SAMPLES.iter().filter(|(name, _)| name.starts_with('M')) {
            if entries(model).any(|entry| entry.kind == Kind::MFunction && entry.covers(name)) {
                blocks.iter().for_each(|block| enter(&setting, block));
            }
        }
    }
    enter(
        &setting(ControlModel::ALL[ControlModel::ALL.len() - 1]),
        "L X+1 RR F100 M118 X1 Y0.5 Z2",
    );
    // What the tables of this room have and never ask.
    for row in BLOCKS {
        for slot in row
            .lines
            .iter()
            .flat_map(|line| line.slots)
            .filter(|slot| slot.need == Need::Unasked)
        {
            let name = reasons
                .iter()
                .find(|name| **name == format!("{} {}", row.id, slot.prompt));
            needed.insert(name.unwrap_or_else(|| panic!("{} never asks {}", row.id, slot.prompt)));
        }
    }
    let unused: Vec<_> = reasons
        .iter()
        .filter(|name| !needed.contains(*name) && !name.starts_with("CYCL"))
        .collect();
    assert!(unused.is_empty(), "reasons for what is asked: {unused:?}");
}

/// A word for a field, as small as can be.
fn some_word(field: &Field) -> Vec<Word> {
    let word = |address: &str, value: &str| Word {
        incremental: false,
        address: address.to_owned(),
        value: value.to_owned(),
    };
    match field.slot.ask {
        Ask::Coordinates { prefix, .. } => vec![word(&format!("{prefix}X"), "2")],
        Ask::Axes(_) => vec![word("Z", "")],
        Ask::Direction if field.slot.prompt.ends_with("start") => vec![word("X", "-")],
        Ask::Direction => vec![word("Y", "+")],
        Ask::Choice(choices) => vec![word(field.slot.address, choices[0].value)],
        Ask::Labels => vec![word("", "3"), word("", "4")],
        _ => vec![word(field.slot.address, "2")],
    }
}

#[test]
fn every_parameter_of_every_cycle_is_entered_by_keys() {
    let reasons = reasons();
    for model in ControlModel::ALL {
        let mut setting = setting(model);
        setting.builder_cycles = vec![BuilderCycle {
            number: 68,
            name: "Bolt hole circle".to_owned(),
            parameters: (1..=7)
                .map(|number| (number, format!("PARAMETER {number}?")))
                .collect(),
        }];
        let numbers = (1..=31).filter(|number| model.limits().has_cycle(*number));
        let definitions = numbers.map(|number| (CycleFunction::Definition, number as u16));
        let registered = |number: &u16| {
            let name = format!("TCH PROBE {number}");
            entries(model).any(|entry| entry.kind == Kind::Cycle && entry.covers(&name))
        };
        let probes = (0..100)
            .filter(registered)
            .map(|number| (CycleFunction::Probe, number));
        for (function, number) in definitions.chain(probes).chain([(CycleFunction::Definition, 68)]) {
            let mut lines = cycle_lines(function, number, &setting);
            let definition = function == CycleFunction::Definition;
            if definition && reasons.contains(&format!("CYCL DEF {number}").as_str()) {
                assert!(cycle(function, number).is_none_or(|cycle| cycle.blocks.is_empty()));
                continue;
            }
            let fields = lines.iter().flat_map(Line::fields).count();
            let wanted = match (number, function) {
                (68, _) => 7,
                (_, CycleFunction::Definition) if !assigned_parameters(number).is_empty() => {
                    assigned_parameters(number).len()
                }
                _ => cycle(function, number)
                    .unwrap()
                    .blocks
                    .iter()
                    .map(|block| block.len())
                    .sum(),
            };
            assert!(
                fields >= wanted,
                "{function:?} {number}: {fields} fields for {wanted} words"
            );
            for line in &mut lines {
                for index in 0..line.fields().len() {
                    let field = line.field_mut(index).unwrap();
                    assert!(field.slot.need != Need::Unasked && !field.slot.prompt.is_empty());
                    field.words = some_word(field);
                    // The second side lies on another axis than the first.
                    if field.slot.prompt.ends_with("5 side") {
                        field
                            .words
                            .iter_mut()
                            .for_each(|word| word.address = "Y".to_owned());
                    }
                }
            }
            let texts: Vec<String> = lines.iter().map(Line::text).collect();
            enter(&setting, &texts.join("\n"));
        }
    }
}
