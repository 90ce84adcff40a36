//! What an interface is ordered to do, as the operator has set it up [000:17216-17228].

use bahn_parameters::MessageId;

use crate::settings::InterfaceMode;
use crate::site::Site;
use crate::transfer::{TransferAction, TransferFiles, TransferOrder};

/// ME 101 has this baud rate and no other [003:7048].
const ME_BAUD: u32 = 2_400;

/// What is to be done at the interface of file transfers, as it is set up.
///
/// # Errors
/// The message of the control: no device can answer there.
pub(crate) fn order(
    files: TransferFiles,
    action: TransferAction,
    site: &Site,
) -> Result<TransferOrder, MessageId> {
    let [second, _] = site.settings.second_interface;
    let port = usize::from(second && site.control().model().has_rs_422());
    let interface = site.settings.interfaces.get(port).copied().unwrap_or_default();
    let mode = interface.mode.device().ok_or(MessageId::ExtInOutputNotReady)?;
    if is_inhibited(port, site) {
        return Err(MessageId::ExtInOutputNotReady);
    }
    Ok(TransferOrder {
        port,
        mode,
        baud: baud(port, site),
        kind: files.usual(site.writes_iso()),
        files,
        action,
    })
}

/// MP5000 inhibits an interface.
pub(crate) fn is_inhibited(port: usize, site: &Site) -> bool {
    let inhibited = site.parameters().interface_parameters().inhibited;
    inhibited.get(port).is_some_and(|own| *own)
}

/// The baud rate in force.
pub(crate) fn baud(port: usize, site: &Site) -> u32 {
    let interface = site.settings.interfaces.get(port).copied().unwrap_or_default();
    match interface.mode {
        InterfaceMode::Me => ME_BAUD,
        _ => interface.baud,
    }
}
