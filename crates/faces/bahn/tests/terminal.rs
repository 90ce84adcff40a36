//! `bahn panel --terminal` as a user starts it, in a terminal of tmux: a day's work, and how it ends.
#![cfg(feature = "terminal")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod support;

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use bahn_panel::{Key, Press, SHORTCUTS};
use support::{Folder, request};

/// How long a person waits; the host may be slow.
const PATIENCE: Duration = Duration::from_secs(60);
/// Between two looks at the screen, and between two events of a key that is held.
const LOOK: Duration = Duration::from_millis(50);

/// A terminal without a window, in which a panel runs.
struct Desk {
    folder: Folder,
    socket: String,
    width: usize,
}

impl Desk {
    /// A panel of the mill with these options; `None` where there is no tmux, but for continuous integration.
    fn start(size: (usize, usize), variables: &str, options: &str) -> Option<Desk> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let there = Command::new("tmux").arg("-V").output();
        if there.is_err() && std::env::var_os("CI").is_none() {
            eprintln!("SKIPPED: there is no tmux");
            return None;
        }
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let desk = Desk {
            folder: Folder::with_mill(""),
            socket: format!("bahn-test-{}-{number}", std::process::id()),
            width: size.0,
        };
        // MP7680 bit 1: the control returns to the contour.
        let list = desk.folder.read("mill/parameters.mp");
        let set = list.replace("MP7680   : %000001", "MP7680   : %000011");
        assert_ne!(set, list);
        desk.folder.write("mill/parameters.mp", set);
        // Behind the panel the terminal tells how it was left.
        let command = format!(
            "cd {}; {variables} sh -c 'echo $$ >pid; exec {} panel --terminal --machine mill {options} 2>said'; \
             echo $? >code; stty -a >tty; touch over; sleep 1000",
            desk.folder.path("").display(),
            env!("CARGO_BIN_EXE_bahn"),
        );
        let [width, height] = [size.0, size.1].map(|side| side.to_string());
        let new = [
            "-f",
            "/dev/null",
            "new-session",
            "-d",
            "-x",
            &width,
            "-y",
            &height,
        ];
        desk.tmux(&[&new[..], &["sh", "-c", &command]].concat());
        Some(desk)
    }

    fn tmux(&self, arguments: &[&str]) -> String {
        let output = Command::new("tmux")
            .args(["-L", &self.socket])
            .args(arguments)
            .env_remove("TMUX")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {said}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn screen(&self) -> String {
        self.tmux(&["capture-pane", "-p"])
    }

    /// Waits until the screen is so.
    fn until(&self, what: &str, is_so: impl Fn(&str) -> bool) -> String {
        let end = Instant::now() + PATIENCE;
        loop {
            let screen = self.screen();
            if is_so(&screen) {
                return screen;
            }
            assert!(Instant::now() < end, "no {what}:\n{screen}");
            std::thread::sleep(LOOK);
        }
    }

    /// Waits until a text stands in a line of the screen, however many blanks are between its words.
    fn shows(&self, text: &str) {
        self.until(text, |screen| {
            screen.lines().any(|line| words(line).contains(text))
        });
    }

    /// The operating mode that has the keys stands in the first line.
    fn mode(&self, title: &str) {
        self.until(title, |screen| {
            screen.lines().next().is_some_and(|line| line.contains(title))
        });
    }

    /// There is no message.
    fn is_quiet(&self) {
        self.until("silence", |screen| {
            screen.lines().nth(2).is_some_and(|line| line.trim().is_empty())
        });
    }

    /// Types what a real keyboard types, one after the other.
    fn types(&self, real: &[String]) {
        let mut arguments = vec!["send-keys"];
        arguments.extend(real.iter().map(String::as_str));
        self.tmux(&arguments);
    }

    /// Keys of the control by their names, and numbers.
    fn keys(&self, keys: &str) {
        let real = keys.split_whitespace().flat_map(|word| {
            let number = word
                .trim_start_matches('-')
                .chars()
                .all(|c| c.is_ascii_digit() || c == '.');
            match (number, Key::from_name(word)) {
                (false, Some(key)) => vec![typed(Press::Key(key))],
                _ => word
                    .chars()
                    .map(|character| typed(Press::Key(Key::of_character(character).unwrap())))
                    .collect(),
            }
        });
        self.types(&real.collect::<Vec<_>>());
    }

    /// A key of the machine.
    fn machine_key(&self, name: &'static str) {
        self.types(&[typed(Press::Machine(name))]);
    }

    /// A command after `:`.
    fn command(&self, command: &str) {
        self.types(&[":".to_owned()]);
        self.tmux(&["send-keys", "-l", command]);
        self.types(&["Enter".to_owned()]);
        self.until("command", |screen| !screen.contains(&format!(":{command}")));
    }

    /// The left button of the mouse on a text: `M` goes down, `m` comes up. Its words are those that terminals write.
    fn mouse(&self, text: &str, button: char) {
        let screen = self.screen();
        let mut rows = (1..).zip(screen.lines());
        let place = rows.find_map(|(row, line)| Some((row, line[..line.find(text)?].chars().count() + 2)));
        let (row, column) = place.unwrap_or_else(|| panic!("no {text}:\n{screen}"));
        self.tmux(&["send-keys", "-l", &format!("\u{1b}[<0;{column};{row}{button}")]);
    }

    /// The soft key under which a word stands.
    fn soft_key(&self, word: &str) {
        let is_there = |screen: &str| soft_key(screen, word, self.width).is_some();
        let screen = self.until(word, is_there);
        let place = soft_key(&screen, word, self.width).unwrap();
        self.types(&[format!("F{}", place + 1)]);
    }

    /// From POWER INTERRUPTED to MANUAL OPERATION.
    fn switch_on(&self) {
        self.shows("POWER INTERRUPTED");
        self.keys("CE");
        self.mode("PASS OVER REFERENCE MARKS");
        self.is_quiet();
        // The drives are ready a moment after the control voltage: a start that comes too early is none.
        let end = Instant::now() + PATIENCE;
        while self.screen().contains("Reference marks are missing") {
            assert!(Instant::now() < end, "{}", self.screen());
            std::thread::sleep(Duration::from_secs(1));
            self.machine_key("NC_START");
            std::thread::sleep(Duration::from_secs(1));
        }
        self.command("speed 100");
        self.mode("MANUAL OPERATION");
        self.command("speed 1");
    }

    /// Sends a signal to the panel; whether it is there.
    fn signal(&self, signal: &str) -> bool {
        let id = self.folder.read("pid");
        let sent = Command::new("kill").args([signal, id.trim()]).output().unwrap();
        sent.status.success()
    }

    /// The panel has ended: its exit code, and the terminal is as it was.
    fn ended(&self) -> String {
        let end = Instant::now() + PATIENCE;
        while !self.folder.path("over").exists() {
            assert!(Instant::now() < end, "{}", self.screen());
            std::thread::sleep(LOOK);
        }
        let tty = self.folder.read("tty");
        for flag in ["icanon", "echo", "isig"] {
            assert!(tty.split_whitespace().any(|word| word == flag), "{flag}: {tty}");
        }
        let flags = "#{alternate_on} #{cursor_flag} #{mouse_any_flag}";
        assert_eq!(self.tmux(&["display-message", "-p", flags]).trim(), "0 1 0");
        self.folder.read("code").trim().to_owned()
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = Command::new("tmux")
            .args(["-L", &self.socket, "kill-server"])
            .output();
    }
}

/// What a real keyboard types for something, in the words of tmux.
fn typed(press: Press) -> String {
    let table = SHORTCUTS.iter().find(|shortcut| shortcut.press == press);
    let (real, alt) = match (table, press) {
        // Escape begins what comes behind it.
        (_, Press::Key(Key::Ce)) => ("Backspace", false),
        (Some(shortcut), _) => (shortcut.real, shortcut.alt),
        (None, Press::Key(key)) => (key.name(), false),
        (None, press) => panic!("{press:?} cannot be typed"),
    };
    let name = match real {
        "PageUp" => "PPage",
        "PageDown" => "NPage",
        "Insert" => "IC",
        "Delete" => "DC",
        "Backspace" => "BSpace",
        other => other.strip_prefix("Arrow").unwrap_or(other),
    };
    let name = match name.len() {
        1 => name.to_lowercase(),
        _ => name.to_owned(),
    };
    format!("{}{name}", if alt { "M-" } else { "" })
}

fn words(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The cells of a line between the frames.
fn cell(line: &str, place: usize) -> Option<&str> {
    line.split('│').filter(|cell| !cell.is_empty()).nth(place)
}

/// The line between two lines in the large window.
fn current(screen: &str) -> String {
    let mut cells = screen.lines().filter_map(|line| cell(line, 0));
    let is_rule = |cell: &str| !cell.trim().is_empty() && cell.chars().all(|c| c == '─');
    cells.by_ref().find(|cell| is_rule(cell));
    words(cells.next().unwrap_or_default())
}

/// The position of an axis in the status window.
fn position(screen: &str, letter: &str) -> f64 {
    let mut cells = screen.lines().filter_map(|line| cell(line, 1));
    let value = cells.find_map(|cell| cell.trim().trim_start_matches('*').strip_prefix(letter));
    value
        .unwrap_or_else(|| panic!("{screen}"))
        .trim()
        .parse()
        .unwrap()
}

/// A program runs or is interrupted: `*` after F and M.
fn star(screen: &str) -> bool {
    let mut cells = screen.lines().filter_map(|line| cell(line, 1));
    cells.any(|cell| cell.starts_with(" F ") && cell.contains('M') && cell.trim_end().ends_with('*'))
}

/// The place of the soft key under which a word stands: below the windows, above the machine operating panel.
fn soft_key(screen: &str, word: &str, width: usize) -> Option<usize> {
    let below = screen.lines().skip_while(|line| !line.starts_with('└')).skip(1);
    let rows = below.take_while(|line| !line.contains("[EMERGENCY STOP]"));
    let column = rows.filter(|line| !line.contains('▸')).find_map(|line| {
        let at = line.find(word)?;
        Some(line[..at].chars().count())
    })?;
    Some(column / (width / 8))
}

/// NC start of an interrupted program until it goes on: the last axis may be on its way back yet.
fn go_on(desk: &Desk) {
    let waits = |screen: &str| screen.contains("NC start goes on");
    desk.until("back at the contour", waits);
    let end = Instant::now() + PATIENCE;
    while waits(&desk.screen()) {
        assert!(Instant::now() < end, "{}", desk.screen());
        desk.machine_key("NC_START");
        std::thread::sleep(Duration::from_millis(500));
    }
}

#[test]
fn a_day_at_the_mill() {
    let Some(desk) = Desk::start((100, 40), "", "--record session.jsonl") else {
        return;
    };
    desk.switch_on();
    // A key that does not belong here, and a datum.
    desk.keys("RL");
    desk.shows("KEY NON-FUNCTIONAL");
    desk.keys("CE");
    desk.is_quiet();
    desk.keys("X 12.5");
    desk.shows("DATUM SET X = 12.5");
    desk.keys("ENT");
    desk.until("datum", |screen| position(screen, "X") == 12.5);

    // The program of the day at the page, by the same keys.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../server/tests/day.tsv");
    let part = std::fs::read_to_string(path).unwrap();
    let part: Vec<_> = part.lines().filter_map(|line| line.split_once('\t')).collect();
    assert!(part.len() > 20);
    desk.keys("PROGRAM PGM_NR P A R T ENT ENT");
    desk.mode("PROGRAMMING AND EDITING");
    for (keys, block) in &part {
        desk.keys(keys);
        desk.shows(block);
    }
    let listing = desk.folder.read("mill/programs/PART.H");
    for (_, block) in &part {
        assert!(listing.contains(block), "{block}: {listing}");
    }

    // The test, with graphics: the part in half blocks.
    desk.keys("TEST GRAPHICS START");
    desk.mode("TEST RUN");
    desk.until("end of test", |screen| {
        current(screen).contains("L Z+50 R0 FMAX M2")
    });
    desk.is_quiet();
    desk.until("picture", |screen| screen.matches('▀').count() > 200);

    // It runs; on the way along the contour it is stopped, the tool is moved away and brought back.
    desk.keys("FULL PGM_NR P A R T ENT");
    desk.mode("PROGRAM RUN, FULL SEQUENCE");
    desk.shows("BEGIN PGM PART MM");
    desk.machine_key("NC_START");
    desk.until("star", star);
    // The block of 100 mm at F400 lasts 15 s of the machine: it is still there when a busy host comes to see it.
    desk.command("speed 2");
    desk.until("contour", |screen| current(screen).contains("L X+100"));
    desk.machine_key("NC_STOP");
    desk.soft_key("MANUAL");
    desk.command("speed 1");
    let stood = position(&desk.screen(), "Z");
    // A key that is held repeats; when it does no more, the axis stands.
    let end = Instant::now() + PATIENCE;
    while position(&desk.screen(), "Z") < stood + 0.5 {
        assert!(Instant::now() < end, "{}", desk.screen());
        desk.machine_key("Z+");
        std::thread::sleep(LOOK);
    }
    let stands = || {
        let before = position(&desk.screen(), "Z");
        std::thread::sleep(Duration::from_millis(400));
        (position(&desk.screen(), "Z") - before).abs() < 0.01
    };
    let end = Instant::now() + PATIENCE;
    while !stands() {
        assert!(Instant::now() < end, "{}", desk.screen());
    }
    desk.soft_key("RESTORE");
    desk.machine_key("NC_START");
    desk.command("speed 20");
    desk.until("return", |screen| (position(screen, "Z") - stood).abs() < 0.01);
    go_on(&desk);
    desk.until("end of the pocket", |screen| {
        current(screen).contains("CYCL DEF") || !star(screen)
    });
    desk.command("speed 50");
    desk.until("end", |screen| !star(screen));
    desk.is_quiet();

    // The end: what was typed was recorded, the terminal is as it was.
    desk.types(&["C-c".to_owned()]);
    assert_eq!(desk.ended(), "0");
    let session = desk.folder.read("session.jsonl");
    assert!(session.contains("\"key\":\"CYCL_DEF\"") && session.contains("\"end\""));
    assert_eq!(desk.folder.read("said"), "");
}

#[test]
fn a_signal_ends_it_and_what_was_done_is_kept() {
    let Some(desk) = Desk::start((80, 24), "", "") else {
        return;
    };
    desk.shows("POWER INTERRUPTED");
    // A key of the machine that stays down comes up.
    desk.command("hold RAPID");
    desk.keys("PROGRAM PGM_NR 4 7 ENT ENT");
    desk.shows("BEGIN PGM 47 MM");
    desk.keys("L X 5 END");
    desk.shows("L X+5");
    assert!(desk.signal("-TERM"));
    assert_eq!(desk.ended(), "0");
    assert!(desk.folder.read("mill/programs/47.H").contains("L X+5"));
    assert_eq!(desk.folder.read("said"), "");
}

#[test]
fn it_ends_with_its_terminal() {
    let Some(desk) = Desk::start((80, 24), "", "") else {
        return;
    };
    desk.shows("POWER INTERRUPTED");
    desk.tmux(&["kill-server"]);
    let end = Instant::now() + PATIENCE;
    while desk.signal("-0") {
        assert!(Instant::now() < end, "it goes on without a terminal");
        std::thread::sleep(LOOK);
    }
    assert!(desk.folder.read("mill/state/control.toml").len() > 10);
}

#[test]
fn windows_of_any_size_and_terminals_without_colours() {
    let Some(desk) = Desk::start((80, 24), "NO_COLOR=1", "") else {
        return;
    };
    desk.shows("POWER INTERRUPTED");
    let colours = |screen: &str| {
        let parts = screen.split("\u{1b}[").skip(1);
        let numbers = parts
            .filter_map(|part| part.split_once('m'))
            .map(|(numbers, _)| numbers.to_owned());
        let is_colour = |number: &str| {
            number
                .parse()
                .is_ok_and(|n: u32| matches!(n, 30..=38 | 40..=48 | 90..=107))
        };
        numbers
            .filter(|numbers| numbers.split(';').any(is_colour))
            .count()
    };
    let drawn = desk.tmux(&["capture-pane", "-p", "-e"]);
    assert!(
        drawn.contains("\u{1b}[1;7m") || drawn.contains("\u{1b}[7m"),
        "{drawn:?}"
    );
    assert_eq!(colours(&drawn), 0, "{drawn:?}");
    for (width, height, text) in [
        ("40", "12", "The window is too small"),
        ("120", "50", "[X+]"),
        ("60", "18", "○ FAULT"),
    ] {
        desk.tmux(&["resize-window", "-x", width, "-y", height]);
        desk.shows(text);
    }
    drop(desk);
    // With colours.
    let desk = Desk::start((80, 24), "NO_COLOR=", "").unwrap();
    desk.shows("POWER INTERRUPTED");
    assert!(colours(&desk.tmux(&["capture-pane", "-p", "-e"])) > 20);
}

#[test]
fn terminal_and_page_show_the_same_machine() {
    let Some(desk) = Desk::start((80, 24), "", "--listen 127.0.0.1:0") else {
        return;
    };
    desk.shows("POWER INTERRUPTED");
    let said = desk.folder.read("said");
    let address = said
        .split("http://")
        .nth(1)
        .and_then(|rest| rest.split('/').next())
        .unwrap();
    assert!(request(address, "POST", "/api/key", "{\"key\":\"CE\"}").contains("\"ok\":true"));
    desk.mode("PASS OVER REFERENCE MARKS");
    desk.keys("PROGRAM");
    desk.mode("PROGRAMMING AND EDITING");
    let page_shows = |what: &str| {
        let end = Instant::now() + PATIENCE;
        while !request(address, "GET", "/api/screen", "").contains(what) {
            assert!(Instant::now() < end, "{what}");
            std::thread::sleep(LOOK);
        }
    };
    page_shows("\"mode\":\"PROGRAMMING AND EDITING\"");
    // The keys of the machine, by the mouse: held as long as its button.
    desk.types(&["Tab".to_owned()]);
    desk.shows("[RAPID]");
    desk.mouse("[RAPID]", 'M');
    page_shows("\"held\":[\"RAPID\"]");
    desk.mouse("[RAPID]", 'm');
    page_shows("\"held\":[]");
    desk.mouse("[EMERGENCY STOP]", 'M');
    page_shows("\"emergency_stop\":true");
    desk.command("quit");
    assert_eq!(desk.ended(), "0");
}

#[test]
fn without_a_terminal_it_says_so() {
    let output = Command::new(env!("CARGO_BIN_EXE_bahn"))
        .args(["panel", "--terminal"])
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("the panel needs a terminal"), "{said}");
}
