//! What a host asks of the control that it drives, whatever its family is.

use std::fmt::{Debug, Display};

use crate::action::{Action, Answer, Source};

/// A control that a host drives, as what of it the parts of a host need to know.
pub trait Hosted: Clone + Sized {
    /// What is done to a channel.
    type Command: Clone + Debug + Display + PartialEq;
    /// What is told when it happens.
    type Notice: Clone + From<HostNotice<Self::Command>>;
    /// The control as it is at a moment, for those who look at it.
    type Snapshot: Clone;
    /// Who stands by.
    type Operator: Clone;
    /// What an editor has written, for a control that is on.
    type Renewed: Clone + Debug;
    /// What belongs to a moment, and the control does not know.
    type Aside: Clone;
    /// What the host has for it that belongs to no moment: threads, looks, files.
    type Beside;
    /// Where it is kept what survives power-off.
    type State;

    /// Time since power-on, µs.
    fn time_us(&self) -> u64;

    /// What belongs to the moment of power-on beside the control.
    fn aside(&self) -> Self::Aside;

    /// The control as it is now.
    fn snapshot(&self) -> Self::Snapshot;

    /// The same in the memory of an earlier one.
    fn snapshot_again(&self, _earlier: Self::Snapshot) -> Self::Snapshot {
        self.snapshot()
    }

    /// Bytes of program text in a command.
    fn text_in(_command: &Self::Command) -> usize {
        0
    }

    /// What who stands by does in this cycle, for which channel, and what is told of it.
    fn stand_by(&self, operator: &mut Self::Operator) -> Option<ByOperator<Self>>;
}

/// What who stands by does: the channel, from 0, the action, and what is told of it.
pub type ByOperator<C> = (
    usize,
    Action<<C as Hosted>::Command>,
    Option<<C as Hosted>::Notice>,
);

/// What a host tells of every control.
#[derive(Clone, Debug, PartialEq)]
pub enum HostNotice<C> {
    /// Something was done, and what came of it.
    Given(Source, Action<C>, Answer),
    /// An earlier moment was gone back to: what comes now follows from it.
    Restored,
    /// Something keeps the machine from going on; in words.
    Fault(String),
}
