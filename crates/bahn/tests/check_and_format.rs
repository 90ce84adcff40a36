//! `bahn check`, `bahn fmt`, `bahn explain`, `bahn completions`.

mod support;

use serde_json::json;
use support::Folder;

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
