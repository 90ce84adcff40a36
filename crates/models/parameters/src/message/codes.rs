//! What stands after the text of a message: the letter of a monitoring, the code of a PLC fault.

use super::MessageId;

/// A message with a certain code after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MessageCode {
    /// The code, as `A` or `1Q`.
    pub code: &'static str,
    /// Why the control shows it.
    pub cause: &'static str,
    /// What to do about it.
    pub remedy: &'static str,
    /// Where the manuals print it.
    pub source: &'static str,
}

const fn code(
    code: &'static str,
    cause: &'static str,
    remedy: &'static str,
    source: &'static str,
) -> MessageCode {
    MessageCode {
        code,
        cause,
        remedy,
        source,
    }
}

/// A marker of the machine panel that agrees with its complement.
const fn panel(name: &'static str, cause: &'static str) -> MessageCode {
    code(name, cause, PAIR, "[000:7543-7585]")
}

/// The same for the jog increments.
const fn jog(name: &'static str, cause: &'static str) -> MessageCode {
    code(name, cause, PAIR, "[000:8494-8525]")
}

/// The same for the strobes of the TNC 355. The manual prints no codes for them; these are left out in its series
/// *(inferred)*.
const fn old_strobe(name: &'static str, cause: &'static str) -> MessageCode {
    code(
        name,
        cause,
        "With M2719 = 0 the PLC program must set the strobe and reset its complement in one scan; set M2719 where strobes with words are used.",
        "[000:10721-10740] [000:10789-10806]",
    )
}

/// What every pair of command and complement needs.
const PAIR: &str = "Check the key and its two contacts, and that the PLC program sets the marker and resets its complement together.";
impl MessageId {
    /// The codes that may stand after the text, none for most messages.
    pub fn codes(self) -> &'static [MessageCode] {
        match self {
            MessageId::GrossPositioningError => &GROSS_POSITIONING,
            MessageId::MeasuringSystemDefective => &MEASURING_SYSTEM,
            MessageId::ErrorInPlcProgram => &PLC_PROGRAM,
            MessageId::TransferredDataIncorrect => &TRANSFER,
            _ => &[],
        }
    }
}

const GROSS_POSITIONING: [MessageCode; 6] = [
    code(
        "A",
        "The lag is above its second limit (MP1720, with precontrol MP1420; on TNC 151/155 MP57 or MP174), or the axes of a gantry stand too far apart (MP855).",
        "Look for a blocked axis, a drive without power, an encoder that counts the wrong way (MP210, MP1040), or limits too tight for rapid traverse.",
        "[000:5200-5206] [000:4490]",
    ),
    code(
        "B",
        "The nominal voltage would be above 10 V.",
        "Compare the adjustment of the amplifier with MP1050 at rapid traverse, and the kv factor; look for an axis that runs heavily.",
        "[000:5258-5264]",
    ),
    code(
        "C",
        "The axis does not move although it gets voltage, or otherwise than calculated (MP1140; on the TNC 425 MP1970).",
        "Check enable of the drive, coupling, belt and encoder; a broken cable of the encoder shows like this.",
        "[000:5266-5287]",
    ),
    code(
        "D",
        "An axis that stands was moved by more than MP1110 (MP169 on TNC 151/155).",
        "Check clamping, weight compensation and cutting forces, then the limit.",
        "[000:5289-5300]",
    ),
    code(
        "E",
        "The offset that the control measured is 100 mV or more.",
        "Adjust the offset of the servo amplifier, then adjust again by code number.",
        "[000:5002-5014]",
    ),
    code(
        "3F",
        "The output of the digital speed controller is above MP1910 (TNC 425).",
        "Check motor, speed encoder and the sign of the torque (MP1950); see MP1910 while marks are passed for the first time.",
        "[000:18337-18522]",
    ),
];

const MEASURING_SYSTEM: [MessageCode; 3] = [
    code(
        "A",
        "The amplitude of the encoder signal is too small (MP31).",
        "Clean scale and reading head, check gap, cable and plug.",
        "[000:3290-3297]",
    ),
    code(
        "B",
        "Signal edges follow each other too closely (MP32).",
        "Look for interference and shielding, and for a speed that is too high for the input.",
        "[000:3290-3297]",
    ),
    code(
        "C",
        "Distance-coded reference marks contradict each other (MP30).",
        "Check MP1350 and the spacing of the marks, then the scale.",
        "[000:3290-3297]",
    ),
];

/// The receiving component has found an error. Which letter stands for which the manuals do not say *(inferred)*.
const fn receiver(name: &'static str, cause: &'static str) -> MessageCode {
    code(
        name,
        cause,
        "Set the same baud rate, data bits, parity and stop bits on both sides; check the cable.",
        "[000:17590-17596]",
    )
}

const TRANSFER: [MessageCode; 9] = [
    receiver("A", "The parity of a character is wrong."),
    receiver("B", "A character has no stop bit."),
    receiver("C", "Characters came faster than they were taken."),
    receiver("D", "The line was interrupted."),
    code(
        "E",
        "A block was answered NAK three times in sequence.",
        "Check the cable, and the data format of the receiving device.",
        "[000:17588-17589]",
    ),
    code(
        "K",
        "The device wanted to signal an error, but no 1 came after ESC.",
        "Check the software of the device.",
        "[000:17597]",
    ),
    code(
        "L",
        "The device signalled an error by a number that is not 0 to 7.",
        "Check the software of the device.",
        "[000:17598]",
    ),
    code(
        "M",
        "A block came with errors three times in sequence.",
        "Check the cable, and the data format of the sending device.",
        "[000:17600]",
    ),
    code(
        "N",
        "The device answers neither ACK nor NAK.",
        "Check that the device is set to the same protocol and is still on.",
        "[000:17599]",
    ),
];

/// Marker pairs, spindle, transfers; the numbers are errors of the PLC program itself.
const PLC_PROGRAM: [MessageCode; 32] = [
    panel("1A", "NC start, M2448, agrees with its complement M2464."),
    panel("1B", "Rapid traverse, M2449, agrees with its complement M2465."),
    panel(
        "1C",
        "Memory function of direction keys, M2450, agrees with its complement M2466.",
    ),
    panel("1D", "Feed release, M2451, agrees with its complement M2467."),
    panel(
        "1I",
        "Manual traverse X+, M2456, agrees with its complement M2472.",
    ),
    panel(
        "1J",
        "Manual traverse X-, M2457, agrees with its complement M2473.",
    ),
    panel(
        "1K",
        "Manual traverse Y+, M2458, agrees with its complement M2474.",
    ),
    panel(
        "1L",
        "Manual traverse Y-, M2459, agrees with its complement M2475.",
    ),
    panel(
        "1M",
        "Manual traverse Z+, M2460, agrees with its complement M2476.",
    ),
    panel(
        "1N",
        "Manual traverse Z-, M2461, agrees with its complement M2477.",
    ),
    panel(
        "1O",
        "Manual traverse 4+, M2462, agrees with its complement M2478.",
    ),
    panel(
        "1P",
        "Manual traverse 4-, M2463, agrees with its complement M2479.",
    ),
    panel(
        "2M",
        "Manual traverse 5+, M2524, agrees with its complement M2540.",
    ),
    panel(
        "2N",
        "Manual traverse 5-, M2525, agrees with its complement M2541.",
    ),
    jog("2A", "Jog X+, M2512, agrees with its complement M2528."),
    jog("2B", "Jog X-, M2513, agrees with its complement M2529."),
    jog("2C", "Jog Y+, M2514, agrees with its complement M2530."),
    jog("2D", "Jog Y-, M2515, agrees with its complement M2531."),
    jog("2E", "Jog Z+, M2516, agrees with its complement M2532."),
    jog("2F", "Jog Z-, M2517, agrees with its complement M2533."),
    jog("2G", "Jog 4+, M2518, agrees with its complement M2534."),
    jog("2H", "Jog 4-, M2519, agrees with its complement M2535."),
    jog("2I", "Jog 5+, M2520, agrees with its complement M2536."),
    jog("2J", "Jog 5-, M2521, agrees with its complement M2537."),
    old_strobe(
        "1E",
        "PLC positioning X of the TNC 355, M2452, agrees with its complement M2468.",
    ),
    old_strobe(
        "1F",
        "PLC positioning Y of the TNC 355, M2453, agrees with its complement M2469.",
    ),
    old_strobe(
        "1G",
        "PLC positioning Z of the TNC 355, M2454, agrees with its complement M2470.",
    ),
    old_strobe(
        "1H",
        "PLC positioning 4 of the TNC 355, M2455, agrees with its complement M2471.",
    ),
    old_strobe(
        "2K",
        "PLC positioning 5 of the TNC 355, M2522, agrees with its complement M2538.",
    ),
    old_strobe(
        "2P",
        "Spindle orientation of the TNC 355, M2527, agrees with its complement M2543.",
    ),
    code(
        "1Q",
        "More than one of the spindle markers M2485 (M3), M2486 (M4) and M2487 (M5) is set.",
        "Reset the other two before one is set; the PLC program must not set two in one scan.",
        "[000:5494-5498]",
    ),
    code(
        "1R",
        "PLC positioning (M2704 ff.), transfer of Q parameters (M2713) and datum correction (M2716) were asked for at once; they share their words. With M2719 = 0: M2452 ff., M2809 and M2819, which share their markers.",
        "Start one after the other: wait until the NC has reset the first marker.",
        "[000:631-633]",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_complete_and_unique() {
        for id in MessageId::ALL {
            let mut seen = Vec::new();
            for code in id.codes() {
                assert!(!seen.contains(&code.code), "{} twice", code.code);
                seen.push(code.code);
                assert!(
                    code.cause.ends_with('.') && code.remedy.ends_with('.'),
                    "{code:?}"
                );
                assert!(code.source.starts_with('['), "{code:?}");
            }
        }
        assert!(MessageId::LimitSwitch.codes().is_empty());
    }
}
