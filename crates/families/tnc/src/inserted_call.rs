//! The TOOL CALL that module 9150 inserts: whether the program that runs can take it up [000:16063-16118].
//!
//! Decision: A TOOL CALL of module 9150 into a program that has no tools (DIN 66025) is an erroneous one: the run
//! ends before the block of the strobe with FUNCTION NOT YET SUPPORTED; the tool stays

use bahn_plc::ToolCallBlock;

// FIX feeder
use crate::language;
use crate::message::Message;
use crate::run::ProgramRun;
use crate::site::Site;

/// It is kept until the strobe is acknowledged, or for now without a program. A program that has no tools is broken off at
/// the block of the strobe, with a message [000:16071].
pub(crate) fn take(call: ToolCallBlock, run: &mut ProgramRun, site: &mut Site) {
    if !run.is_active() || run.source.is_of_control() {
        site.tools.inserted_call = Some(call);
        return;
    }
    let block = run.running_block();
    let error = language::without_tools(block.unwrap_or_default(), run.source.reader());
    site.messages.show(Message::Program(Box::new(error)), block);
    if !run.refuse_block(site) {
        run.stop();
    }
}
