//! Screens of a station, drawn into a buffer and held to those that were looked at: `tests/screens`, written anew when
//! `BAHN_WRITE_DOCS` is set.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant, UNIX_EPOCH};

use bahn_panel::{
    CheckLine, Input, Key, KeyAction, Language, Layout, LessonLine, LessonState, MessageLine, PlcLine,
    Screen, Station, load,
};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::buffer::Buffer;
use ratatui::crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};
use ratatui::layout::Position;
use ratatui::style::{Color, Modifier};

use crate::desk::{Desk, Target, Targets};
use crate::draw::{Drawn, Scene, draw};
use crate::graphics::{Mosaic, Wanted, mosaic};
use crate::machine::Machine;
use crate::palette::Palette;

/// A machine that is on, in simulation time, and the desk in front of it.
struct Hall {
    station: Station,
    desk: Desk,
    part: Option<Mosaic>,
    palette: Palette,
    folder: PathBuf,
}

impl Hall {
    fn new() -> Hall {
        Hall::of("mill")
    }

    fn of(machine: &str) -> Hall {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("bahn-terminal-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        copy(&machines().join(machine), &folder);
        // The day on which the PLC program was written stands on the screen at power-on: 2025-12-31.
        let plc = File::options()
            .append(true)
            .open(folder.join("plc/MAIN.PLC"))
            .unwrap();
        plc.set_modified(UNIX_EPOCH + Duration::from_secs(1_767_225_599))
            .unwrap();
        let station = Station::power_on(load(&folder).unwrap()).unwrap();
        Hall {
            desk: Desk::new(Machine::of(&bahn_service::Surface::of(
                &bahn_service::Machine::of(&station),
            ))),
            station,
            part: None,
            palette: Palette::Plain,
            folder,
        }
    }

    /// The same after the reference run, where nothing flickers in the last digit.
    fn referenced() -> Hall {
        let mut hall = Hall::new();
        hall.run(1.0);
        hall.keys("CE");
        hall.run(2.0);
        let start = Input::Machine("NC_START".to_owned(), KeyAction::Tap);
        hall.station.input(&start).unwrap();
        let mut cycles = 0;
        while hall.screen().mode != "MANUAL OPERATION" {
            hall.run(0.5);
            cycles += 1;
            assert!(cycles < 400);
        }
        hall.run(5.0);
        hall
    }

    fn screen(&mut self) -> Screen {
        self.station.screen().clone()
    }

    fn keys(&mut self, keys: &str) {
        for word in keys.split_whitespace() {
            let named = Key::from_name(word).map(|key| vec![key]);
            let digits = || {
                word.chars()
                    .map(|digit| Key::of_character(digit).unwrap())
                    .collect()
            };
            for key in named.unwrap_or_else(digits) {
                self.station.input(&Input::Key(key)).unwrap();
                self.station.cycle().unwrap();
            }
        }
    }

    fn run(&mut self, seconds: f64) {
        let end = self.station.control().time_us() + (1e6 * seconds) as u64;
        while self.station.control().time_us() < end {
            self.station.cycle().unwrap();
        }
    }

    fn draw(&mut self, width: u16, height: u16) -> (Buffer, Drawn) {
        let screen = self.screen();
        self.draw_screen(&screen, width, height)
    }

    fn draw_screen(&self, screen: &Screen, width: u16, height: u16) -> (Buffer, Drawn) {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        let mut drawn = Drawn::default();
        let scene = Scene {
            screen,
            desk: &self.desk,
            part: self.part.as_ref(),
            palette: self.palette,
        };
        terminal.draw(|frame| drawn = draw(frame, &scene)).unwrap();
        (terminal.backend().buffer().clone(), drawn)
    }

    /// The screen is as it was when it was looked at.
    fn is(&mut self, name: &str, width: u16, height: u16) -> (Buffer, Drawn) {
        let (buffer, drawn) = self.draw(width, height);
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/screens/{name}.txt"));
        let text = text(&buffer);
        if std::env::var_os("BAHN_WRITE_DOCS").is_some() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &text).unwrap();
        }
        let expected = std::fs::read_to_string(&path).unwrap();
        assert!(text == expected, "{name} was\n{expected}\nand is\n{text}");
        (buffer, drawn)
    }
}

impl Drop for Hall {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

pub fn machines() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../machines")
}

pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true if entry.file_name() == "state" => {}
            true => copy(&entry.path(), &target),
            false => drop(std::fs::copy(entry.path(), target).unwrap()),
        }
    }
}

/// The characters of a picture, without blanks at the ends of lines.
pub fn text(buffer: &Buffer) -> String {
    let row = |y| {
        let cells = (0..buffer.area.width).map(move |x| buffer[(x, y)].symbol());
        let line: String = cells.collect();
        format!("{}\n", line.trim_end())
    };
    (0..buffer.area.height).map(row).collect()
}

/// Where a text begins.
fn place(buffer: &Buffer, wanted: &str) -> Position {
    let lines = text(buffer);
    let mut rows = (0..).zip(lines.lines());
    let found = rows.find_map(|(y, line)| {
        let at = line.find(wanted)?;
        Some(Position::new(
            u16::try_from(line[..at].chars().count()).unwrap(),
            y,
        ))
    });
    found.unwrap_or_else(|| panic!("no {wanted} in\n{lines}"))
}

/// What stands around the screen is in the language of the control.
#[test]
fn a_german_control_has_a_german_terminal() {
    let mut hall = Hall::referenced();
    hall.desk.help = Some(0);
    let mut screen = hall.screen();
    let english = text(&hall.draw_screen(&screen, 80, 60).0);
    screen.look.language = Language::German;
    screen.machine.paused = true;
    let german = text(&hall.draw_screen(&screen, 80, 60).0);
    for [one, other] in [
        ["SHORT CUTS", "TASTENKÜRZEL"],
        ["Circle with radius", "Kreis mit Radius"],
        ["feed override +5 %", "Vorschub-Override +5 %"],
        ["EMERGENCY STOP", "NOT-AUS"],
        ["the supply of the control", "die Versorgung der Steuerung"],
    ] {
        assert!(
            english.contains(one) && !english.contains(other),
            "{one}: {english}"
        );
        assert!(
            german.contains(other) && !german.contains(one),
            "{other}: {german}"
        );
    }
    assert!(german.contains("Zeit steht bei"), "{german}");
    // What is said of a wrong entry, too.
    hall.desk.help = None;
    for code in ":hold q\r".chars() {
        let code = match code {
            '\r' => KeyCode::Enter,
            code => KeyCode::Char(code),
        };
        let event = Event::Key(KeyEvent::new(code, KeyModifiers::NONE));
        hall.desk
            .event(&event, &screen, &Targets::default(), Instant::now());
    }
    assert_eq!(hall.desk.notice, "die Maschine hat keine Taste q");
}

/// A TNC 360 has no key of the layout, no letters: they are neither listed nor pressed.
#[test]
fn the_keyboard_is_that_of_the_model() {
    let mut hall = Hall::of("mill-tnc360");
    hall.desk.help = Some(0);
    let (small, _) = hall.draw(80, 70);
    let mut large = Hall::new();
    large.desk.help = Some(0);
    let (large, _) = large.draw(80, 70);
    for label in [Key::Screen.label(), Key::Chf.label()] {
        assert!(
            text(&large).contains(label) && !text(&small).contains(label),
            "{label}"
        );
    }
    assert!(text(&small).contains(Key::Rnd.label()));
    let refused = hall.station.input(&Input::Key(Key::Screen)).unwrap_err();
    assert_eq!(refused.0, "the TNC 360 has no key SCREEN");
    hall.station.input(&Input::Key(Key::Rnd)).unwrap();
}

#[test]
fn power_on() {
    let mut hall = Hall::new();
    hall.run(1.0);
    let (buffer, _) = hall.is("power-on", 80, 24);
    let message = &buffer[place(&buffer, "POWER INTERRUPTED")];
    assert!(message.modifier.contains(Modifier::REVERSED));
    // Without colours no cell has one.
    let plain = buffer
        .content()
        .iter()
        .all(|cell| (cell.fg, cell.bg) == (Color::Reset, Color::Reset));
    assert!(plain);
    hall.palette = Palette::Indexed;
    let (coloured, _) = hall.draw(80, 24);
    assert_eq!(text(&coloured), text(&buffer));
    assert_eq!(coloured[place(&coloured, "POWER INTERRUPTED")].fg, Color::Yellow);
}

#[test]
fn the_machine_and_its_keys() {
    let mut hall = Hall::referenced();
    hall.is("manual", 80, 24);
    hall.desk.at_the_machine = true;
    hall.station
        .input(&Input::Machine("Y+".to_owned(), KeyAction::Press))
        .unwrap();
    hall.run(0.1);
    hall.station
        .input(&Input::Machine("EMERGENCY_STOP".to_owned(), KeyAction::Tap))
        .unwrap();
    hall.run(3.0);
    let (buffer, drawn) = hall.is("machine-keys", 80, 24);
    assert!(
        buffer[place(&buffer, "[Y+]")]
            .modifier
            .contains(Modifier::REVERSED)
    );
    assert!(
        !buffer[place(&buffer, "[X+]")]
            .modifier
            .contains(Modifier::REVERSED)
    );
    // What is clicked lies where it is drawn.
    let at = place(&buffer, "[Y+]");
    let hit = drawn
        .targets
        .0
        .iter()
        .find(|(area, _)| area.contains(at))
        .unwrap();
    assert_eq!(hit.1, Target::Machine("Y+".to_owned()));
    let at = place(&buffer, "EMERGENCY STOP]");
    let hit = drawn
        .targets
        .0
        .iter()
        .find(|(area, _)| area.contains(at))
        .unwrap();
    assert_eq!(hit.1, Target::Machine("EMERGENCY_STOP".to_owned()));
}

#[test]
fn programming_with_the_machine_beside() {
    let mut hall = Hall::referenced();
    hall.keys("PROGRAM PGM_NR 7 ENT ENT L Z 5 ENT ENT ENT NO_ENT L X 10 Y SIGN 2.5");
    let (buffer, _) = hall.is("programming", 100, 40);
    // The word that is typed stands out.
    let typed = &buffer[place(&buffer, "Y-2.5")];
    assert_ne!(typed.modifier, Modifier::empty());
    hall.keys("SCREEN");
    hall.is("split", 100, 40);
    hall.is("split-small", 80, 24);
    hall.keys("END");
    hall.keys("CYCL_DEF");
    hall.is("cycles", 80, 24);
    hall.keys("END MANUAL SCREEN MOD");
    let (buffer, _) = hall.draw(80, 24);
    let chosen = &buffer[place(&buffer, "POSITION DISPLAY")];
    assert!(chosen.modifier.contains(Modifier::REVERSED));
}

#[test]
fn the_graphics() {
    let mut hall = Hall::referenced();
    hall.keys("TEST PGM_NR");
    let names = hall.screen().program;
    assert!(
        names.lines.iter().any(|line| line.text.contains("BRACKET")),
        "{names:?}"
    );
    hall.keys("B R A C K E T ENT GRAPHICS START");
    let mut cycles = 0;
    while hall
        .screen()
        .graphics
        .is_none_or(|graphics| graphics.running || graphics.progress < 1.0)
    {
        hall.run(0.1);
        cycles += 1;
        assert!(cycles < 600, "{:?}", hall.screen().graphics);
    }
    for (name, width, height) in [("graphics", 120, 40), ("graphics-small", 80, 24)] {
        let (_, drawn) = hall.draw(width, height);
        let area = drawn.graphics.unwrap();
        let picture = hall.station.picture().unwrap();
        let wanted = Wanted {
            serial: 1,
            columns: area.width,
            rows: area.height,
        };
        hall.part = mosaic(&picture, wanted);
        hall.palette = Palette::Plain;
        let (plain, _) = hall.is(name, width, height);
        hall.palette = Palette::Indexed;
        let (coloured, _) = hall.draw(width, height);
        // Half blocks where the part is drawn, and nowhere else.
        let mut count = 0;
        for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
            let symbol = coloured[(x, y)].symbol();
            match area.contains(Position::new(x, y)) {
                true => count += usize::from(["▀", "▄"].contains(&symbol)),
                false => assert_eq!(symbol, plain[(x, y)].symbol(), "{x} {y}"),
            }
        }
        assert!(
            10 * count > usize::from(area.width) * usize::from(area.height),
            "{name}: {count}"
        );
    }
}

#[test]
fn short_cuts_and_commands() {
    let mut hall = Hall::new();
    hall.run(1.0);
    hall.desk.help = Some(0);
    let (_, drawn) = hall.is("help", 80, 24);
    assert!(drawn.help_end > 0);
    hall.desk.help = Some(drawn.help_end);
    let (buffer, _) = hall.draw(80, 24);
    assert!(text(&buffer).contains(":quit"));
    hall.desk.help = None;
    hall.desk.line = Some("key NC_STA".to_owned());
    let (buffer, _) = hall.draw(80, 24);
    assert!(text(&buffer).contains(":key NC_STA"));
    // The smallest window that is one, and a smaller one.
    hall.draw(60, 18);
    let (buffer, drawn) = hall.draw(59, 18);
    assert!(text(&buffer).starts_with("The window is too small"));
    assert_eq!(drawn, Drawn::default());
}

#[test]
fn the_lesson_and_the_window_of_the_plc() {
    let mut hall = Hall::new();
    hall.palette = Palette::Indexed;
    let mut screen = hall.screen();
    let check = |text: &str, done| CheckLine {
        text: text.to_owned(),
        done,
    };
    screen.lesson = Some(LessonLine {
        title: "The door".to_owned(),
        task: "Close the door.\nStart the program.".to_owned(),
        hints: vec!["Look at I24.".to_owned()],
        checks: vec![
            check("the door is closed", true),
            check("the program runs", false),
        ],
        state: LessonState::Failed,
        reason: "The time is over.".to_owned(),
        ..LessonLine::default()
    });
    // A quarter of the bar is green; the text is red after its third character.
    let line = PlcLine {
        text: "OILPRESSURE".to_owned(),
        colours: [vec![0; 3], vec![4; 8]].concat(),
        bar: Some([76, 19, 2, 0]),
    };
    screen.plc_window = Some(vec![line, PlcLine::default()]);
    let (buffer, _) = hall.draw_screen(&screen, 80, 40);
    for text in [
        "The door  FAILED",
        "The time is over.",
        "Close the door.",
        "✓ the door is closed",
        "· the program runs",
        "? Look at I24.",
    ] {
        place(&buffer, text);
    }
    let bar = place(&buffer, "█");
    let full = (bar.x..80).take_while(|x| buffer[(*x, bar.y)].symbol() == "█");
    // 19 columns for 76.
    assert_eq!(full.count(), 5);
    assert_eq!(buffer[bar].fg, Color::Green);
    let text = place(&buffer, "OILPRESSURE");
    let colour = |column| buffer[(text.x + column, text.y)].fg;
    assert_eq!((colour(2), colour(3)), (Color::Reset, Color::Red));
}

#[test]
fn flashing_messages_come_first_and_none_is_lost() {
    let mut hall = Hall::new();
    let mut screen = hall.screen();
    let message = |text: &str, flashing| MessageLine {
        text: text.to_owned(),
        flashing,
        place: None,
    };
    screen.messages = vec![
        message("OLD", false),
        message("FAULT OF A DRIVE", true),
        message("NEW", false),
    ];
    let (buffer, _) = hall.draw_screen(&screen, 80, 24);
    let at = place(&buffer, "FAULT OF A DRIVE  (+2)");
    assert!(
        buffer[at]
            .modifier
            .contains(Modifier::REVERSED | Modifier::SLOW_BLINK)
    );
    // Where there is room, all stand below each other, the new one before the old one.
    let (buffer, _) = hall.draw_screen(&screen, 80, 40);
    let rows = ["FAULT OF A DRIVE", "NEW", "OLD"].map(|text| place(&buffer, text).y);
    assert_eq!(rows, [rows[0], rows[0] + 1, rows[0] + 2]);
}

/// Whatever the size, nothing is drawn outside and nothing fails.
#[test]
fn every_size_is_drawn() {
    let mut hall = Hall::referenced();
    hall.keys("PROGRAM PGM_NR 7 ENT ENT SCREEN");
    for width in (1..=200).step_by(13) {
        for height in (1..=70).step_by(7) {
            for at_the_machine in [false, true] {
                hall.desk.at_the_machine = at_the_machine;
                hall.desk.help = at_the_machine.then_some(3);
                let (buffer, drawn) = hall.draw(width, height);
                for (area, target) in drawn.targets.0 {
                    assert_eq!(
                        area.intersection(buffer.area),
                        area,
                        "{width} x {height}: {target:?}"
                    );
                }
            }
        }
    }
}

/// The screen of a TNC 155 has no soft keys, and a point behind an axis that is clamped [001:505-507].
#[test]
fn a_screen_of_one_colour_has_no_soft_keys() {
    let mut hall = Hall::of("mill-tnc360");
    hall.run(1.0);
    hall.keys("CE");
    hall.run(2.0);
    hall.keys("PROGRAM MOD");
    let soft_keys = |drawn: &Drawn| {
        let targets = drawn.targets.0.iter();
        let soft =
            targets.filter(|(_, target)| matches!(target, Target::Key(key) if key.soft_key().is_some()));
        soft.count()
    };
    let mut screen = hall.screen();
    assert!(soft_keys(&hall.draw_screen(&screen, 100, 40).1) > 0);
    screen.look.layout = Layout::Monochrome;
    for axis in &mut screen.status.axes {
        axis.label = format!(" {}.", axis.letter);
    }
    let (buffer, drawn) = hall.draw_screen(&screen, 100, 40);
    assert_eq!(soft_keys(&drawn), 0);
    let (letter, value) = (place(&buffer, "X."), place(&buffer, &screen.status.axes[0].value));
    assert_eq!(letter.y, value.y);
}
