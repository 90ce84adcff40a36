//! What the editors of the machine builder write, and the control takes over while it is on: his PLC program and its texts,
//! lists of machine parameters, tables of axis errors.

use std::collections::BTreeMap;
use std::sync::Arc;

use bahn_parameters::ParameterList;
use bahn_parameters::compensation::{CompensationAssignment, CompensationTable, CorrectionTables};
use bahn_plc::PlcProgram;

use crate::alteration::Altered;
use crate::compensation::Compensation;
use crate::setup::Setup;
use crate::tnc::Tnc;

/// What was written anew.
#[derive(Clone, Debug)]
pub enum Renewed {
    /// The PLC program: it runs when the control begins anew, at the next power-on or reset [000:11263-11267].
    Plc(Arc<PlcProgram>),
    /// The texts of its messages and of its dialogues, which were activated: they stand there at once [000:11237-11240].
    Texts {
        /// Texts of PLC messages, from 0.
        messages: Vec<String>,
        /// Texts of PLC dialogues, from 0.
        dialogues: Vec<String>,
    },
    /// The tables of non-linear axis errors: the active line acts at once [000:3781].
    Compensation(Box<CompensationFiles>),
    /// A list of machine parameters goes into effect, as the editor does it that is left with it [000:10072-10074]: the
    /// control begins anew. `None` is the usual list of the machine. Not while a program runs, or while the supply is off.
    List(Option<String>, Box<ParameterList>),
}

/// The files of the non-linear axis-error compensation.
#[derive(Clone, Debug, Default)]
pub struct CompensationFiles {
    /// The assignment (.CMA) of tables to axes.
    pub assignment: Option<CompensationAssignment>,
    /// Its tables (.COM) by name.
    pub tables: BTreeMap<String, CompensationTable>,
    /// The correction tables of code number 105 296.
    pub correction_tables: Option<CorrectionTables>,
}

/// Takes it over: into what the control is made of when it begins anew, and into what runs.
pub(crate) fn take(renewed: Renewed, setup: &mut Setup, tnc: &mut Tnc, off: bool) -> Altered {
    match renewed {
        Renewed::Plc(program) => setup.plc = program,
        Renewed::Texts { messages, dialogues } => {
            setup.plc_messages.clone_from(&messages);
            setup.plc_dialogues.clone_from(&dialogues);
            tnc.machine.link.take_texts(messages, dialogues);
        }
        Renewed::Compensation(own) => {
            for files in [&mut setup.files, &mut tnc.machine.link.files] {
                files.compensation.clone_from(&own.assignment);
                files.compensation_tables.clone_from(&own.tables);
                files.correction_tables.clone_from(&own.correction_tables);
            }
            // The line that the file names; module 9095 selects another one again.
            let line = own.assignment.as_ref().and_then(|assignment| assignment.active);
            tnc.machine.compensation = Compensation::of(&tnc.machine.link.files, line);
            tnc.machine.unsaved = true;
        }
        Renewed::List(name, list) => {
            if off || tnc.channels.iter().any(|channel| channel.run.is_active()) {
                return Altered::Refused;
            }
            if let Some(name) = &name {
                // Module 9033 selects what was entered.
                let lists = &mut setup.files.parameter_lists;
                lists.insert(name.clone(), Some((*list).clone()));
            }
            tnc.machine.link.selected_list = name;
            return Altered::Reset(list);
        }
    }
    Altered::Done
}
