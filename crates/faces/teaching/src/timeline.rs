//! The time line: any moment since power-on can be gone back to, and from there another way.
//!
//! States of the whole machine are saved at regular times; the way from one of them to a moment is gone again with what
//! was given then. Going on from a moment of the past makes a branch: the way that was gone before is kept, and can be
//! gone back to until newer ones take its place. Files are no part of it: a program that was written stays written.

use std::collections::VecDeque;

use bahn_host::{
    Action, AnyPlant, Course, Event, Host, HostError, Next, Notice, Reader, Source, Stamped, Timeline,
};
use bahn_screen::{BranchLine, MarkKind, TimeLine, TimeMark};
use bahn_tnc::{Command, RunState};

use crate::lesson::LessonRun;

/// Between two saved states at first, µs.
const EVERY_US: u64 = 1_000_000;
/// Saved states at most: when there are more, every other one goes.
const MOMENTS: usize = 128;
/// Ways that are kept beside the one that is gone.
const BRANCHES: usize = 4;
/// Marks of a way at most; the oldest go.
const MARKS: usize = 256;

/// A way with everything that belongs to it.
struct Way {
    course: Course,
    moments: Timeline<AnyPlant>,
    marks: Vec<TimeMark>,
    lesson: Option<LessonRun>,
}

impl Way {
    fn replay(&self, host: &mut Host<AnyPlant>, time_us: u64) -> Result<(), HostError> {
        let saved = self
            .moments
            .nearest(time_us)
            .ok_or(match self.moments.is_empty() {
                true => HostError::StaysWhereItIs,
                false => HostError::Forgotten,
            })?;
        host.replay_course(&self.course, saved, time_us)
    }
}

struct Branch {
    number: u32,
    from_us: u64,
    way: Way,
}

/// What is kept of the time since power-on.
pub struct Past {
    notices: Reader<Stamped>,
    run: RunState,
    moments: Timeline<AnyPlant>,
    marks: Vec<TimeMark>,
    /// While the operator looks back: the way as far as it was gone, and how many actions led to where he looks.
    looks: Option<(Way, u64)>,
    branches: VecDeque<Branch>,
    last_number: u32,
}

impl Past {
    /// The time line of a machine from now on.
    pub fn new(host: &mut Host<AnyPlant>) -> Past {
        let mut moments = Timeline::new(EVERY_US, MOMENTS);
        moments.follow(host);
        Past {
            notices: host.notices(),
            run: RunState::Idle,
            moments,
            marks: Vec::new(),
            looks: None,
            branches: VecDeque::new(),
            last_number: 0,
        }
    }

    /// To be called after every cycle.
    pub fn follow(&mut self, host: &mut Host<AnyPlant>) {
        self.go_on(host.control().time_us());
        self.moments.follow(host);
        while let Some(next) = self.notices.next() {
            if let Next::Item(stamped) = next {
                self.mark(&stamped, host);
            }
        }
    }

    /// To be called after every input: what the machine was given while the operator looked back leads elsewhere.
    pub fn settle(&mut self, host: &Host<AnyPlant>) {
        let given = self.looks.as_ref().map(|(_, given)| *given);
        if given.is_some_and(|given| given != host.given_count()) {
            self.go_on(host.control().time_us());
        }
    }

    /// The way that was gone before becomes a branch.
    fn go_on(&mut self, now_us: u64) {
        if let Some((way, _)) = self.looks.take() {
            self.marks.retain(|mark| mark.t * 1e6 <= now_us as f64);
            self.keep(way, now_us);
        }
    }

    /// A way that is left needs less memory: half of its moments.
    fn keep(&mut self, mut way: Way, from_us: u64) {
        while way.moments.len() > MOMENTS / 2 {
            way.moments.thin();
        }
        if self.branches.len() == BRANCHES {
            self.branches.pop_front();
        }
        self.last_number += 1;
        self.branches.push_back(Branch {
            number: self.last_number,
            from_us,
            way,
        });
    }

    /// Goes to a moment of this way or of a branch; the machine stands there. The lesson of that way comes with it.
    ///
    /// What went wrong on the way there, if anything, in words.
    ///
    /// # Errors
    /// When there is no such branch, or its beginning is forgotten; everything stays as it is then.
    pub fn go_to(
        &mut self,
        host: &mut Host<AnyPlant>,
        lesson: &mut Option<LessonRun>,
        time_us: u64,
        branch: Option<u32>,
    ) -> Result<Option<String>, String> {
        let place = match branch {
            None => None,
            Some(number) => {
                let place = self.branches.iter().position(|branch| branch.number == number);
                Some(place.ok_or_else(|| format!("there is no branch {number}"))?)
            }
        };
        let here_us = host.control().time_us();
        let present = match self.looks.take() {
            Some((way, _)) => way,
            None => Way {
                course: host.course(),
                moments: self.moments.clone(),
                marks: self.marks.clone(),
                lesson: lesson.clone(),
            },
        };
        let target = place.and_then(|place| self.branches.get(place));
        let gone = target
            .map_or(&present, |branch| &branch.way)
            .replay(host, time_us);
        if let Err(error @ (HostError::Logged | HostError::StaysWhereItIs | HostError::Forgotten)) = gone {
            // Nothing has happened.
            let looks = here_us < present.course.end_us();
            self.looks = looks.then(|| (present, host.given_count()));
            return Err(error.to_string());
        }
        let way = match place.and_then(|place| self.branches.remove(place)) {
            Some(branch) => {
                self.keep(present, here_us.min(branch.from_us));
                branch.way
            }
            None => present,
        };
        self.enter(host, lesson, way);
        Ok(gone.err().map(|error| error.to_string()))
    }

    /// The machine is on this way now.
    fn enter(&mut self, host: &Host<AnyPlant>, lesson: &mut Option<LessonRun>, way: Way) {
        let now_us = host.control().time_us();
        self.moments = way.moments.clone();
        self.marks.clone_from(&way.marks);
        // What is told of the past was told then.
        self.notices = host.notices();
        self.run = host.control().run_state();
        lesson.clone_from(&way.lesson);
        if let Some(run) = lesson {
            run.go_back(now_us);
        }
        if lesson.as_ref().is_some_and(|run| run.begun_us() > now_us) {
            *lesson = None;
        }
        let at_end = now_us >= way.course.end_us();
        self.looks = (!at_end).then(|| (way, host.given_count()));
    }

    /// The operator looks at the past.
    pub fn looks_back(&self) -> bool {
        self.looks.is_some()
    }

    /// The line and its marks, as the screen shows them.
    pub fn shown(&self, host: &Host<AnyPlant>) -> TimeLine {
        let now_us = host.control().time_us();
        let (to_us, marks) = match &self.looks {
            Some((way, _)) => (way.course.end_us(), &way.marks),
            None => (now_us, &self.marks),
        };
        let line = |branch: &Branch| BranchLine {
            number: branch.number,
            from_s: seconds(branch.from_us),
            to_s: seconds(branch.way.course.end_us()),
        };
        TimeLine {
            from_s: 0.0,
            to_s: seconds(to_us),
            now_s: seconds(now_us),
            marks: marks.clone(),
            branches: self.branches.iter().map(line).collect(),
        }
    }

    fn mark(&mut self, stamped: &Stamped, host: &Host<AnyPlant>) {
        let control = host.control();
        let program = || control.selected_program().unwrap_or_default().to_owned();
        let before = self.run;
        let (kind, text) = match &stamped.notice {
            Notice::Shown(shown) => (MarkKind::Message, control.shown_text(shown)),
            Notice::Ended => (MarkKind::End, program()),
            Notice::Run(run) => {
                self.run = *run;
                match (before, run) {
                    (RunState::Idle, RunState::Running) => (MarkKind::Start, program()),
                    (_, RunState::Interrupted | RunState::Stopped) => (MarkKind::Stop, program()),
                    _ => return,
                }
            }
            // What a lesson does is for the trainee to find.
            Notice::Given(Source::Client(_), action, _) if is_telling(action) => {
                (MarkKind::Action, action.to_string())
            }
            _ => return,
        };
        if self.marks.len() == MARKS {
            self.marks.remove(0);
        }
        self.marks.push(TimeMark {
            t: seconds(stamped.time_us),
            kind,
            text,
        });
    }
}

/// Deeds that one looks for later: not each key.
fn is_telling(action: &Action) -> bool {
    match action {
        Action::Command(_, command) => matches!(command, Command::Power(_)),
        Action::Event(event, _) => matches!(
            event,
            Event::Fault(_)
                | Event::Repair(_)
                | Event::EmergencyStop(_)
                | Event::Voltage(_)
                | Event::Switch(..)
                | Event::Force(..)
                | Event::Tool(_)
                | Event::Probe(_)
                | Event::Stylus(..)
        ),
    }
}

fn seconds(us: u64) -> f64 {
    us as f64 / 1e6
}
