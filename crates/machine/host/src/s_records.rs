//! S records of the EXORMAX format, in which EPROMs are described for a programmer [000:11905-11909].
//!
//! `S`, the kind, and in hexadecimal digits: how many bytes follow, the address, the data, and the complement of the sum of
//! all these bytes. S0 is the title, S3 data at an address of four bytes, S7 the end (public).

use std::fmt::Write as _;

use bahn_text::{Diagnostic, Span};

/// Bytes of data in a record.
const RECORD: usize = 32;
/// Largest image that is read: the EPROMs are far smaller.
const IMAGE_MAX: usize = 1 << 22;

/// Contents of a memory from address 0 on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// Title, ASCII.
    pub title: String,
    /// The bytes.
    pub bytes: Vec<u8>,
}

impl Image {
    /// The image as records, a line each.
    ///
    /// ```
    /// use bahn_host::s_records::Image;
    /// let image = Image { title: "HDR".into(), bytes: vec![0x0A, 0x0D] };
    /// assert_eq!(image.to_records(), "S00600004844521B\r\nS307000000000A0DE1\r\nS70500000000FA\r\n");
    /// assert_eq!(Image::from_records(&image.to_records()), Ok(image));
    /// ```
    pub fn to_records(&self) -> String {
        let mut text = String::new();
        let title: Vec<u8> = self.title.bytes().take(RECORD).collect();
        record(&mut text, 0, &[0, 0], &title);
        for (index, data) in self.bytes.chunks(RECORD).enumerate() {
            let address = u32::try_from(index * RECORD).unwrap_or(u32::MAX);
            record(&mut text, 3, &address.to_be_bytes(), data);
        }
        record(&mut text, 7, &[0; 4], &[]);
        text
    }

    /// Reads records; they follow each other without gaps.
    ///
    /// # Errors
    /// At the first record that is damaged, missing or out of order.
    pub fn from_records(text: &str) -> Result<Image, Diagnostic> {
        let mut image = Image::default();
        let mut ended = false;
        for (line, record) in (1..).zip(text.lines()) {
            let fault = |message: String| Diagnostic::error(Span::line(line), message);
            let record = record.trim();
            if record.is_empty() || record == "\u{1a}" {
                continue;
            }
            if ended {
                return Err(fault("nothing follows the end record S7".into()));
            }
            let (kind, bytes) = checked(record).map_err(fault)?;
            match (kind, bytes.as_slice()) {
                (0, [_, _, title @ ..]) => image.title = title.iter().map(|byte| char::from(*byte)).collect(),
                (3, [a, b, c, d, data @ ..]) => {
                    let address = u32::from_be_bytes([*a, *b, *c, *d]);
                    if address as usize != image.bytes.len() {
                        let expected = image.bytes.len();
                        return Err(fault(format!(
                            "address {address:08X} where {expected:08X} follows"
                        )));
                    }
                    image.bytes.extend_from_slice(data);
                }
                (7, _) => ended = true,
                _ => return Err(fault(format!("S{kind} is none of S0, S3 and S7"))),
            }
            if image.bytes.len() > IMAGE_MAX {
                return Err(fault("the image is larger than any EPROM".into()));
            }
        }
        match ended {
            true => Ok(image),
            false => Err(Diagnostic::error(Span::FILE, "the end record S7 is missing")),
        }
    }
}

fn record(text: &mut String, kind: u8, address: &[u8], data: &[u8]) {
    let count = u8::try_from(address.len() + data.len() + 1).unwrap_or(u8::MAX);
    let body = [&[count], address, data].concat();
    let sum = body.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    // Writing into a string never fails.
    let _ = write!(text, "S{kind}");
    for byte in body.iter().chain([&!sum]) {
        let _ = write!(text, "{byte:02X}");
    }
    text.push_str("\r\n");
}

/// Kind, and address and data of a record whose length and check sum are right.
fn checked(record: &str) -> Result<(u8, Vec<u8>), String> {
    let digits = record.strip_prefix(['S', 's']).ok_or("a record begins with S")?;
    let mut digits = digits.bytes();
    let kind = digits
        .next()
        .filter(u8::is_ascii_digit)
        .ok_or("the kind of the record is missing")?;
    let digits: Vec<u8> = digits.collect();
    let bytes: Option<Vec<u8>> = digits
        .chunks(2)
        .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok().filter(|p| p.len() == 2)?, 16).ok())
        .collect();
    let bytes = bytes.ok_or("the record is no row of hexadecimal bytes")?;
    let [count, rest @ .., _] = bytes.as_slice() else {
        return Err("the record is too short".into());
    };
    if usize::from(*count) != rest.len() + 1 {
        return Err(format!(
            "the record has {} bytes and announces {count}",
            rest.len() + 1
        ));
    }
    let sum = bytes.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    if sum != 0xFF {
        return Err("the check sum is wrong".into());
    }
    Ok((kind - b'0', rest.to_vec()))
}
