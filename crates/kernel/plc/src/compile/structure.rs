//! IF, REPEAT, WHILE: nested structures and their invisible labels [000:14434-14527].

/// Structures inside each other at most.
pub(super) const NESTING_MAX: usize = 16;

/// An open structure. Jumps whose target is not known yet are kept by their index in the code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The jump over the first branch, or the one at its end once there was an ELSE.
    If { jump: usize, has_else: bool },
    /// Where the loop starts.
    Repeat { start: usize },
    /// The test, which is also the jump out of the loop.
    While { test: usize },
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Structure {
    pub(super) kind: Kind,
    pub(super) place: super::Place,
}

/// What closes a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Closer {
    Else,
    EndIf,
    Until,
    EndWhile,
}

impl Closer {
    fn closes(self, kind: Kind) -> bool {
        matches!(
            (self, kind),
            (Closer::Else, Kind::If { has_else: false, .. })
                | (Closer::EndIf, Kind::If { .. })
                | (Closer::Until, Kind::Repeat { .. })
                | (Closer::EndWhile, Kind::While { .. })
        )
    }
}

/// Takes the structure that a command closes, and tells whether it was the innermost one. A structure
/// farther out is taken too, so that crossed structures are one error and not two.
pub(super) fn close(open: &mut Vec<Structure>, closer: Closer) -> Option<(Structure, bool)> {
    let at = open.iter().rposition(|structure| closer.closes(structure.kind))?;
    let innermost = at + 1 == open.len();
    Some((open.remove(at), innermost))
}
