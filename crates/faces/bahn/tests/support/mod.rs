//! Runs the real command in a folder of its own.

#![allow(dead_code, reason = "every test file uses its part")]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "what fails in the support of tests fails the test"
)]

#[path = "../../../../machine/host/tests/support/copy.rs"]
mod copy;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

pub use copy::copy;
use serde_json::Value;

/// Starts `bahn panel` with its data in a folder and waits until it is there: the process, and its address.
pub fn start_panel(folder: &Path, options: &[&str]) -> (Child, String) {
    std::fs::create_dir_all(folder).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_bahn"))
        .args(["panel", "--listen", "127.0.0.1:0"])
        .args(options)
        .current_dir(folder)
        .env("XDG_DATA_HOME", folder)
        .stderr(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = String::new();
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    while !said.contains("the panel is at") {
        said.clear();
        assert!(lines.read_line(&mut said).unwrap() > 0, "it ended");
    }
    // What is said later is read, so that nobody waits for it.
    std::thread::spawn(move || std::io::copy(&mut lines, &mut std::io::sink()));
    let address = said.split("http://").nth(1).unwrap().split('/').next().unwrap();
    (child, address.to_owned())
}

/// Waits until the screen of a panel has a text.
pub fn until_screen(address: &str, what: &str) {
    let screen = || request(address, "GET", "/api/screen", "");
    for _ in 0..600 {
        if screen().contains(what) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    panic!("no {what}: {}", screen());
}

/// What a panel answers to a request, with its head.
pub fn request(address: &str, method: &str, path: &str, body: &str) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    let length = body.len();
    let head = format!(
        "{method} {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n"
    );
    stream.write_all((head + body).as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer
}

/// A folder that is removed in the end.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new() -> Folder {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("bahn-test-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// A folder with the main program `main.H` of these blocks between BEGIN and END.
    pub fn with_program(blocks: &str) -> Folder {
        let folder = Folder::new();
        folder.write("main.H", program(blocks));
        folder
    }

    /// A folder with a program and the mill in `mill`, as it was delivered.
    pub fn with_mill(blocks: &str) -> Folder {
        let folder = Folder::with_program(blocks);
        copy(&machines().join("mill"), &folder.path("mill"));
        folder
    }

    /// With the shipped portal with a System 900 in it.
    pub fn with_portal() -> Folder {
        let folder = Folder::new();
        copy(&machines().join("portal900"), &folder.path("portal"));
        folder
    }

    /// The same on an ideal machine, with the standard answers in the place of its PLC and without the cycle of its tool change.
    pub fn with_ideal_portal() -> Folder {
        let folder = Folder::with_portal();
        let described = folder.read("portal/machine.toml");
        let (ideal, _) = described.split_once("plant = ").unwrap();
        folder.write("portal/machine.toml", format!("{ideal}plant = \"ideal\"\n"));
        std::fs::remove_file(folder.path("portal/programs/Z6.900")).unwrap();
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> &Folder {
        std::fs::write(self.path(name), content).unwrap();
        self
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Names of all files, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    pub fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bahn"));
        command.current_dir(&self.0);
        command
    }

    /// Runs `bahn` with arguments separated by blanks.
    pub fn bahn(&self, arguments: &str) -> Run {
        Run(self
            .command()
            .args(arguments.split_whitespace())
            .output()
            .unwrap())
    }

    /// `bahn test main.H --format json` with further arguments: exit code and report.
    pub fn test(&self, arguments: &str) -> (i32, Value) {
        let run = self.bahn(&format!("test main.H --format json {arguments}"));
        (run.code(), run.json())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl AsRef<Path> for Folder {
    fn as_ref(&self) -> &Path {
        &self.0
    }
}

/// The shipped machines.
pub fn machines() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines")
}

/// Holds a document of the repository to what a command prints; with `BAHN_WRITE_DOCS` it is written anew first.
pub fn holds_document(document: &str, command: &str, written_by: &str) {
    let run = Folder::new().bahn(command);
    assert_eq!(run.code(), 0, "{}", run.err());
    bahn_house::holds_text(document, &run.out(), written_by);
}

/// Blocks with BEGIN and END.
pub fn program(blocks: &str) -> String {
    format!("BEGIN PGM MAIN MM\n{}\nEND PGM MAIN MM\n", blocks.trim())
}

/// What a command did.
pub struct Run(pub Output);

impl Run {
    pub fn code(&self) -> i32 {
        self.0.status.code().unwrap_or(-1)
    }

    pub fn out(&self) -> String {
        String::from_utf8(self.0.stdout.clone()).unwrap()
    }

    pub fn err(&self) -> String {
        String::from_utf8(self.0.stderr.clone()).unwrap()
    }

    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.0.stdout)
            .unwrap_or_else(|_| panic!("no JSON: {} {}", self.out(), self.err()))
    }
}

/// The number at a path like `/path_mm/feed`.
pub fn number(report: &Value, pointer: &str) -> f64 {
    let value = report.pointer(pointer).and_then(Value::as_f64);
    value.unwrap_or_else(|| panic!("no number at {pointer} in {report}"))
}

/// Asserts that two numbers are equal to 1e-6.
#[track_caller]
pub fn assert_near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-6 * b.abs().max(1.0), "{a} is not {b}");
}

/// The fields of a table without quoted fields, without the header.
pub fn rows(table: &str) -> Vec<Vec<&str>> {
    table
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect()
}
