//! The registry of what each function does: complete, proven, shown by the commands.
#![allow(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use bahn_house as house;
use bahn_parameters::conformance::{Effect, Entry, Kind, all};
use bahn_parameters::{ControlModel, Definition, MessageId};
use support::{Folder, holds_document};

fn source_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            source_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The source of a test: its comment with its body; the file it stands in with the manual's programs that it runs.
struct Source {
    test: String,
    file: String,
}

/// All tests by name, `crate::name`: functions after `#[test]`.
fn tests() -> BTreeMap<String, Vec<Source>> {
    let mut found: BTreeMap<String, Vec<Source>> = BTreeMap::new();
    for room in house::rooms() {
        let mut files = Vec::new();
        source_files(&room.join("src"), &mut files);
        source_files(&room.join("tests"), &mut files);
        for file in files {
            let text = fs::read_to_string(file).unwrap();
            let parts: Vec<&str> = text.split("#[test]").collect();
            for pair in parts.windows(2) {
                let [before, part] = pair else { continue };
                let name = part.split_once("fn ").and_then(|(_, rest)| rest.split_once('('));
                let Some((name, _)) = name else { continue };
                let comment = before.rsplit("\n\n").next().unwrap_or_default();
                // The function ends where a brace stands as far left as it began.
                let indent = before.len() - before.trim_end_matches(' ').len();
                let end = part
                    .find(&format!("\n{}}}", " ".repeat(indent)))
                    .unwrap_or(part.len());
                let test = format!("{comment}{}", &part[..end]);
                let programs = test
                    .split("manual(\"")
                    .skip(1)
                    .filter_map(|rest| rest.split('"').next());
                let programs = programs.map(|name| room.join(format!("tests/programs/{name}.H")));
                let programs: String = programs
                    .filter_map(|path| fs::read_to_string(path).ok())
                    .collect();
                let source = Source {
                    test,
                    file: format!("{text}{programs}"),
                };
                let name = format!("{}::{name}", house::name(&room));
                found.entry(name).or_default().push(source);
            }
        }
    }
    found
}

#[test]
fn what_acts_is_proven_by_a_test() {
    let tests = tests();
    assert!(tests.len() > 1000, "{}", tests.len());
    let of_tnc = all().iter().filter(|entry| entry.effect != Effect::None);
    let of_tnc = of_tnc.map(|entry| (entry.name, entry.proof));
    let of_system900 = bahn_system900::rows().iter().filter(|row| !row.proof.is_empty());
    let of_system900 = of_system900.map(|row| (row.number, row.proof));
    let unproven: Vec<String> = of_tnc
        .chain(of_system900)
        .flat_map(|(name, proofs)| proofs.split(' ').map(move |proof| (name, proof)))
        .filter(|(_, proof)| !tests.contains_key(*proof))
        .map(|(name, proof)| format!("{name}: there is no test `{proof}`"))
        .collect();
    assert!(unproven.is_empty(), "{}", unproven.join("\n"));
}

/// Where a text has a word, not as a part of another one.
fn has_word(text: &str, word: &str) -> bool {
    let part_of_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    text.match_indices(word).any(|(at, _)| {
        !part_of_word(text[..at].chars().next_back()) && !part_of_word(text[at + word.len()..].chars().next())
    })
}

/// Whether a text names a machine parameter: `MP1060`, `mp1060_`, `"1060.0=5`, `(1060, 0`, or a row of a table.
fn names_parameter(text: &str, number: &str) -> bool {
    text.match_indices(number).any(|(at, _)| {
        let before = text[..at].trim_end_matches(' ');
        let begins = ["MP", "mp", "\"", "(", "\n", "\\"]
            .iter()
            .any(|mark| before.ends_with(mark));
        begins && !text[at + number.len()..].starts_with(|c: char| c.is_ascii_digit())
    })
}

/// Whether a table of titles in a test has a parameter: `Rapid traverse * | ..`, where `*` is an axis or a number.
fn names_title(text: &str, number: &str) -> bool {
    let patterns = text.lines().filter_map(|line| line.split_once(" | "));
    let patterns: Vec<&str> = patterns.map(|(pattern, _)| pattern).collect();
    let definitions = ControlModel::FAMILIES.into_iter().flat_map(Definition::all);
    let mut titles = definitions
        .filter(|definition| definition.id.number.to_string() == number)
        .map(|definition| format!("{}, {}", definition.name, definition.axis));
    titles.any(|title| {
        let title = title.trim_end_matches(", ");
        patterns.iter().any(|pattern| match pattern.split_once('*') {
            Some((before, after)) => title.starts_with(before) && title.ends_with(after),
            None => *pattern == title,
        })
    })
}

/// Whether a proof is about its row: it says the number or the name. Of a row of signals, one for each
/// axis, direction or key, it may take any. Programs stand beside their tests.
fn is_about(entry: &Entry, source: &Source) -> bool {
    let (test, file) = (source.test.as_str(), source.file.as_str());
    let codes = |letters: &str| -> Vec<String> {
        let digits = |text: &str| {
            text.trim_start_matches(|c: char| !c.is_ascii_digit())
                .parse::<u32>()
        };
        let mut ends = entry.name.split('-').map(digits);
        let first = ends.next().and_then(Result::ok).unwrap_or_default();
        let last = ends.next().and_then(Result::ok).unwrap_or(first);
        (first..=last).map(|code| format!("{letters}{code}")).collect()
    };
    match entry.kind {
        Kind::MachineParameter => {
            let digits = entry.name.trim_start_matches("MP");
            let number = digits.split(['.', '-']).next().unwrap_or_default();
            names_parameter(test, number) || names_title(test, number)
        }
        Kind::MFunction => codes("M").iter().any(|code| {
            let spelled = [code.clone(), code.replacen('M', "M0", 1)];
            spelled
                .iter()
                .any(|code| has_word(file, code) || test.contains(&format!("{}_", code.to_lowercase())))
        }),
        Kind::Cycle => codes(
            entry
                .name
                .trim_end_matches(|c: char| c.is_ascii_digit() || c == '-'),
        )
        .iter()
        .any(|cycle| has_word(file, cycle)),
        Kind::Fn => codes("FN").iter().any(|function| has_word(file, function)),
        Kind::Module => test.contains(entry.name),
        Kind::Word => entry
            .name
            .split([' ', ':'])
            .any(|word| !word.is_empty() && has_word(file, word)),
        Kind::Message => {
            let id = MessageId::ALL.iter().find(|id| id.name() == entry.name);
            let texts = ControlModel::FAMILIES.map(|model| id.map_or("", |id| id.text(model)));
            has_word(test, entry.name) || texts.iter().any(|text| test.contains(text))
        }
        Kind::Marker => {
            let signals = bahn_exchange::signal::all();
            let own = signals
                .iter()
                .find(|signal| signal.operand.to_string() == entry.name);
            let row = own.map(|own| row_of(own.name));
            let mut like = signals.iter().filter(|signal| Some(row_of(signal.name)) == row);
            like.any(|signal| has_word(test, &signal.operand.to_string()) || has_word(test, signal.name))
        }
    }
}

/// The name of a signal without axis, direction and number: `JOG_X_PLUS` is one of a row.
fn row_of(name: &str) -> Vec<&str> {
    const PLACES: &[&str] = &["X", "Y", "Z", "IV", "V", "PLUS", "MINUS"];
    let is_place = |part: &&str| PLACES.contains(part) || part.parse::<u32>().is_ok();
    name.split('_').filter(|part| !is_place(part)).collect()
}

/// Proofs that are about their rows without saying so.
const UNSAID: &[&str] = &[
    // Ranges: the test takes some of them, or all in a loop.
    "bahn::retained_memory_survives",
    "tnc::changed_parameters_take_effect",
    "tnc::edges_of_inputs",
    "exchange::a_quiet_scan_brings_the_images_together",
    "plc::m9001_copies_bytes",
    // Names that the test puts together: axes, keys, functions, messages with an axis.
    "tnc::analogue_inputs_of_the_extensions",
    "tnc::encoder_signals",
    "tnc::jog_increment",
    "tnc::one_mark_from_the_cam",
    "tnc::positioning_error_in_a_program",
    "tnc::software_limits",
    "interpreter::functions_calculate",
    "interpreter::functions_jump",
    // The function is reached by its own interface, or goes by another name: a chamfer is an L block.
    "interpreter::p02_chamfer",
    "plc::m9031_error_codes",
    "workpiece::another_tool_axis_is_not_shown",
    "workpiece::plunge_is_a_cylinder",
];

#[test]
fn proofs_name_what_they_prove() {
    let tests = tests();
    let mut unsaid = BTreeSet::new();
    let mut missing = Vec::new();
    for entry in all().iter().filter(|entry| entry.effect != Effect::None) {
        let mut sources = entry
            .proof
            .split(' ')
            .filter_map(|proof| tests.get(proof))
            .flatten();
        if !sources.any(|source| is_about(entry, source)) {
            unsaid.insert(entry.proof);
            if !UNSAID.contains(&entry.proof) {
                missing.push(format!("{}: {} does not name it", entry.name, entry.proof));
            }
        }
    }
    let idle: Vec<_> = UNSAID.iter().filter(|proof| !unsaid.contains(*proof)).collect();
    assert!(
        missing.is_empty() && idle.is_empty(),
        "{}\nno exception: {idle:?}",
        missing.join("\n")
    );
}

/// Names that lack a row, and rows that name nothing.
fn compare(kind: Kind, names: impl IntoIterator<Item = String>) {
    let names: BTreeSet<String> = names.into_iter().collect();
    let rows: Vec<&str> = all()
        .iter()
        .filter(|entry| entry.kind == kind)
        .map(|entry| entry.name)
        .collect();
    let unique: BTreeSet<String> = rows.iter().map(|row| (*row).to_owned()).collect();
    assert_eq!(unique.len(), rows.len(), "a row stands twice");
    let missing: Vec<_> = names.difference(&unique).collect();
    let idle: Vec<_> = unique.difference(&names).collect();
    assert!(
        missing.is_empty() && idle.is_empty(),
        "no row: {missing:?}; no object: {idle:?}"
    );
}

#[test]
fn every_marker_module_and_message_has_its_row() {
    let markers = bahn_exchange::signal::all();
    compare(
        Kind::Marker,
        markers.iter().map(|signal| signal.operand.to_string()),
    );
    let modules = bahn_plc::modules();
    compare(
        Kind::Module,
        modules.iter().map(|module| module.number.to_string()),
    );
    compare(
        Kind::Message,
        MessageId::ALL.iter().map(|id| id.name().to_owned()),
    );
}

/// M0 to M99 on every model; beyond, what the manuals name, once on each model.
#[test]
fn every_m_function_has_one_row() {
    for model in ControlModel::FAMILIES {
        for code in 0..=99 {
            let name = format!("M{code}");
            let rows = all()
                .iter()
                .filter(|entry| entry.kind == Kind::MFunction && entry.is_of(model) && entry.covers(&name));
            assert_eq!(rows.count(), 1, "{name} on {model}");
        }
    }
}

/// docs/conformance.md is what the command prints. It is written anew with BAHN_WRITE_DOCS=1.
#[test]
fn the_document_is_the_table() {
    holds_document(
        "docs/conformance.md",
        "conformance --format markdown",
        "make conformance",
    );
}

#[test]
fn the_table_can_be_narrowed() {
    let folder = Folder::new();
    let run = folder.bahn("conformance --model tnc360 --kind m");
    assert!(
        !run.out().contains("M103") && run.out().contains("M90 "),
        "{}",
        run.out()
    );
    let json = folder.bahn("conformance --model tnc425 --kind parameter --effect none --format json");
    let table: serde_json::Value = serde_json::from_str(&json.out()).unwrap();
    let entries = table["entries"].as_array().unwrap();
    assert!(entries.iter().any(|entry| entry["name"] == "MP440"));
    assert!(entries.iter().all(|entry| entry["effect"] == "none"));
    // The parameters of a TNC 425, each counted once: 885 in the manual's list for it.
    let total = |key: &str| table["totals"][0][key].as_u64().unwrap();
    assert_eq!(total("acts") + total("partly") + total("none"), 885);
    assert_eq!(folder.bahn("conformance --kind x").code(), 2);
}

/// The same program in all three commands: refused, strict, passed over.
#[test]
fn the_commands_say_what_is_not_done() {
    let folder = Folder::with_program("L X+1 R0 FMAX\nL X+2 R0 FMAX M96\nL X+3 R0 FMAX M128");
    let check = folder.bahn("check main.H");
    assert_eq!(check.code(), 1);
    assert!(check.err().contains("M96 has no effect here"), "{}", check.err());
    assert!(check.err().ends_with("1 error, 1 warning\n"), "{}", check.err());
    assert!(
        folder
            .bahn("check main.H --strict")
            .err()
            .ends_with("2 errors, 0 warnings\n")
    );
    assert_eq!(folder.bahn("check main.H --skip-unknown").code(), 0);
    let test = folder.bahn("test main.H --format json");
    assert_eq!(test.code(), 1);
    let report = test.json();
    assert_eq!(
        report["error"]["message"],
        "FUNCTION NOT AVAILABLE ON THIS CONTROL"
    );
    assert_eq!(report["error"]["block"], 3);
    assert_eq!(report["warnings"][0]["block"], 2);
    let skipped = folder.bahn("test main.H --skip-unknown --format json");
    assert_eq!(skipped.code(), 0, "{}", skipped.err());
    assert_eq!(skipped.json()["warnings"][1]["block"], 3);
    assert_eq!(folder.bahn("test main.H --strict --skip-unknown").code(), 2);
}

#[test]
fn the_machine_says_it_too() {
    let folder = Folder::with_program("L X+10 R0 FMAX\nL X+12 R0 FMAX M96\nL X+13 R0 FMAX M128");
    let mill = house::root().join("machines/mill");
    let run = |options: &str| {
        let mill = mill.display();
        folder.bahn(&format!(
            "run main.H --machine {mill} --fresh --format json {options}"
        ))
    };
    let refused = run("");
    assert_eq!(refused.code(), 1, "{}", refused.err());
    let skipped = run("--skip-unknown");
    assert_eq!(skipped.code(), 0, "{}", skipped.err());
    let text = skipped.out();
    assert!(
        text.contains("M96 has no effect here") && text.contains("passed over: this control has no M128"),
        "{text}"
    );
}

#[test]
fn barred_tools_are_refused() {
    let folder = Folder::with_program("TOOL CALL 1 Z S100\nTOOL CALL 2 Z S100");
    folder.write("tool.t", "T;R;TL;TIME2;CUR.TIME;RT\n1;5;;20;19;\n2;5;L;;;\n");
    let message = |folder: &Folder| {
        let run = folder.bahn("test main.H --tools tool.t --format json");
        run.json()["error"]["message"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    };
    assert_eq!(message(&folder), "TOOL LOCKED");
    folder.write("tool.t", "T;R;TL;TIME2;CUR.TIME;RT\n1;5;;20;19;\n2;5;;20;21;\n");
    assert_eq!(message(&folder), "MAX. TOOL LIFE EXPIRED");
}

#[test]
fn parameters_say_that_they_have_no_effect() {
    let folder = Folder::new();
    let explained = folder.bahn("mp explain 7315").out();
    let explained = explained.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        explained.contains("no effect here (no graphics without TOOL CALL, none that M functions start)"),
        "{explained}"
    );
    assert!(
        folder
            .bahn("mp explain 7310")
            .out()
            .contains("acts in part here: ")
    );
    assert!(!folder.bahn("mp explain 1060").out().contains("effect"));
    let listed = folder.bahn("mp list 7315 1060").out();
    assert_eq!(listed.matches("(no effect here)").count(), 1, "{listed}");
    let without = folder.bahn("mp list --without-effect --format json").out();
    assert!(!without.contains("\"acts\"") && without.contains("MP7315"));
    folder.write("a.mp", "MP7315 : 1\n").write("b.mp", "MP7315 : 2\n");
    let difference = folder.bahn("mp diff a.mp b.mp").out();
    assert!(
        difference.contains("no effect here (no graphics without TOOL CALL, none that M functions start)"),
        "{difference}"
    );
    folder.bahn("mp new -o mill.mp");
    let check = folder.bahn("mp check mill.mp").err();
    assert!(check.contains(" without effect here, "), "{check}");
}
