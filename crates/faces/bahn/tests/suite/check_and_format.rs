//! `bahn check`, `bahn fmt`, `bahn explain`, `bahn completions`.

use crate::support::Folder;
use serde_json::json;

#[test]
fn check_shows_all_errors_of_all_files_in_one_pass() {
    let folder = Folder::with_program("L X+10 Ynan\nL X+1 R0 F100\nCALL LBL 7");
    folder.write("good.H", "BEGIN PGM GOOD MM\nL X+1 R0 F100\nEND PGM GOOD MM\n");
    let run = folder.bahn("check main.H good.H");
    assert_eq!(run.code(), 1);
    let err = run.err();
    assert!(err.contains("main.H:2:8") && err.contains("main.H:4:10"), "{err}");
    assert!(err.contains("main.H: 5 blocks, 2 errors, 0 warnings"), "{err}");
    assert!(err.contains("good.H: 3 blocks, 0 errors, 0 warnings"), "{err}");
    assert_eq!(folder.bahn("check good.H").code(), 0);
    assert_eq!(folder.bahn("check good.H nothing.H").code(), 2);
}

#[test]
fn check_reports_as_json() {
    let folder = Folder::with_program("L X+10 Ynan");
    let run = folder.bahn("check main.H --format json");
    assert_eq!(run.code(), 1);
    let report = run.json();
    assert_eq!(report[0]["errors"], 1);
    let found = &report[0]["diagnostics"][0];
    assert_eq!(
        (&found["severity"], &found["block"], &found["line"]),
        (&json!("error"), &json!(1), &json!(2))
    );
    assert_eq!((&found["column"], &found["length"]), (&json!(8), &json!(4)));
    assert_eq!(found["message"], "ENTRY VALUE INCORRECT");
}

#[test]
fn check_knows_the_limits_of_models() {
    // Q200 and formulas are those of the TNC 407 and later.
    let folder = Folder::with_program("FN0: Q200 = +1");
    assert_eq!(folder.bahn("check main.H --model tnc415b").code(), 0);
    assert_eq!(folder.bahn("check main.H --model tnc360").code(), 1);
}

const LOOSE: &str =
    "\u{feff}BEGIN PGM 1 MM\r\n\r\nl x5y-10,50r0 f 100m03\r\n  CC X+0 Y+0 ; pole\r\nEND PGM 1 MM\r\n";
const LISTING: &str = "0 BEGIN PGM 1 MM\n1 L X+5 Y-10.5 R0 F100 M3\n2 CC X+0 Y+0 ; pole\n3 END PGM 1 MM\n";

#[test]
fn fmt_prints_the_listing() {
    let folder = Folder::new();
    folder.write("main.H", LOOSE);
    let run = folder.bahn("fmt main.H");
    assert_eq!((run.code(), run.out().as_str()), (0, LISTING));
    assert_eq!(
        folder.bahn("fmt main.H --comma").out(),
        LISTING.replace("10.5", "10,5")
    );
    assert_eq!(folder.read("main.H"), LOOSE, "nothing is written without --write");
    assert_eq!(folder.bahn("fmt nothing.H").code(), 2);
}

#[test]
fn fmt_writes_and_checks() {
    let folder = Folder::new();
    folder.write("main.H", LOOSE).write("same.H", LISTING);
    let run = folder.bahn("fmt --check main.H same.H");
    assert_eq!((run.code(), run.out().as_str()), (1, "main.H\n"));
    assert_eq!(folder.bahn("fmt --write main.H same.H").code(), 0);
    assert_eq!(folder.read("main.H"), LISTING);
    assert_eq!(folder.bahn("fmt --check main.H same.H").code(), 0);
    assert_eq!(folder.names(), ["main.H", "same.H"]);
    assert_eq!(folder.bahn("fmt --check --write main.H").code(), 2);
}

#[cfg(unix)]
#[test]
fn fmt_keeps_permissions_and_links() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = Folder::new();
    folder.write("main.H", LOOSE);
    std::fs::set_permissions(folder.path("main.H"), std::fs::Permissions::from_mode(0o640)).unwrap();
    symlink("main.H", folder.path("link.H")).unwrap();
    assert_eq!(folder.bahn("fmt --write link.H").code(), 0);
    assert_eq!(folder.read("main.H"), LISTING);
    assert!(
        std::fs::symlink_metadata(folder.path("link.H"))
            .unwrap()
            .is_symlink()
    );
    assert_eq!(
        std::fs::metadata(folder.path("main.H"))
            .unwrap()
            .permissions()
            .mode()
            & 0o777,
        0o640
    );
}

#[test]
fn messages_are_explained() {
    let folder = Folder::new();
    for wanted in [
        "TOOL RADIUS TOO LARGE",
        "tool radius too large",
        "ToolRadiusTooLarge",
    ] {
        let run = folder.bahn(&format!("explain {wanted}"));
        assert_eq!(run.code(), 0);
        assert!(
            run.out().starts_with("TOOL RADIUS TOO LARGE\n  cause:"),
            "{}",
            run.out()
        );
    }
    // The text of another model finds the message too.
    assert_eq!(folder.bahn("explain WRONG RPM").code(), 0);
    assert!(folder.bahn("explain").out().lines().count() > 40);
    assert_eq!(folder.bahn("explain COFFEE IS READY").code(), 2);
    for (wanted, expected) in [
        (
            "GROSS POSITIONING ERROR A",
            "GROSS POSITIONING ERROR A\n  cause:       The lag is above",
        ),
        (
            "limit switch x+",
            "LIMIT SWITCH X+\n  which:       positive end of axis X: MP910.0",
        ),
        (
            "ERROR IN PLC-PROGRAM 1Q",
            "ERROR IN PLC-PROGRAM 1Q\n  cause:       More than one",
        ),
        (
            "plc error 16",
            "PLC error 16 jump within a parenthesis\n  found:       when",
        ),
        ("tapping", "Machine parameters (bahn mp explain N)\n"),
    ] {
        let out = folder.bahn(&format!("explain {wanted}")).out();
        assert!(out.contains(expected), "{wanted}: {out}");
        assert!(out.lines().all(|line| line.chars().count() <= 80), "{out}");
    }
}

#[test]
fn completions_name_the_options() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let run = folder.bahn(&format!("completions {shell}"));
        assert_eq!(run.code(), 0);
        assert!(run.out().contains("resolution"), "{shell}");
    }
    assert_eq!(folder.bahn("completions tcsh").code(), 2);
}

/// Five faults of a beginner are five errors, each with the help that fits.
#[test]
fn check_goes_on_after_an_error() {
    let folder = Folder::with_program(
        "BLK FORM 0.2 X+100 Y+100 Z+0\nL X+0 Y+0 R0\nL X+20 Y+5 RL F200\nL X+3O\nC X+40 Y+20 DR+\nL X+0 R0\n\
         CYCL CALL",
    );
    let run = folder.bahn("check main.H");
    let err = run.err();
    assert_eq!(run.code(), 1);
    assert!(err.contains("6 errors, 0 warnings"), "{err}");
    for help in [
        "Program BLK FORM 0.1",
        "Enter a feed rate",
        "Call the tool before",
        "Correct the word or delete it",
        "Program CC with",
        "Define a cycle with CYCL DEF",
    ] {
        assert_eq!(err.matches(help).count(), 1, "{help}: {err}");
    }
}

/// A file of nonsense is one line for each of the first hundred blocks and a count of the others.
#[test]
fn check_does_not_drown_in_errors() {
    let folder = Folder::new();
    folder.write("main.H", "IFT\n".repeat(50_000));
    let run = folder.bahn("check main.H");
    let err = run.err();
    assert!(err.len() < 40_000, "{}", err.len());
    assert!(
        err.contains("50000 errors") && err.contains("not shown"),
        "{}",
        &err[err.len() - 200..]
    );
    // DIN/ISO is said in one line.
    folder.write("iso.H", "%1000 G71 *\nN10 G00 G40 X+5 *\nN20 X+7 *\n");
    let err = folder.bahn("check iso.H").err();
    assert!(
        err.contains("DIN/ISO programming is read from files whose names end with .I"),
        "{err}"
    );
    assert!(err.contains("1 error, 0 warnings"), "{err}");
}

#[test]
fn check_follows_calls_of_programs() {
    let folder = Folder::with_program("L X+0 Y+0 R0 F100\nCALL PGM Part_7\nCALL PGM nothing");
    folder.write("PART_7.h", "BEGIN PGM 7 MM\nL X+5\nC X+9 Y+9 DR+\nEND PGM 7 MM\n");
    let err = folder.bahn("check main.H").err();
    assert!(
        err.contains("PART_7.h:3") && err.contains("there is no program nothing"),
        "{err}"
    );
    assert!(err.contains("2 errors"), "{err}");
}

/// A program calls its neighbours by their names in any case, and beside a `.nc` file also `.nc`.
#[test]
fn called_programs_are_found_in_any_case() {
    let folder = Folder::new();
    folder
        .write(
            "main.nc",
            "BEGIN PGM 1 MM\nCALL PGM sub\nCALL PGM OTHER\nEND PGM 1 MM\n",
        )
        .write("SUB.NC", "BEGIN PGM 2 MM\nL X+5 R0 F100\nEND PGM 2 MM\n")
        .write("other.nc", "BEGIN PGM 3 MM\nL X+15 R0 F100\nEND PGM 3 MM\n");
    let run = folder.bahn("test main.nc --format json");
    assert_eq!(run.code(), 0, "{}", run.err());
    assert_eq!(run.json()["final_position"]["X"], 15.0);
}

#[test]
fn check_and_test_count_feeds_alike() {
    let folder = Folder::new();
    // 2000 inch/min are beyond the limits of the TNC 360, 2000 tenths are not.
    folder.write(
        "main.H",
        "BEGIN PGM 1 INCH\nL X+0 R0 F2000\nL X+9 F100\nEND PGM 1 INCH\n",
    );
    for command in ["check", "test"] {
        let code = |option: &str| {
            folder
                .bahn(&format!("{command} main.H --model tnc360 {option}"))
                .code()
        };
        assert_eq!(
            (code(""), code("--inch-feed tenths"), code("--inch-feed whole")),
            (1, 0, 1),
            "{command}"
        );
    }
    folder.write("slow.H", "BEGIN PGM 1 INCH\nL X+0 R0 F8\nL X+9\nEND PGM 1 INCH\n");
    let warned = folder.bahn("check slow.H");
    assert!(warned.err().contains("--inch-feed whole"), "{}", warned.err());
    assert!(
        !folder
            .bahn("check slow.H --inch-feed whole")
            .err()
            .contains("warning:")
    );
    assert!(folder.bahn("test slow.H").out().contains("--inch-feed whole"));
}

#[test]
fn fmt_leaves_files_alone_that_are_no_programs() {
    let folder = Folder::new();
    let quoting = "# Title\n\nBEGIN PGM 1 MM\nl x5\nEND PGM 1 MM\nmore\n";
    folder
        .write("plant.toml", "[axis]\nX = 5\n")
        .write("README.md", quoting)
        .write("main.H", LOOSE);
    let run = folder.bahn("fmt --write plant.toml README.md main.H");
    assert_eq!(run.code(), 2, "{}", run.err());
    assert!(run.err().contains("plant.toml stays as it is"), "{}", run.err());
    assert_eq!(folder.read("plant.toml"), "[axis]\nX = 5\n");
    assert_eq!(folder.read("README.md"), quoting);
    assert_eq!(folder.read("main.H"), LISTING);
}

/// A pipe gives its bytes once.
#[cfg(unix)]
#[test]
fn fmt_checks_what_comes_through_a_pipe() {
    let folder = Folder::new();
    folder.write("same.H", LISTING).write("main.H", LOOSE);
    let piped = |file: &str| {
        let command = format!(
            "cat {file} | {} fmt --check /dev/stdin",
            env!("CARGO_BIN_EXE_bahn")
        );
        let status = std::process::Command::new("sh")
            .args(["-c", &command])
            .current_dir(folder.path("."))
            .output()
            .unwrap()
            .status;
        status.code()
    };
    assert_eq!((piped("same.H"), piped("main.H")), (Some(0), Some(1)));
}

/// Control characters of programs and file names never reach the terminal.
#[cfg(unix)]
#[test]
fn escape_sequences_are_shown_not_sent() {
    let folder = Folder::new();
    let name = "a\u{1b}[31m.H";
    folder.write(
        name,
        "BEGIN PGM \u{1b}[2J MM\nCALL PGM x\u{1b}]0;y\u{7}\nL Xnan ; \u{1b}[1m\nEND PGM 1 MM\n",
    );
    for command in ["check", "test", "fmt --check"] {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_bahn"))
            .args(command.split(' '))
            .arg(name)
            .current_dir(folder.path("."))
            .output()
            .unwrap();
        for text in [output.stdout, output.stderr] {
            let text = String::from_utf8(text).unwrap();
            assert!(
                !text.contains('\u{1b}') && !text.contains('\u{7}'),
                "{command}: {text:?}"
            );
        }
    }
}

/// Nor do they reach a table, a report or a log, in which a line stays a line.
#[cfg(unix)]
#[test]
fn escape_sequences_reach_no_file() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("shelf")).unwrap();
    let name = "shelf/a\u{1b}[31m\nb.H";
    folder.write(
        name,
        "BEGIN PGM \u{1b}[2J MM\nTOOL CALL 3 Z S500\nL X+1 Y+1 R0 F500\nCALL PGM x\u{1b}]0;y\nEND PGM 1 MM\n",
    );
    let mill = format!("{}/../../../machines/mill", env!("CARGO_MANIFEST_DIR"));
    let run = format!("--machine {mill} --fresh --no-graphics --log out.log --record out.csv");
    for (command, arguments, files) in [
        (
            "test",
            "--path path.csv --path path.svg",
            &["path.csv", "path.svg"][..],
        ),
        ("run", &run, &["out.log", "out.csv"]),
    ] {
        let output = folder
            .command()
            .arg(command)
            .arg(name)
            .args(arguments.split(' '))
            .output();
        assert!(
            output.unwrap().status.code().is_some_and(|code| code <= 1),
            "{command}"
        );
        for file in files {
            assert!(!folder.read(file).contains('\u{1b}'), "{}", folder.read(file));
        }
    }
    let log = folder.read("out.log");
    assert!(
        log.lines()
            .all(|line| line.starts_with("; ") || line.contains(": ")),
        "{log}"
    );
    for report in ["all.csv", "all.html", "all.json"] {
        folder.bahn(&format!("test shelf --report {report}"));
        assert!(!folder.read(report).contains('\u{1b}'), "{report}");
    }
}
