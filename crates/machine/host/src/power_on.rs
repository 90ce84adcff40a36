//! What a machine begins with when it is switched on.
//!
//! Decision: A list of machine parameters that module 9033 has selected, and that is missing or faulty at power-on,
//! keeps no machine off: that is said with its name, the usual list counts, and the selection is forgotten

use std::sync::Arc;

use bahn_exchange::Exchange;
use bahn_machine::{Machine, Mechanics};
use bahn_parameters::{InchFeed, ParameterList};
use bahn_tnc::{Checking, NcFiles, Position0, Programs, Remembered};

use crate::error::HostError;
use crate::machine_folder::{FolderPrograms, FoundMechanics, LoadedMachine, State};
use bahn_text::Diagnostic;

/// What a control finds at power-on, and how it takes programs. What is read here can be changed until the
/// [`Host`](crate::Host) is made of it.
pub struct PowerOn {
    /// Machine parameters: those of the machine, or the list that module 9033 has selected.
    pub parameters: ParameterList,
    /// What the control kept over power-off: datums, tool, Q parameters and so on.
    pub remembered: Remembered,
    /// Memory of the PLC.
    pub exchange: Exchange,
    /// Where the mechanics of the simulated machine stand; `None` as its description says, with the tools where the control
    /// remembers them.
    pub mechanics: Option<Mechanics>,
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
    /// What the channel kept over power-off.
    pub remembered: Remembered,
    /// Part programs that the channel can select and call.
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
            mechanics: None,
            state: None,
            checking: Checking::default(),
            inch_feed: None,
            block_time: false,
            warnings: refused(&machine.refused),
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

    /// The simulated machine of the folder as it stands then.
    ///
    /// # Errors
    /// [`HostError::NotSimulated`].
    pub fn simulated(&self, machine: &LoadedMachine) -> Result<Machine, HostError> {
        let mut plant = machine.simulated()?.clone();
        let kept = self.mechanics.as_ref();
        let stands = kept.is_some_and(|place| plant.stand_at(place).is_ok());
        if !stands {
            load_magazine(&mut plant, machine, &self.remembered);
        }
        Ok(plant)
    }

    /// A machine that finds what it kept, in the folder of its state.
    ///
    /// # Errors
    /// When it is switched on already, or what was kept cannot be read.
    pub fn kept(machine: &LoadedMachine) -> Result<PowerOn, HostError> {
        let found = State::open(
            &machine.root.join(&machine.folder.state),
            1 + machine.channels.len(),
            pockets_sum(machine),
        )?;
        machine.sweep();
        let mut power_on = PowerOn {
            exchange: found.exchange,
            state: Some(found.state),
            ..PowerOn::fresh(machine)
        };
        power_on.warnings.extend(found.warnings);
        for (channel, found) in power_on.channels.iter_mut().zip(found.others) {
            channel.remembered = found.unwrap_or_else(|| channel.remembered.clone());
        }
        let Some(mut remembered) = found.remembered else {
            power_on.put_up(machine, found.mechanics);
            return Ok(power_on);
        };
        if !remembered.fit_pockets(machine.tools.as_ref()) {
            power_on.warnings.push(
                "the pockets of the tool table have changed since the last run: they count, not those that the \
                 control remembered"
                    .to_owned(),
            );
        }
        if let Some(name) = remembered.parameter_list.take() {
            power_on.select(machine, name, &mut remembered);
        }
        if let Some(name) = &remembered.datum_table
            && !machine.files.datum_tables.contains_key(name)
        {
            power_on.warnings.push(format!(
                "{name}, the datum table that module 9090 selected, is missing or faulty in {}: the datums of cycle 7 are \
                 refused until it is there, or another one is selected",
                machine.root.join(&machine.folder.programs).display()
            ));
        }
        power_on.remembered = remembered;
        power_on.put_up(machine, found.mechanics);
        Ok(power_on)
    }

    /// The list of machine parameters that module 9033 has selected [000:14884-14896]. Without it the machine begins with its
    /// usual one, in which everything can be entered again, and the selection is forgotten, so that what is edited, shown
    /// and asked for by hosts is what counts (inferred).
    fn select(&mut self, machine: &LoadedMachine, name: String, remembered: &mut Remembered) {
        match selected_list(&machine.files, &name) {
            Some(list) => {
                self.parameters = list;
                remembered.parameter_list = Some(name);
            }
            None => self.warnings.push(format!(
                "{name}, which module 9033 selected, is {} in {}: {} counts until the PLC selects another list",
                match machine.files.parameter_lists.contains_key(&name) {
                    true => "faulty",
                    false => "missing",
                },
                machine.root.display(),
                machine.folder.parameters
            )),
        }
    }

    /// Where the mechanics stand, if they are those of this machine; what does not agree with control and PLC is said.
    fn put_up(&mut self, machine: &LoadedMachine, found: Option<FoundMechanics>) {
        let (Some(found), Some(state), Some(described)) = (found, &self.state, &machine.plant) else {
            return;
        };
        let file = state.mechanics_file().display();
        let mut plant = described.clone();
        if let Err(what) = plant.stand_at(&found.mechanics) {
            self.warnings.push(format!(
                "{file} is of another machine: {what}; the machine stands as at its start, its tools lie where the control \
                 remembers them"
            ));
            return;
        }
        if found.loaded_anew {
            load_magazine(&mut plant, machine, &self.remembered);
            if described.magazine().is_some() {
                self.warnings.push(
                    "the pockets of the tables have changed since the last run: the tools lie in the magazine as they say"
                        .to_owned(),
                );
            }
        }
        if !found.others.is_empty() {
            let names: Vec<String> = found
                .others
                .iter()
                .map(|path| path.display().to_string())
                .collect();
            let mut text = format!(
                "{file} and {} are not of the same moment: one of them was changed, removed or put there from elsewhere",
                names.join(", ")
            );
            for difference in differences(&plant, described.clone(), machine, &self.remembered) {
                text += &format!("\n  {difference}");
            }
            text += &format!(
                "\n  what each file says counts; without {file} the machine stands as at its start, its tools lie where the \
                 control remembers them"
            );
            self.warnings.push(text);
        }
        self.mechanics = Some(plant.mechanics());
    }
}

/// The tools lie in the magazine where the control remembers them.
fn load_magazine(plant: &mut Machine, machine: &LoadedMachine, remembered: &Remembered) {
    let moved = |tool: u32| remembered.pockets.iter().find(|moved| moved.tool == tool);
    let tools = machine.tools.iter().flatten().filter_map(|(number, tool)| {
        let pocket = moved(*number).map_or(tool.pocket, |moved| moved.pocket);
        Some((pocket?, *number))
    });
    plant.load_magazine(tools, remembered.tool);
}

/// Files with faults that stop nothing, each with its first one.
fn refused(faults: &[Diagnostic]) -> Vec<String> {
    let mut said: Vec<String> = Vec::new();
    for (at, fault) in faults.iter().enumerate() {
        let earlier = faults.iter().take(at);
        if !earlier.into_iter().any(|earlier| earlier.file == fault.file) {
            said.push(format!(
                "{}: {}; it is refused when it is used",
                fault.file.display(),
                fault.at_line()
            ));
        }
    }
    said
}

/// Check sum of what the tables say of pockets.
fn pockets_sum(machine: &LoadedMachine) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    for (number, tool) in machine.tools.iter().flatten() {
        sum.update(&number.to_le_bytes());
        sum.update(&tool.pocket.map_or(-1, i32::from).to_le_bytes());
    }
    sum.finalize()
}

/// Tools that are elsewhere in the magazine than the control remembers them.
fn differences(
    plant: &Machine,
    mut expected: Machine,
    machine: &LoadedMachine,
    remembered: &Remembered,
) -> Vec<String> {
    load_magazine(&mut expected, machine, remembered);
    let (Some(is), Some(said)) = (plant.magazine(), expected.magazine()) else {
        return Vec::new();
    };
    let tool = |tool: u32| match tool {
        0 => "no tool".to_owned(),
        tool => format!("tool {tool}"),
    };
    let mut different = Vec::new();
    let mut compare = |place: String, is: u32, said: u32| {
        if is != said {
            different.push(format!(
                "{place}: {}; the control has {} there",
                tool(is),
                tool(said)
            ));
        }
    };
    compare("spindle".to_owned(), is.spindle, said.spindle);
    compare("shuttle".to_owned(), is.shuttle, said.shuttle);
    for (gripper, (is, said)) in is.arm.iter().zip(said.arm).enumerate() {
        compare(format!("gripper {}", gripper + 1), *is, said);
    }
    for (pocket, (is, said)) in is.pockets.iter().zip(said.pockets).enumerate() {
        compare(format!("pocket {}", pocket + 1), *is, *said);
    }
    different
}

fn selected_list(files: &NcFiles, name: &str) -> Option<ParameterList> {
    files.parameter_lists.get(name).cloned().flatten()
}
