//! The swivel axes: MP7510 to MP7592.

use bahn_path::{Axis, Link, Swivels};

use super::bit_of;
use crate::ParameterList;

/// The axes of MP75x0, by its bits.
const AXES: [Axis; 6] = [Axis::X, Axis::Y, Axis::Z, Axis::A, Axis::B, Axis::C];

impl ParameterList {
    /// The links of the machine geometry, MP7510 to MP7592: nine at most, up to the first that names no axis
    /// [000:4278-4301]. Of several bits in MP75x0 the first counts (inferred).
    pub fn swivel_links(&self) -> Vec<Link> {
        let block = |first: u16| {
            let axes = self.get(first, 0)?;
            let (_, axis) = (0..).zip(AXES).find(|(bit, _)| bit_of(axes, *bit))?;
            let identifier = self.get(first + 1, 0)?;
            Some(Link {
                axis,
                table: bit_of(identifier, 0),
                absolute: bit_of(identifier, 1),
                dimension: self.get(first + 2, 0)?,
            })
        };
        (7510..=7590).step_by(10).map_while(block).collect()
    }

    /// The swivel axes of the machine; `None` when it has none.
    pub fn swivels(&self) -> Option<Swivels> {
        let swivels = Swivels::new(self.swivel_links());
        let turns = swivels.free_axes().next().is_some();
        turns.then_some(swivels)
    }
}
