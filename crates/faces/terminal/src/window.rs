//! The terminal itself: taken over, and left as it was.

use std::io::{ErrorKind, IsTerminal, Stdout, stdin, stdout};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Once};
use std::time::Duration;

use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::crossterm::event::{
    DisableBracketedPaste, DisableFocusChange, DisableMouseCapture, EnableBracketedPaste, EnableFocusChange,
    EnableMouseCapture, Event, KeyboardEnhancementFlags, PopKeyboardEnhancementFlags,
    PushKeyboardEnhancementFlags,
};
use ratatui::crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, SetTitle, disable_raw_mode, enable_raw_mode,
    supports_keyboard_enhancement,
};
use ratatui::crossterm::{cursor, event, execute};

use crate::TerminalError;

/// The terminal while the panel is in it. When it goes, whatever the reason, the terminal is as it was.
pub(crate) struct FullScreen {
    pub terminal: Terminal<CrosstermBackend<Stdout>>,
    /// The terminal reports when a key is let go.
    pub reports_releases: bool,
}

/// Whether there is a terminal.
pub(crate) fn is_there() -> bool {
    stdin().is_terminal() && stdout().is_terminal()
}

impl FullScreen {
    /// Takes the terminal over.
    pub fn open() -> Result<FullScreen, TerminalError> {
        leave_on_panic();
        enable_raw_mode()?;
        // What follows may fail halfway: then everything is taken back.
        let opened = FullScreen::enter();
        if opened.is_err() {
            leave();
        }
        opened
    }

    fn enter() -> Result<FullScreen, TerminalError> {
        let reports_releases = supports_keyboard_enhancement().unwrap_or(false);
        execute!(
            stdout(),
            EnterAlternateScreen,
            EnableMouseCapture,
            EnableFocusChange,
            EnableBracketedPaste,
        )?;
        if reports_releases {
            let flags = KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
                | KeyboardEnhancementFlags::REPORT_EVENT_TYPES;
            execute!(stdout(), PushKeyboardEnhancementFlags(flags))?;
        }
        let mut terminal = Terminal::new(CrosstermBackend::new(stdout()))?;
        terminal.clear()?;
        Ok(FullScreen {
            terminal,
            reports_releases,
        })
    }

    /// The title of the window.
    pub fn title(&self, title: &str) -> Result<(), TerminalError> {
        let title: String = title
            .chars()
            .filter(|character| !character.is_control())
            .collect();
        Ok(execute!(stdout(), SetTitle(title))?)
    }
}

impl Drop for FullScreen {
    fn drop(&mut self) {
        leave();
    }
}

/// Keys and mouse, read on a thread of their own: reading from a terminal that was closed may never come back.
pub(crate) struct Events {
    events: Receiver<std::io::Result<Event>>,
    over: Arc<AtomicBool>,
}

/// A thread that waits for an event looks so often whether it is to end.
const LOOK: Duration = Duration::from_millis(100);
/// Events that wait at most.
const WAITING: usize = 256;

impl Events {
    /// Reads on until it is dropped.
    pub fn follow() -> Events {
        let (sender, events) = sync_channel(WAITING);
        let over = Arc::new(AtomicBool::new(false));
        let ends = Arc::clone(&over);
        std::thread::spawn(move || {
            while !ends.load(Ordering::Relaxed) {
                let event = match event::poll(LOOK) {
                    Ok(false) => continue,
                    Ok(true) => event::read(),
                    Err(error) => Err(error),
                };
                let is_last = event.is_err();
                if sender.send(event).is_err() || is_last {
                    return;
                }
            }
        });
        Events { events, over }
    }

    /// The next one, waited for at most so long.
    pub fn next(&self, at_most: Duration) -> Option<std::io::Result<Event>> {
        match self.events.recv_timeout(at_most) {
            Ok(event) => Some(event),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Err(ErrorKind::UnexpectedEof.into())),
        }
    }
}

impl Drop for Events {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
    }
}

/// Everything as it was. What fails cannot be helped any more.
fn leave() {
    // The keyboard's own screen has its own flags: they go before it.
    let _ = execute!(stdout(), PopKeyboardEnhancementFlags);
    let _ = execute!(
        stdout(),
        DisableBracketedPaste,
        DisableFocusChange,
        DisableMouseCapture,
        LeaveAlternateScreen,
        cursor::Show,
    );
    let _ = disable_raw_mode();
}

/// What a panic says is to be read on a terminal that is as it was.
fn leave_on_panic() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            leave();
            before(panic);
        }));
    });
}
