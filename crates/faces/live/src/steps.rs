//! Contour cycles that somebody asks for: they pass one by one, and what is given meanwhile is done between two of them.
//!
//! Decision: Contour cycles that somebody asks for while time stands pass in real time, 10,000 wait at most, and what
//! is given meanwhile is done between them; pausing or going on breaks them off; EMERGENCY STOP goes before all other
//! inputs and breaks off what takes long (also `live/src/live.rs`)

use serde::Serialize;

/// Contour cycles that wait at most: 30 s of a TNC 415.
const MOST: u64 = 10_000;

/// Why no more of the cycles that were asked for pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StepsEnd {
    /// As many as were asked for have passed.
    Complete,
    /// No more than 10,000 wait at a time: so many have passed.
    Limit,
    /// Somebody let time stand, or go on.
    Paused,
    /// The machine has gone to another moment, or a lesson has begun.
    Elsewhere,
}

/// What has become of cycles that were asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Stepped {
    /// Contour cycles that have passed.
    pub cycles: u64,
    /// Why no more do.
    pub ended: StepsEnd,
}

/// The cycles that are asked for. They are counted since the station began.
#[derive(Clone, Debug, Default)]
pub struct Steps {
    taken: u64,
    until: u64,
    /// How often they were broken off, at which count, and why.
    breaks: u64,
    broken: Option<(u64, StepsEnd)>,
}

/// Some of them: those of one who waits for them.
#[derive(Clone, Copy, Debug)]
pub struct Ticket {
    from: u64,
    to: u64,
    cut: bool,
    breaks: u64,
}

impl Steps {
    /// So many more are to pass, after those that are asked for already.
    pub fn ask(&mut self, cycles: u32) -> Ticket {
        let from = self.until;
        let wanted = from + u64::from(cycles);
        self.until = wanted.min(self.taken + MOST);
        Ticket {
            from,
            to: self.until,
            cut: self.until < wanted,
            breaks: self.breaks,
        }
    }

    /// Some are still to pass.
    pub fn wait(&self) -> bool {
        self.taken < self.until
    }

    /// A contour cycle has passed.
    pub fn pass(&mut self) {
        self.taken += u64::from(self.wait());
    }

    /// None of those that wait will pass.
    pub fn break_off(&mut self, why: StepsEnd) {
        if self.wait() {
            self.breaks += 1;
            self.broken = Some((self.taken, why));
            self.until = self.taken;
        }
    }

    /// What has become of some of them, as soon as no more pass.
    pub fn outcome(&self, ticket: &Ticket) -> Option<Stepped> {
        let (taken, ended) = match self.broken {
            Some(broken) if ticket.breaks < self.breaks => broken,
            _ if self.taken < ticket.to && ticket.from < ticket.to => return None,
            _ if ticket.cut => (ticket.to, StepsEnd::Limit),
            _ => (ticket.to, StepsEnd::Complete),
        };
        Some(Stepped {
            cycles: taken.clamp(ticket.from, ticket.to) - ticket.from,
            ended,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stepped(cycles: u64, ended: StepsEnd) -> Option<Stepped> {
        Some(Stepped { cycles, ended })
    }

    #[test]
    fn they_pass_one_after_the_other_and_are_broken_off_together() {
        let mut steps = Steps::default();
        let (two, three) = (steps.ask(2), steps.ask(3));
        steps.pass();
        assert_eq!((steps.outcome(&two), steps.outcome(&three)), (None, None));
        steps.pass();
        assert_eq!(steps.outcome(&two), stepped(2, StepsEnd::Complete));
        steps.pass();
        steps.break_off(StepsEnd::Paused);
        assert!(!steps.wait());
        assert_eq!(steps.outcome(&three), stepped(1, StepsEnd::Paused));
        // What is asked for later has nothing to do with that.
        let later = steps.ask(1);
        assert_eq!(steps.outcome(&later), None);
        steps.pass();
        assert_eq!(steps.outcome(&later), stepped(1, StepsEnd::Complete));
        assert_eq!(
            steps.outcome(&steps.clone().ask(0)),
            stepped(0, StepsEnd::Complete)
        );
    }

    #[test]
    fn no_more_wait_than_a_limit() {
        let mut steps = Steps::default();
        let (many, more) = (steps.ask(100_000), steps.ask(1));
        assert_eq!(steps.outcome(&more), stepped(0, StepsEnd::Limit));
        for _ in 0..MOST {
            steps.pass();
        }
        assert_eq!(steps.outcome(&many), stepped(MOST, StepsEnd::Limit));
        assert!(!steps.wait());
    }
}
