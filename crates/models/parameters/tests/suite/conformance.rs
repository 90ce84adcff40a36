//! The registry of what each function does: its form, and whether machine parameters that act are read.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{Readings, changed, readings};
use bahn_parameters::conformance::{Effect, Entry, Kind, all, find};
use bahn_parameters::{ControlModel, Definition, ParameterList};

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/conformance")
}

#[test]
fn every_row_is_read() {
    let mut lines = 0;
    for file in fs::read_dir(data()).unwrap() {
        let text = fs::read_to_string(file.unwrap().path()).unwrap();
        lines += text.lines().count() - 1;
    }
    assert_eq!(all().len(), lines, "a row cannot be read");
    for entry in all() {
        let name = entry.name;
        assert_eq!(
            entry.missing.is_empty(),
            entry.effect == Effect::Acts,
            "{name}: what is missing"
        );
        assert_eq!(
            entry.proof.is_empty(),
            entry.effect == Effect::None,
            "{name}: its test"
        );
        assert!(entry.models().next().is_some(), "{name}");
        let is_own = entry.source.starts_with("(own");
        assert!(
            is_own || entry.source.starts_with('['),
            "{name}: {}",
            entry.source
        );
    }
}

/// Markers with a second use: for M2809 those of the positions carry a number [000:16175-16179].
const USED_TWICE: &[&str] = &["M2560-M2576"];

/// Rows of a kind that are about the same function of the same model.
#[test]
fn no_function_has_two_rows() {
    let rows = || all().iter().filter(|entry| !USED_TWICE.contains(&entry.name));
    for (at, entry) in rows().enumerate() {
        let is_like = |other: &&Entry| other.kind == entry.kind && other.covers(entry.name);
        for other in rows().skip(at + 1).filter(is_like) {
            let both = entry.models().find(|model| other.is_of(*model));
            assert_eq!(both, None, "{} and {}", entry.name, other.name);
        }
    }
}

#[test]
fn every_parameter_has_one_row_and_every_row_a_parameter() {
    for model in ControlModel::FAMILIES {
        let rows: Vec<&Entry> = all()
            .iter()
            .filter(|entry| entry.kind == Kind::MachineParameter && entry.is_of(model))
            .collect();
        let mut used = BTreeSet::new();
        for definition in Definition::all(model) {
            let id = definition.id.to_string();
            let own: Vec<&&Entry> = rows.iter().filter(|entry| entry.covers(&id)).collect();
            assert_eq!(own.len(), 1, "{id} on {model}");
            used.extend(own.iter().map(|entry| entry.name));
        }
        let idle: Vec<_> = rows.iter().filter(|entry| !used.contains(entry.name)).collect();
        assert!(idle.is_empty(), "{model}: no such parameter: {idle:?}");
    }
}

#[test]
fn ranges_and_indices_are_distinguished() {
    let effect = |name| find(ControlModel::Tnc415b, Kind::MachineParameter, name).map(|entry| entry.name);
    assert_eq!(effect("MP1060.2"), Some("MP1060"));
    assert_eq!(effect("MP1060"), Some("MP1060"));
    assert_eq!(effect("MP106"), None);
    let of_m = |name| find(ControlModel::Tnc415b, Kind::MFunction, name).is_some();
    assert!(of_m("M25") && of_m("M0") && !of_m("M205") && !of_m("MP25"));
}

/// The sources of all rooms but this one, without comments: what uses the getters.
fn sources() -> String {
    fn take(folder: &Path, all: &mut String) {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                take(&path, all);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                let code = text.split("#[cfg(test)]").next().unwrap_or_default();
                for line in code.lines() {
                    all.push_str(line.split("//").next().unwrap_or_default());
                    all.push('\n');
                }
            }
        }
    }
    let mut all = String::new();
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for layer in fs::read_dir(crates).unwrap() {
        for room in fs::read_dir(layer.unwrap().path()).into_iter().flatten() {
            let room = room.unwrap().path();
            if !room.ends_with("parameters") {
                take(&room.join("src"), &mut all);
            }
        }
    }
    all
}

/// Whether a text has a word, with nothing of another word before or after it.
fn has_word(text: &str, before: &str, word: &str) -> bool {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    let wanted = format!("{before}{word}");
    text.match_indices(&wanted).any(|(at, _)| {
        let after = text[at + wanted.len()..].chars().next().unwrap_or(' ');
        let ahead = text[..at].chars().next_back().unwrap_or(' ');
        (after == '.' || !is_word(after)) && (!before.is_empty() || !is_word(ahead))
    })
}

/// Settings under which some parameters act at all: axis-error compensation of either kind, a rotary axis, a
/// position for tool changes in the block scan, the output S by feed, a Hirth coupling, a measuring probe, a machine geometry of nine links.
const CIRCUMSTANCES: &[&[&str]] = &[
    &[],
    &[
        "730=0",
        "7450=%11111",
        "410.3=0",
        "3010=0",
        "3011=1",
        "420.3=1",
        "430.3=2.5",
    ],
    // Marks under the cams and a coded speed of a TNC 155.
    &["242=0", "243=0", "244=0", "245=0", "62=1", "63=1991"],
    // A printer is told seven characters.
    &["226=1819", "230=1802"],
    &["730=%11111", "410.3=2", "410.4=0", "90=5", "6200=1"],
    &[
        "7510=1", "7520=1", "7530=1", "7540=1", "7550=1", "7560=1", "7570=1", "7580=1", "7590=1",
    ],
];

/// A list, and what the getters say of it.
fn lists(model: ControlModel) -> Vec<(ParameterList, Readings)> {
    let list = |assignments: &&[&str]| {
        let mut list = ParameterList::reference(model);
        for assignment in *assignments {
            // Not every model has all of them.
            let _ = list.assign(assignment);
        }
        let readings = readings(&list);
        (list, readings)
    };
    CIRCUMSTANCES.iter().map(list).collect()
}

/// Whether another value of a parameter changes a field that is read elsewhere.
fn is_read_as(
    definition: &Definition,
    (list, before): &(ParameterList, Readings),
    is_read: impl Fn(&String) -> bool,
) -> bool {
    let (number, index) = (definition.id.number, definition.id.index.unwrap_or(0));
    let now = list.get(number, index).unwrap_or_default();
    let values = [
        now + 1.0,
        now - 1.0,
        0.0,
        1.0,
        2.0,
        3.0,
        255.0,
        now / 2.0,
        definition.max,
    ];
    values.into_iter().filter(|value| *value != now).any(|value| {
        let mut list = list.clone();
        let is_taken = list.set(number, index, value).is_ok();
        is_taken && changed(before, &readings(&list)).iter().any(&is_read)
    })
}

/// What a row marked `acts` or `partly` says must be read: a getter of this room answers otherwise when the
/// parameter changes, and the field that changes is used in another room; or another room reads the parameter
/// by its number.
#[test]
fn parameters_that_act_are_read_outside_this_room() {
    let sources = sources();
    let is_read = |field: &String| match field.split('.').collect::<Vec<_>>()[..] {
        // What the PLC gets is kept under the name of its getter; its fields have names that others have, too.
        [getter @ "plc_parameters", name] => {
            let kept = has_word(&sources, &format!("{getter}."), name);
            kept || has_word(&sources, &format!("{getter}()."), name)
        }
        [.., name] => has_word(&sources, ".", name) || sources.contains(&format!("{{ {name} }}")),
        [] => false,
    };
    let mut unread = Vec::new();
    for model in [
        ControlModel::Tnc155,
        ControlModel::Tnc360,
        ControlModel::Tnc425,
        ControlModel::Tnc407,
    ] {
        let lists = lists(model);
        for entry in all().iter().filter(|entry| {
            entry.kind == Kind::MachineParameter && entry.effect != Effect::None && entry.is_of(model)
        }) {
            // A row of the TNC 360 to 425 is looked at once.
            let is_seen = model == ControlModel::Tnc407 && entry.is_of(ControlModel::Tnc425)
                || model == ControlModel::Tnc360 && entry.is_of(ControlModel::Tnc425);
            if is_seen {
                continue;
            }
            let definitions = Definition::all(model).iter();
            let mut own = definitions.filter(|definition| entry.covers(&definition.id.to_string()));
            let by_number = || {
                let number = entry
                    .name
                    .trim_start_matches("MP")
                    .split(['.', '-'])
                    .next()
                    .unwrap_or_default();
                // Module 9032 reads MP4230 and MP4231 by the number that the PLC gives it [000:14851-14875]; an entry of
                // MP7330 and MP7340 is a user parameter only when it names one, which no single change here does.
                matches!(number, "4230" | "4231")
                    || matches!(number, "7330" | "7340") && has_word(&sources, ".", "user_parameters")
                    || number.parse::<u32>().is_ok_and(|number| number > 263)
                        && has_word(&sources, "", number)
            };
            let found = own.any(|definition| lists.iter().any(|list| is_read_as(definition, list, is_read)));
            if !found && !by_number() {
                unread.push(format!("{} on {model}", entry.name));
            }
        }
    }
    assert!(
        unread.is_empty(),
        "no other room uses what is read of {}",
        unread.join(", ")
    );
}
