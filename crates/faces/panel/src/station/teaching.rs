//! What a station has for teachers and for those who look back: sessions, the time line, why, the drawer, lessons.

use std::path::Path;

use bahn_host::{AnyPlant, Clock, Host, LoadedMachine};
use bahn_live::{Input, Refusal};
use bahn_screen::texts::Language;
use bahn_teaching::drawer::{self, Breakable};
use bahn_teaching::lesson::{self, Driven, LessonRun};
use bahn_why::Reason;

use super::Station;
use crate::session::{Head, Recorder};
use bahn_live::StepsEnd;

impl Driven for Station {
    fn machine(&self) -> &LoadedMachine {
        &self.machine
    }

    fn host(&mut self) -> &mut Host<AnyPlant> {
        &mut self.host
    }

    fn cycle(&mut self) -> Result<(), String> {
        match self.host.is_broken_off() {
            true => Err("EMERGENCY STOP was pressed before the lesson could begin".to_owned()),
            false => Station::cycle(self).map_err(|error| error.to_string()),
        }
    }
}

impl Station {
    /// Goes to a moment since power-on, s, and stands there; what is done then leads another way, and what was later is
    /// kept as a branch.
    ///
    /// # Errors
    /// When the moment is forgotten, or the list of machine parameters is entered.
    pub fn go_to(&mut self, time_s: f64) -> Result<(), Refusal> {
        self.input(&Input::GoTo(time_s, None))
    }

    pub(super) fn go_to_in(&mut self, time_s: f64, branch: Option<u32>) -> Result<(), Refusal> {
        self.has_its_list()?;
        // A number that is none is the beginning.
        let time_us = (time_s.max(0.0) * 1e6).round() as u64;
        let gone = self
            .study
            .past
            .go_to(&mut self.host, &mut self.study.lesson, time_us, branch);
        let remark = gone.map_err(Refusal)?;
        self.passing.steps.break_off(StepsEnd::Elsewhere);
        self.passing.paused = true;
        self.supply.is_on = !self.host.control().is_off();
        let (mode, model) = (self.host.control().mode(), self.host.control().model());
        self.console.machine_is_elsewhere(mode, model);
        self.instruments.graphics.machine_is_elsewhere();
        if self.supply.is_on {
            // The page finds what it shows.
            let (console, mut site) = self.parts();
            console.tick(&mut site);
        }
        self.study.waits.forget();
        self.instruments.plc.stop();
        self.follow_plc();
        remark.map_or(Ok(()), |words| Err(Refusal(words)))
    }

    /// Keeps every input from now on in a file.
    ///
    /// # Errors
    /// In words, when the file is there already or cannot be written.
    pub fn record(&mut self, path: &Path) -> Result<(), String> {
        let head = Head::of(&self.machine, self.host.control());
        self.study.recorder = Some(Recorder::create(path, &head)?);
        Ok(())
    }

    /// Ends the file that is recorded.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn end_recording(&mut self) -> Result<(), String> {
        let Some(recorder) = self.study.recorder.take() else {
            return Ok(());
        };
        let now_us = self.host.control().time_us();
        recorder.finish(now_us, self.screen())
    }

    /// What the machine waits for, in the language of the dialogue, what is most urgent first.
    pub fn why(&self) -> Vec<Reason> {
        self.study
            .waits
            .reasons(&self.host, &self.machine, self.language())
    }

    /// Everything that a teacher can break, and how.
    pub fn drawer(&self) -> Vec<Breakable> {
        drawer::of(self.host.plant(), self.control().model(), self.language())
    }

    /// The lessons of the machine's folder: names and titles; one that cannot be read has its faults as title.
    pub fn lessons(&self) -> Vec<(String, String)> {
        lesson::list(&self.machine, self.host.plant(), self.language())
    }

    /// The lesson that goes on.
    pub fn lesson(&self) -> Option<&LessonRun> {
        self.study.lesson.as_ref()
    }

    /// Begins a lesson, as fast as the machine gets ready for it, or ends the one that goes on. One that cannot be read
    /// changes nothing.
    pub(super) fn begin_lesson(&mut self, name: Option<&str>) -> Result<(), Refusal> {
        let lesson = name
            .map(|name| lesson::load(&self.machine, self.host.plant(), name))
            .transpose();
        let lesson = lesson.map_err(Refusal)?;
        if lesson.is_some() {
            self.has_its_list()?;
        }
        self.study.lesson = None;
        let Some(lesson) = lesson else {
            return Ok(());
        };
        self.passing.steps.break_off(StepsEnd::Elsewhere);
        self.host.set_clock(Clock::Free);
        let begun = lesson::begin(self, lesson);
        self.host.set_clock(self.clock());
        self.study.lesson = Some(begun.map_err(Refusal)?);
        Ok(())
    }

    pub(super) fn hand_in(&mut self) {
        if let Some(mut lesson) = self.study.lesson.take() {
            let screen = self.screen().clone();
            lesson.hand_in(&mut self.host, &screen);
            self.study.lesson = Some(lesson);
        }
    }

    /// The lesson looks at what a cycle has changed.
    pub(super) fn follow_lesson(&mut self) {
        if let Some(mut lesson) = self.study.lesson.take() {
            let screen = lesson.wants_screen(&self.host).then(|| self.screen().clone());
            lesson.follow(&mut self.host, screen.as_ref());
            self.study.lesson = Some(lesson);
        }
    }

    pub(crate) fn language(&self) -> Language {
        let english = self.machine.parameters.operation_parameters().english;
        self.chosen.now.language(english)
    }
}
