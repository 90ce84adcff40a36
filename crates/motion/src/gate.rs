//! Where functions and dwell make the path stop.

use bahn_path::{At, Curve, PathElement, Synchronisation, TechnologyFunction};

/// The ends of an element at which the path must stand still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Gates {
    pub(crate) start: bool,
    pub(crate) end: bool,
}

/// The end of the element at which the axes wait for a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wait {
    Start,
    End,
}

impl Gates {
    /// A block without movement and a dwell stop the path; so do functions that wait for their
    /// acknowledgement, at the end where they do.
    #[inline]
    pub(crate) fn of(element: &PathElement) -> Gates {
        let hold = matches!(element.curve, Curve::Hold);
        let mut gates = Gates {
            start: hold,
            end: hold || element.dwell_s > 0.0,
        };
        for function in element.functions() {
            match wait(function) {
                Some(Wait::Start) => gates.start = true,
                Some(Wait::End) => gates.end = true,
                None => {}
            }
        }
        gates
    }
}

/// Where the axes wait for a function, `None` when they do not (MP7440 bit 2) [004:54]. The place
/// decides; in the midst of a movement, where nothing can wait, the type does.
pub(crate) fn wait(function: &TechnologyFunction) -> Option<Wait> {
    match (function.synchronisation, function.at) {
        (Synchronisation::Mos, _) => None,
        (_, At::Start) => Some(Wait::Start),
        (_, At::End) => Some(Wait::End),
        (Synchronisation::MvsSvs, At::Length(_)) => Some(Wait::Start),
        (Synchronisation::MnsSns, At::Length(_)) => Some(Wait::End),
    }
}
