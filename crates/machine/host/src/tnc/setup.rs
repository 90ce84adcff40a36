//! The control of a TNC at power-on, put together from what its folder says.
//!
//! Decision: Channels that cannot be put together, or of which some are missing at power-on, are an error and never a
//! machine with fewer of them

use std::sync::Arc;

use bahn_tnc::{Cartesian, ChannelSetup, Control, Programs, Setup, SpindleWiring};

use crate::error::HostError;
use crate::machine_folder::{LoadedChannel, LoadedMachine};
use crate::power_on::{ChannelPowerOn, PowerOn};

/// The control of a folder. Channels that do not fit are no machine, and never another one.
pub(super) fn control_of(
    machine: &LoadedMachine,
    power_on: PowerOn,
    programs: Arc<dyn Programs>,
) -> Result<Control, HostError> {
    let (there, found) = (machine.channels.len(), power_on.channels.len());
    if there != found {
        return Err(HostError::ChannelsMissing(there, found));
    }
    let block_time_ms = power_on.parameters.model().limits().block_time_ms;
    let setup = Setup {
        parameters: power_on.parameters,
        plc: Arc::clone(&machine.plc),
        plc_messages: machine.plc_messages.clone(),
        plc_dialogues: machine.plc_dialogues.clone(),
        tools: machine.tools.clone(),
        checking: power_on.checking,
        inch_feed: power_on.inch_feed,
        functions: machine.functions.clone(),
        programs,
        files: machine.files.clone(),
        remembered: power_on.remembered,
        exchange: power_on.exchange,
    };
    let mut control = Control::with_channels(setup, channel_setups(machine, power_on.channels))?;
    control.hand_over_by(machine.hand_overs.clone());
    if power_on.block_time {
        control.set_block_time((block_time_ms * 1e3) as u32);
    }
    control.defer_work();
    Ok(control)
}

/// The channels beside the first one, as the control takes them.
fn channel_setups(machine: &LoadedMachine, found: Vec<ChannelPowerOn>) -> Vec<ChannelSetup> {
    let channels = machine.channels.iter().zip(found);
    let setup = |(channel, found): (&LoadedChannel, ChannelPowerOn)| {
        // Counted from 0 on the machine, and the spindle is the sixth.
        let connectors = channel.folder.connectors.saturating_sub(1);
        let spindle = usize::from(connectors) + 5;
        ChannelSetup {
            parameters: channel.parameters.clone(),
            axes: channel.axes,
            connectors,
            spindle: SpindleWiring {
                output: spindle,
                input: spindle,
            },
            programs: found.programs,
            kinematics: Arc::new(Cartesian),
            window: channel.window.clone(),
            remembered: found.remembered,
        }
    };
    channels.map(setup).collect()
}
