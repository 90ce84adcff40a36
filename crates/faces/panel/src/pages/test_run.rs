//! TEST RUN: a program is checked without moving an axis [003:1514-1535].

use std::sync::Arc;

use bahn_dialogue::Key;
use bahn_graphics::Subject;
use bahn_parameters::MessageId;
use bahn_program::Program;
use bahn_tnc::{Command, TestCommand, TestState};

use crate::page::{Page, Turn, View};
use crate::pages::files::{Directory, Purpose, selection};
use crate::pages::number::Number;
use crate::pages::q_parameters::QParameters;
use crate::pages::run::{block_of, listing};
use crate::site::Site;

/// A program is tested.
pub(crate) struct TestRun {
    open: Option<(String, Arc<Program>)>,
    /// What the test came to was said.
    said: bool,
    block: u32,
    /// It waits for the operator.
    interrupted: bool,
}

impl TestRun {
    /// With the program that was edited or tested last.
    pub fn new(site: &mut Site) -> TestRun {
        let name = site.settings.edited.clone();
        let open = name.and_then(|name| Some((name.clone(), site.programs.read(&name)?)));
        TestRun {
            open,
            said: true,
            block: 0,
            interrupted: false,
        }
    }

    fn start(&mut self, site: &mut Site) -> Turn {
        let Some((name, _)) = &self.open else {
            return Turn::Refused;
        };
        let program = selection(name).to_owned();
        self.said = false;
        match site.command(Command::Test(program)) {
            true => {
                site.graphics.test(site.host.control());
                Turn::Done
            }
            false => Turn::Refused,
        }
    }

    /// STOP AT N: the test begins, or goes on, and is interrupted at a block [003:1524].
    fn ask_where_to_stop(&mut self, site: &mut Site) -> Turn {
        let Some((name, program)) = self.open.clone() else {
            return Turn::Refused;
        };
        self.said = false;
        Turn::Open(Number::ask(site.words("STOP AT: N ="), move |value, site| {
            let Some(block) = block_of(Some(&program), value) else {
                return false;
            };
            if !is_interrupted(site) {
                if !site.command(Command::Test(selection(&name).to_owned())) {
                    return false;
                }
                site.graphics.test(site.host.control());
            }
            let there = interrupt(Some(block), site);
            go_on(site);
            there
        }))
    }

    /// STOP interrupts the test and its graphics [003:1534]; what is interrupted ends (inferred).
    fn stop(&mut self, site: &mut Site) -> Turn {
        let interrupted = is_interrupted(site);
        if !interrupted && interrupt(None, site) {
            return Turn::Done;
        }
        site.graphics.stop();
        match site.command(Command::EndTest) {
            true => Turn::Done,
            false => Turn::Refused,
        }
    }
}

/// The test waits for the operator.
fn is_interrupted(site: &mut Site) -> bool {
    let report = site.control().test_report();
    report.is_some_and(|report| report.state == TestState::Interrupted)
        || site.graphics.tested().is_some_and(|trial| trial.is_interrupted())
}

/// The test and its graphics are interrupted, at once or at a block; `false` where neither goes on.
fn interrupt(at: Option<u32>, site: &mut Site) -> bool {
    let command = at.map_or(TestCommand::Interrupt, TestCommand::InterruptAt);
    let tested = site.command(Command::TestRun(command));
    let trial = site.graphics.tested().map(|trial| trial.interrupt(at));
    tested || trial.is_some()
}

/// NO ENT: what is interrupted goes on [003:1535].
fn go_on(site: &mut Site) -> Turn {
    if !is_interrupted(site) {
        return Turn::Refused;
    }
    site.command(Command::TestRun(TestCommand::GoOn));
    if let Some(trial) = site.graphics.tested() {
        trial.go_on();
    }
    Turn::Done
}

const KEYS: [Key; 5] = [Key::Start, Key::Stop, Key::Graphics, Key::BlkForm, Key::Magn];

impl Page for TestRun {
    fn file(&self) -> Option<&str> {
        self.open.as_ref().map(|(name, _)| name.as_str())
    }

    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if site.graphics.key(Subject::Test, key) {
            return Turn::Done;
        }
        match key {
            Key::PgmNr => Turn::Open(Box::new(Directory::new(Purpose::Test, site))),
            Key::Start => self.start(site),
            Key::Ent if !site.control().model().has_soft_keys() => self.start(site),
            Key::Goto if !site.control().model().has_soft_keys() => self.ask_where_to_stop(site),
            Key::Stop => self.stop(site),
            Key::NoEnt => go_on(site),
            Key::Q if is_interrupted(site) => Turn::Open(Box::new(QParameters::of_test())),
            _ => Turn::Refused,
        }
    }

    fn soft_keys(&self, site: &Site) -> Vec<Vec<String>> {
        vec![vec![
            site.words("START"),
            site.words("STOP"),
            site.words("GRAPHICS"),
            site.words("BLK FORM"),
            site.words("MAGN"),
            site.words("STOP AT N"),
        ]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        if place == KEYS.len() {
            return self.ask_where_to_stop(site);
        }
        match KEYS.get(place) {
            Some(key) => self.key(*key, site),
            None => Turn::Refused,
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        match &self.open {
            Some((name, program)) => {
                let mut view = View::of(listing(name, program, self.block, lines));
                if self.interrupted {
                    view.dialogue.prompt = site.words("INTERRUPTED: CONTINUE = NO ENT / END = STOP");
                }
                view
            }
            None => super::no_program(site),
        }
    }

    fn subject(&self) -> Option<Subject> {
        Some(Subject::Test)
    }

    fn tick(&mut self, site: &mut Site) -> Turn {
        let open = self.open.as_ref().map(|(name, _)| name.as_str());
        if open != site.settings.edited.as_deref() {
            *self = TestRun::new(site);
        }
        self.interrupted = is_interrupted(site);
        if site.graphics.cannot_be_shown() {
            return Turn::Say(site.message(MessageId::PgmSectionCannotBeShown));
        }
        let Some(report) = site.control().test_report() else {
            return Turn::Done;
        };
        if report.block.program == 0 {
            self.block = report.block.block;
        }
        match &report.state {
            TestState::Failed(message) if !self.said => {
                self.said = true;
                let text = site.control().message_text(message);
                Turn::Say(bahn_screen::texts::translate(site.language(), &text))
            }
            TestState::Finished => {
                self.said = true;
                Turn::Done
            }
            _ => Turn::Done,
        }
    }
}
