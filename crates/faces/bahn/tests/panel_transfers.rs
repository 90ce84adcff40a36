//! EXT at a panel that runs, with `bahn link` as the device at the other end of the line.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod support;

use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output};
use std::time::Duration;

use support::{request, start_panel, until_screen};

/// A panel with its data folder and a folder of the device; ended with the test, whatever comes.
struct Bench {
    folder: PathBuf,
    child: Child,
    address: String,
}

impl Drop for Bench {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

impl Bench {
    fn new(name: &str, options: &[&str]) -> Bench {
        let folder = std::env::temp_dir().join(format!("bahn-{name}-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("device")).unwrap();
        let (child, address) = start_panel(&folder, options);
        let bench = Bench {
            folder,
            child,
            address,
        };
        bench.until("POWER INTERRUPTED");
        bench.press("CE");
        bench
    }

    fn programs(&self) -> PathBuf {
        self.folder.join("bahn/mill/programs")
    }

    fn press(&self, keys: &str) {
        for key in keys.split_whitespace() {
            let key = format!("{{\"key\":\"{key}\"}}");
            let answer = request(&self.address, "POST", "/api/key", &key);
            assert!(answer.contains("\"ok\":true"), "{key}: {answer}");
        }
    }

    fn screen(&self) -> String {
        request(&self.address, "GET", "/api/screen", "")
    }

    /// The cursor goes to a line of a menu.
    fn down_to(&self, name: &str) {
        let named = format!("\"text\":\"{name}");
        let at_cursor = |screen: &str| {
            let mut after = screen.split(&named).skip(1);
            after.any(|text| {
                let line = text.split('}').next().unwrap_or_default();
                line.contains("\"current\":true")
            })
        };
        for _ in 0..30 {
            // A screen is published 25 times a second.
            std::thread::sleep(Duration::from_millis(100));
            if at_cursor(&self.screen()) {
                return;
            }
            self.press("DOWN");
        }
        panic!("no {name}: {}", self.screen());
    }

    fn until(&self, what: &str) {
        until_screen(&self.address, what);
    }

    /// `bahn link` as the device, which ends by itself.
    fn device(&self, arguments: &[&str]) -> std::thread::JoinHandle<Output> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bahn"));
        command.arg("link").args(arguments).current_dir(&self.folder);
        std::thread::spawn(move || command.output().unwrap())
    }
}

fn free_port() -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    listener.local_addr().unwrap().port()
}

/// A program of so many lines.
fn part(name: &str, lines: usize) -> String {
    let blocks: String = (1..=lines).map(|x| format!("{x} L X+{x} R0 F500\n")).collect();
    format!("0 BEGIN PGM {name} MM\n{blocks}{} END PGM {name} MM\n", lines + 1)
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_default()
}

fn ended(output: Output) {
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
}

/// Programs are read in and out over a socket; what is there is asked for, and the list of files has what came.
#[test]
fn programs_come_and_go_by_the_key_ext() {
    let port = free_port();
    let bench = Bench::new("ext", &["--rs232", &format!("tcp:127.0.0.1:{port}")]);
    let line = format!("connect:127.0.0.1:{port},mode=fe2");
    std::fs::write(bench.folder.join("device/4711.H"), part("4711", 40)).unwrap();
    std::fs::write(
        bench.folder.join("device/12.I"),
        "%12 G71 *\nN10 M3 *\nN99999 %12 G71 *\n",
    )
    .unwrap();
    let device = ["send", "--as", "host", "--dir", "device", "--port", &line];
    // MOD: FE2, which asks by headers.
    bench.press("PROGRAM MOD");
    bench.down_to("DATA INTERFACES");
    bench.press("ENT");
    bench.down_to("RS-232 INTERFACE");
    bench.press("RIGHT");
    bench.until("FE2");
    bench.press("END END");

    // READ-IN SELECTED PROGRAM.
    let host = bench.device(&device);
    bench.press("EXT DOWN DOWN DOWN ENT 4 7 1 1 ENT");
    bench.until("4711.H  READ IN");
    bench.until("DATA TRANSFER HAS ENDED");
    ended(host.join().unwrap());
    assert_eq!(read(&bench.programs().join("4711.H")), part("4711", 40));

    // The same again: ERASE/OVERREAD, and NO ENT leaves what is there.
    std::fs::write(bench.folder.join("device/4711.H"), part("4711", 3)).unwrap();
    let host = bench.device(&device);
    bench.press("END ENT 4 7 1 1 ENT");
    bench.until("ERASE/OVERREAD 4711.H");
    bench.press("NO_ENT");
    bench.until("DATA TRANSFER HAS ENDED");
    drop(host.join().unwrap());
    assert_eq!(read(&bench.programs().join("4711.H")), part("4711", 40));
    let host = bench.device(&device);
    bench.press("END ENT 4 7 1 1 ENT");
    bench.until("ERASE/OVERREAD 4711.H");
    bench.press("ENT");
    bench.until("4711.H  READ IN");
    ended(host.join().unwrap());
    assert_eq!(read(&bench.programs().join("4711.H")), part("4711", 3));
    bench.press("END END PGM_NR");
    bench.until("4711             .H");
    bench.press("END");

    // READ-OUT SELECTED PROGRAM.
    let host = bench.device(&[
        "receive", "--as", "host", "--dir", "device", "--all", "--port", &line,
    ]);
    bench.press("EXT DOWN DOWN DOWN DOWN ENT C I R C L E ENT");
    bench.until("CIRCLE.H  READ OUT");
    bench.until("DATA TRANSFER HAS ENDED");
    ended(host.join().unwrap());
    // Blocks lose what stands at the ends of their lines, nothing else.
    let text = |path: PathBuf| -> Vec<String> {
        let text = read(&path);
        text.lines().map(|line| line.trim().to_owned()).collect()
    };
    let sent = text(bench.folder.join("device/CIRCLE.H"));
    assert_eq!(sent, text(bench.programs().join("CIRCLE.H")));
}

/// A pseudo terminal whose device says nothing: END breaks the transfer off, and nothing partial is left.
#[test]
fn end_breaks_a_transfer_off_while_the_machine_goes_on() {
    // However slow the machine of the test is, END comes before the device counts as dead.
    let bench = Bench::new("ext-end", &["--rs232", "pty:rs232,timeout=600"]);
    let before = std::fs::read_dir(bench.programs()).unwrap().count();
    // The other end is open, and says nothing.
    let other = std::fs::OpenOptions::new()
        .read(true)
        .write(true)
        .open(bench.folder.join("rs232"))
        .unwrap();
    bench.press("PROGRAM EXT DOWN ENT");
    bench.until("DATA TRANSFER RUNS");
    bench.press("END");
    bench.until("DATA TRANSFER HAS ENDED");
    bench.until("PROGRAM INCOMPLETE");
    assert_eq!(std::fs::read_dir(bench.programs()).unwrap().count(), before);
    drop(other);
}

/// A device that is silent is dead: error N.
#[test]
fn a_silent_device_is_dead() {
    let bench = Bench::new("ext-silent", &["--rs232", "pty:rs232,timeout=1"]);
    let other = std::fs::OpenOptions::new()
        .read(true)
        .write(true)
        .open(bench.folder.join("rs232"))
        .unwrap();
    bench.press("PROGRAM EXT DOWN ENT");
    bench.until("TRANSFERRED DATA INCORRECT N");
    drop(other);
}

#[test]
fn without_a_line_nothing_is_ready() {
    let bench = Bench::new("ext-none", &[]);
    bench.press("PROGRAM EXT DOWN ENT");
    bench.until("EXT. OUTPUT/INPUT NOT READY");
}
