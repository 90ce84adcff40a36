//! A data interface asks nobody for a password: who opens it at an address that others reach is told so.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

mod support;

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Stdio};

use support::*;

/// A command that goes on until somebody ends it.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// What a command says on standard error until all its ports are open.
fn said(folder: &Folder, arguments: &str) -> String {
    let mut command = folder.command();
    command
        .args(arguments.split(' '))
        .env("XDG_DATA_HOME", folder.path("data"))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut running = Running(command.spawn().unwrap());
    let mut said = String::new();
    match arguments.starts_with("panel") {
        true => {
            let mut lines = BufReader::new(running.0.stderr.take().unwrap());
            while !said.contains("the panel is at") {
                assert!(lines.read_line(&mut said).unwrap() > 0, "{arguments}: {said}");
            }
        }
        false => {
            let mut lines = BufReader::new(running.0.stdout.take().unwrap());
            let mut line = String::new();
            while !line.contains("ready") {
                assert!(lines.read_line(&mut line).unwrap() > 0, "{arguments}: {line}");
            }
            let mut errors = running.0.stderr.take().unwrap();
            drop(running);
            errors.read_to_string(&mut said).unwrap();
        }
    }
    said
}

#[test]
fn who_listens_for_others_is_warned() {
    let folder = Folder::with_mill("L X+10 R0 FMAX");
    for command in [
        "panel --listen 127.0.0.1:0 --machine mill --rs232",
        "panel --listen 127.0.0.1:0 --machine mill --rs422",
        "link serve --machine mill --rs232",
        "link serve --machine mill --rs422",
        "link disk mill/programs --port",
    ] {
        for (address, others) in [
            ("0.0.0.0:0", true),
            ("127.0.0.1:0", false),
            ("127.0.0.2:0", false),
        ] {
            let line = format!("{command} tcp:{address}");
            let said = said(&folder, &line);
            assert_eq!(
                said.contains("can be reached by others"),
                others,
                "{line}: {said}"
            );
            let says = format!("warning: tcp:{address} can be reached by others");
            assert_eq!(said.contains(&says), others, "{line}: {said}");
        }
    }
}
