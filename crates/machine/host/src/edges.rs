//! What happens to operands inside a scan of the PLC, where before and after it there is nothing to be seen.
//!
//! Decision: A recording of operands looks into every scan in the reference interpreter, which does the same bits:
//! values that are gone again at its end are events

use bahn_exchange::{Content, Image, Operand};
use bahn_plc::{TraceStep, Tracer};

/// Looks at operands instruction by instruction.
#[derive(Clone, Debug, Default)]
pub struct Edges {
    watched: Vec<Watched>,
}

#[derive(Clone, Debug)]
struct Watched {
    operand: Operand,
    /// At the beginning of the scan, and now.
    first: i32,
    last: i32,
    changes: u32,
}

impl Watched {
    fn now(&self, image: &Image) -> i32 {
        match self.operand {
            Operand::Text(_) => 0,
            operand => match operand.read(image) {
                Content::Number(value) => value,
                Content::Text(_) => 0,
            },
        }
    }
}

impl Edges {
    /// Of bits and numbers; strings are not looked at.
    pub fn of(operands: impl Iterator<Item = Operand>) -> Edges {
        let watched = operands.filter(|operand| !matches!(operand, Operand::Text(_)));
        let watched = watched.map(|operand| Watched {
            operand,
            first: 0,
            last: 0,
            changes: 0,
        });
        Edges {
            watched: watched.collect(),
        }
    }

    /// It looks at nothing.
    pub fn is_empty(&self) -> bool {
        self.watched.is_empty()
    }

    /// The operands that had values in the scans since the last call which were gone again at the end of the scan, and
    /// how often.
    pub fn take_pulses(&mut self) -> impl Iterator<Item = (Operand, u32)> {
        self.watched.iter_mut().filter_map(|watched| {
            let seen = u32::from(watched.first != watched.last);
            let hidden = std::mem::take(&mut watched.changes).saturating_sub(seen);
            watched.first = watched.last;
            // A pulse goes there and back.
            (hidden > 0).then(|| (watched.operand, hidden.div_ceil(2)))
        })
    }
}

impl Tracer for Edges {
    fn began(&mut self, image: &Image) {
        for watched in &mut self.watched {
            watched.last = watched.now(image);
            (watched.first, watched.changes) = (watched.last, 0);
        }
    }

    fn executed(&mut self, step: &TraceStep<'_>) {
        for watched in &mut self.watched {
            let now = watched.now(step.image);
            watched.changes += u32::from(now != watched.last);
            watched.last = now;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use bahn_exchange::Exchange;
    use bahn_parameters::{ControlModel, ParameterList};
    use bahn_plc::{Compilation, Machine, MemoryFiles, Options, Start, TestNc};

    use super::*;

    /// M1 goes 0-1-0, M2 1-0-1-0, M3 is set once, W8 passes 7 on its way to 0, M4 stays.
    #[test]
    fn pulses_are_seen_where_the_ends_of_scans_show_nothing() {
        let text = "LN M9\nS M1\nR M1\nR M2\nS M2\nR M2\nS M3\nL K+7\n= W8\nL K+0\n= W8\nEM\n";
        let files = MemoryFiles::from([("MAIN.PLC", text)]);
        let program = Compilation::compile(&files, "MAIN.PLC", Options::default())
            .program
            .unwrap();
        let mut machine = Machine::new(program.into(), Start::PowerOn);
        let mut nc = TestNc::new(ParameterList::reference(ControlModel::Tnc415b));
        let mut exchange = Exchange::default();
        exchange.nc_set("M2".parse().unwrap(), true);
        let operands = ["M1", "M2", "M3", "M4", "W8", "S0"].map(|name| name.parse::<Operand>().unwrap());
        let mut edges = Edges::of(operands.into_iter());
        machine.scan_traced(&mut exchange, &mut nc, &mut edges).unwrap();
        let pulses: Vec<String> = edges
            .take_pulses()
            .map(|(operand, count)| format!("{operand} {count}"))
            .collect();
        assert_eq!(pulses, ["M1 1", "M2 1", "W8 1"]);
        assert_eq!(edges.take_pulses().count(), 0, "they are told once");
    }
}
