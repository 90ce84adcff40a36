//! The panel in the terminal: events in, screens out, until the operator leaves.

use std::sync::Arc;
use std::time::{Duration, Instant};

use bahn_panel::{Input, Screen};
use bahn_service::Operated;

use crate::TerminalError;
use crate::desk::{Desk, let_go};
use crate::draw::{Drawn, Scene, draw};
use crate::graphics::{Painter, Wanted};
use crate::machine::Machine;
use crate::palette::Palette;
use crate::window::{self, Events, FullScreen};

/// Between two pictures of the screen: 25 a second at most.
const PICTURE: Duration = Duration::from_millis(40);
/// A new screen, a key that was let go, a signal are noticed within this time.
const LOOK: Duration = Duration::from_millis(20);

/// Whether the panel can be shown here.
///
/// # Errors
/// [`TerminalError::NoTerminal`].
pub fn check() -> Result<(), TerminalError> {
    match window::is_there() {
        true => Ok(()),
        false => Err(TerminalError::NoTerminal),
    }
}

/// Shows the panel of a machine in the terminal until the operator leaves, or `ends` says so. The terminal is then as it was;
/// the machine goes on.
///
/// # Errors
/// [`TerminalError`]
pub fn show(machine: impl Operated + 'static, ends: impl Fn() -> bool) -> Result<(), TerminalError> {
    check()?;
    let window = FullScreen::open()?;
    let mut panel = Panel::new(Arc::new(machine), window);
    let shown = panel.follow(ends);
    // Nothing stays down on the machine.
    let released = let_go(&mut panel.desk);
    panel.give(released);
    shown
}

struct Panel {
    machine: Arc<dyn Operated>,
    desk: Desk,
    painter: Painter,
    palette: Palette,
    screen: Arc<Screen>,
    drawn: Drawn,
    /// The title of the window.
    title: String,
    events: Events,
    window: FullScreen,
}

impl Panel {
    fn new(machine: Arc<dyn Operated>, window: FullScreen) -> Panel {
        let mut desk = Desk::new(Machine::of(&machine.surface()));
        desk.holds.reports_releases = window.reports_releases;
        Panel {
            painter: Painter::of(Arc::clone(&machine)),
            screen: machine.screen(),
            machine,
            desk,
            palette: Palette::of_the_terminal(),
            drawn: Drawn::default(),
            title: String::new(),
            events: Events::follow(),
            window,
        }
    }

    fn follow(&mut self, ends: impl Fn() -> bool) -> Result<(), TerminalError> {
        let mut due = Instant::now();
        let mut changed = true;
        while !self.desk.leaves && !ends() {
            changed |= self.take_events()?;
            let released = self.desk.tick(Instant::now());
            self.give(released);
            changed |= self.look();
            if changed && Instant::now() >= due {
                self.draw()?;
                due = Instant::now() + PICTURE;
                changed = false;
            }
        }
        Ok(())
    }

    /// Waits for events a moment, and takes all there are; whether there were any.
    fn take_events(&mut self) -> Result<bool, TerminalError> {
        let Some(first) = self.events.next(LOOK) else {
            return Ok(false);
        };
        // A keyboard that is held down does not keep the screen from being drawn.
        let end = Instant::now() + PICTURE;
        let before = self.machine.screen().serial;
        let mut given = false;
        let mut next = Some(first);
        while let Some(event) = next {
            let now = Instant::now();
            let inputs = self.desk.event(&event?, &self.screen, &self.drawn.targets, now);
            given |= !inputs.is_empty();
            self.give(inputs);
            next = match now < end && !self.desk.leaves {
                true => self.events.next(Duration::ZERO),
                false => None,
            };
        }
        if given {
            // What came of it is what is drawn next.
            self.machine.next_screen(before, LOOK);
        }
        Ok(true)
    }

    fn give(&mut self, inputs: Vec<Input>) {
        for input in inputs {
            if let Err(error) = self.machine.input(input) {
                self.desk.notice = error.to_string();
            }
        }
    }

    /// Whether there is a new screen, or a new picture of the part.
    fn look(&mut self) -> bool {
        let screen = self.machine.screen();
        let is_new = screen.serial != self.screen.serial;
        self.screen = screen;
        let wanted = match (&self.screen.graphics, self.drawn.graphics) {
            (Some(graphics), Some(area)) => Some(Wanted {
                serial: graphics.serial,
                columns: area.width,
                rows: area.height,
            }),
            _ => None,
        };
        self.painter.follow(wanted) | is_new
    }

    fn draw(&mut self) -> Result<(), TerminalError> {
        let title = format!("Bahn {}: {}", self.desk.machine.name, self.screen.mode);
        if title != self.title {
            self.window.title(&title)?;
            self.title = title;
        }
        let scene = Scene {
            screen: &self.screen,
            desk: &self.desk,
            part: self.painter.last(),
            palette: self.palette,
        };
        let mut drawn = Drawn::default();
        self.window.terminal.draw(|frame| drawn = draw(frame, &scene))?;
        if let Some(scrolled) = &mut self.desk.help {
            *scrolled = drawn.help_end.min(*scrolled);
        }
        self.drawn = drawn;
        Ok(())
    }
}
