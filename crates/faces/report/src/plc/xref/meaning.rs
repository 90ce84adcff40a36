//! What an operand means outside of the program.

use bahn_exchange::signal::{self, SignalOperand};
use bahn_exchange::{Bit, BitArea, BitRange};
use bahn_plc::Subject;

/// Whether control or machine read what a program writes to an operand: outputs, starts of timers and
/// counters, markers with a fixed meaning, the bytes from PLC to NC [000:11556-11584][000:10534-10968]. Markers that only
/// the TNC 355 has are read by nobody [000:16442-16500].
pub fn is_read_outside(subject: Subject) -> bool {
    const PLC_TO_NC: std::ops::Range<u16> = 512..768;
    match subject {
        Subject::Bit { indexed: true, .. } | Subject::Number { indexed: true, .. } => true,
        Subject::Bit { bit, .. } => match bit.area() {
            BitArea::O | BitArea::T | BitArea::C => true,
            BitArea::I => false,
            BitArea::M => signal::all()
                .iter()
                .filter(|signal| signal.has_function())
                .any(|signal| match signal.operand {
                    SignalOperand::Bit(fixed) => fixed == bit,
                    SignalOperand::Bits(range) => is_in(range, bit),
                    SignalOperand::Number(_) | SignalOperand::Bytes(_) => false,
                }),
        },
        Subject::Number { number, .. } => PLC_TO_NC.contains(&number.address()),
        Subject::Text { .. } => false,
    }
}

/// The name of an operand with a fixed meaning, or of the markers it belongs to.
pub fn fixed_name(subject: Subject) -> Option<&'static str> {
    let named = signal::all()
        .iter()
        .find(|signal| match (subject, signal.operand) {
            (Subject::Bit { bit, indexed: false }, SignalOperand::Bit(fixed)) => bit == fixed,
            (Subject::Bit { bit, indexed: false }, SignalOperand::Bits(range)) => is_in(range, bit),
            (
                Subject::Number {
                    number,
                    indexed: false,
                },
                SignalOperand::Number(fixed),
            ) => number == fixed,
            _ => false,
        });
    named.map(|signal| signal.name)
}

/// Whether a marker belongs to a range with a meaning; that of the retained markers has none.
fn is_in(range: BitRange, bit: Bit) -> bool {
    range != signal::RETAINED_MARKERS && range.iter().any(|fixed| fixed == bit)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// M2510 had a function on the TNC 355 only; M2452 is read with M2719 = 0, M2657 has another function here.
    #[test]
    fn markers_of_the_tnc_355_are_read_where_they_act() {
        let read = |text: &str| {
            let bit = text.parse().unwrap();
            is_read_outside(Subject::Bit { bit, indexed: false })
        };
        assert_eq!(["M2510", "M2452", "M2657"].map(read), [false, true, true]);
    }
}
