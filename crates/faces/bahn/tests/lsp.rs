//! `bahn lsp` as an editor starts it: every request in every language over standard input and output.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here fails the test")]

#[path = "../../lsp/tests/support/client.rs"]
mod client;
#[path = "../../lsp/tests/support/script.rs"]
mod script;
mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use serde_json::{Value, json};

use client::{Client, Wire};
use support::Folder;

/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(30);

/// The command, with the messages that it has written.
struct Command {
    child: Child,
    input: Option<ChildStdin>,
    output: Receiver<Value>,
}

impl Command {
    fn start(folder: &Folder, options: &[&str]) -> Command {
        let mut command = folder.command();
        let command = command
            .arg("lsp")
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let input = child.stdin.take();
        let mut reader = BufReader::new(child.stdout.take().unwrap());
        let (sender, output) = channel();
        std::thread::spawn(move || {
            while let Some(message) = message(&mut reader) {
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        Command { child, input, output }
    }

    /// Ends the input, and waits for the exit code.
    fn code(mut self) -> i32 {
        self.input = None;
        self.child.wait().unwrap().code().unwrap()
    }
}

/// A message with its head; none at the end.
fn message(reader: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if reader.read_line(&mut line).ok()? == 0 {
            return None;
        }
        if line.trim().is_empty() {
            break;
        }
        if let Some(number) = line.strip_prefix("Content-Length:") {
            length = number.trim().parse().unwrap();
        }
    }
    let mut bytes = vec![0; length];
    reader.read_exact(&mut bytes).ok()?;
    Some(serde_json::from_slice(&bytes).unwrap())
}

impl Wire for Command {
    fn send(&mut self, message: Value) {
        let text = message.to_string();
        let input = self.input.as_mut().unwrap();
        write!(input, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        input.flush().unwrap();
    }

    fn receive(&mut self, patience: Duration) -> Option<Value> {
        self.output.recv_timeout(patience).ok()
    }
}

#[test]
fn an_editor_works_with_documents_of_every_language() {
    let folder = Folder::new();
    script::lay_out(folder.as_ref());
    let mut client = Client::start(Command::start(&folder, &["--stdio"]), Value::Null);
    script::plain(&mut client, folder.as_ref());
    script::iso(&mut client, folder.as_ref());
    script::plc(&mut client, folder.as_ref());
    script::list(&mut client, folder.as_ref());
    script::din(&mut client, folder.as_ref());
    script::conversions(&mut client, folder.as_ref());
    script::others(&mut client, folder.as_ref());
    assert_eq!(client.end().code(), 0);
}

/// The control is that of the machine in whose folder a program lies, unless the user says otherwise.
#[test]
fn a_file_of_a_machine_is_for_its_control() {
    let folder = Folder::new();
    support::copy(&support::machines().join("mill-tnc360"), &folder.path("mill"));
    let path = folder.path("mill/programs/q.H");
    // A TNC 360 has Q123 at most.
    std::fs::write(&path, "0 BEGIN PGM q MM\n1 FN0: Q200 = +0\n2 END PGM q MM\n").unwrap();
    for (options, errors) in [(&[][..], 1), (&["--model", "tnc415b"], 0)] {
        let mut client = Client::start(Command::start(&folder, options), Value::Null);
        let document = client.open(&path, "tnc-plain");
        assert_eq!(client.diagnostics(&document).len(), errors, "{options:?}");
        assert_eq!(client.end().code(), 0);
    }
}

/// An editor that dies leaves no server behind.
#[test]
fn a_server_ends_with_its_editor() {
    let folder = Folder::new();
    let client = Client::start(Command::start(&folder, &[]), json!({"model": "tnc360"}));
    assert_eq!(client.into_wire().code(), 2);
    let command = Command::start(&folder, &[]);
    assert_eq!(command.code(), 2, "before it has begun");
}

/// What is no message is answered or logged; a length beyond all messages ends the server with a word.
#[test]
fn what_is_no_message_does_not_end_the_server() {
    let folder = Folder::new();
    let client = Client::start(Command::start(&folder, &[]), Value::Null);
    let mut wire = client.into_wire();
    let raw = |wire: &mut Command, text: &str| {
        let input = wire.input.as_mut().unwrap();
        input.write_all(text.as_bytes()).unwrap();
        input.flush().unwrap();
    };
    raw(&mut wire, "Content-Length: 1\r\n\r\n{");
    let log = wire.receive(PATIENCE).unwrap();
    assert_eq!(log["method"], "window/logMessage");
    raw(&mut wire, "Content-Length: 22\r\n\r\n{\"id\":7,\"method\":null}");
    let refused = wire.receive(PATIENCE).unwrap();
    assert_eq!(
        (&refused["id"], &refused["error"]["code"]),
        (&json!(7), &json!(-32600))
    );
    wire.send(json!({"jsonrpc": "2.0", "id": 8, "method": "shutdown"}));
    assert_eq!(wire.receive(PATIENCE).unwrap()["id"], 8);
    let client = Client::start(Command::start(&folder, &[]), Value::Null);
    let mut wire = client.into_wire();
    raw(&mut wire, "Content-Length: 4611686018427387904\r\n\r\n{}");
    let mut error = String::new();
    wire.child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut error)
        .unwrap();
    assert!(error.contains("Content-Length 4611686018427387904"), "{error}");
    assert_eq!(wire.child.wait().unwrap().code(), Some(2));
}
