//! What can happen to a machine, and what puts everything back.

use super::dice::Dice;

/// What kind of thing happens, and so what may come of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// The operator uses the machine as he may: overrides, NC stop, NC start, modes, keys.
    Use,
    /// He presses a key of an axis.
    AxisKey,
    /// EMERGENCY STOP, or the control voltage goes.
    Emergency,
    /// The supply of the control goes.
    Power,
    /// A door, a lubricant: something that the PLC watches is moved by hand.
    Thing,
    /// Something of the machine fails.
    Fault,
    /// The PLC says something wrong.
    Plc,
}

impl Kind {
    /// Every kind of happening.
    pub const ALL: [Kind; 7] = [
        Kind::Use,
        Kind::AxisKey,
        Kind::Emergency,
        Kind::Power,
        Kind::Thing,
        Kind::Fault,
        Kind::Plc,
    ];
}

/// Something that can happen, with what undoes it later.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Mishap {
    pub kind: Kind,
    pub what: String,
    pub undone_by: Option<String>,
}

/// Everything that can happen to a machine.
#[derive(Clone, Debug)]
pub(super) struct Catalogue {
    by_kind: Vec<(Kind, Vec<Mishap>)>,
    /// What puts everything back, in this order.
    pub repairs: Vec<String>,
}

impl Catalogue {
    /// Of all that was found.
    pub fn of(mishaps: &[Mishap], repairs: Vec<String>) -> Catalogue {
        let by_kind = Kind::ALL.map(|kind| {
            let own = mishaps.iter().filter(|mishap| mishap.kind == kind);
            (kind, own.cloned().collect())
        });
        Catalogue {
            by_kind: by_kind.to_vec(),
            repairs,
        }
    }

    /// Something of the machine's own that the PLC does not expect.
    pub fn also(&mut self, what: &str) {
        let own = self.by_kind.iter_mut().filter(|(kind, _)| *kind == Kind::Plc);
        for (kind, mishaps) in own {
            mishaps.push(Mishap {
                kind: *kind,
                what: what.to_owned(),
                undone_by: None,
            });
        }
    }

    /// One of a kind.
    pub fn pick(&self, kind: Kind, dice: &mut Dice) -> Option<Mishap> {
        let (_, mishaps) = self.by_kind.iter().find(|(own, _)| *own == kind)?;
        dice.pick(mishaps).cloned()
    }
}
