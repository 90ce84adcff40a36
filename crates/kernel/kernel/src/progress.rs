//! How far a run is: started, interrupted, stopped, ended.
//!
//! Decision: A fault of a program interrupts the run; the next start tries its block again, and another program can
//! be chosen meanwhile

/// What the run does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunState {
    /// Nothing was started, or it was broken off or ended.
    #[default]
    Idle,
    /// Blocks are executed one after the other.
    Running,
    /// An external stop: `*` flashes. NC start goes on [000:6581-6587].
    Interrupted,
    /// A programmed stop (STOP, M0, M6): NC start goes on.
    Stopped,
    /// Single block: NC start executes the next one.
    BlockEnd,
}

/// How far a run has come, and what it is to do next.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress {
    state: RunState,
    /// A fault has interrupted it: it is not on its way, and the next start tries the block again.
    broken: bool,
    /// NC start was given: the run begins with the next preparation.
    begin_wanted: bool,
    /// The program that runs came to its end since it was started (M2061).
    ended: bool,
}

impl Progress {
    /// What the run does now.
    pub fn state(&self) -> RunState {
        self.state
    }

    /// A fault has interrupted it.
    pub fn is_broken(&self) -> bool {
        self.broken
    }

    /// The program came to its end since it was started.
    pub fn has_ended(&self) -> bool {
        self.ended
    }

    /// A run was started and not ended or broken off.
    pub fn is_active(&self) -> bool {
        self.state != RunState::Idle && !self.broken || self.begin_wanted
    }

    /// Blocks are executed now.
    pub fn is_running(&self) -> bool {
        self.state == RunState::Running || self.begin_wanted
    }

    /// NC start was given, or the path moves.
    pub fn goes_on(&self) -> bool {
        self.state == RunState::Running
    }

    /// The path has something to do: started, and not broken off by a fault.
    pub fn is_on_its_way(&self) -> bool {
        self.state != RunState::Idle && !self.broken
    }

    /// The run is to begin.
    pub fn want_begin(&mut self) {
        self.begin_wanted = true;
    }

    /// The run is to begin, and nothing speaks against it.
    pub fn take_begin(&mut self, may: impl FnOnce() -> bool) -> bool {
        self.begin_wanted && may() && std::mem::take(&mut self.begin_wanted)
    }

    /// A run begins that has not ended.
    pub fn begin(&mut self) {
        self.leave_fault();
        self.ended = false;
    }

    /// It comes to a state in the course of its blocks.
    pub fn enter(&mut self, state: RunState) {
        self.state = state;
    }

    /// NC stop: a run that goes on is interrupted, one that was to begin does not.
    pub fn stop(&mut self) {
        self.begin_wanted = false;
        if self.state == RunState::Running {
            self.state = RunState::Interrupted;
        }
    }

    /// A block scan begins.
    pub fn scan(&mut self) {
        *self = Progress {
            state: RunState::Interrupted,
            broken: false,
            ended: false,
            ..*self
        };
    }

    /// What is on its way is broken off.
    pub fn break_off(&mut self) {
        self.state = RunState::Idle;
        self.broken = false;
    }

    /// A fault interrupts it.
    pub fn fail(&mut self) {
        self.broken = true;
        self.state = RunState::Interrupted;
    }

    /// The program came to its end.
    pub fn end(&mut self) {
        self.ended = true;
    }

    /// Nothing is interrupted any more by a fault.
    pub fn leave_fault(&mut self) {
        if std::mem::take(&mut self.broken) {
            self.state = RunState::Idle;
        }
    }
}
