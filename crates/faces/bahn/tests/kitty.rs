//! `bahn panel --terminal` in a terminal with the keyboard protocol of kitty: this test is that terminal, over a pty of
//! `script`. Keys are pressed, repeat and are let go by their escape sequences, and the machine does the same.
#![cfg(all(feature = "terminal", target_os = "linux"))]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod support;

use std::io::{Read, Write};
use std::net::TcpListener;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use support::{Folder, request};

const PATIENCE: Duration = Duration::from_secs(60);

/// A terminal of this kind with a panel in it, which can be asked over HTTP, too.
struct Terminal {
    folder: Folder,
    child: Child,
    keys: ChildStdin,
    /// All that the panel has written.
    written: Arc<Mutex<String>>,
    address: String,
}

impl Terminal {
    fn start() -> Option<Terminal> {
        let there = Command::new("script").arg("--version").output();
        if there.is_err() && std::env::var_os("CI").is_none() {
            eprintln!("SKIPPED: there is no script");
            return None;
        }
        let folder = Folder::with_mill("");
        // A free port; the terminal shows no line that would tell it.
        let port = TcpListener::bind("127.0.0.1:0")
            .unwrap()
            .local_addr()
            .unwrap()
            .port();
        let address = format!("127.0.0.1:{port}");
        let inside = format!(
            "stty cols 100 rows 40; exec {} panel --terminal --listen {address} --machine mill",
            env!("CARGO_BIN_EXE_bahn")
        );
        let mut child = Command::new("script")
            .args(["-qfec", &inside, "/dev/null"])
            .current_dir(folder.path(""))
            .env("TERM", "xterm-kitty")
            .env_remove("NO_COLOR")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let written = Arc::<Mutex<String>>::default();
        let own = Arc::clone(&written);
        let mut output = child.stdout.take().unwrap();
        std::thread::spawn(move || {
            let mut piece = [0; 4096];
            while let Ok(count @ 1..) = output.read(&mut piece) {
                own.lock()
                    .unwrap()
                    .push_str(&String::from_utf8_lossy(&piece[..count]));
            }
        });
        let keys = child.stdin.take().unwrap();
        Some(Terminal {
            folder,
            child,
            keys,
            written,
            address,
        })
    }

    fn send(&mut self, bytes: &str) {
        self.keys.write_all(bytes.as_bytes()).unwrap();
        self.keys.flush().unwrap();
    }

    fn wait_for(&self, text: &str) {
        let end = Instant::now() + PATIENCE;
        while !self.written.lock().unwrap().contains(text) {
            assert!(
                Instant::now() < end,
                "{text:?} in {:?}",
                self.written.lock().unwrap()
            );
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    fn screen(&self) -> Value {
        let answer = request(&self.address, "GET", "/api/screen", "");
        serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
    }

    /// Waits until the screen is so; how long it took.
    fn until(&self, what: impl Fn(&Value) -> bool) -> Duration {
        let begun = Instant::now();
        loop {
            let screen = self.screen();
            if what(&screen) {
                return begun.elapsed();
            }
            assert!(begun.elapsed() < PATIENCE, "{screen:#}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Repeats an arrow until these keys are held: one whose repetitions end comes up by itself.
    fn held_while_repeating(&mut self, letter: char, keys: &[&str]) {
        let end = Instant::now() + PATIENCE;
        while self.screen()["machine"]["held"] != json!(keys) {
            assert!(Instant::now() < end, "{:#}", self.screen());
            self.send(&arrow(letter, 2));
            std::thread::sleep(Duration::from_millis(40));
        }
    }

    fn held(&self, keys: &[&str]) -> Duration {
        self.until(|screen| screen["machine"]["held"] == json!(keys))
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// An arrow with Alt that is pressed (1), repeats (2) or is let go (3).
fn arrow(letter: char, event: u8) -> String {
    format!("\x1b[1;3:{event}{letter}")
}

#[test]
fn keys_are_held_as_long_as_the_real_ones() {
    let Some(mut terminal) = Terminal::start() else {
        return;
    };
    // It asks for the protocol, and is told that it is there; then it asks for disambiguation and types of events.
    terminal.wait_for("\x1b[?u");
    terminal.send("\x1b[?0u\x1b[?62;c");
    terminal.wait_for("\x1b[>3u");
    // Where the cursor stands is asked, too.
    terminal.wait_for("\x1b[6n");
    terminal.send("\x1b[1;1R");
    terminal.wait_for("POWER INTERRUPTED");
    // Escape is no lone byte any more.
    terminal.send("\x1b[27u\x1b[27;1:3u");
    terminal.until(|screen| screen["mode"] == "PASS OVER REFERENCE MARKS");

    // Held without a repetition, longer than a key that is not told again: it stays down until it is let go.
    terminal.send(&arrow('C', 1));
    terminal.held(&["X+"]);
    std::thread::sleep(Duration::from_millis(450));
    assert_eq!(terminal.screen()["machine"]["held"], json!(["X+"]));
    // Two at once; one that repeats holds both.
    terminal.send(&arrow('A', 1));
    terminal.held(&["X+", "Y+"]);
    for _ in 0..40 {
        terminal.send(&arrow('A', 2));
        std::thread::sleep(Duration::from_millis(40));
    }
    assert_eq!(terminal.screen()["machine"]["held"], json!(["X+", "Y+"]));
    terminal.send(&arrow('C', 3));
    terminal.held_while_repeating('A', &["Y+"]);
    terminal.send(&arrow('A', 3));
    terminal.held(&[]);

    // EMERGENCY STOP is turned over once, however often its key repeats.
    terminal.send("\x1b[48;3:1u\x1b[48;3:2u\x1b[48;3:2u\x1b[48;3:3u");
    terminal.until(|screen| screen["machine"]["emergency_stop"] == true);
    std::thread::sleep(Duration::from_millis(800));
    assert_eq!(terminal.screen()["machine"]["emergency_stop"], true);
    terminal.send("\x1b[48;3:1u\x1b[48;3:3u");
    terminal.until(|screen| screen["machine"]["emergency_stop"] == false);

    // Letters write text, of which no release is told: by time they come up, and soon.
    terminal.send("\t");
    let first = terminal.screen()["machine"]["held"].clone();
    assert_eq!(first, json!([]));
    terminal.send("b");
    terminal.until(|screen| screen["machine"]["held"].as_array().unwrap().len() == 1);
    assert!(terminal.held(&[]) < Duration::from_millis(700));
    terminal.send("\t");

    // Alt and a letter is a key of the control; its release is none.
    terminal.send("\x1b[54;3:1u\x1b[54;3:3u");
    terminal.until(|screen| screen["mode"] == "PROGRAMMING AND EDITING");
    terminal.send("\x1b[49;3:1u\x1b[49;3:3u");
    terminal.until(|screen| screen["headings"][0]["active"] == true);

    // It ends, and leaves the keyboard as it was.
    terminal.send("\x1b[99;5u");
    let end = Instant::now() + PATIENCE;
    while terminal.child.try_wait().unwrap().is_none() {
        assert!(Instant::now() < end);
        std::thread::sleep(Duration::from_millis(20));
    }
    terminal.wait_for("\x1b[<1u");
    assert!(terminal.folder.path("mill/state").exists());
}
