//! What switches a contactor of a cabinet.

use bahn_servo::OUTPUTS;

use crate::reader::{Coil, Section};

/// What switches a contactor: it pulls in with any of its branches, and holds itself as long as all contacts of `hold` are closed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Circuit {
    branches: Vec<Vec<Coil>>,
    hold: Vec<Coil>,
}

impl Circuit {
    /// Reads `on = ["A7 and A20", "not K1"]` and `hold = ["voltage", "not A17"]`; `None` without `on`.
    pub fn read(section: &Section) -> Option<Circuit> {
        let series = |(at, text): (usize, &str)| -> Vec<Coil> {
            let terms = text.split(" and ").map(str::trim);
            terms.filter_map(|term| section.contact_at(at, term)).collect()
        };
        let branches: Vec<Vec<Coil>> = section.texts("on").into_iter().map(series).collect();
        let hold = section.texts("hold").into_iter().flat_map(series).collect();
        (!branches.is_empty()).then_some(Circuit { branches, hold })
    }

    /// Whether it is under voltage, when its own contact is closed or not.
    pub fn is_on(&self, closed: bool, live: &[bool; OUTPUTS]) -> bool {
        let all = |contacts: &[Coil]| contacts.iter().all(|contact| contact.is_on(live));
        let holds = closed && !self.hold.is_empty() && all(&self.hold);
        holds || self.branches.iter().any(|branch| all(branch))
    }
}
