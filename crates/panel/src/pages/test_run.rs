//! TEST RUN: a program is checked without moving an axis [003:1514-1535].

use std::sync::Arc;

use bahn_control::{Command, TestState};
use bahn_dialogue::Key;
use bahn_parameters::MessageId;
use bahn_program::Program;

use crate::graphics::Subject;
use crate::page::{Page, Turn, View};
use crate::pages::files::{Directory, Purpose, selection};
use crate::pages::run::listing;
use crate::site::Site;

/// A program is tested.
pub(crate) struct TestRun {
    open: Option<(String, Arc<Program>)>,
    /// What the test came to was said.
    said: bool,
    block: u32,
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

    /// STOP: neither the test nor its graphics go on.
    fn stop(&mut self, site: &mut Site) -> Turn {
        site.graphics.stop();
        match site.command(Command::EndTest) {
            true => Turn::Done,
            false => Turn::Refused,
        }
    }
}

/// The soft keys.
const KEYS: [Key; 5] = [Key::Start, Key::Stop, Key::Graphics, Key::BlkForm, Key::Magn];

impl Page for TestRun {
    fn key(&mut self, key: Key, site: &mut Site) -> Turn {
        if site.graphics.key(Subject::Test, key) {
            return Turn::Done;
        }
        match key {
            Key::PgmNr => Turn::Open(Box::new(Directory::new(Purpose::Test, site))),
            Key::Start => self.start(site),
            Key::Stop => self.stop(site),
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
        ]]
    }

    fn soft_key(&mut self, _row: usize, place: usize, site: &mut Site) -> Turn {
        match KEYS.get(place) {
            Some(key) => self.key(*key, site),
            None => Turn::Refused,
        }
    }

    fn show(&self, site: &Site, lines: usize) -> View {
        match &self.open {
            Some((name, program)) => View::of(listing(name, program, self.block, lines)),
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
                Turn::Say(crate::texts::translate(site.language(), &text))
            }
            TestState::Finished => {
                self.said = true;
                Turn::Done
            }
            _ => Turn::Done,
        }
    }
}
