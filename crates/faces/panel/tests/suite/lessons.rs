//! The lessons of the mill: solved key by key, and failed by who does nothing or the wrong thing.

use crate::support::Trainee;
use bahn_panel::{Input, LessonState, Refusal};

/// A trainee whose task has begun.
fn begin(name: &str) -> Trainee {
    let mut trainee = Trainee::at("mill");
    trainee.give(&format!("{{\"lesson\":\"{name}\"}}"));
    assert_eq!(
        state(&trainee),
        LessonState::Running,
        "{:#?}",
        trainee.screen().lesson
    );
    trainee
}

fn state(trainee: &Trainee) -> LessonState {
    trainee.station.lesson().unwrap().state()
}

/// Everything was done; when not, what is open.
fn passed(trainee: &mut Trainee) {
    for _ in 0..1200 {
        if state(trainee) != LessonState::Running {
            break;
        }
        trainee.wait(0.1);
    }
    let screen = trainee.screen();
    let lesson = screen.lesson.clone().unwrap();
    assert_eq!(lesson.state, LessonState::Passed, "{lesson:#?} {screen:#?}");
    assert!(lesson.checks.iter().all(|check| check.done) && lesson.reason.is_empty());
}

/// Who does nothing, and says that he is through, has not passed.
fn nothing_is_not_enough(name: &str) {
    let mut trainee = begin(name);
    trainee.wait(15.0).give(r#"{"hand_in":true}"#);
    let lesson = trainee.screen().lesson.unwrap();
    assert_eq!(lesson.state, LessonState::Failed, "{lesson:#?}");
    let open = lesson.checks.iter().find(|check| !check.done).unwrap();
    assert_eq!(lesson.reason, format!("This is not so yet: {}", open.text));
}

/// Something was done that must not be.
fn wrong(name: &str, action: &str, why: &str) {
    let mut trainee = begin(name);
    trainee
        .wait(1.0)
        .give(&format!("{{\"action\":\"{action}\"}}"))
        .wait(0.2);
    let lesson = trainee.screen().lesson.unwrap();
    assert_eq!(lesson.state, LessonState::Failed, "{lesson:#?}");
    assert_eq!(lesson.reason, format!("This must not happen: {why}"));
}

/// A key of an axis is held until something is so.
fn hold(trainee: &mut Trainee, key: &str, axis: char, until: impl Fn(f64) -> bool) {
    trainee.give(&format!("{{\"key\":\"{key}\",\"down\":true}}"));
    for _ in 0..6000 {
        trainee.wait(0.02);
        if until(trainee.position(axis).parse().unwrap()) {
            break;
        }
    }
    trainee
        .give(&format!("{{\"key\":\"{key}\",\"down\":false}}"))
        .wait(1.0);
}

const CHOOSE_CIRCLE: &str = "FULL PGM_NR C I R C L E ENT NC_START";

#[test]
fn switching_on() {
    let mut trainee = begin("01-power-on");
    trainee.until(5.0, |screen| !screen.messages.is_empty());
    trainee.press("CE");
    trainee.until(10.0, |screen| {
        screen.mode == "PASS OVER REFERENCE MARKS" && screen.messages.is_empty()
    });
    trainee.wait(1.0).press("NC_START");
    passed(&mut trainee);
    nothing_is_not_enough("01-power-on");
}

#[test]
fn the_datum() {
    let mut trainee = begin("02-datum");
    trainee.press("X").number("-5").press("ENT");
    trainee.press("Y").number("12.5").press("ENT");
    trainee.give(r#"{"feed_override":10.0}"#);
    hold(&mut trainee, "X+", 'X', |x| x > 19.8);
    passed(&mut trainee);
    nothing_is_not_enough("02-datum");
}

#[test]
fn off_the_limit() {
    let mut trainee = begin("03-limit");
    assert_eq!(trainee.messages(), ["LIMIT SWITCH X+"]);
    let before: f64 = trainee.position('X').parse().unwrap();
    trainee.press("CE");
    hold(&mut trainee, "X-", 'X', |x| x < before - 55.0);
    passed(&mut trainee);
    nothing_is_not_enough("03-limit");
}

#[test]
fn the_door() {
    let mut trainee = begin("04-door");
    trainee.until(20.0, |screen| {
        screen
            .messages
            .iter()
            .any(|message| message.text == "DOOR IS OPEN")
    });
    assert!(
        trainee.screen().why[0].contains("I21 is 0 (door: closed)"),
        "{:?}",
        trainee.screen().why
    );
    trainee
        .give(r#"{"action":"switch door closed"}"#)
        .wait(2.0)
        .press("CE NC_START");
    passed(&mut trainee);
    nothing_is_not_enough("04-door");
    wrong(
        "04-door",
        "fault input I21 1",
        "The door was overridden at its input",
    );
}

#[test]
fn the_lagging_axis() {
    let mut trainee = begin("05-lag");
    // MOD: position display ACTL, NOML, LAG.
    trainee.press("MOD ENT ENT MOD").wait(0.2);
    assert_eq!(trainee.screen().status.position_type, "LAG");
    // As the hint says: 0.05 V of 9 V for 15 m/min, through kv in (m/min)/mm.
    let kv = trainee.station.machine().parameters.axis_parameters(1).lag.kv;
    let expected = 0.05 / 9.0 * 15.0 / kv;
    for letter in "XYZC".chars() {
        let lag: f64 = trainee.position(letter).parse().unwrap();
        let offset = if letter == 'Y' { expected } else { 0.0 };
        assert!((lag.abs() - offset).abs() < 0.005, "{letter} {lag} {offset}");
    }
    trainee.press("PROGRAM MOD");
    let chosen = |trainee: &mut Trainee| {
        let lines = trainee.screen().program.lines;
        lines.into_iter().find(|line| line.current).unwrap().text
    };
    while !chosen(&mut trainee).starts_with("CODE NUMBER") {
        trainee.press("DOWN");
    }
    trainee.press("ENT").number("75368").press("ENT").wait(0.2);
    assert_eq!(trainee.screen().program.title, "OFFSET ADJUSTMENT (1 = 0.15 mV)");
    trainee.press("ENT MOD").wait(1.0);
    trainee.press(CHOOSE_CIRCLE);
    passed(&mut trainee);
    nothing_is_not_enough("05-lag");
    // A program that is started does not go on, and says why.
    let mut trainee = begin("05-lag");
    trainee.press(CHOOSE_CIRCLE).wait(30.0);
    let reasons = trainee.station.why();
    let reason = reasons
        .iter()
        .find(|reason| reason.parameter.as_deref() == Some("MP1030.1"));
    assert_eq!(reason.unwrap().marker.as_deref(), Some("M2009"), "{reasons:?}");
    assert_eq!(state(&trainee), LessonState::Running);
}

#[test]
fn the_drive_that_is_not_ready() {
    let mut trainee = begin("06-drive");
    trainee.wait(0.5);
    let why = trainee.screen().why.join("\n");
    assert!(why.contains("I7 is 0 (drive of Z: ready)"), "{why}");
    trainee.give(r#"{"action":"repair Z"}"#).wait(1.0).press("CE");
    let before: f64 = trainee.position('Z').parse().unwrap();
    hold(&mut trainee, "Z+", 'Z', |z| z > before + 12.0);
    passed(&mut trainee);
    nothing_is_not_enough("06-drive");
    wrong("06-drive", "repair C", "A drive was repaired that is sound");
}

#[test]
fn the_tool_change() {
    let mut trainee = begin("07-tool-change");
    assert_eq!(trainee.messages(), ["CHANGE TOOL, THEN CONFIRM"]);
    trainee
        .press("TOOL_RELEASE")
        .wait(1.5)
        .press("TOOL_RELEASE")
        .wait(1.5);
    trainee.press("CONFIRM").wait(0.5);
    passed(&mut trainee);
    nothing_is_not_enough("07-tool-change");
}

#[test]
fn the_lubricant() {
    let mut trainee = begin("08-lubricant");
    assert_eq!(trainee.messages(), ["LUBRICANT LOW"]);
    trainee.give(r#"{"action":"switch lubricant full"}"#).wait(1.5);
    trainee.press("CE LUBRICATE").wait(3.0);
    passed(&mut trainee);
    nothing_is_not_enough("08-lubricant");
}

#[test]
fn back_to_the_contour() {
    let mut trainee = begin("09-emergency-stop");
    trainee.until(20.0, |screen| {
        let mut messages = screen.messages.iter();
        messages.any(|message| message.text == "EXTERNAL EMERGENCY STOP")
    });
    trainee
        .give(r#"{"key":"EMERGENCY_STOP","down":false}"#)
        .wait(1.0)
        .press("CE")
        .wait(1.0);
    let soft_keys = trainee.screen().soft_keys.keys;
    assert_eq!(soft_keys[0], "MANUAL OPERATION");
    trainee.press("SK1").wait(0.5);
    hold(&mut trainee, "Z+", 'Z', |z| z > 115.0);
    trainee.press("SK2").wait(0.5);
    for _ in 0..5 {
        trainee.press("NC_START").wait(3.0);
    }
    passed(&mut trainee);
    nothing_is_not_enough("09-emergency-stop");
}

#[test]
fn the_broken_wire() {
    let mut trainee = begin("10-broken-wire");
    trainee.press(CHOOSE_CIRCLE).wait(1.0);
    let why = trainee.screen().why.join("\n");
    assert!(why.contains("I19 is 0 (tool_clamp: clamped)"), "{why}");
    trainee
        .give(r#"{"action":"repair I19"}"#)
        .wait(1.0)
        .press("CE NC_START");
    passed(&mut trainee);
    nothing_is_not_enough("10-broken-wire");
    let words = "The tool clamp was repaired, which is sound";
    wrong("10-broken-wire", "repair tool_clamp", words);
}

#[test]
fn time_is_over_some_time() {
    let mut trainee = begin("08-lubricant");
    trainee.wait(301.0);
    let lesson = trainee.screen().lesson.unwrap();
    assert_eq!(lesson.state, LessonState::Failed);
    assert_eq!(
        lesson.reason,
        "The time is over, and this was not so yet: The tank is full"
    );
}

#[test]
fn all_lessons_are_listed_and_complete_in_both_languages() {
    let trainee = Trainee::at("mill");
    let lessons = trainee.station.lessons();
    assert_eq!(lessons.len(), 10);
    assert_eq!(lessons[0], ("01-power-on".to_owned(), "Switch on".to_owned()));
    for (name, _) in &lessons {
        let text = trainee.file(&format!("lessons/{name}.lesson"));
        let count = |word: &str| text.lines().filter(|line| line.starts_with(word)).count();
        for word in ["title", "task", "hint"] {
            let (english, german) = (count(&format!("{word}:")), count(&format!("{word} de:")));
            let reported = english > 0 && german > 0 && (word != "hint" || english == german);
            assert!(reported, "{name}: {word}");
        }
        let checks = text.lines().filter(|line| line.contains("=>"));
        assert!(checks.clone().all(|line| line.contains(" | ")), "{name}");
    }
}

/// A lesson that cannot be read hides itself alone: it is listed with its faults, each with file and line, and refused; the
/// others are there and begin.
#[test]
fn a_faulty_lesson_hides_itself_alone() {
    let good = "title: Good\ntask: T\nbegin: here\n[checks]\nOff => screen \"not there\"\n";
    let mut trainee = Trainee::with("mill", |folder| {
        let lessons = folder.join("lessons");
        let write = |name: &str, text: &[u8]| std::fs::write(lessons.join(name), text).unwrap();
        write("11-good.lesson", good.as_bytes());
        // Without a task, with a key that does not exist, with a condition of nothing, of bytes that are no text, empty.
        write("00-task.lesson", good.replace("task: T\n", "").as_bytes());
        write(
            "03b-key.lesson",
            good.replace("begin: here", "begins: here").as_bytes(),
        );
        write("05b-check.lesson", good.replace("screen", "nothing").as_bytes());
        write("07b-bytes.lesson", &[0xff, 0xfe, 0x00, 0x80, b'\n']);
        write("12-empty.lesson", b"");
        std::fs::create_dir(lessons.join("13-folder.lesson")).unwrap();
    });
    let lessons = trainee.station.lessons();
    let faulty = [
        "00-task",
        "03b-key",
        "05b-check",
        "07b-bytes",
        "12-empty",
        "13-folder",
    ];
    assert_eq!(lessons.len(), 10 + 1 + faulty.len(), "{lessons:#?}");
    trainee.give(r#"{"lesson":"11-good"}"#);
    for (name, title) in &lessons {
        let is_faulty = faulty.contains(&name.as_str());
        assert_eq!(
            title.contains(&format!("{name}.lesson")),
            is_faulty,
            "{name}: {title}"
        );
        if is_faulty {
            let input = Input::Lesson(Some(name.clone()));
            assert_eq!(
                trainee.station.input(&input),
                Err(Refusal(title.clone())),
                "{name}"
            );
            // The one that goes on is not ended by it.
            assert_eq!(state(&trainee), LessonState::Running, "{name}");
        }
    }
    let title = |name: &str| &lessons.iter().find(|lesson| lesson.0 == name).unwrap().1;
    assert_eq!(title("11-good"), "Good");
    // Its third line.
    assert!(
        title("03b-key").contains("03b-key.lesson:3: "),
        "{}",
        title("03b-key")
    );
}

/// A lesson goes back with the machine: what was done later is to be done again.
#[test]
fn the_past_of_a_lesson_comes_back() {
    let mut trainee = begin("08-lubricant");
    trainee.wait(1.0);
    let early_s = trainee.screen().time_s;
    trainee
        .give(r#"{"action":"switch lubricant full"}"#)
        .wait(1.5)
        .press("CE")
        .wait(0.5);
    let done = |trainee: &mut Trainee| {
        let lesson = trainee.screen().lesson.unwrap();
        lesson.checks.iter().filter(|check| check.done).count()
    };
    assert_eq!(done(&mut trainee), 2);
    trainee.station.go_to(early_s).unwrap();
    assert_eq!(done(&mut trainee), 0);
    trainee.station.go_to(1e9).unwrap();
    assert_eq!(done(&mut trainee), 2);
    trainee.station.go_to(early_s).unwrap();
    trainee.give(r#"{"pause":false}"#).wait(5.0);
    assert_eq!(done(&mut trainee), 0);
    // Before it had begun there was none.
    trainee.station.go_to(0.0).unwrap();
    assert!(trainee.screen().lesson.is_none());
}

/// A session with a lesson is seen again, with what the lesson did to the machine.
#[test]
fn a_lesson_is_seen_again() {
    let path = std::env::temp_dir().join(format!("bahn-lesson-{}", std::process::id()));
    let _ = std::fs::remove_file(&path);
    let mut trainee = Trainee::at("mill");
    trainee.wait(1.0).station.record(&path).unwrap();
    trainee.give(r#"{"lesson":"04-door"}"#).wait(10.0);
    // What the lesson broke is not told on the time line: it is to be found.
    let marks = trainee.screen().timeline.marks;
    assert!(
        marks.iter().all(|mark| !mark.text.starts_with("switch")),
        "{marks:?}"
    );
    trainee
        .give(r#"{"action":"switch door closed"}"#)
        .wait(2.0)
        .press("CE NC_START");
    passed(&mut trainee);
    trainee.station.end_recording().unwrap();
    let mut other = Trainee::at("mill");
    other.wait(1.0);
    let mut replay = bahn_panel::Replay::read(&path).unwrap();
    while replay.cycle(&mut other.station).unwrap() {}
    assert_eq!(state(&other), LessonState::Passed);
    assert_eq!(replay.came_true(&mut other.station), Some(true));
    std::fs::remove_file(path).unwrap();
}

/// Every shipped machine gets ready for a lesson, and its drawer has only what it takes.
#[test]
fn every_machine_has_lessons_and_a_drawer() {
    let text = "title: T\ntask: T\nbegin: BEGIN\n[checks]\nOff => screen \"not there\"\n";
    for machine in ["mill", "mill-tnc360", "mill-tnc155", "dig425", "twin", "gantry"] {
        let mut trainee = Trainee::with(machine, |folder| {
            let lessons = folder.join("lessons");
            std::fs::create_dir_all(&lessons).unwrap();
            for begin in ["ready", "power-on", "here"] {
                let lesson = text.replace("BEGIN", begin);
                std::fs::write(lessons.join(format!("{begin}.lesson")), lesson).unwrap();
            }
        });
        trainee
            .give(r#"{"lesson":"power-on"}"#)
            .give(r#"{"lesson":"ready"}"#);
        let screen = trainee.screen();
        assert_eq!(screen.mode, "MANUAL OPERATION", "{machine}");
        assert!(screen.messages.is_empty(), "{machine}: {:?}", screen.messages);
        let all = trainee.station.control().first().lacks_reference();
        assert!(!all, "{machine}");
        let plant = trainee.station.machine().plant.clone().unwrap();
        for breakable in trainee.station.drawer() {
            for fault in &breakable.faults {
                let mut plant = plant.clone();
                plant.apply(&fault.action).unwrap();
                plant.apply(&breakable.repair).unwrap();
            }
        }
        // Whatever was broken, the next lesson begins with a machine that is whole.
        trainee.give(r#"{"action":"fault input I3 0"}"#).wait(1.0);
        trainee.give(r#"{"key":"EMERGENCY_STOP","down":true}"#).wait(1.0);
        assert!(!trainee.station.why().is_empty(), "{machine}");
        trainee.give(r#"{"lesson":"ready"}"#);
        assert_eq!(trainee.screen().mode, "MANUAL OPERATION", "{machine}");
    }
}

#[test]
fn faults_of_a_lesson_have_file_and_line() {
    let text = "title: T\ntask: T\ntitel: T\nlimit: no\nbegin: soon\nhint fr: T\n[prepare]\n0: jump\n1: expect M1=1\n[checks]\n\
                A => X.heat>5\nB -> M1=1\nC => screen TEXT\n => M1=1\nD => did jump\n";
    let mut trainee = Trainee::with("mill", |folder| {
        std::fs::write(folder.join("lessons/wrong.lesson"), text).unwrap();
    });
    let Err(Refusal(words)) = trainee
        .station
        .input(&bahn_panel::Input::Lesson(Some("wrong".to_owned())))
    else {
        panic!("it is wrong");
    };
    let lines: Vec<u32> = words
        .lines()
        .map(|line| {
            line.split("wrong.lesson:")
                .nth(1)
                .unwrap()
                .split(':')
                .next()
                .unwrap()
                .parse()
                .unwrap()
        })
        .collect();
    // A script with faulty lines is not looked at further; without checks it is none.
    assert_eq!(lines, [1, 3, 4, 5, 6, 8, 11, 12, 13, 14, 15], "{words}");
    for name in ["", "none", "../lessons/01-power-on", "a/b"] {
        let begun = trainee
            .station
            .input(&bahn_panel::Input::Lesson(Some(name.to_owned())));
        assert!(begun.is_err(), "{name}");
    }
}

/// What is in the drawer breaks, and is whole again.
#[test]
fn everything_in_the_drawer_can_be_broken_and_repaired() {
    let trainee = Trainee::at("mill");
    let drawer = trainee.station.drawer();
    let actions: usize = drawer.iter().map(|breakable| breakable.faults.len()).sum();
    assert!(actions > 200, "{actions}");
    let mut plant = trainee.station.machine().plant.clone().unwrap();
    for breakable in &drawer {
        for fault in &breakable.faults {
            plant.apply(&fault.action).unwrap();
        }
        plant.apply(&breakable.repair).unwrap();
    }
    let door = drawer
        .iter()
        .find(|breakable| breakable.repair == "switch door closed")
        .unwrap();
    assert_eq!(door.faults[0].action, "switch door open");
    let wire = drawer.iter().find(|breakable| breakable.name == "I19").unwrap();
    assert_eq!(wire.words, "tool_clamp: clamped");
}
