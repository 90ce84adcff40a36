//! Where functions and dwell make the path stop.

use bahn_path::{At, Curve, PathElement, Synchronisation, TechnologyFunction};

/// The ends of an element at which the path must stand still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Gates {
    pub(crate) start: bool,
    pub(crate) end: bool,
}

/// An end of an element, where the path can wait for functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gate {
    /// Before its movement.
    Start,
    /// After its movement.
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
            !functions.is_empty() && functions.iter().all(|function| wait(function).is_none())
        };
        let hold = matches!(element.curve, Curve::Hold) && !passes();
        let thread = element.thread().is_some();
        let mut gates = Gates {
            start: hold || thread,
            end: hold || thread || element.dwell_s > 0.0,
        };
        for function in element.functions() {
            match wait(function) {
                Some(Gate::Start) => gates.start = true,
                Some(Gate::End) => gates.end = true,
                None => {}
            }
        }
        gates
    }
}

/// Where the axes wait for a function, `None` when they do not (MP7440 bit 2) [004:54].
pub(crate) fn wait(function: &TechnologyFunction) -> Option<Gate> {
    match function.synchronisation {
        Synchronisation::Mos => None,
        Synchronisation::MvsSvs | Synchronisation::MnsSns => place(function),
    }
}

/// The end of the element at which a function is output, `None` in the midst of the movement. Nothing
/// can wait there: the type decides at which end a function that waits is output instead.
pub(crate) fn place(function: &TechnologyFunction) -> Option<Gate> {
    match (function.at, function.synchronisation) {
        (At::Start, _) => Some(Gate::Start),
        (At::End, _) => Some(Gate::End),
        (At::Length(_) | At::BeforeEnd(_), Synchronisation::MvsSvs) => Some(Gate::Start),
        (At::Length(_) | At::BeforeEnd(_), Synchronisation::MnsSns) => Some(Gate::End),
        (At::Length(_) | At::BeforeEnd(_), Synchronisation::Mos) => None,
    }
}
