//! Commands that act on the program run.
//!
//! Decision: A Q parameter that is changed while a run is interrupted counts from the block that was cut: what was
//! read ahead is read again from there

use bahn_interpreter::DripFeed;
use bahn_kernel::{Feeder, RunState};
use bahn_parameters::operation::RestartParameters;

use crate::command::Command;
use crate::dnc::Dnc;
use crate::message::Message;
use crate::plane_command::PlaneCommand;
use crate::run::ProgramRun;
use crate::site::Site;
use crate::source::{Basis, Resume};

/// Executes a command of the program run; `false` when it is not possible now, or none of the run.
pub(crate) fn execute(
    command: Command,
    rules: &RestartParameters,
    run: &mut ProgramRun,
    site: &mut Site,
    basis: &Basis,
) -> bool {
    match command {
        Command::InternalStop => run.internal_stop(site),
        Command::Select(name) => run.select(name, site, basis),
        Command::Dnc(dnc) => transfer(dnc, run, site, basis),
        Command::Goto(block) => run.goto(block),
        Command::Mdi(blocks) => run.set_mdi(blocks),
        Command::ManualOperation => run.manual_operation(rules, site),
        Command::RestorePosition => run.restore_position(site),
        Command::Q(number, value) => enter_q(number, value, run, site),
        Command::RestoreAt(block) => run.restore_at(block, rules, site, basis),
        Command::WorkingPlane(plane) => tilt(&plane, run, site, basis),
        // `Set` and `Power` are of the whole control.
        _ => false,
    }
}

/// 3D ROT for program run, while no program runs.
fn tilt(plane: &PlaneCommand, run: &mut ProgramRun, site: &Site, basis: &Basis) -> bool {
    let basic = basis.touch.basic_rotation(site.chain.offsets.tool_axis).angle_deg;
    let tilting = basis.list.operation_parameters().tilting && !run.is_active();
    let swivels = basis.list.swivels().filter(|_| tilting);
    let positions = swivels.and_then(|swivels| plane.positions(&swivels, &site.axes));
    // A basic rotation is measured and in force with the swivel axes at 0 only [000:4269].
    positions.is_some_and(|positions| (basic == 0.0 || positions.is_none()) && run.source.tilt(positions))
}

/// A program is transferred while it runs, or comes to be.
fn transfer(dnc: Dnc, run: &mut ProgramRun, site: &mut Site, basis: &Basis) -> bool {
    let name = match dnc {
        Dnc::Begin(name) => name,
        dnc => {
            let answer = run.source.drip_feed.as_mut().map(|feed| dnc.follow(feed));
            let (done, said) = answer.unwrap_or_default();
            if let Some(message) = said {
                site.messages.show(Message::Plain(message), run.running_block());
            }
            return done;
        }
    };
    let feed = run.source.drip_feed.as_mut();
    if feed.is_some_and(|feed| feed.reopen(&name)) {
        return true;
    }
    let done = run.select(name.clone(), site, basis);
    if done {
        let reading = &run.source.reading;
        let path = reading.programs.name_here(&name);
        let rules = reading.model.limits().blockwise;
        let feed = DripFeed::new(name, path, basis.list.drip_feed_memory(), rules);
        run.source.drip_feed = Some(feed);
    }
    done
}

/// A Q parameter is changed, between runs or while one is interrupted: what was read ahead with its old value is read
/// again, from the block that is cut on [003:4337-4344].
fn enter_q(number: u16, value: f64, run: &mut ProgramRun, site: &mut Site) -> bool {
    // After a programmed stop nothing is read.
    if run.is_active() && run.progress().state() != RunState::Stopped {
        let stands = !run.progress().is_running() && run.core.track.stands(&site.axes);
        let free = site.handshakes.is_idle() && run.core.track.has_output_all() && !run.probe.is_on();
        if !stands || !free || run.core.restores() || run.core.track.path.is_coupled() {
            return false;
        }
        let cut = run.core.track.path.clear().map(|cut| cut.sequence);
        let next = run.source.feeder().map(Feeder::next_sequence);
        run.source.resume_at(cut.or(next).map(Resume::Block));
        if run.source.go_on(site)
            && let Some(feeder) = run.source.feeder()
        {
            site.chain.place(feeder.reader().placement());
        }
        run.core.track.begin_at(site.here(), site.chain);
    }
    run.source.set_q(number, value);
    true
}
