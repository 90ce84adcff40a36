//! A pseudo terminal: what others open as if it were a serial port.

use std::ffi::OsStr;
use std::fs;
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rustix::event::PollFlags;
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use super::poll::{self, Got, nothing};

/// How often one looks whether somebody has opened it.
const LOOK: Duration = Duration::from_millis(20);
/// How often one looks whether the other side has read everything.
const GLANCE: Duration = Duration::from_millis(5);
/// So many looks at what is unread, before it is thrown away.
const GLANCES: u32 = 200;

/// Our side of a pseudo terminal.
#[derive(Debug)]
pub(super) struct Pty {
    ours: OwnedFd,
    name: PathBuf,
    link: Option<PathBuf>,
    /// Somebody has the other side open.
    open: bool,
}

impl Pty {
    /// Makes one, raw, and a symbolic link to it, which goes with it. A link of before is replaced, nothing else is.
    pub fn open(link: Option<PathBuf>) -> io::Result<Pty> {
        let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&ours)?;
        unlockpt(&ours)?;
        let name = ptsname(&ours, Vec::new())?;
        let name = PathBuf::from(OsStr::from_bytes(name.to_bytes()));
        let mut settings = tcgetattr(&ours)?;
        settings.make_raw();
        tcsetattr(&ours, OptionalActions::Now, &settings)?;
        // Opened and closed once, the system tells from then on whether somebody has it open.
        let theirs = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
        drop(rustix::fs::open(&name, theirs, rustix::fs::Mode::empty())?);
        fcntl_setfl(&ours, fcntl_getfl(&ours)? | OFlags::NONBLOCK)?;
        if let Some(link) = &link {
            if fs::symlink_metadata(link).is_ok_and(|found| found.is_symlink()) {
                fs::remove_file(link)?;
            }
            std::os::unix::fs::symlink(&name, link)?;
        }
        Ok(Pty {
            ours,
            name,
            link,
            open: false,
        })
    }

    /// The path of the terminal that the other side opens.
    pub fn name(&self) -> &Path {
        self.link.as_deref().unwrap_or(&self.name)
    }

    pub fn link(&self) -> Option<&PathBuf> {
        self.link.as_ref()
    }

    pub fn read(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<Got> {
        // While nobody has it open the system says so at once, instead of waiting.
        let events = poll::wait_for(&self.ours, PollFlags::IN, wait)?;
        let hung_up = events.contains(PollFlags::HUP);
        if hung_up && !events.contains(PollFlags::IN) {
            if self.open {
                self.open = false;
                return Ok(Got::Closed);
            }
            std::thread::sleep(wait.min(LOOK));
            return Ok(Got::Nothing);
        }
        if !self.open && !hung_up {
            self.open = true;
            return Ok(Got::Opened);
        }
        match rustix::io::read(&self.ours, buffer) {
            Ok(0) => Ok(Got::Nothing),
            Ok(count) => Ok(Got::Bytes(count)),
            Err(rustix::io::Errno::IO) => Ok(Got::Nothing),
            Err(error) => {
                let error = io::Error::from(error);
                nothing(&error).ok_or(error)
            }
        }
    }

    pub fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(rustix::io::write(&self.ours, bytes)?)
    }

    pub fn wait_to_write(&self, wait: Duration) -> io::Result<()> {
        poll::writable(&self.ours, wait)
    }
}

impl Pty {
    /// Waits until the other side has read what was written, at most a second: what is unread when this side closes is lost.
    /// Nothing waits in a UART so long, and a socket keeps it.
    fn wait_until_read(&self) -> io::Result<()> {
        let theirs = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC | OFlags::NONBLOCK;
        let theirs = rustix::fs::open(&self.name, theirs, rustix::fs::Mode::empty())?;
        // What was written a moment ago may still be in transit.
        let mut empty = 0;
        for _ in 0..GLANCES {
            empty = if rustix::io::ioctl_fionread(&theirs)? == 0 {
                empty + 1
            } else {
                0
            };
            if empty > 1 {
                break;
            }
            std::thread::sleep(GLANCE);
        }
        Ok(())
    }
}

impl Drop for Pty {
    fn drop(&mut self) {
        if self.open {
            // Who cannot look does not wait.
            let _ = self.wait_until_read();
        }
        if let Some(link) = &self.link {
            // Only its own: another one may have taken the name meanwhile.
            if fs::read_link(link).is_ok_and(|target| target == self.name) {
                let _ = fs::remove_file(link);
            }
        }
    }
}
