//! Telegrams about the control and its run.
//!
//! Decision: A message of a host to the PLC is a doubleword when it has four bytes, else a string

use std::io::Write;
use std::time::{SystemTime, UNIX_EPOCH};

use super::session::{Answer, Session, Task};
use super::{Command, Device, ErrorNumber, Level, PlcMessage, Run, Telegram, keys};
use bahn_store::Existing;

fn done() -> Answer {
    Ok(Telegram::new(Command::T_OK))
}

/// `R_ST`: the status that was set.
pub(super) fn status(session: &mut Session, telegram: &Telegram) -> Answer {
    Ok(Telegram::new(telegram.command.answer()).raw(&session.status))
}

/// `C_ST`: sets it. It changes nothing else (inferred).
pub(super) fn set_status(session: &mut Session, telegram: &Telegram) -> Answer {
    for (set, byte) in session.status.iter_mut().zip(&telegram.data) {
        *set = *byte;
    }
    done()
}

/// `R_VR`: control, NC software, PLC program and options; with a number one of them (public).
pub(super) fn version(session: &mut Session, telegram: &Telegram) -> Answer {
    /// Options of later controls, none of which is there.
    const OPTIONS: &str = "%0000000000000000";
    let identity = session.site.device.identity();
    let answer = Telegram::new(telegram.command.answer());
    let all = [
        identity.control.as_str(),
        &identity.nc_software,
        &identity.plc_software,
        OPTIONS,
    ];
    match telegram.fields().byte() {
        None => Ok(all.iter().fold(answer, |answer, text| answer.string(text))),
        Some(number @ 1..=4) => {
            let text = all.get(usize::from(number) - 1).copied().unwrap_or_default();
            Ok(answer.string(text))
        }
        Some(5) => Ok(answer.string(&identity.id)),
        // Neither types of releases nor a safe PLC are there.
        Some(_) => Err(ErrorNumber::WRONG_PARAMETER),
    }
}

/// `R_CI`: 1 turbo mode, 2 whether DNC is allowed, 3 sampling rate of the axes (public).
pub(super) fn configuration(_: &mut Session, telegram: &Telegram) -> Answer {
    const SWITCH: u32 = 1;
    let answer = Telegram::new(telegram.command.answer());
    match telegram.fields().long().ok_or(ErrorNumber::BAD_FORMAT)? {
        1 => Ok(answer.long(SWITCH).long(0)),
        2 => Ok(answer.long(SWITCH).long(1)),
        _ => Err(ErrorNumber::WRONG_PARAMETER),
    }
}

/// Number and index of a machine parameter: `7230.1`, `MP7230.1`; without an index 0.
fn parameter_name(text: &str) -> Result<(u16, u8), ErrorNumber> {
    let text = text.trim();
    let digits = text
        .strip_prefix("MP")
        .or_else(|| text.strip_prefix("mp"))
        .unwrap_or(text);
    let (number, index) = digits.split_once('.').unwrap_or((digits, "0"));
    let number = number.parse().map_err(|_| ErrorNumber::NO_PARAMETER)?;
    let index = index.parse().map_err(|_| ErrorNumber::NO_PARAMETER)?;
    Ok((number, index))
}

/// `R_MC`, `R_MP`: a machine parameter.
pub(super) fn parameter(session: &mut Session, telegram: &Telegram) -> Answer {
    let name = telegram.fields().string().ok_or(ErrorNumber::BAD_FORMAT)?;
    let (number, index) = parameter_name(&name)?;
    let value = session.site.device.parameter(number, index);
    let value = value.ok_or(ErrorNumber::NO_PARAMETER)?;
    Ok(Telegram::new(telegram.command.answer()).string(&value))
}

/// `C_MC`: changes one; 0 for good, 1 until power-off (public).
pub(super) fn set_parameter(session: &mut Session, telegram: &Telegram) -> Answer {
    let mut fields = telegram.fields();
    let for_good = fields.long().ok_or(ErrorNumber::BAD_FORMAT)? == 0;
    let name = fields.string().ok_or(ErrorNumber::BAD_FORMAT)?;
    let value = fields.string().ok_or(ErrorNumber::BAD_FORMAT)?;
    let (number, index) = parameter_name(&name)?;
    session
        .site
        .device
        .set_parameter(number, index, &value, for_good)?;
    done()
}

/// `R_RI`: the run (public).
pub(super) fn run(session: &mut Session, telegram: &Telegram) -> Answer {
    let which = telegram.fields().word().ok_or(ErrorNumber::BAD_FORMAT)?;
    let run = session.site.device.run()?;
    let answer = Telegram::new(telegram.command.answer());
    match which {
        22 => Ok(axes(&run, answer)),
        23 => Ok(answer.word(run.execution as u16)),
        24 => Ok(answer.long(run.block).string(&run.main).string(&run.current)),
        25 => Ok(run.overrides.iter().fold(answer, |answer, percent| {
            answer.long((percent * 100.0).round().clamp(0.0, 1e9) as u32)
        })),
        26 => Ok(answer.word(run.state as u16)),
        27 => message_at(session, &run, 0, answer),
        28 => message_at(session, &run, session.next_message, answer),
        51 => Ok(answer
            .long(run.tool.number)
            .word(0)
            .word(run.tool.axis)
            .raw(&run.tool.length.to_le_bytes())
            .raw(&run.tool.radius.to_le_bytes())),
        _ => Err(ErrorNumber::WRONG_PARAMETER),
    }
}

/// How many axes, then all values as text, then all letters.
fn axes(run: &Run, answer: Telegram) -> Telegram {
    let count = u8::try_from(run.axes.len()).unwrap_or(u8::MAX);
    let answer = answer.byte(0).byte(count);
    let axes = run.axes.iter().take(count.into());
    let answer = axes.clone().fold(answer, |answer, (_, position)| {
        answer.string(&format!("{position:.4}"))
    });
    axes.fold(answer, |answer, (letter, _)| answer.string(&letter.to_string()))
}

fn message_at(session: &mut Session, run: &Run, place: usize, answer: Telegram) -> Answer {
    let message = run.messages.get(place).ok_or(ErrorNumber::NO_NEXT_ERROR)?;
    session.next_message = place + 1;
    /// Messages have no groups (inferred).
    const GROUP: u16 = 0;
    Ok(answer
        .word(message.class)
        .word(GROUP)
        .long(message.number)
        .string(&message.text))
}

/// `R_DT`: seconds since 1970 (public).
pub(super) fn date(_: &mut Session, telegram: &Telegram) -> Answer {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let seconds = u32::try_from(now.as_secs()).unwrap_or(u32::MAX);
    Ok(Telegram::new(telegram.command.answer()).long(seconds))
}

/// `R_LB`: the log book, an event in each telegram: time, kind (0 key, 1 message), text (inferred).
pub(super) fn log_book(session: &mut Session, telegram: &Telegram) -> Answer {
    let event = |event: &super::Event| {
        Telegram::new(telegram.command.answer())
            .long(event.time)
            .word(event.kind as u16)
            .string(&event.text)
    };
    let mut telegrams: std::collections::VecDeque<Telegram> =
        session.site.device.log_book().iter().map(event).collect();
    let first = telegrams.pop_front();
    if first.is_some() {
        session.task = Task::Listing(telegrams);
    }
    Ok(first.unwrap_or(Telegram::new(Command::T_FD)))
}

/// `C_LK`: 1 locks the keys for everybody else, 0 unlocks them (public).
pub(super) fn lock_keys(session: &mut Session, telegram: &Telegram) -> Answer {
    match telegram.fields().byte() {
        Some(on @ (0 | 1)) => session.lock_keys(on == 1)?,
        _ => return Err(ErrorNumber::WRONG_PARAMETER),
    }
    done()
}

/// `C_EK`: presses a key (public).
pub(super) fn press(session: &mut Session, telegram: &Telegram) -> Answer {
    let code = telegram.fields().word().ok_or(ErrorNumber::BAD_FORMAT)?;
    if !session.has_keys() {
        return Err(ErrorNumber::KEY_REFUSED);
    }
    let key = keys::name(code).ok_or(ErrorNumber::KEY_REFUSED)?;
    session.site.device.press(&key)?;
    done()
}

/// A message to the PLC: four bytes are a doubleword, anything else is a string; one of three characters has two zero bytes
/// at its end (inferred).
fn to_plc(session: &Session, telegram: &Telegram) -> Result<(), ErrorNumber> {
    let message = match <[u8; 4]>::try_from(telegram.data.as_slice()) {
        Ok(bytes) => PlcMessage::Double(i32::from_be_bytes(bytes)),
        Err(_) => {
            let end = telegram.data.iter().position(|byte| *byte == 0);
            let text = telegram.data.get(..end.unwrap_or(telegram.data.len()));
            PlcMessage::Text(text.unwrap_or_default().to_vec())
        }
    };
    session.site.device.to_plc(message)
}

/// A message of the PLC as it goes to a host.
pub(crate) fn from_plc(message: &PlcMessage) -> Telegram {
    let telegram = Telegram::new(Command::M_PC);
    match message {
        PlcMessage::Double(value) => telegram.raw(&value.to_be_bytes()),
        PlcMessage::Text(text) => {
            let telegram = telegram.raw(text).byte(0);
            if telegram.data.len() == 4 {
                telegram.byte(0)
            } else {
                telegram
            }
        }
    }
}

/// `M_PC`: a message to the PLC [000:15875].
pub(super) fn message(session: &mut Session, telegram: &Telegram) -> Answer {
    to_plc(session, telegram)?;
    done()
}

/// `X_PC`: the same, confirmed by `X_OK` or `X_ER` (public).
pub(super) fn message_to_confirm(session: &mut Session, telegram: &Telegram) -> Answer {
    let answer = match to_plc(session, telegram) {
        Ok(()) => Command(*b"X_OK"),
        Err(_) => Command(*b"X_ER"),
    };
    Ok(Telegram::new(answer))
}

/// `C_CC`: system commands (public): 3 to 7 size of a telegram, 12 the screen as a BMP file, 19 uploads are confirmed.
pub(super) fn system(session: &mut Session, telegram: &Telegram) -> Answer {
    let mut fields = telegram.fields();
    match fields.word().ok_or(ErrorNumber::BAD_FORMAT)? {
        3 => session.block = 1024,
        4 => session.block = 512,
        5 => session.block = 2048,
        6 => session.block = 3072,
        7 => session.block = 4096,
        12 => {
            let path = fields.string().ok_or(ErrorNumber::BAD_FORMAT)?;
            screen_dump(session, &path)?;
        }
        19 => session.secure = true,
        _ => return Err(ErrorNumber::WRONG_PARAMETER),
    }
    done()
}

/// Writes the screen to a file, which needs the right to do so.
fn screen_dump(session: &Session, path: &str) -> Result<(), ErrorNumber> {
    if !session.has(Level::File) && !session.has(Level::FilePlc) {
        return Err(ErrorNumber::NO_PRIVILEGE);
    }
    let place = session.place(path)?;
    let device: &dyn Device = session.site.device.as_ref();
    let bytes = device.screen()?;
    let file = device.store().create(&place, Existing::Replace);
    let mut file = file.map_err(|error| ErrorNumber::from(&error))?;
    file.write_all(&bytes).map_err(|_| ErrorNumber::NO_SPACE)?;
    file.commit().map_err(|error| ErrorNumber::from(&error))
}
