//! Where functions and dwell make the path stop.

use bahn_path::{At, Curve, FeedRate, OutputPlace, PathElement, TechnologyFunction, WaitPlace};

/// The ends of an element at which the path must stand still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Gates {
    pub(crate) start: bool,
    pub(crate) end: bool,
}

/// An end of an element, where the path can wait for functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gate {
    /// Before the movement of the element.
    Start,
    /// After the movement of the element.
    End,
}

impl Gates {
    /// A block without movement, a dwell and a path that follows the spindle stop the path; so do functions that wait for their
    /// acknowledgement, at the end where they do. A block of nothing but functions that do not wait is passed
    /// (MP3030 = 1) [000:5645-5651].
    #[inline]
    pub(crate) fn of(element: &PathElement) -> Gates {
        let passes = || {
            let functions = element.functions();
            !functions.is_empty() && functions.iter().all(|function| wait(function, element).is_none())
        };
        let hold = matches!(element.curve, Curve::Hold) && !passes();
        let thread = element.thread().is_some();
        let mut gates = Gates {
            start: hold || thread,
            end: hold || thread || element.dwell_s > 0.0,
        };
        for function in element.functions() {
            match wait(function, element) {
                Some(Gate::Start) => gates.start = true,
                Some(Gate::End) => gates.end = true,
                None => {}
            }
        }
        gates
    }
}

/// At which end of its element the axes wait for a function in any case, `None` when they do not (MP7440 bit 2), or only
/// as long as it is not acknowledged ([`late`](crate::late)) [004:54].
pub(crate) fn wait(function: &TechnologyFunction, element: &PathElement) -> Option<Gate> {
    let synchronisation = function.synchronisation;
    match synchronisation.wait() {
        // In the movement that would wait for it, it is a function at its start [004:72].
        WaitPlace::Feed if is_feed(element) => Some(Gate::Start),
        WaitPlace::Nowhere | WaitPlace::Feed | WaitPlace::Point => None,
        WaitPlace::After if synchronisation.spans_motion() => None,
        WaitPlace::Before | WaitPlace::After | WaitPlace::Output => place(function),
    }
}

/// A movement with a feed: G01, G02, G03 [004:72].
pub(crate) fn is_feed(element: &PathElement) -> bool {
    matches!(element.feed, FeedRate::Programmed(_)) && element.curve != Curve::Hold
}

/// The end of the element at which a function is output, `None` in the midst of the movement. Nothing
/// can wait there: the type decides at which end a function that waits is output instead.
pub(crate) fn place(function: &TechnologyFunction) -> Option<Gate> {
    let synchronisation = function.synchronisation;
    match function.at {
        At::Ahead(_) => None,
        At::Start => Some(Gate::Start),
        At::End => Some(Gate::End),
        At::Length(_) | At::BeforeEnd(_) if !synchronisation.is_waited_for() => None,
        At::Length(_) | At::BeforeEnd(_) if synchronisation.output() == OutputPlace::After => Some(Gate::End),
        At::Length(_) | At::BeforeEnd(_) => Some(Gate::Start),
    }
}
