//! What a host asks of the control that it drives, whatever its family is.

use std::fmt::{Debug, Display};

use bahn_path::PathElement;
use bahn_reader::Warning;

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

    /// How many channels there are.
    fn channels(&self) -> usize;

    /// Keeps the path elements of programs that begin from now on, for [`Hosted::take_prepared`].
    fn keep_path(&mut self);

    /// What a channel, from 0, has prepared of its path since the last call.
    fn take_prepared(&mut self, channel: usize) -> Prepared;

    /// How far a channel, from 0, is on its path; `None` where there is no such channel.
    fn executes(&self, channel: usize) -> Option<Executes<'_>>;

    /// What is to be said of the program of a channel, from 0, since the last call, and ends no run.
    fn take_warnings(&mut self, channel: usize) -> Vec<Warning>;

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

/// What a channel has prepared of its path.
#[derive(Clone, Debug, Default)]
pub struct Prepared {
    /// Of what was taken before, the elements from this sequence on are not executed: the tool is replaced before them.
    pub dropped: Option<u64>,
    /// New elements, in workpiece coordinates.
    pub elements: Vec<PathElement>,
}

/// How far a channel is on its path.
#[derive(Clone, Copy, Debug)]
pub struct Executes<'a> {
    /// The element that is executed, with the distance that is left of it, mm.
    pub element: Option<(&'a PathElement, f64)>,
    /// The program has come to its end.
    pub has_ended: bool,
}

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
