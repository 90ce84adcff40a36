//! The words of M200 to M204: what output S gives [000:9841-9909].

use bahn_parameters::MessageId;
use bahn_path::Voltage;
use bahn_program::MFunctions;

use crate::error::Fault;
use crate::numbers::Numbers;
use crate::settings::Settings;

/// Greatest voltage of V, V, and greatest TIME, s.
const VOLTS_MAX: f64 = 9.999;
const TIME_MAX_S: f64 = 1.999;

/// The voltage of an M function from 200 to 204.
pub(crate) fn of(
    code: u16,
    m: &MFunctions,
    numbers: &Numbers,
    settings: &Settings,
) -> Result<Voltage, Fault> {
    let word = |letter, name: &str, most: f64| {
        let value = m.argument(code, letter);
        let value = value.ok_or_else(|| fault(format!("M{code} needs {name}")))?;
        let value = numbers.q.value(value)?;
        match (0.0..=most).contains(&value) {
            true => Ok(value),
            false => Err(fault(format!("{name} of M{code} is 0 to {most}, not {value}"))),
        }
    };
    let volts = || word('V', "V", VOLTS_MAX);
    let time_s = || word('T', "TIME", TIME_MAX_S);
    Ok(match code {
        200 => Voltage::Fixed(volts()?),
        201 => Voltage::Along(volts()?),
        202 => {
            let number = word('F', "FNR", 3.0)?;
            let all = settings.rules.voltages.filter(|_| number.fract() == 0.0);
            let one = all.and_then(|all| all.get(number as u8));
            Voltage::ByVelocity(one.ok_or_else(|| fault(format!("MP3013 has no characteristic {number}")))?)
        }
        203 => Voltage::Ramp {
            volts: volts()?,
            time_s: time_s()?,
        },
        _ => Voltage::Pulse {
            volts: volts()?,
            time_s: time_s()?,
        },
    })
}

fn fault(detail: String) -> Fault {
    Fault::new(MessageId::EntryValueIncorrect, detail)
}
