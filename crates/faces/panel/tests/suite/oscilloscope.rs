//! The oscilloscope at the panel: its main display, a recording that is seen while it goes on, cursors and scales.

use crate::support::Trainee;
use bahn_panel::{GraphicsView, Screen};

fn open(trainee: &mut Trainee) {
    trainee.press("MOD");
    let place = trainee
        .screen()
        .program
        .lines
        .iter()
        .position(|line| line.text.starts_with("CODE NUMBER"))
        .unwrap();
    for _ in 0..place {
        trainee.press("DOWN");
    }
    trainee.press("ENT").number("688379").press("ENT");
    assert_eq!(trainee.screen().program.title, "OSCILLOSCOPE");
}

fn current(screen: &Screen) -> String {
    let line = screen.program.lines.iter().find(|line| line.current);
    line.unwrap()
        .text
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

fn soft_key(trainee: &mut Trainee, text: &str) {
    let keys = trainee.screen().soft_keys.keys;
    let place = keys.iter().position(|own| own == text);
    let place = place.unwrap_or_else(|| panic!("{text}: {keys:?}"));
    trainee.press(&format!("SK{}", place + 1));
}

fn picture(trainee: &mut Trainee) -> Vec<u8> {
    trainee.station.picture().unwrap().png(640, 480).unwrap().unwrap()
}

/// Channel 1: V NOMINAL of X; it triggers from 100 mm/min on, with a quarter of the memory before it. Channel 2: D DIFF.
fn set_up(trainee: &mut Trainee) {
    // The start screen of the manual.
    let shown: Vec<String> = trainee
        .screen()
        .program
        .lines
        .iter()
        .map(|line| line.text.split_whitespace().collect::<Vec<_>>().join(" "))
        .collect();
    assert_eq!(shown[0], "OUTPUT RAMP");
    assert_eq!(shown[3..5], ["CHANNEL 1 X", "OFF"]);
    assert_eq!(
        shown[11..],
        [
            "TRIGGER FREE RUN",
            "TRIGGER THRESHOLD +0",
            "SLOPE +",
            "PRE-TRIGGER 0 %"
        ]
    );
    // Nothing is to be recorded.
    soft_key(trainee, "OSZI");
    soft_key(trainee, "START");
    assert!(!trainee.station.control().oscilloscope().records);
    trainee.press("CE");
    soft_key(trainee, "SET UP");
    trainee.press("DOWN DOWN DOWN DOWN ENT ENT");
    assert_eq!(current(&trainee.screen()), "V NOMINAL [mm/min]");
    trainee.press("DOWN DOWN ENT ENT ENT ENT ENT");
    assert_eq!(current(&trainee.screen()), "D DIFF [mm]");
    trainee.press("DOWN DOWN DOWN DOWN DOWN ENT ENT");
    assert_eq!(current(&trainee.screen()), "TRIGGER CHANNEL 1");
    // The numerical keys enter it [000:18733-18734].
    trainee.press("DOWN").number("100").press("ENT");
    assert_eq!(current(&trainee.screen()), "TRIGGER THRESHOLD +100 mm/min");
    trainee.press("DOWN DOWN ENT");
    assert_eq!(current(&trainee.screen()), "PRE-TRIGGER 25 %");
}

/// Left, it is entered again by MOD and soft key OSZI, with its settings; a TNC that was off wants the code number again
/// [000:18674-18675].
#[test]
fn it_is_entered_again_by_mod_and_oszi() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    let has_key = |trainee: &mut Trainee| trainee.screen().soft_keys.keys.contains(&"OSZI".to_owned());
    trainee.press("MOD");
    assert!(!has_key(&mut trainee));
    trainee.press("END");
    open(&mut trainee);
    trainee.press("DOWN").number("1500").press("ENT");
    assert_eq!(current(&trainee.screen()), "NOML. FEED RATE 1500");
    // SAMPLE TIME is no number.
    trainee.press("DOWN 5");
    assert!(current(&trainee.screen()).starts_with("SAMPLE TIME"));
    trainee.press("CE END END MOD");
    soft_key(&mut trainee, "OSZI");
    assert_eq!(trainee.screen().program.title, "OSCILLOSCOPE");
    trainee.press("DOWN");
    assert_eq!(current(&trainee.screen()), "NOML. FEED RATE 1500");
    trainee.press("END END");
    trainee.give(r#"{"power":false}"#).wait(0.5);
    trainee.give(r#"{"power":true}"#).ready();
    trainee.press("MOD");
    assert!(!has_key(&mut trainee));
}

#[test]
fn curves_are_seen_while_the_axis_moves() {
    let mut trainee = Trainee::at("mill");
    trainee.ready();
    open(&mut trainee);
    set_up(&mut trainee);
    soft_key(&mut trainee, "OSZI");
    soft_key(&mut trainee, "START");
    trainee.wait(0.1);
    assert!(trainee.station.control().oscilloscope().records);
    // STOP is the only soft key.
    let keys = trainee.screen().soft_keys.keys;
    assert_eq!(
        keys.iter().filter(|key| !key.is_empty()).collect::<Vec<_>>(),
        ["STOP"]
    );
    let graphics = trainee.screen().graphics.unwrap();
    assert_eq!(
        (graphics.view, graphics.running),
        (GraphicsView::Oscilloscope, true)
    );
    let before = picture(&mut trainee);
    trainee.give(r#"{"key":"X+","down":true}"#).wait(1.0);
    let live = trainee.screen().graphics.unwrap();
    assert!(live.serial > graphics.serial, "another picture while it records");
    assert_ne!(picture(&mut trainee), before);
    trainee.give(r#"{"key":"X+","down":false}"#);
    // The memory becomes full, and it stops by itself.
    let memory_s = 4096.0 * trainee.station.control().cycle_us() as f64 * 1e-6;
    trainee.until(1.1 * memory_s + 1.0, |screen| {
        !screen.graphics.as_ref().unwrap().running
    });
    assert!(!trainee.station.control().oscilloscope().records);

    // The first cursor on the trigger: there the nominal feed has just passed 100 mm/min.
    soft_key(&mut trainee, "CH 1");
    trainee.press("SK_RIGHT SK_RIGHT");
    soft_key(&mut trainee, "CURSOR");
    let t1 = |trainee: &mut Trainee| {
        let lines = trainee.screen().program.lines;
        let line = lines.iter().find(|line| line.text.starts_with("T1")).unwrap();
        let words: Vec<&str> = line.text.split_whitespace().collect();
        (words[1].parse::<f64>().unwrap(), words[3].parse::<f64>().unwrap())
    };
    let mut passed = None;
    while t1(&mut trainee).0 > 0.0 {
        passed = Some(t1(&mut trainee).1);
        trainee.press("LEFT");
    }
    assert!(passed.unwrap() > 100.0, "{passed:?}");
    let (time_ms, value) = t1(&mut trainee);
    assert!(
        time_ms > -100.0 && (value <= 100.0 || time_ms == 0.0),
        "{time_ms} {value}"
    );
    // A coarser scale draws another picture, NO ENT the old one.
    let optimal = picture(&mut trainee);
    trainee.press("DOWN");
    assert_ne!(picture(&mut trainee), optimal);
    trainee.press("NO_ENT");
    assert_eq!(picture(&mut trainee), optimal);
    // The curves are there when the oscilloscope is opened again.
    trainee.press("END END END");
    assert!(trainee.screen().graphics.is_none());
    open(&mut trainee);
    soft_key(&mut trainee, "OSZI");
    assert_eq!(picture(&mut trainee).len(), optimal.len());
}
