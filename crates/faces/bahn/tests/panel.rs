//! `bahn panel` as a user starts it: it says where it is, answers, and keeps everything when it ends.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod support;

use std::process::{Child, Command};

use support::{request, start_panel, until_screen};

fn end(mut child: Child) -> i32 {
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    child.wait().unwrap().code().unwrap()
}

#[test]
fn the_mill_needs_no_folder_and_keeps_what_is_done() {
    let data = std::env::temp_dir().join(format!("bahn-panel-command-{}", std::process::id()));
    let (child, address) = start_panel(&data, &[]);
    until_screen(&address, "POWER INTERRUPTED");
    assert!(request(&address, "GET", "/", "").contains("data-region=\"header\""));
    let keys = ["CE", "PROGRAM", "MANUAL"];
    for key in keys {
        let answer = request(&address, "POST", "/api/key", &format!("{{\"key\":\"{key}\"}}"));
        assert!(answer.contains("\"ok\":true"), "{answer}");
    }
    assert_eq!(end(child), 0);
    // A second time the folder is there; a session is recorded, and shown again on a third.
    let session = data.join("session.jsonl");
    let (child, address) = start_panel(&data, &["--record", session.to_str().unwrap()]);
    until_screen(&address, "POWER INTERRUPTED");
    request(&address, "POST", "/api/key", "{\"key\":\"CE\"}");
    until_screen(&address, "REFERENCE");
    assert_eq!(end(child), 0);
    let recorded = std::fs::read_to_string(&session).unwrap();
    assert!(
        recorded.contains("\"key\":\"CE\"") && recorded.contains("\"end\""),
        "{recorded}"
    );
    let (child, address) = start_panel(&data, &["--replay", session.to_str().unwrap(), "--speed", "20"]);
    until_screen(&address, "REFERENCE");
    assert_eq!(end(child), 0);
    std::fs::remove_dir_all(data).unwrap();
}

#[test]
fn others_need_a_token() {
    let output = Command::new(env!("CARGO_BIN_EXE_bahn"))
        .args(["panel", "--listen", "0.0.0.0:0"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("needs a token"));
}

/// Presses keys, numbers by their digits.
fn press(address: &str, keys: &str) {
    for key in keys.split_whitespace() {
        let answer = request(address, "POST", "/api/key", &format!("{{\"key\":\"{key}\"}}"));
        assert!(answer.contains("\"ok\":true"), "{key}: {answer}");
    }
}

#[test]
fn a_killed_panel_has_lost_nothing_of_a_program() {
    let data = std::env::temp_dir().join(format!("bahn-panel-killed-{}", std::process::id()));
    let (mut child, address) = start_panel(&data, &[]);
    until_screen(&address, "POWER INTERRUPTED");
    press(
        &address,
        "CE PROGRAM PGM_NR 7 7 ENT ENT L X 1 5 Y 2 ENT ENT ENT NO_ENT",
    );
    until_screen(&address, "L X+15 Y+2 R0 FMAX");
    // In the middle of the next block the process is gone, without a word.
    press(&address, "L X 4 2");
    until_screen(&address, "X+42");
    child.kill().unwrap();
    child.wait().unwrap();
    let (child, address) = start_panel(&data, &[]);
    until_screen(&address, "POWER INTERRUPTED");
    press(&address, "CE PROGRAM PGM_NR 7 7 ENT");
    until_screen(&address, "L X+15 Y+2 R0 FMAX");
    // The block that was open is there as it was typed, and goes on.
    until_screen(&address, "X+42");
    press(&address, "ENT ENT ENT NO_ENT");
    until_screen(&address, "L X+42 R0 FMAX");
    assert_eq!(end(child), 0);
    std::fs::remove_dir_all(data).unwrap();
}
/// A second panel of the same machine is told what helps; it has no option that runs beside the first.
#[test]
fn a_second_panel_is_shown_what_helps() {
    let folder = std::env::temp_dir().join(format!("bahn-panel-second-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (first, _) = start_panel(&folder, &[]);
    let second = Command::new(env!("CARGO_BIN_EXE_bahn"))
        .args(["panel", "--listen", "127.0.0.1:0"])
        .env("XDG_DATA_HOME", &folder)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&second.stderr).into_owned();
    assert_eq!(second.status.code(), Some(2), "{said}");
    assert!(said.contains("switched on already"), "{said}");
    assert!(said.contains("--machine") && !said.contains("--fresh"), "{said}");
    assert_eq!(end(first), 0);
    std::fs::remove_dir_all(folder).unwrap();
}
