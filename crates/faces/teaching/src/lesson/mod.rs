//! Lessons: a fault, a task, checks. A lesson is a text file of the machine's folder; its state is small and is kept
//! with its time, so that looking back shows how far it was then.

mod begin;
mod driven;
mod file;
mod player;

use std::path::PathBuf;
use std::sync::Arc;

use bahn_host::{Action, AnyPlant, Host, LoadedMachine, Source, files};
use bahn_screen::texts::{self, Language};
use bahn_screen::{CheckLine, LessonLine, LessonState, Screen, Window};

pub use file::{Lesson, check_lesson};

use file::{Check, Condition, ENDING};
use player::Player;

pub use driven::Driven;

/// Folder of the lessons in that of the machine.
const FOLDER: &str = "lessons";
/// What stands on the screen is looked at so often, µs.
const LOOK_US: u64 = 100_000;

/// A lesson that goes on, or has ended.
#[derive(Clone, Debug)]
pub struct LessonRun {
    lesson: Arc<Lesson>,
    begun_us: u64,
    now: Progress,
    /// The states before with the times when they began.
    history: Vec<(u64, Progress)>,
}

#[derive(Clone, Debug, PartialEq)]
struct Progress {
    events: Player,
    /// Checks that were so.
    checks: usize,
    ended: Option<Ended>,
}

#[derive(Clone, Debug, PartialEq)]
enum Ended {
    Passed,
    /// The time is over.
    TooLate,
    /// The trainee said that he was through.
    HandedIn,
    /// Something of `never`, by its place.
    Never(usize),
    /// The machine has not what the lesson names.
    Impossible(String),
}

/// Begins a lesson, whose task begins when the machine is prepared for it: that takes time of the machine.
///
/// # Errors
/// In words, when it cannot begin.
pub fn begin(station: &mut dyn Driven, lesson: Lesson) -> Result<LessonRun, String> {
    begin::begin(station, &lesson)?;
    let begun_us = station.host().control().time_us();
    let now = Progress {
        events: Player::new(&lesson.events),
        checks: 0,
        ended: None,
    };
    Ok(LessonRun {
        lesson: Arc::new(lesson),
        begun_us,
        history: vec![(begun_us, now.clone())],
        now,
    })
}

/// The lessons of a machine, as its plant can do them: names and titles; one that cannot be read has its faults, with file and line, as title.
pub fn list(machine: &LoadedMachine, plant: &AnyPlant, language: Language) -> Vec<(String, String)> {
    let folder = machine.root.join(FOLDER);
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|ending| ending == ENDING))
        .collect();
    paths.sort();
    let titled = |path: &PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        match load(machine, plant, &name) {
            Ok(lesson) => (lesson.name.clone(), lesson.title.of(language).to_owned()),
            Err(faults) => (name.into_owned(), faults),
        }
    };
    paths.iter().map(titled).collect()
}

/// Reads a lesson of the machine's folder, whose plant must have what it names.
///
/// # Errors
/// In words, each fault with its file and line, when there is none of this name or it has faults.
pub fn load(machine: &LoadedMachine, plant: &AnyPlant, name: &str) -> Result<Lesson, String> {
    if !bahn_screen::programs::is_name(name) {
        return Err(format!("`{name}` is no name of a lesson"));
    }
    let path = machine.root.join(FOLDER).join(format!("{name}.{ENDING}"));
    let bytes = files::read_table(&path).map_err(|error| error.to_string())?;
    Lesson::read(&path, &bytes, plant, &machine.parameters).map_err(|faults| {
        let line = |fault: &bahn_text::Diagnostic| {
            format!("{}:{}: {}", path.display(), fault.span.line, fault.exactly())
        };
        faults.iter().map(line).collect::<Vec<_>>().join("\n")
    })
}

impl LessonRun {
    /// Whether the lesson runs, or how it has ended.
    pub fn state(&self) -> LessonState {
        match self.now.ended {
            None => LessonState::Running,
            Some(Ended::Passed) => LessonState::Passed,
            Some(_) => LessonState::Failed,
        }
    }

    /// When its task began, µs since power-on.
    pub fn begun_us(&self) -> u64 {
        self.begun_us
    }

    /// The screen is to be looked at in this cycle.
    pub fn wants_screen(&self, host: &Host<AnyPlant>) -> bool {
        let now_us = host.control().time_us();
        let cycle_us = u64::from(host.control().cycle_us()).max(1);
        let mut checks = self
            .lesson
            .never
            .iter()
            .chain(self.lesson.checks.get(self.now.checks));
        self.now.ended.is_none()
            && now_us % LOOK_US < cycle_us
            && checks.any(|check| {
                check
                    .conditions
                    .iter()
                    .any(|condition| matches!(condition, Condition::Screen(..)))
            })
    }

    /// To be called after every cycle, with the screen when it is wanted.
    pub fn follow(&mut self, host: &mut Host<AnyPlant>, screen: Option<&Screen>) {
        if self.now.ended.is_some() {
            return;
        }
        let now_us = host.control().time_us();
        let next = self.next(host, &Look::new(screen, self.begun_us));
        if self.now != next {
            self.now = next;
            self.keep(now_us);
        }
    }

    /// The trainee is through: what is still open was not done.
    pub fn hand_in(&mut self, host: &mut Host<AnyPlant>, screen: &Screen) {
        self.follow(host, Some(screen));
        if self.now.ended.is_none() {
            self.now.ended = Some(Ended::HandedIn);
            self.keep(host.control().time_us());
        }
    }

    fn next(&self, host: &mut Host<AnyPlant>, look: &Look) -> Progress {
        let lesson = &self.lesson;
        let mut now = self.now.clone();
        if let Err(why) = now.events.follow(&lesson.events, self.begun_us, host) {
            now.ended = Some(Ended::Impossible(why));
            return now;
        }
        if let Some(place) = lesson.never.iter().position(|check| look.is_so(check, host)) {
            now.ended = Some(Ended::Never(place));
            return now;
        }
        while let Some(check) = lesson.checks.get(now.checks)
            && look.is_so(check, host)
        {
            now.checks += 1;
        }
        let passed_us = host.control().time_us().saturating_sub(self.begun_us);
        if now.checks == lesson.checks.len() {
            now.ended = Some(Ended::Passed);
        } else if passed_us as f64 / 1e6 > lesson.limit_s {
            now.ended = Some(Ended::TooLate);
        }
        now
    }

    fn keep(&mut self, now_us: u64) {
        self.history.push((now_us, self.now.clone()));
    }

    /// The machine is at an earlier moment, or at a later one again.
    pub fn go_back(&mut self, now_us: u64) {
        let then = self.history.iter().rfind(|(time, _)| *time <= now_us);
        if let Some((_, then)) = then.or(self.history.first()) {
            self.now = then.clone();
        }
        self.history
            .retain(|(time, _)| *time <= now_us.max(self.begun_us));
    }

    /// As the screen shows it.
    pub fn line(&self, language: Language) -> LessonLine {
        let lesson = &self.lesson;
        let done = self.now.checks;
        let checks = lesson.checks.iter().enumerate();
        LessonLine {
            name: lesson.name.clone(),
            title: lesson.title.of(language).to_owned(),
            task: lesson.task.of(language).to_owned(),
            hints: lesson
                .hints
                .iter()
                .map(|hint| hint.of(language).to_owned())
                .collect(),
            checks: checks
                .map(|(place, check)| CheckLine {
                    text: check.words.of(language).to_owned(),
                    done: place < done,
                })
                .collect(),
            state: self.state(),
            reason: self.reason(language),
        }
    }

    fn reason(&self, language: Language) -> String {
        let words = |english| texts::words(language, english);
        let open = || {
            let check = self.lesson.checks.get(self.now.checks);
            check.map_or("", |check| check.words.of(language))
        };
        match &self.now.ended {
            None | Some(Ended::Passed) => String::new(),
            Some(Ended::TooLate) => format!(
                "{}: {}",
                words("The time is over, and this was not so yet"),
                open()
            ),
            Some(Ended::HandedIn) => format!("{}: {}", words("This is not so yet"), open()),
            Some(Ended::Never(place)) => {
                let check = self.lesson.never.get(*place);
                let what = check.map_or("", |check| check.words.of(language));
                format!("{}: {what}", words("This must not happen"))
            }
            Some(Ended::Impossible(why)) => {
                format!("{}: {why}", words("The lesson does not fit the machine"))
            }
        }
    }
}

/// Screen and begin that conditions look at.
struct Look {
    /// What can be read on the screen, when somebody has looked.
    text: Option<String>,
    begun_us: u64,
}

impl Look {
    fn new(screen: Option<&Screen>, begun_us: u64) -> Look {
        Look {
            text: screen.map(text_of),
            begun_us,
        }
    }

    fn is_so(&self, check: &Check, host: &Host<AnyPlant>) -> bool {
        check
            .conditions
            .iter()
            .all(|condition| self.holds(condition, host))
    }

    fn holds(&self, condition: &Condition, host: &Host<AnyPlant>) -> bool {
        match condition {
            Condition::Machine(expected) => expected.check(host.control(), host.plant()).is_none(),
            Condition::Screen(wanted, there) => {
                let text = self.text.as_ref();
                text.is_some_and(|text| there.agrees(text.contains(wanted.as_str())))
            }
            Condition::Did(wanted, there) => there.agrees(self.did(wanted, host)),
        }
    }

    /// The trainee has done this since the task began.
    fn did(&self, wanted: &Action, host: &Host<AnyPlant>) -> bool {
        let own = host.given().rev().take_while(|(time, ..)| *time >= self.begun_us);
        let mut own = own.filter(|(_, source, _)| matches!(source, Source::Client(_)));
        own.any(|(_, _, action)| action == wanted)
    }
}

/// Everything that can be read on the screen of the control, a line each.
fn text_of(screen: &Screen) -> String {
    let window = |window: &Window| {
        let lines = window.lines.iter().map(|line| line.text.clone());
        std::iter::once(window.title.clone())
            .chain(lines)
            .collect::<Vec<_>>()
    };
    let status = &screen.status;
    let mut lines: Vec<String> = screen
        .headings
        .iter()
        .map(|heading| heading.title.clone())
        .collect();
    lines.push(format!("{} {}", screen.dialogue.prompt, screen.dialogue.entry));
    lines.extend(screen.messages.iter().map(|message| message.text.clone()));
    lines.extend(window(&screen.program));
    lines.extend(screen.beside.iter().flat_map(window));
    lines.push(status.position_type.clone());
    let axes = status.axes.iter();
    lines.extend(axes.map(|axis| format!("{} {}", axis.letter, axis.value)));
    lines.extend(status.flags.iter().cloned());
    lines.push(status.m.clone());
    lines.extend(screen.soft_keys.keys.iter().cloned());
    let plc = screen.plc_window.iter().flatten();
    lines.extend(plc.map(|line| line.text.clone()));
    lines.join("\n")
}
