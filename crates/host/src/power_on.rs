//! What a machine begins with when it is switched on.

use std::sync::Arc;

use bahn_control::{Checking, NcFiles, Position0, Programs, Remembered};
use bahn_exchange::Exchange;
use bahn_parameters::{InchFeed, ParameterList};

use crate::error::HostError;
use crate::machine_folder::{FolderPrograms, LoadedMachine, State};

/// What a control finds at power-on, and how it takes programs. What is read here can be changed until the
/// [`Host`](crate::Host) is made of it.
pub struct PowerOn {
    /// Machine parameters: those of the machine, or the list that module 9033 has selected.
    pub parameters: ParameterList,
    /// What it remembers.
    pub remembered: Remembered,
    /// Memory of the PLC.
    pub exchange: Exchange,
    /// Where it keeps what changes; `None` keeps nothing.
    pub state: Option<State>,
    /// How programs are taken.
    pub checking: Checking,
    /// What F counts in a program in inches; `None` for what it counts on the model.
    pub inch_feed: Option<InchFeed>,
    /// The block processing time of the model is simulated.
    pub block_time: bool,
    /// What was lost, in words.
    pub warnings: Vec<String>,
    /// The same of the channels beside the first one.
    pub channels: Vec<ChannelPowerOn>,
}

/// What a channel beside the first one begins with.
#[derive(Clone)]
pub struct ChannelPowerOn {
    /// What it remembers.
    pub remembered: Remembered,
    /// Its part programs.
    pub programs: Arc<dyn Programs>,
}

impl PowerOn {
    /// A machine that was never on, and keeps nothing.
    pub fn fresh(machine: &LoadedMachine) -> PowerOn {
        PowerOn {
            parameters: machine.parameters.clone(),
            remembered: Remembered {
                datums: [Position0(machine.datum()); 3],
                ..Remembered::default()
            },
            exchange: Exchange::default(),
            state: None,
            checking: Checking::default(),
            inch_feed: None,
            block_time: false,
            warnings: Vec::new(),
            channels: (1..)
                .zip(&machine.channels)
                .map(|(number, channel)| ChannelPowerOn {
                    remembered: Remembered {
                        datums: [Position0(channel.datum()); 3],
                        ..Remembered::default()
                    },
                    programs: Arc::new(FolderPrograms::of_folder(&machine.programs(number))),
                })
                .collect(),
        }
    }

    /// A machine that finds what it kept, in the folder of its state.
    ///
    /// # Errors
    /// When it is switched on already, what was kept cannot be read, or what was selected is missing.
    pub fn kept(machine: &LoadedMachine) -> Result<PowerOn, HostError> {
        let found = State::open(
            &machine.root.join(&machine.folder.state),
            1 + machine.channels.len(),
        )?;
        let mut power_on = PowerOn {
            exchange: found.exchange,
            state: Some(found.state),
            warnings: found.warnings,
            ..PowerOn::fresh(machine)
        };
        for (channel, found) in power_on.channels.iter_mut().zip(found.others) {
            channel.remembered = found.unwrap_or_else(|| channel.remembered.clone());
        }
        let Some(mut remembered) = found.remembered else {
            return Ok(power_on);
        };
        if !remembered.fit_pockets(machine.tools.as_ref()) {
            power_on.warnings.push(
                "the pockets of the tool table have changed since the last run: they count, not those that the \
                 control remembered"
                    .to_owned(),
            );
        }
        if let Some(name) = &remembered.parameter_list {
            power_on.parameters = selected_list(&machine.files, name).ok_or_else(|| {
                HostError::new(format!(
                    "{name}, which module 9033 selected, is missing or faulty in {}",
                    machine.root.display()
                ))
            })?;
        }
        if let Some(name) = &remembered.datum_table
            && !machine.files.datum_tables.contains_key(name)
        {
            return Err(HostError::new(format!(
                "{name}, the datum table that module 9090 selected, is missing in {}",
                machine.root.join(&machine.folder.programs).display()
            )));
        }
        power_on.remembered = remembered;
        Ok(power_on)
    }
}

fn selected_list(files: &NcFiles, name: &str) -> Option<ParameterList> {
    files.parameter_lists.get(name).cloned().flatten()
}
