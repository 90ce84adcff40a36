//! Speeds of spindles, and how they are meant.
//!
//! Decision: G96 and G97 of a System 900 count for the spindle words of their block; without one for the first one. G95 counts
//! revolutions: while G96 is in force it is refused

use bahn_path::{Function, Synchronisation};
use bahn_system900::Memory;

use crate::g_functions::Once;
use crate::modal::Modal;
use crate::refusal::{Refusal, wrong};
use crate::words::Words;
use crate::writes::Ordered;

/// Takes the speeds: they are shown and acted on when the block is executed.
pub(crate) fn take(
    words: &Words,
    once: Once,
    modal: &mut Modal,
    memory: &Memory,
    channel: u8,
    ordered: &mut Ordered,
) -> Result<(), Refusal> {
    if let Some(kind) = once.speed_kind {
        let mut any = false;
        let named = words.speeds.iter().map(|(word, _)| *word);
        let first = words.speeds.is_empty().then_some(1);
        for word in named.chain(first) {
            if let Some([_, q]) = memory.spindle_of_word(channel, word) {
                let value = Some(kind.into());
                ordered.at_start(Function::Write { q, value }, Synchronisation::Mos);
                any = true;
            }
        }
        if modal.cuts && !any {
            return wrong("G96 needs a spindle: q142 to q149 name none");
        }
        ordered.write_later(memory, memory.path_data(channel).speed_kind(), Some(kind.into()))?;
    }
    for (word, speed) in &words.speeds {
        if let Some(slot) = modal.speeds.get_mut(usize::from(word - 1)) {
            *slot = *speed;
        }
        let name = memory.path_data(channel).speed(*word);
        if memory.q(name).is_ok() {
            ordered.write_later(memory, name, Some(*speed))?;
        }
        if *word == 1 {
            ordered.at_start(Function::SpindleSpeed(*speed), Synchronisation::MvsSvs);
        } else if let Some([q, _]) = memory.spindle_of_word(channel, *word) {
            let value = Some(*speed);
            ordered.at_start(Function::Write { q, value }, Synchronisation::Mos);
        }
    }
    Ok(())
}
