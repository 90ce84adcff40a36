//! A machine in a program of one's own: loads its folder, runs a part program, stops it and lets it go on, follows
//! what happens. `cargo run --example embed -- machines/mill CIRCLE.H`

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use bahn_host::{
    Action, Attendance, FolderPrograms, Host, Job, LoadedMachine, Next, Notice, Operator, PowerOn, Source,
    When,
};
use bahn_tnc::RunState;

const MILL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../machines/mill");

#[allow(dead_code, reason = "a test calls `run` itself")]
fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or_else(|| MILL.to_owned());
    let program = arguments.next().unwrap_or_else(|| "CIRCLE.H".to_owned());
    run(Path::new(&folder), Path::new(&program), &mut std::io::stdout())
}

/// Runs a program; NC stop two seconds after its start, NC start a second later.
pub fn run(folder: &Path, program: &Path, out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let machine = LoadedMachine::load(folder)?.map_err(|faults| format!("{} faults", faults.len()))?;
    let programs = FolderPrograms::new(&machine.root.join(&machine.folder.programs), Some(program))?;
    let job = programs.main_name().map(Job::whole);
    let operator = Operator::new(Attendance::Full, machine.folder.operator.clone(), job);
    let mut host = Host::new(&machine, PowerOn::fresh(&machine), Arc::new(programs), operator)?;
    let me = Source::Client("embed".to_owned());
    let (mut notices, mut started) = (host.notices(), false);
    loop {
        host.step()?;
        for next in &mut notices {
            let Next::Item(stamped) = next else { continue };
            let time_s = stamped.time_us as f64 * 1e-6;
            match stamped.notice {
                Notice::Shown(shown) => {
                    writeln!(
                        out,
                        "{time_s:.3} s: {}",
                        host.control().message_text(&shown.message)
                    )?;
                }
                Notice::Run(state) => writeln!(out, "{time_s:.3} s: the run is {state:?}")?,
                Notice::Ended => return Ok(writeln!(out, "{time_s:.3} s: the program has ended")?),
                _ => {}
            }
        }
        if host.control().run_state() == RunState::Running && !std::mem::replace(&mut started, true) {
            let now = host.control().time_us();
            host.order(me.clone(), When::At(now + 2_000_000), Action::tap("NC_STOP"))?;
            host.order(me.clone(), When::At(now + 3_000_000), Action::tap("NC_START"))?;
        }
    }
}
