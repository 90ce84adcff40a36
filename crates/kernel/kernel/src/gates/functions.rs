//! What the gates ask a family, and tell it.

use bahn_path::Position;

/// The functions of a family, which goes from cycle to cycle along the path.
pub trait Functions {
    /// How it knows a function: they count on in the order of the programs.
    type Ticket: Copy + Ord;
    /// What it does at places beside functions.
    type Own;

    /// Cycles of the run that are over.
    fn cycle(&self) -> u64;

    /// Nothing has to be waited for because of a function any more.
    fn is_done(&self, ticket: Self::Ticket) -> bool;

    /// The path need not stand at the wait place of a function, as motion goes now.
    fn is_open(&self, ticket: Self::Ticket) -> bool;

    /// Whether the path comes to a standstill for a function in any case, as motion goes now.
    fn stands_for(&self, ticket: Self::Ticket) -> bool;

    /// Whether a function is waited for anywhere.
    fn is_waited_for(&self, ticket: Self::Ticket) -> bool;

    /// Whether the path waits for a function on its way back.
    fn waits_backward(&self, ticket: Self::Ticket) -> bool;

    /// The function for which this one cannot be output now.
    fn blocker(&self, ticket: Self::Ticket) -> Option<Self::Ticket>;

    /// Whether any function may have a blocker now.
    fn any_blocked(&self) -> bool;

    /// What executes a function is commanded.
    fn command(&mut self, ticket: Self::Ticket);

    /// A function goes out.
    fn output(&mut self, ticket: Self::Ticket, at: Moment, way: Way);

    /// The same function once more, in another ticket: as it is on the way back, or as it was.
    fn again(&mut self, ticket: Self::Ticket, backward: bool) -> Option<Self::Ticket>;

    /// Functions have these tickets now.
    fn renamed(&mut self, new: &dyn Fn(&mut Self::Ticket));

    /// Does what is its own where the path is; `all_out` when nothing is left to go out ahead. Whether that is done.
    fn act(&mut self, own: &Self::Own, path: Position, all_out: bool) -> bool;

    /// Whether the path has to stop for what is its own.
    fn stops_for(&self, own: &Self::Own) -> bool;

    /// Whether the path waits there, and does not end.
    fn waits_for(&self, own: &Self::Own) -> bool;

    /// Whether the run goes on.
    fn goes_on(&self) -> bool;

    /// Where the axes are when the path is somewhere: some may move beside it.
    fn beside(&self, path: Position) -> Position;

    /// Axes that move beside the path do so for a cycle. Whether there are any.
    fn move_beside(&mut self) -> bool;

    /// The path begins to move or comes to rest, in a block or at its end.
    fn tell(&mut self, moves: bool, block: &str, at: Moment);

    /// The path has gone on to a distance along it, mm, and has this speed now, mm/s.
    fn went(&mut self, distance_mm: f64, speed_mm_s: f64);

    /// A function went out later than it should.
    fn tell_short_lead(&mut self, ticket: Self::Ticket, short: Short);
}

/// Where and when something happens.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Time of the run, s.
    pub t: f64,
    /// Where the axes are.
    pub position: Position,
    /// Speed along the path, mm/s.
    pub speed_mm_s: f64,
}

/// How a function goes out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// At its place, at which the path was so long before, s.
    Place(f64),
    /// Ahead of it; with the distance, mm, and the time, s, to go, where they are wanted.
    Ahead(Option<(f64, f64)>),
    /// On the way back.
    Back,
}

/// A lead that was not kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Short {
    /// The lead that was kept, s or mm.
    pub is: f64,
    /// The lead that was asked for, s or mm.
    pub asked: f64,
    /// They are times, s; otherwise distances, mm.
    pub is_time: bool,
    /// What kept it from more.
    pub why: Why,
}

/// Why a lead was not kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// It was planned with an end velocity of 0 at its place, and the path has not stopped.
    NoStop,
    /// The path was there sooner than it was planned.
    Sooner,
    /// Another function came first, or was not fetched.
    Another,
    /// The path begins there, or comes to rest there for a flush.
    Barrier,
    /// The look-ahead begins there.
    LookAhead,
}
