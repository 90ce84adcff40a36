//! Axes that no program of a machine moves.

use bahn_parameters::ParameterList;
use bahn_path::{Axis, AxisSet};

/// The axes that no program of a machine moves, by the reason; without a machine there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AbsentAxes {
    /// The machine does not have them.
    pub missing: AxisSet,
    /// The PLC alone moves them: MP60 [000:4094-4116].
    pub plc: AxisSet,
    /// They follow their masters: MP850 [000:4519].
    pub slaves: AxisSet,
}

impl AbsentAxes {
    /// Those of a machine with these lists, one for each channel: an axis may come from another channel.
    pub fn of<'a>(lists: impl Iterator<Item = &'a ParameterList> + Clone) -> AbsentAxes {
        let mut absent = AbsentAxes::default();
        for axis in Axis::ALL {
            let mut places = lists.clone().filter_map(|list| {
                let index = list.axis_index(axis)?;
                Some(list.axis_parameters(index))
            });
            match places.next() {
                None => absent.missing.insert(axis),
                Some(place) if place.plc_axis => absent.plc.insert(axis),
                Some(place) if place.synchronization.master.is_some() => absent.slaves.insert(axis),
                Some(_) => {}
            }
        }
        absent
    }

    /// Why the first of some axes is not there for a program; `None` when all are.
    pub fn reason(&self, axes: AxisSet) -> Option<String> {
        let barred = self.missing.union(self.plc).union(self.slaves).intersection(axes);
        let axis = barred.iter().next()?;
        let letter = axis.letter();
        Some(if self.plc.contains(axis) {
            format!("the PLC alone moves {letter} (MP60)")
        } else if self.slaves.contains(axis) {
            format!("{letter} follows its master (MP850)")
        } else {
            format!("there is no axis {letter} here")
        })
    }
}
