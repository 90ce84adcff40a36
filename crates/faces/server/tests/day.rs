//! A day's work in a real browser: switched on, referenced, a datum, a program by dialogue, tested, run, interrupted,
//! moved away, brought back, finished; with the mouse, with a finger and with the keyboard alone.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests fail by panic")]

mod support;

use bahn_browser::{Browser, Page};
use serde_json::{Value, json};
use std::time::Duration;
use support::{Panel, pictures, position};

/// How long a person waits; the host may be slow.
const PATIENCE: Duration = Duration::from_secs(30);
/// A key of the machine is held so long, as a person holds it.
const HELD: Duration = Duration::from_millis(120);

/// The part: a contour with tool radius compensation, a pocket, a row of tapped holes by a label. Its keys, and the
/// block that they give.
fn part() -> Vec<(&'static str, &'static str)> {
    let lines = include_str!("day.tsv")
        .lines()
        .filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split_once('\t').unwrap()).collect()
}

/// What a person uses.
#[derive(Clone, Copy, PartialEq)]
enum Hand {
    Mouse,
    Finger,
}

struct Desk<'a> {
    panel: &'a Panel,
    page: Page,
    hand: Hand,
}

impl<'a> Desk<'a> {
    fn new(panel: &'a Panel, browser: &Browser, hand: Hand) -> Desk<'a> {
        let mut page = browser.page().unwrap();
        match hand {
            Hand::Mouse => page.viewport(1400, 900, false).unwrap(),
            Hand::Finger => page.viewport(390, 800, true).unwrap(),
        }
        page.dark(false).unwrap();
        page.open(&format!("http://{}/", panel.address)).unwrap();
        let mut desk = Desk { panel, page, hand };
        desk.until("document.querySelectorAll('[data-region=softkeys] button').length === 10");
        desk
    }

    fn until(&mut self, condition: &str) {
        if let Err(error) = self.page.wait_until(condition, PATIENCE) {
            let screen = self.panel.screen();
            let parts = [
                "mode",
                "dialogue",
                "messages",
                "program",
                "why",
                "soft_keys",
                "timeline",
                "status",
            ]
            .map(|part| &screen[part]);
            panic!("{error}\n{parts:#?}");
        }
    }

    fn mode(&mut self, title: &str) {
        let condition = format!("document.title === 'Bahn: {title}'");
        self.until(&condition);
    }

    fn shows(&mut self, region: &str, text: &str) {
        let text = Value::from(text);
        let condition = format!(
            "document.querySelector('[data-region={region}]').innerText.replace(/\\s+/g, ' ').includes({text})"
        );
        self.until(&condition);
    }

    /// The part of the panel that a small window shows.
    fn tab(&mut self, name: &str) {
        if self.hand == Hand::Finger {
            self.page.tap(&format!("[data-tab={name}]")).unwrap();
            self.until(&format!("document.body.dataset.tab === '{name}'"));
        }
    }

    fn push(&mut self, selector: &str) {
        match self.hand {
            Hand::Mouse => self.page.click(selector).unwrap(),
            Hand::Finger => self.page.tap(selector).unwrap(),
        }
    }

    /// Keys of the keyboard one after the other; numbers by their digits.
    fn keys(&mut self, keys: &str) {
        let before = self.sent();
        let mut count = 0;
        for word in keys.split_whitespace() {
            let number = word
                .trim_start_matches('-')
                .chars()
                .all(|c| c.is_ascii_digit() || c == '.');
            let names: Vec<String> = match number {
                true => word.chars().map(digit).collect(),
                false => vec![word.to_owned()],
            };
            for name in names {
                self.push(&format!("[data-key=\"{name}\"]"));
                count += 1;
            }
        }
        // All of them have arrived and were taken.
        self.until(&format!(
            "Number(sessionStorage.getItem('bahn-number')) >= {} && sessionStorage.getItem('bahn-waiting') === '[]'",
            before + count
        ));
    }

    fn sent(&mut self) -> u64 {
        self.page
            .number("Number(sessionStorage.getItem('bahn-number'))")
            .unwrap() as u64
    }

    /// A key of the machine operating panel, pressed and let go.
    fn machine_key(&mut self, name: &str) {
        self.tab("machine");
        let at = self.page.middle(&format!("[data-key=\"{name}\"]")).unwrap();
        match self.hand {
            Hand::Mouse => {
                self.page.mouse_move(at).unwrap();
                self.page.mouse_down(at).unwrap();
                std::thread::sleep(HELD);
                self.page.mouse_up(at).unwrap();
            }
            Hand::Finger => {
                self.page.touch("touchStart", &[at]).unwrap();
                std::thread::sleep(HELD);
                self.page.touch("touchEnd", &[]).unwrap();
            }
        }
        self.tab("keyboard");
    }

    fn soft_key(&mut self, text: &str) {
        self.shows("softkeys", text);
        let text = Value::from(text);
        let script = format!(
            "[...document.querySelectorAll('[data-region=softkeys] button')].find(b => b.textContent === {text})?.dataset.key"
        );
        let name = self.page.evaluate(&script).unwrap();
        self.keys(name.as_str().unwrap());
    }

    fn speed(&mut self, factor: f64) {
        assert_eq!(self.panel.give(&json!({ "speed": factor })), 200);
    }

    /// From POWER INTERRUPTED to MANUAL OPERATION.
    fn switch_on(&mut self) {
        self.shows("header", "POWER INTERRUPTED");
        self.keys("CE");
        self.mode("PASS OVER REFERENCE MARKS");
        self.until("!document.querySelector('[data-region=header] .message')");
        // The drives are ready a moment after the control voltage.
        self.panel.wait(1.0);
        self.machine_key("NC_START");
        self.speed(100.0);
        self.mode("MANUAL OPERATION");
        self.speed(1.0);
    }

    /// Writes a program of these blocks; its listing is what is on the medium.
    fn write(&mut self, name: &str, blocks: &[(&str, &str)]) -> String {
        self.keys("PROGRAM PGM_NR");
        let letters: Vec<String> = name.chars().map(String::from).collect();
        self.keys(&letters.join(" "));
        self.keys("ENT ENT");
        self.mode("PROGRAMMING AND EDITING");
        for (keys, block) in blocks {
            self.keys(keys);
            self.shows("program", block);
        }
        self.panel.file(&format!("programs/{name}.H"))
    }

    /// The sign that a program runs: `steady`, `blinking` while it is interrupted, `off`.
    fn star(&self, star: &str) {
        self.panel.until(|screen| screen["status"]["star"] == star);
    }

    /// The program is chosen, and tested to its end.
    fn test(&mut self, last: &str) {
        self.keys("TEST");
        self.mode("TEST RUN");
        self.keys("START");
        let last = Value::from(last);
        self.until(&format!(
            "document.querySelector('[data-region=program] .current').innerText.replace(/\\s+/g, ' ').includes({last})"
        ));
        self.until("!document.querySelector('[data-region=header] .message')");
    }

    /// The program is chosen and started.
    fn start(&mut self, name: &str) {
        self.keys("FULL PGM_NR");
        let letters: Vec<String> = name.chars().map(String::from).collect();
        self.keys(&letters.join(" "));
        self.keys("ENT");
        self.mode("PROGRAM RUN, FULL SEQUENCE");
        self.shows("program", &format!("BEGIN PGM {name} MM"));
        self.machine_key("NC_START");
        self.star("steady");
        self.speed(10.0);
    }
}

impl Drop for Desk<'_> {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            assert_eq!(self.page.complaints(), [] as [String; 0]);
        }
    }
}

/// The key of a digit, point or sign.
fn digit(character: char) -> String {
    match character {
        '-' => "SIGN".to_owned(),
        '.' => "POINT".to_owned(),
        digit => digit.to_string(),
    }
}

#[test]
fn a_day_at_the_mill_with_the_mouse() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    // MP7680 bit 1: the control returns to the contour.
    let panel = Panel::with(|folder| {
        let path = folder.join("parameters.mp");
        let text = std::fs::read_to_string(&path).unwrap();
        let set = text.replace("MP7680   : %000001", "MP7680   : %000011");
        assert_ne!(set, text);
        std::fs::write(path, set).unwrap();
    });
    let mut desk = Desk::new(&panel, &browser, Hand::Mouse);
    pictures::take(&mut desk.page, "power-on");
    desk.switch_on();

    // A datum; and a key that does not belong here.
    desk.keys("RL");
    desk.shows("header", "KEY NON-FUNCTIONAL");
    desk.keys("CE");
    desk.until("!document.querySelector('[data-region=header] .message')");
    desk.keys("X 12.5");
    desk.shows("dialogue", "DATUM SET X =");
    desk.keys("ENT");
    // An axis that is held in position may be a step of its encoder beside it.
    desk.until(
        "/X \\+12\\.(499|500|501)/.test(document.querySelector('[data-region=status] .axes').textContent)",
    );
    pictures::take(&mut desk.page, "manual");

    // The program; in the middle of a block the page is loaded anew.
    let listing = desk.write("PART", &part()[..6]);
    assert!(
        listing.contains("\nL Z-5 R0 FMAX\nL X+0 Y+0 RL F400\n"),
        "{listing}"
    );
    desk.keys("L Y 6");
    desk.shows("dialogue", "COORDINATES?");
    desk.until("document.querySelector('[data-region=program] .current').textContent.includes('Y+6')");
    let typed = desk.page.text("[data-region=program] .current").unwrap();
    desk.page.reload().unwrap();
    desk.shows("dialogue", "COORDINATES?");
    assert_eq!(desk.page.text("[data-region=program] .current").unwrap(), typed);
    // The block goes on where it was.
    desk.keys("0 END");
    desk.shows("program", "L Y+60");
    pictures::take(&mut desk.page, "programming");
    for (keys, block) in &part()[7..] {
        desk.keys(keys);
        desk.shows("program", block);
    }
    let listing = panel.file("programs/PART.H");
    assert!(listing.lines().count() > 30, "{listing}");
    for (_, block) in part() {
        assert!(listing.contains(block), "{block}: {listing}");
    }

    desk.test("L Z+50 R0 FMAX M2");
    pictures::take(&mut desk.page, "test-run");

    // It runs; on the way along the contour it is stopped, the tool is moved away and brought back.
    desk.start("PART");
    panel.until(|screen| current(screen).contains("L X+100"));
    desk.machine_key("NC_STOP");
    desk.star("blinking");
    pictures::take(&mut desk.page, "interrupted");
    desk.speed(1.0);
    desk.soft_key("MANUAL OPERATION");
    let stood = position(&panel.screen(), "Z");
    let jog = desk.page.middle("[data-key=\"Z+\"]").unwrap();
    desk.page.mouse_move(jog).unwrap();
    desk.page.mouse_down(jog).unwrap();
    panel.until(|screen| position(screen, "Z") > stood + 0.5);
    desk.page.mouse_up(jog).unwrap();
    panel.wait(1.0);
    desk.soft_key("RESTORE POSITION");
    pictures::take(&mut desk.page, "restore");
    desk.machine_key("NC_START");
    desk.speed(20.0);
    panel.until(|screen| (position(screen, "Z") - stood).abs() < 0.01);
    panel.wait(1.0);
    desk.machine_key("NC_START");
    desk.star("steady");
    desk.speed(50.0);
    desk.star("off");
    desk.speed(1.0);
    assert_eq!(panel.screen()["messages"], json!([]));
    pictures::take(&mut desk.page, "finished");
}

/// The current line of the large window.
fn current(screen: &Value) -> String {
    let lines = screen["program"]["lines"].as_array().unwrap();
    let line = lines.iter().find(|line| line["current"] == true);
    line.map(|line| line["text"].as_str().unwrap().to_owned())
        .unwrap_or_default()
}

#[test]
fn the_first_part_by_touch_on_a_phone() {
    let Some(browser) = Browser::for_test().unwrap() else {
        return;
    };
    let panel = Panel::start();
    let mut desk = Desk::new(&panel, &browser, Hand::Finger);
    // Nothing is wider than the window.
    assert!(desk.page.number("document.documentElement.scrollWidth").unwrap() <= 390.0);
    desk.switch_on();
    desk.keys("RL");
    desk.shows("header", "KEY NON-FUNCTIONAL");
    desk.keys("CE");
    let end = ("L Z 50 ENT ENT ENT 2 ENT", "L Z+50 R0 FMAX M2");
    let part = part();
    let blocks: Vec<_> = part[..8].iter().copied().chain([part[11], end]).collect();
    let listing = desk.write("FIRST", &blocks);
    assert!(listing.contains("RND R8\n"), "{listing}");
    pictures::take(&mut desk.page, "phone-programming");
    desk.test("L Z+50 R0 FMAX M2");
    desk.start("FIRST");
    pictures::take(&mut desk.page, "phone-run");
    desk.speed(50.0);
    desk.star("off");
    assert_eq!(panel.screen()["messages"], json!([]));
}
