//! The next interface needs this room alone: a protocol of lines over a pipe, in one file of 60 lines.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

#[path = "adapter/lines.rs"]
mod lines;
mod support;

use std::io::{BufRead, BufReader, PipeReader, PipeWriter, Write, pipe};

use bahn_service::{MachineService, Role};
use support::Mill;

/// A client of the adapter.
struct Client {
    input: BufReader<PipeReader>,
    output: PipeWriter,
}

impl Client {
    /// Whoever has this handle is served on a thread of its own, until the client goes.
    fn of(machine: MachineService) -> Client {
        let (their_input, output) = pipe().unwrap();
        let (input, their_output) = pipe().unwrap();
        std::thread::spawn(move || lines::serve(&machine, BufReader::new(their_input), their_output));
        Client {
            input: BufReader::new(input),
            output,
        }
    }

    fn ask(&mut self, line: &str) -> String {
        writeln!(self.output, "{line}").unwrap();
        let mut answer = String::new();
        self.input.read_line(&mut answer).unwrap();
        answer.trim_end().to_owned()
    }
}

#[test]
fn the_next_adapter_needs_the_service_alone() {
    let text = include_str!("adapter/lines.rs");
    let rooms: Vec<&str> = text
        .split("bahn_")
        .skip(1)
        .map(|rest| rest.split(|one: char| !one.is_alphanumeric()).next().unwrap())
        .collect();
    assert!(
        !rooms.is_empty() && rooms.iter().all(|room| *room == "service"),
        "{rooms:?}"
    );
    assert!(text.lines().count() <= 60);

    let mill = Mill::new();
    mill.until(|screen| !screen.messages.is_empty());
    let mut client = Client::of(mill.machine.clone());
    // The mill has the axes X, Y, Z and C (machines/mill/parameters.mp, MP10).
    assert_eq!(client.ask("state"), "ok manual XYZC POWER INTERRUPTED");
    assert_eq!(client.ask("key CE"), "ok CE");
    mill.until(|screen| screen.messages.is_empty());
    assert_eq!(client.ask("key NONSENSE"), "error NONSENSE is no key");
    // CIRCLE.H has ten blocks, 0 to 9.
    assert_eq!(client.ask("get CIRCLE.H"), "ok 10");
    assert_eq!(client.ask("get NONE.H"), "error there is no file TNC:\\NONE.H");
    // No program of the mill has marker 1900.
    assert_eq!(client.ask("mem M1900"), "ok 0");
    assert_eq!(client.ask("mem M1900=1"), "ok 1");
    assert_eq!(client.ask("put NEW.A text"), "ok NEW.A");
    assert_eq!(client.ask("get NEW.A"), "ok 1");
    assert_eq!(client.ask("jump"), "error jump is no command");

    let mut looks = Client::of(mill.machine.with_role(Role::Look));
    let only = "error this token is for looking, not for operating";
    assert_eq!(looks.ask("get NEW.A"), "ok 1");
    for line in ["key CE", "mem M1900=0", "put NEW.A other"] {
        assert_eq!(looks.ask(line), only, "{line}");
    }
    assert_eq!(looks.ask("mem M1900"), "ok 1");
}
