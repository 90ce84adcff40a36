//! Whatever lies in the folder of programs, the machine can be switched on: a file that cannot be used is said at power-on, and
//! refused by what uses it.

use std::fs;

use crate::support::*;
use bahn_host::{Action, Answer, Attendance, FolderPrograms, Host, LoadedMachine, Operator, PowerOn, Source};
use bahn_tnc::Command;

/// Names, what stands in them, and whether that is said at power-on.
fn kinds() -> Vec<(&'static str, Vec<u8>, bool)> {
    let text = |text: &str| text.as_bytes().to_vec();
    let huge = || vec![b'7'; 40 << 20];
    vec![
        ("EMPTY.D", text(""), true),
        (
            "LATER.D",
            text("BEGIN LATER .D MM\nNR X Y Z A B C\n0  1 2 3 0 0 0\n[END]\n"),
            false,
        ),
        ("AXES.D", text("NR X B C\n0 1 7 0\n"), true),
        ("BINARY.D", (0..=255).cycle().take(5000).collect(), true),
        ("HUGE.D", huge(), true),
        ("lower.d", text("NR X\n0 1x\n"), true),
        ("EMPTY.P", text(""), false),
        ("BAD.P", text("NR\n1\n"), false),
        ("NAMES.A", text("\u{fc}\u{0}"), false),
        ("POINTS.PNT", text("no points"), false),
        ("AXES.COM", text("X"), false),
        ("AXES.CMA", text("ACTIVE 77"), false),
        ("TOOL.T", text("T\n-1\n"), false),
        ("TOOL_P.TCH", text("P\n9999\n"), false),
        ("HELP.HLP", text("#"), false),
        ("OLD.BAK", (128..=255).collect(), false),
        ("99999968.H", text("BEGIN PGM 1 MM\n"), false),
        ("EMPTY.H", text(""), false),
        ("HUGE.I", huge(), false),
        ("BINARY.H", (0..=255).cycle().take(5000).collect(), false),
        ("two words.H", text("BEGIN PGM 1 MM\nEND PGM 1 MM\n"), false),
        ("Fr\u{e4}se \u{2460}.D", text("nothing"), true),
        ("without", text(""), false),
        (".hidden.D", text("?"), true),
    ]
}

fn switch_on(copy: &Copy) -> (Host, Vec<String>) {
    let machine = LoadedMachine::load(copy.path())
        .unwrap()
        .unwrap_or_else(|faults| panic!("{faults:#?}"));
    let power_on = PowerOn::kept(&machine).unwrap();
    let warnings = power_on.warnings.clone();
    let operator = Operator::new(Attendance::Full, machine.folder.operator.clone(), None);
    let programs = FolderPrograms::of_folder(&machine.programs(0));
    (
        Host::new(&machine, power_on, std::sync::Arc::new(programs), operator).unwrap(),
        warnings,
    )
}

/// The reference marks are passed.
fn ready(host: &mut Host) {
    while host.operator().phase() != bahn_host::Phase::Ready || !host.control().stands() {
        assert!(host.control().time_us() < 200_000_000);
        host.step().unwrap();
    }
    seconds(host, 0.5);
}

fn command(host: &mut Host, text: &str) -> Answer {
    let action = match text.parse::<Command>() {
        Ok(command) => Action::Command(0, command),
        Err(_) => Action::parse(text).unwrap(),
    };
    host.act(Source::Script, action).unwrap()
}

/// A program of the operator from its selection to its end, or to its message.
fn run(host: &mut Host, name: &str) -> Vec<String> {
    if !host.control().shown().is_empty() {
        command(host, "ce");
    }
    for text in ["mode full", &format!("select {name}"), "key NC_START tap"] {
        command(host, text);
        seconds(host, 0.3);
    }
    let end_us = host.control().time_us() + 30_000_000;
    while !host.control().snapshot().ended
        && host.control().shown().is_empty()
        && host.control().time_us() < end_us
    {
        host.step().unwrap();
    }
    let control = host.control();
    // With what the control knows of it beside its text.
    let words = |shown: &bahn_tnc::Shown| format!("{} {:?}", control.shown_text(shown), shown.message);
    control.shown().iter().map(words).collect()
}

/// More than 16 kinds, one by one and all together, with directories, what may not be read, and links to nowhere.
#[test]
fn no_file_of_the_folder_keeps_the_machine_off() {
    let copy = Copy::of("mill", "any-file");
    let folder = copy.path().join("programs");
    let (mut wrong, kinds) = (0, kinds());
    assert!(kinds.len() >= 16);
    for (name, content, is_said) in &kinds {
        fs::write(folder.join(name), content).unwrap();
        wrong += usize::from(*is_said);
        let (_, warnings) = switch_on(&copy);
        assert_eq!(warnings.len(), wrong, "{name}: {warnings:#?}");
        assert_eq!(
            warnings
                .iter()
                .any(|warning| warning.contains(name) && warning.contains("refused when it is used")),
            *is_said,
            "{name}: {warnings:#?}"
        );
    }
    for name in ["FOLDER.D", "FOLDER.P", "FOLDER.H"] {
        fs::create_dir(folder.join(name)).unwrap();
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::{PermissionsExt, symlink};
        for name in ["NOWHERE.D", "NOWHERE.H"] {
            symlink(folder.join("nothing there"), folder.join(name)).unwrap();
        }
        fs::write(folder.join("SECRET.H"), "BEGIN PGM 1 MM\nEND PGM 1 MM\n").unwrap();
        fs::set_permissions(folder.join("SECRET.H"), fs::Permissions::from_mode(0o000)).unwrap();
    }
    fs::write(
        folder.join("GOOD.H"),
        "BEGIN PGM GOOD MM\nL X+10 R0 FMAX\nEND PGM GOOD MM\n",
    )
    .unwrap();
    let (mut host, warnings) = switch_on(&copy);
    assert_eq!(warnings.len(), wrong, "{warnings:#?}");
    ready(&mut host);
    assert_eq!(run(&mut host, "GOOD.H"), [""; 0]);
    // Whatever the operator chooses, the control goes on.
    for (name, ..) in &kinds {
        run(&mut host, name);
    }
    assert_eq!(run(&mut host, "GOOD.H"), [""; 0]);
}

/// A faulty, a missing and an unreadable table are refused at the block that wants a datum of them, whoever selected them: machine.toml
/// names them here [000:6898-6904].
#[test]
fn a_faulty_table_is_refused_where_it_is_used() {
    let copy = Copy::of("mill", "faulty-table");
    let folder = copy.path().join("programs");
    let program = |what: &str| format!("BEGIN PGM 1 MM\n{what}\nEND PGM 1 MM\n");
    fs::write(
        folder.join("SHIFT.H"),
        program("CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #0\nL X+1 R0 FMAX"),
    )
    .unwrap();
    fs::write(folder.join("PLAIN.H"), program("L X+1 R0 FMAX")).unwrap();
    let description = fs::read_to_string(copy.path().join("machine.toml")).unwrap();
    fs::write(
        copy.path().join("machine.toml"),
        description.replace(
            "programs = \"programs\"",
            "programs = \"programs\"\ndatum_table = \"ZERO.D\"\npallets = \"JOBS.P\"",
        ),
    )
    .unwrap();
    fs::write(folder.join("JOBS.P"), "NR PGM\n0 PLAIN\n").unwrap();
    let tried = [
        (Some("NR X\n0 1x\n"), Some("`1x` is no number")),
        (Some(""), Some("the table is empty")),
        (None, Some("is missing")),
        (Some("NR X\n0 1\n"), None),
    ];
    for (table, fault) in tried {
        let _ = fs::remove_file(folder.join("ZERO.D"));
        if let Some(table) = table {
            fs::write(folder.join("ZERO.D"), table).unwrap();
        }
        let (mut host, warnings) = switch_on(&copy);
        assert_eq!(!warnings.is_empty(), fault.is_some(), "{warnings:?}");
        ready(&mut host);
        assert_eq!(run(&mut host, "PLAIN.H"), [""; 0]);
        let said = run(&mut host, "SHIFT.H");
        match fault {
            None => assert_eq!(said, [""; 0]),
            Some(fault) => assert!(
                said.len() == 1 && said[0].contains("ENTRY VALUE INCORRECT") && said[0].contains(fault),
                "{fault}: {said:?}"
            ),
        }
    }
    // A pallet file that cannot be read is none.
    fs::write(folder.join("JOBS.P"), "NR\n1\n").unwrap();
    let (_, warnings) = switch_on(&copy);
    assert!(
        warnings.len() == 1 && warnings[0].contains("JOBS.P"),
        "{warnings:?}"
    );
}

/// What was half written in any folder of the machine by who was killed goes at the next power-on, and nothing else.
#[test]
fn half_written_files_go() {
    let copy = Copy::of("mill", "half-written");
    let folders = [".", "programs", "plc", "state", "lessons"];
    let ours = [".X.H.4711-3.tmp", ".control.toml.4711.tmp"];
    let others = [".X.H.tmp", "X.H.4711-3.tmp", ".X.H.47a-3.tmp", ".4711.tmp.H"];
    for folder in folders {
        let folder = copy.path().join(folder);
        fs::create_dir_all(&folder).unwrap();
        for name in ours.iter().chain(&others) {
            fs::write(folder.join(name), "half").unwrap();
        }
    }
    drop(switch_on(&copy));
    for folder in folders {
        let folder = copy.path().join(folder);
        assert!(
            ours.iter().all(|name| !folder.join(name).exists()),
            "{}",
            folder.display()
        );
        assert!(
            others.iter().all(|name| folder.join(name).exists()),
            "{}",
            folder.display()
        );
    }
}
