//! Who asks for JSON gets some, also from a command that refuses what it was given: every command with `--format json`, with an
//! option that does not exist, and with files that are missing, are a folder, or are no text.

use crate::support::*;
use serde_json::Value;

/// Nobody listens there.
const NOBODY: &str = "127.0.0.1:1";

/// What each command is given; FILE is what it cannot read. Commands that read nothing have no line of arguments, since
/// the option that does not exist is all that they can refuse.
const COMMANDS: &[(&str, &[&str])] = &[
    (
        "test",
        &["FILE", "main.H --tools FILE", "main.H --parameters FILE"],
    ),
    (
        "run",
        &[
            "--machine FILE",
            "--machine mill --fresh FILE",
            "main.H --machine mill --fresh --script FILE",
        ],
    ),
    ("scope", &["FILE", "good.csv --against FILE"]),
    ("tune", &["FILE X"]),
    ("compensate", &["FILE"]),
    ("machine check", &["FILE", "mill FILE"]),
    ("machine io", &["FILE"]),
    ("check", &["FILE", "main.H FILE"]),
    ("convert", &["--to iso FILE", "--to iso main.H --tools FILE"]),
    ("plc check", &["FILE", "mill/plc/MAIN.PLC --parameters FILE"]),
    ("plc run", &["FILE", "mill/plc/MAIN.PLC --script FILE"]),
    ("plc trace", &["FILE"]),
    ("plc diagram", &["FILE --show M0"]),
    ("plc list", &["FILE"]),
    ("plc xref", &["FILE"]),
    ("plc signals", &[]),
    ("mp check", &["FILE", "mill/parameters.mp FILE"]),
    ("mp list", &["--list FILE", "--list FILE 1010"]),
    ("mp explain", &["1010 --list FILE", "9999"]),
    (
        "mp diff",
        &["FILE", "FILE mill/parameters.mp", "mill/parameters.mp FILE"],
    ),
    (
        "technology",
        &[
            "part.nc --channel FILE",
            "FILE --channel glue.lis",
            "part.nc --channel glue.lis --plc FILE",
        ],
    ),
    ("channel check", &["FILE", "glue.lis FILE"]),
    ("channel explain", &["nothing-of-this-name"]),
    ("q explain", &["P500", "nothing"]),
    ("q map", &["FILE P7000", "data.q P5000", "data.q nothing"]),
    ("q get", &["FILE P7000", "data.q P5000", "data.q nothing"]),
    (
        "q set",
        &[
            "FILE q5=1 -o out.q",
            "data.q q5=far -o out.q",
            "data.q q5=1 --status q5=1 -o out.q",
            "data.q q5 -o out.q",
            "data.q q5=1 -o data.q",
        ],
    ),
    ("q check", &["FILE"]),
    ("q diff", &["FILE data.q", "data.q FILE"]),
    ("q zero", &["FILE", "data.q --channel 2"]),
    ("q tools", &["FILE", "data.q --channel 2"]),
    ("q m", &["FILE", "data.q M1000", "data.q --channel 9"]),
    ("oem list", &["FILE"]),
    ("table show", &["FILE"]),
    ("table check", &["FILE", "mill/tools.tsv FILE"]),
    (
        "link receive",
        &[
            "--machine FILE --port connect:NOBODY A.H",
            "--machine mill --port connect:NOBODY A.H",
        ],
    ),
    (
        "link send",
        &[
            "--machine FILE --port connect:NOBODY A.H",
            "--machine mill --port connect:NOBODY A.H",
        ],
    ),
    (
        "link list",
        &[
            "--machine FILE --port connect:NOBODY",
            "--machine mill --port connect:NOBODY",
        ],
    ),
    (
        "link dnc run",
        &[
            "--machine FILE --port connect:NOBODY A.H",
            "--machine mill --port connect:NOBODY A.H",
        ],
    ),
    (
        "link dnc send",
        &[
            "--dir FILE --port connect:NOBODY A.H",
            "--dir . --port connect:NOBODY A.H",
        ],
    ),
    ("link lsv2", &[]),
    ("link lsv2 ls", &["NOBODY"]),
    ("link lsv2 get", &["NOBODY TNC:/A.H a.h"]),
    ("link lsv2 put", &["NOBODY FILE TNC:/A.H"]),
    ("link lsv2 rm", &["NOBODY TNC:/A.H"]),
    ("link lsv2 info", &["NOBODY"]),
    ("link lsv2 screen", &["NOBODY a.png"]),
    ("conformance", &[]),
    ("faults", &[]),
    ("torture", &["--machine FILE --seeds 0..1"]),
];

/// All commands whose help knows `--format json`.
fn with_json(folder: &Folder, command: &str, found: &mut Vec<String>) {
    let help = folder.bahn(&format!("{command} --help")).out();
    let format = help.split("\n      --format ").nth(1).unwrap_or_default();
    if format
        .split("\n      --")
        .next()
        .unwrap_or_default()
        .contains("json")
    {
        found.push(command.trim().to_owned());
    }
    let listed = help.split("\nCommands:\n").nth(1).unwrap_or_default();
    let names = listed.lines().take_while(|line| !line.is_empty());
    for line in names.filter(|line| line.starts_with("  ") && !line.starts_with("   ")) {
        let name = line.split_whitespace().next().unwrap();
        if name != "help" {
            with_json(folder, &format!("{command} {name}"), found);
        }
    }
}

/// Whether something in it says what is wrong.
fn says_why(value: &Value) -> bool {
    match value {
        Value::Array(items) => items.iter().any(says_why),
        Value::Object(fields) => fields.iter().any(|(name, value)| match value {
            Value::String(text) => matches!(name.as_str(), "error" | "message") && !text.is_empty(),
            Value::Array(items) if !items.is_empty() => {
                matches!(name.as_str(), "errors" | "faults" | "diagnostics" | "refused")
                    || items.iter().any(says_why)
            }
            Value::Object(_) if name == "error" => true,
            other => says_why(other),
        }),
        _ => false,
    }
}

/// What is not as it should be with a refusal; empty when all is well.
fn wrong_with(run: &Run) -> String {
    let values: Result<Vec<Value>, _> = serde_json::Deserializer::from_slice(&run.0.stdout)
        .into_iter()
        .collect();
    let what = match values {
        Ok(values) if values.is_empty() => "nothing on standard output".to_owned(),
        Ok(values) if !values.iter().any(says_why) => "does not say why".to_owned(),
        Ok(_) if run.code() != 1 && run.code() != 2 => format!("exit code {}", run.code()),
        Ok(_) => return String::new(),
        Err(error) => format!("no JSON: {error}"),
    };
    format!("{what}\n{}{}", run.out(), run.err())
}

fn desk() -> Folder {
    let folder = Folder::with_mill("L X+10 R0 FMAX");
    folder.write("part.nc", "%PART\nN10 G00 X0 Y0\nN20 G01 X40 F2000 M3\nM30\n");
    folder.write("data.q", "q102: 10000\nq103: 5000\n");
    folder.write("glue.lis", "# nothing\n");
    folder.write("good.csv", "time [s],X.lag [mm],event\n1,0.5,start\n2,0.25,\n");
    folder.write("bytes", [0x80, 0x00, 0xc3, 0x28, 0x0a, 0xff]);
    std::fs::create_dir(folder.path("empty-folder")).unwrap();
    folder
}

/// A command that is new has to be in the table above.
#[test]
fn of_every_command() {
    let folder = desk();
    let mut found = Vec::new();
    with_json(&folder, "", &mut found);
    let known: Vec<&str> = COMMANDS.iter().map(|(command, _)| *command).collect();
    assert_eq!(found, known, "the commands with --format json, and the table");
    let mut faults = Vec::new();
    for (command, given) in COMMANDS {
        let with_format = |arguments: &str| format!("{command} --format json {arguments}");
        let mut lines = vec![
            with_format("--no-such-option"),
            with_format("").replace(" json", "=json --no-such-option"),
        ];
        for arguments in *given {
            let arguments = with_format(&arguments.replace("NOBODY", NOBODY));
            match arguments.contains("FILE") {
                true => lines.extend(
                    ["missing.H", "empty-folder", "bytes"].map(|file| arguments.replace("FILE", file)),
                ),
                false => lines.push(arguments),
            }
        }
        for line in lines {
            let wrong = wrong_with(&folder.bahn(&line));
            if !wrong.is_empty() {
                faults.push(format!("bahn {line}: {wrong}"));
            }
        }
    }
    assert!(
        faults.is_empty(),
        "{} faults\n{}",
        faults.len(),
        faults.join("\n")
    );
}

/// One of several files that cannot be read has its place among the others, with its name, and hides none.
#[test]
fn one_of_several_files() {
    let folder = desk();
    for (command, good) in [
        ("check", "main.H"),
        ("mp check", "mill/parameters.mp"),
        ("machine check", "mill"),
        ("table check", "mill/tools.tsv"),
        ("channel check", "glue.lis"),
    ] {
        let run = folder.bahn(&format!("{command} --format json missing.X {good}"));
        let reports = run.json();
        assert_eq!(
            (run.code(), reports.as_array().unwrap().len()),
            (2, 2),
            "{command}: {reports:#}"
        );
        assert_eq!(reports[0]["file"], "missing.X", "{command}");
        assert_eq!(reports[0]["completed"], false, "{command}");
        assert!(
            reports[0]["error"].as_str().unwrap().contains("missing.X"),
            "{command}"
        );
        assert!(
            reports[1]["error"].is_null() && reports[1].to_string().contains(good),
            "{command}: {reports:#}"
        );
    }
    // A program of a machine that cannot be read hides neither the others nor the machine.
    std::fs::create_dir(folder.path("mill/programs/FOLDER.H")).unwrap();
    let run = folder.bahn("machine check --format json mill");
    let report = &run.json()[0];
    assert_eq!((run.code(), &report["ok"]), (1, &Value::Bool(false)));
    let programs = report["programs"].as_array().unwrap();
    let refused: Vec<&Value> = programs
        .iter()
        .filter(|program| program["error"].is_string())
        .collect();
    assert!(programs.len() > 3 && refused.len() == 1, "{report:#}");
    assert!(refused[0]["file"].as_str().unwrap().ends_with("FOLDER.H"));
}

/// A machine whose PLC program does not compile, as what answers to a technology.
#[test]
fn a_faulty_plc() {
    let folder = desk();
    folder.write(
        "mill/plc/MAIN.PLC",
        "       L     M0\n       NONSENSE\n       EM\n",
    );
    let run = folder.bahn("technology part.nc --channel glue.lis --plc mill --format json");
    let reported = run.json();
    assert_eq!(
        (run.code(), &reported["completed"]),
        (1, &Value::Bool(false)),
        "{reported:#}"
    );
    let fault = &reported["faults"][0];
    assert!(
        fault["file"].as_str().unwrap().ends_with("MAIN.PLC") && fault["line"] == 2,
        "{reported:#}"
    );
}

/// Nothing that a file, a signal, a table or a control has as its name steers the terminal: everything passes `console::print`, or
/// its like for standard error.
#[test]
fn names_do_not_steer_the_terminal() {
    let folder = desk();
    let bad = "\x1b[31mRED\x07\u{202e}";
    folder.write(
        "s.csv",
        format!("time [s],{bad}.lag [mm],event\n1,0.5,{bad}\n2,0.25,\n"),
    );
    folder.write("t.t", format!("T L R R2 NAME\n1 80.5 10 0 {bad}\n"));
    folder.write(&format!("{bad}.H"), program("L X+10 R0 FMAX\nNONSENSE"));
    folder.write(&format!("{bad}.mp"), format!("MP1010.0 : {bad}\n"));
    folder.write("part2.nc", format!("%PART\nN10 G00 X0 ({bad})\nN20 {bad}\nM30\n"));
    let file = |name: &str| format!("{bad}.{name}");
    let (h, mp) = (file("H"), file("mp"));
    for arguments in [
        vec!["scope", "s.csv"],
        vec!["scope", "s.csv", "--signals", bad],
        vec!["table", "show", "t.t"],
        vec!["table", "show", "t.t", "--format", "csv"],
        vec!["table", "check", "t.t", &mp],
        vec!["check", &h],
        vec!["test", &h],
        vec!["test", "."],
        vec!["convert", "--to", "iso", &h],
        vec!["mp", "check", &mp],
        vec!["mp", "explain", bad],
        vec!["mp", "list", bad],
        vec!["channel", "explain", bad],
        vec!["channel", "check", &mp],
        vec!["technology", "part2.nc", "--channel", "glue.lis"],
        vec!["plc", "check", &mp],
        vec!["machine", "check", bad],
        vec!["explain", bad],
        vec!["link", "lsv2", "info", bad],
    ] {
        let run = Run(folder.command().args(&arguments).output().unwrap());
        for (stream, bytes) in [("out", &run.0.stdout), ("err", &run.0.stderr)] {
            let text = String::from_utf8_lossy(bytes);
            let steers = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
            assert!(!text.contains(steers), "{arguments:?}, {stream}: {text:?}");
        }
    }
}
