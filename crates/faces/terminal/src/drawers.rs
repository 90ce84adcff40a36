//! The three that draw a screen show the same texts: this room, the page in a browser, the picture of LSV/2.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use bahn_browser::Browser;
use bahn_panel::Screen;
use bahn_ports::screen_picture;
use bahn_server::{Server, ServerOptions, Tokens};
use bahn_service::{Input, KeyAction, Live, MachineService, Station, load};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

use crate::desk::Desk;
use crate::draw::{Scene, draw};
use crate::machine::Machine;
use crate::palette::Palette;
use crate::tests::{copy, machines, text};

/// How long a person waits; the host may be slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// Words with one blank between, in capitals: how they are laid out is each one's own.
fn words(text: &str) -> String {
    let words: Vec<String> = text.split_whitespace().map(str::to_uppercase).collect();
    words.join(" ")
}

/// All that the screen says: headings, dialogue, messages, program, axes, soft keys.
fn said(screen: &Screen) -> Vec<String> {
    let texts = (screen.headings.iter().map(|heading| &heading.title))
        .chain([&screen.dialogue.prompt, &screen.status.position_type])
        .chain(screen.messages.iter().map(|message| &message.text))
        .chain(screen.program.lines.iter().map(|line| &line.text))
        .chain(screen.status.axes.iter().map(|axis| &axis.value))
        .chain([&screen.status.f, &screen.status.m])
        .chain(&screen.soft_keys.keys);
    let texts = texts.map(|text| words(text));
    texts.filter(|text| !text.is_empty()).collect()
}

/// The characters of the picture, line by line as they stand there.
fn picture(screen: &Screen) -> String {
    let image = screen_picture::draw(screen, None);
    // A character stands in the middle of 8 x 16 pixels.
    let cell = |min: f64, max: f64, pixels: f64| ((min + max) / 2.0 / pixels) as u32;
    let mut letters: Vec<(u32, u32, &str)> = image
        .labels()
        .iter()
        .map(|label| {
            let line = cell(label.min[1], label.max[1], 16.0);
            let column = cell(label.min[0], label.max[0], 8.0);
            match line {
                // Each soft key is read for itself: 10 columns of the last three lines.
                27.. => (27 + column / 10, line * 80 + column, label.text.as_str()),
                _ => (line, column, label.text.as_str()),
            }
        })
        .collect();
    letters.sort_unstable();
    let mut text = String::new();
    let mut next = (0, 0);
    for (line, column, letter) in letters {
        if (line, column) != next {
            text.push(' ');
        }
        text += letter;
        next = (line, column + 1);
    }
    text
}

fn terminal(screen: &Screen, machine: Machine) -> String {
    let mut terminal = Terminal::new(TestBackend::new(160, 60)).unwrap();
    let desk = Desk::new(machine);
    let scene = Scene {
        screen,
        desk: &desk,
        part: None,
        palette: Palette::Plain,
    };
    terminal.draw(|frame| drop(draw(frame, &scene))).unwrap();
    text(terminal.backend().buffer())
}

fn until(machine: &MachineService, what: impl Fn(&Screen) -> bool) {
    let end = Instant::now() + PATIENCE;
    while !what(&machine.screen()) {
        assert!(Instant::now() < end, "{:#?}", machine.screen());
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A mill in program run, with a program that is chosen; time stands, so that all draw the same moment.
fn standing(live: &Live) -> MachineService {
    let machine = MachineService::of(live).unwrap();
    machine.input(Input::Speed(50.0)).unwrap();
    until(&machine, |screen| !screen.messages.is_empty());
    machine.press("CE").unwrap();
    until(&machine, |screen| {
        screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
    });
    std::thread::sleep(Duration::from_millis(50));
    let start = Input::Machine("NC_START".to_owned(), KeyAction::Tap);
    machine.input(start).unwrap();
    until(&machine, |screen| screen.mode == "MANUAL OPERATION");
    for key in "FULL PGM_NR C I R C L E ENT".split(' ') {
        machine.press(key).unwrap();
    }
    until(&machine, |screen| {
        screen
            .program
            .lines
            .iter()
            .any(|line| line.text.contains("BEGIN PGM CIRCLE"))
    });
    machine.input(Input::Pause(bahn_panel::Switch::On)).unwrap();
    machine
}

#[test]
fn all_who_draw_a_screen_show_the_same_texts() {
    let folder: PathBuf = std::env::temp_dir().join(format!("bahn-drawers-{}", std::process::id()));
    copy(&machines().join("mill"), &folder);
    let live = Live::start(Station::power_on(load(&folder).unwrap()).unwrap());
    let machine = standing(&live);
    let (screen, _) = machine.screen_with_picture().unwrap();
    let said = said(&screen);
    // Ten blocks and four axes at least.
    assert!(said.len() >= 14, "{said:?}");
    let mut drawn = vec![
        (
            "terminal",
            terminal(
                &screen,
                Machine::of(&bahn_service::Surface::of(machine.machine())),
            ),
        ),
        ("picture of LSV/2", picture(&screen)),
    ];
    if let Some(browser) = Browser::for_test().unwrap() {
        let options = ServerOptions {
            listen: "127.0.0.1:0".parse().unwrap(),
            tokens: Tokens::default(),
        };
        let server = Server::start(machine.clone(), options).unwrap();
        let mut page = browser.page().unwrap();
        page.viewport(1440, 900, false).unwrap();
        page.open(&format!("http://{}/", server.address())).unwrap();
        let keys = "document.querySelectorAll('[data-region=softkeys] button').length === 10";
        page.wait_until(keys, PATIENCE).unwrap();
        page.wait_until("document.body.innerText.includes('CIRCLE')", PATIENCE)
            .unwrap();
        let text = page.evaluate("document.body.innerText").unwrap();
        drawn.push(("page", text.as_str().unwrap().to_owned()));
        server.end();
    }
    for (name, text) in drawn {
        let shown = words(&text);
        for text in &said {
            assert!(shown.contains(text), "the {name} lacks `{text}`:\n{shown}");
        }
    }
    live.end().unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
}
