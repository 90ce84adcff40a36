//! `bahn panel` on a machine with a System 900.

use std::path::Path;

use bahn_host::{Machine900, PowerOn900};
use bahn_live::{Input, Live};
use bahn_panel900::{Service900, Station900};
use bahn_server::{Server, ServerOptions};

use super::options::PanelOptions;
use super::shown::{in_use, in_words, say_page, show};
use crate::interrupt::Interrupt;
use crate::{Outcome, UsageError, diagnostics};

/// Switches the machine on and shows its panel until Ctrl-C.
pub(super) fn command(
    options: &PanelOptions,
    folder: &Path,
    served: Option<ServerOptions>,
) -> Result<Outcome, UsageError> {
    let of_a_tnc = [
        ("--rs232", options.rs232.is_some()),
        ("--rs422", options.rs422.is_some()),
        ("--print", options.print.is_some()),
        ("--record", options.record.is_some()),
        ("--replay", options.replay.is_some()),
    ];
    UsageError::unless_of_a_tnc(&of_a_tnc, folder)?;
    let machine = match Machine900::load(folder)? {
        Ok(machine) => machine,
        Err(faults) => {
            diagnostics::print_faults(&faults);
            return Ok(Outcome::ProgramError);
        }
    };
    let power_on = PowerOn900::kept(&machine).map_err(in_use)?;
    let name = machine.folder.name.clone();
    let mut station = Station900::with(machine, power_on);
    station.take(&Input::Speed(options.speed)).map_err(in_words)?;
    let interrupt = Interrupt::on_ctrl_c();
    let live = Live::start(station);
    let shown = Service900::of(&live).map_err(in_words).and_then(|service| {
        let server = served.map(|served| Server::start(service.clone(), served));
        let server = server.transpose().map_err(in_words)?;
        if let Some(server) = &server {
            say_page(options, &name, server);
        }
        let shown = show(options, service, &interrupt, || live.has_ended());
        if let Some(server) = server {
            server.end();
        }
        shown
    });
    // Whatever became of the page, what was done is kept.
    live.end().map_err(UsageError::new)?;
    shown.map(|()| Outcome::Fine)
}
