//! Numbers in single markers, as PLC programs of the TNC 355 read and write them [000:16206-16293].
//!
//! The codes of T, S, M and gear functions stand there beside their words, whatever M2719 says: it is about strobes
//! only. Which marker carries which bit is the table below.
//!
//! Decision: Codes of the TNC 355: M, S, the lowest S code and its step are decades (eight markers for 0 to 99),
//! gears binary, the T code as M2597 says in M2032 ff. and in decades in M2112 ff.; what does not fit is all ones

use bahn_exchange::{Bit, BitRange, Exchange, Image, signal};

/// How a number is written in markers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Coding {
    Binary,
    /// Decades of four markers each, 8-4-2-1 [001:562].
    Bcd,
}

/// Bits of a decade.
const DECADE: u16 = 4;

/// A number in consecutive markers, its lowest bit first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MarkerCode {
    markers: BitRange,
    coding: Coding,
}

// M and S codes and the lowest S code are 0 to 99, for which seven binary digits are enough: that there are eight, and
// four for a step of 1 to 9, says decades *(inferred)*, as the predecessors put them out [001:562] [001:736].
/// M2072 to M2079: the code of an M function.
pub(crate) const M_FUNCTION: MarkerCode = bcd(signal::M_CODE_BIT_1, 8);
/// M2064 to M2071: the S code.
pub(crate) const SPEED: MarkerCode = bcd(signal::S_CODE_BIT_1, 8);
/// M2080 to M2087: the S code of the lowest speed, from MP3020.
pub(crate) const LOWEST_SPEED: MarkerCode = bcd(signal::MINIMUM_RPM_MP3020_BIT_1, 8);
/// M2088 to M2091: the step of S codes, from MP3020.
pub(crate) const SPEED_STEP: MarkerCode = bcd(signal::SPEED_STEP_MP3020_BIT_1, 4);
/// M2104 to M2106: the gear code, 0 to 7.
pub(crate) const GEAR: MarkerCode = binary(signal::GEAR_CODE_BIT_1, 3);
/// M2832 to M2839: the code of an inhibited key.
pub(crate) const INHIBITED_KEY: MarkerCode = MarkerCode {
    markers: signal::INHIBITED_KEY_CODE_BITS_TNC355,
    coding: Coding::Binary,
};
/// M2800 to M2807: the code of a key that is simulated.
pub(crate) const SIMULATED_KEY: MarkerCode = MarkerCode {
    markers: signal::KEY_CODE_TNC355,
    coding: Coding::Binary,
};
/// M2032 to M2039: the T code with M2597 = 0, and with M2597 = 1 *(inferred: which markers M2597 is about)*.
const TOOL: [MarkerCode; 2] = [binary(signal::T_CODE_BIT_1, 8), bcd(signal::T_CODE_BIT_1, 8)];
/// M2112 to M2119: the same number in decades.
const TOOL_DECADES: MarkerCode = bcd(signal::TOOL_NUMBER_BCD_DECADE_1_BIT_1, 8);
/// Markers of M2560 to M2576 that are digits.
const Q_DIGITS: u16 = 4 * DECADE;

const fn binary(first: Bit, count: u16) -> MarkerCode {
    MarkerCode {
        markers: BitRange::from_marker(first, count),
        coding: Coding::Binary,
    }
}

const fn bcd(first: Bit, count: u16) -> MarkerCode {
    MarkerCode {
        markers: BitRange::from_marker(first, count),
        coding: Coding::Bcd,
    }
}

impl MarkerCode {
    /// Five markers that choose a position of MP4210 *(inferred: binary; the list calls all of M2560 to M2589
    /// BCD, but five markers are no decades, and there are 32 positions)*.
    pub const fn position(markers: BitRange) -> MarkerCode {
        MarkerCode {
            markers,
            coding: Coding::Binary,
        }
    }

    /// Writes a number; all markers are 1 for one that has no place in them [001:736].
    pub fn put(&self, number: u32, exchange: &mut Exchange) {
        let count = self.markers.count();
        let pattern = match self.coding {
            Coding::Binary => number,
            Coding::Bcd => in_decades(number),
        };
        let fits = pattern.checked_shr(count.into()).unwrap_or(0) == 0;
        for (place, marker) in (0..).zip(self.markers.iter()) {
            exchange.nc_put(marker, !fits || pattern >> place & 1 != 0);
        }
    }

    /// Reads a number; `None` where a decade is no digit.
    pub fn read(&self, nc: &Image) -> Option<u32> {
        let pattern = pattern(self.markers, nc);
        match self.coding {
            Coding::Binary => Some(pattern),
            Coding::Bcd => of_decades(pattern),
        }
    }
}

/// T function: the pocket or tool number of W262 [000:16209-16216] [000:16256-16263].
pub(crate) fn put_tool(w262: i16, exchange: &mut Exchange) {
    // What is no number has no place in the markers.
    let number = u32::try_from(w262).unwrap_or(u32::MAX);
    let [binary, decades] = &TOOL;
    let code = if exchange.nc().bit(signal::TOOL_NUMBER_OUTPUT_MODE) {
        decades
    } else {
        binary
    };
    code.put(number, exchange);
    TOOL_DECADES.put(number, exchange);
}

/// M2560 to M2576: a number for a Q parameter, four decades and a sign *(inferred: whole numbers, M2576 = 1 is
/// negative; the data formats M2810 to M2812 are not there [000:16494-16496])*. `None` where a decade is no digit.
pub(crate) fn q_value(nc: &Image) -> Option<f64> {
    let negative = signal::Q_VALUE_TNC355
        .get(Q_DIGITS)
        .is_some_and(|sign| nc.bit(sign));
    let digits = pattern(signal::Q_VALUE_TNC355, nc) & !(u32::MAX << Q_DIGITS);
    let value = f64::from(of_decades(digits)?);
    Some(if negative { -value } else { value })
}

/// M2817 and M2818: which of Q100 to Q103.
pub(crate) fn q_number(nc: &Image) -> u16 {
    u16::from(nc.bit(signal::Q_NUMBER_LSB_TNC355)) | u16::from(nc.bit(signal::Q_NUMBER_MSB_TNC355)) << 1
}

fn pattern(markers: BitRange, nc: &Image) -> u32 {
    (0..).zip(markers.iter()).fold(0, |pattern, (place, marker)| {
        pattern | u32::from(nc.bit(marker)) << place
    })
}

/// A number of up to eight digits in decades; more have no place anywhere.
fn in_decades(number: u32) -> u32 {
    if number > 99_999_999 {
        return u32::MAX;
    }
    let digits = (0..8).map(|decade| (decade, number / 10u32.pow(decade) % 10));
    digits.fold(0, |pattern, (decade, digit)| {
        pattern | digit << (u32::from(DECADE) * decade)
    })
}

fn of_decades(pattern: u32) -> Option<u32> {
    let digits = (0..8)
        .rev()
        .map(|decade| pattern >> (u32::from(DECADE) * decade) & 0xf);
    digits
        .map(|digit| (digit <= 9).then_some(digit))
        .try_fold(0u32, |number, digit| number.checked_mul(10)?.checked_add(digit?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The markers from a first one on, lowest first.
    fn shown(exchange: &Exchange, first: u16, count: u16) -> String {
        let markers = (first..first + count).filter_map(|number| Bit::new(bahn_exchange::BitArea::M, number));
        markers
            .map(|marker| if exchange.nc().bit(marker) { '1' } else { '0' })
            .collect()
    }

    /// M19 is `1001 1000` on the relays of the TNC 155, M30 `0000 1100` [001:564-675].
    #[test]
    fn m_codes_are_decades() {
        let mut exchange = Exchange::default();
        for (code, markers) in [
            (19, "10011000"),
            (30, "00001100"),
            (3, "11000000"),
            (0, "00000000"),
        ] {
            M_FUNCTION.put(code, &mut exchange);
            assert_eq!(shown(&exchange, 2072, 8), markers, "M{code}");
        }
    }

    /// M2597 = 0: T 25 in binary is 16 + 8 + 1; M2597 = 1: 5 and 2. M2112 ff. have decades always. Numbers above 99
    /// have all eight markers in decades [001:736].
    #[test]
    fn t_codes_are_binary_or_decades() {
        let mut exchange = Exchange::default();
        for (mode, tool, code, decades) in [
            (false, 25, "10011000", "10100100"),
            (true, 25, "10100100", "10100100"),
            (false, 254, "01111111", "11111111"),
            (true, 254, "11111111", "11111111"),
            (false, 300, "11111111", "11111111"),
        ] {
            exchange.nc_set(signal::TOOL_NUMBER_OUTPUT_MODE, mode);
            put_tool(tool, &mut exchange);
            assert_eq!(shown(&exchange, 2032, 8), code, "M2597 = {mode}, T{tool}");
            assert_eq!(shown(&exchange, 2112, 8), decades, "T{tool}");
        }
    }

    /// M2560 ff. carry 4 - 3 - 2 - 1 from the highest decade: 4321; M2576 makes it negative. Ten is no digit.
    #[test]
    fn numbers_for_q_parameters() {
        let mut exchange = Exchange::default();
        let markers = signal::Q_VALUE_TNC355;
        let set = |exchange: &mut Exchange, bits: &str| {
            for (marker, bit) in markers.iter().zip(bits.bytes().filter(|bit| *bit != b' ')) {
                exchange.nc_set(marker, bit == b'1');
            }
        };
        set(&mut exchange, "1000 0100 1100 0010 0");
        assert_eq!(q_value(exchange.nc()), Some(4321.0));
        set(&mut exchange, "1000 0100 1100 0010 1");
        assert_eq!(q_value(exchange.nc()), Some(-4321.0));
        set(&mut exchange, "0101 0000 0000 0000 0");
        assert_eq!(q_value(exchange.nc()), None);
        // M2817 is the lower bit of the number, M2818 the upper one.
        exchange.nc_set(signal::Q_NUMBER_MSB_TNC355, true);
        assert_eq!(q_number(exchange.nc()), 2);
    }

    #[test]
    fn what_is_put_is_read() {
        let mut exchange = Exchange::default();
        for number in 0..100 {
            for code in [SPEED, LOWEST_SPEED, SIMULATED_KEY] {
                code.put(number, &mut exchange);
                assert_eq!(code.read(exchange.nc()), Some(number));
            }
        }
    }
}
