//! The screen of the control as a picture of 640 x 480 pixels: 80 columns and 30 lines, as the screens of its time had
//! (inferred), in the colours that MP7350 to MP7363 give it. It is one of the three that draw a [`Screen`], beside the terminal
//! (room `terminal`, `draw`) and the browser (room `server`, `web/`); none of them knows more than that.

use bahn_picture::{Anchor, Colour, Image, mix};
use bahn_service::{Line, Picture, Screen, Star, Window, WindowKind};

/// Width and height of the picture, pixels.
const SIZE: [u32; 2] = [640, 480];
/// Pixels of a character.
const CELL: [f64; 2] = [8.0, 16.0];
/// Size of the letters.
const LETTERS: f64 = 13.0;
/// Columns of the screen.
const COLUMNS: usize = 80;
/// Columns of the headings' left half, and of a window that has another one beside it.
const HALF: usize = COLUMNS / 2;
/// The first line of what is shown: heading, dialogue and messages stand above it.
const WINDOWS: usize = 4;
/// The first line of the status display; the windows end above it.
const STATUS: usize = 21;
/// The lines of the soft keys, and the columns of each.
const SOFT_KEYS: [usize; 3] = [27, 28, 29];
const SOFT_KEY: usize = COLUMNS / 8 - 1;

/// What has which colour when the parameters give none: a screen without colours.
const BACK: Colour = [0; 3];
const FORE: Colour = [230; 3];

/// The page that is being drawn.
struct Sheet {
    image: Image,
    back: Colour,
    fore: Colour,
    message: Colour,
}

/// Draws the screen, with what the graphics show when they are looked at.
pub fn draw(screen: &Screen, picture: Option<&Picture>) -> Image {
    let colour = |name: &str, other: Colour| {
        let text = screen.look.colours.get(name).map(String::as_str);
        text.and_then(of_text).unwrap_or(other)
    };
    let back = colour("7352.0", BACK);
    let mut sheet = Sheet {
        image: Image::new(SIZE[0], SIZE[1], back),
        back,
        // A text as dark as what it stands on would not be seen.
        fore: readable(colour("7353.0", FORE), back),
        message: readable(colour("7351.0", FORE), back),
    };
    headings(&mut sheet, screen);
    windows(&mut sheet, screen, picture);
    status(&mut sheet, screen);
    for (place, text) in screen.soft_keys.keys.iter().enumerate().take(8) {
        let column = place * COLUMNS / 8;
        let mut parts = broken(text, SOFT_KEY).into_iter();
        for line in SOFT_KEYS {
            sheet.bar(column, line, SOFT_KEY);
            sheet.text(column, line, &parts.next().unwrap_or_default(), sheet.fore);
        }
    }
    sheet.image
}

/// The colour that a text such as `#d28220` names.
fn of_text(text: &str) -> Option<Colour> {
    let packed = u32::from_str_radix(text.strip_prefix('#')?, 16).ok()?;
    let [_, red, green, blue] = packed.to_be_bytes();
    Some([red, green, blue])
}

/// A colour that is seen on another one: black or white instead of one that is nearly the same.
fn readable(colour: Colour, back: Colour) -> Colour {
    /// Least difference of brightness, of 255.
    const LEAST: i32 = 90;
    let brightness = |colour: Colour| {
        let [red, green, blue] = colour.map(i32::from);
        (299 * red + 587 * green + 114 * blue) / 1000
    };
    match (brightness(colour) - brightness(back)).abs() < LEAST {
        true if brightness(back) > 127 => [0; 3],
        true => [255; 3],
        false => colour,
    }
}

impl Sheet {
    fn text(&mut self, column: usize, line: usize, text: &str, colour: Colour) {
        for (place, character) in text.chars().take(COLUMNS - column.min(COLUMNS)).enumerate() {
            let at = [
                ((column + place) as f64 + 0.5) * CELL[0],
                (line as f64 + 0.5) * CELL[1],
            ];
            let mut bytes = [0; 4];
            let character: &str = character.encode_utf8(&mut bytes);
            self.image.text(at, Anchor::Centre, LETTERS, colour, character);
        }
    }

    /// A stripe after text that stands out.
    fn bar(&mut self, column: usize, line: usize, columns: usize) {
        let min = [column as f64 * CELL[0], line as f64 * CELL[1]];
        let max = [min[0] + columns as f64 * CELL[0], min[1] + CELL[1]];
        let colour = mix(self.back, self.fore, 0.25);
        self.image.rectangle(min, max, colour);
    }

    fn rule(&mut self, line: usize) {
        let y = line as f64 * CELL[1];
        let colour = mix(self.back, self.fore, 0.5);
        self.image.line([0.0, y], [f64::from(SIZE[0]), y], 1.0, colour);
    }
}

fn headings(sheet: &mut Sheet, screen: &Screen) {
    for (heading, column) in screen.headings.iter().zip([0, HALF]) {
        if heading.active {
            sheet.bar(column, 0, HALF);
        }
        sheet.text(column + 1, 0, &fitting(&heading.title, HALF - 2), sheet.fore);
    }
    let dialogue = format!("{} {}", screen.dialogue.prompt, screen.dialogue.entry);
    sheet.text(1, 1, &fitting(dialogue.trim(), COLUMNS - 2), sheet.fore);
    for (message, line) in screen.messages.iter().rev().zip([2, 3]) {
        sheet.text(1, line, &fitting(&message.text, COLUMNS - 2), sheet.message);
    }
    sheet.rule(WINDOWS);
}

fn windows(sheet: &mut Sheet, screen: &Screen, picture: Option<&Picture>) {
    let halves = screen.beside.is_some() || picture.is_some();
    let columns = if halves { HALF } else { COLUMNS };
    window(sheet, &screen.program, 0, columns);
    if let Some(picture) = picture {
        paste(sheet, picture);
    } else if let Some(beside) = &screen.beside {
        window(sheet, beside, HALF, HALF);
    }
}

fn window(sheet: &mut Sheet, window: &Window, column: usize, columns: usize) {
    if window.kind == WindowKind::Empty {
        return;
    }
    sheet.text(
        column + 1,
        WINDOWS,
        &fitting(&window.title, columns - 2),
        sheet.message,
    );
    let lines = WINDOWS + 1..STATUS;
    for (line, place) in window.lines.iter().zip(lines) {
        show(sheet, line, column, place, columns);
    }
}

fn show(sheet: &mut Sheet, line: &Line, column: usize, place: usize, columns: usize) {
    if line.current {
        sheet.bar(column, place, columns);
    }
    sheet.text(column + 1, place, &fitting(&line.text, columns - 2), sheet.fore);
}

/// The graphics in the right half.
fn paste(sheet: &mut Sheet, picture: &Picture) {
    let [left, top] = [HALF as f64 * CELL[0], WINDOWS as f64 * CELL[1]].map(|pixels| pixels as usize + 1);
    let width = SIZE[0] as usize - left;
    let height = (STATUS - WINDOWS) * CELL[1] as usize - 2;
    // Without a part there is nothing to be seen.
    let Ok(Some(pixels)) = picture.pixels(width as u32, height as u32) else {
        return;
    };
    let rows = sheet.image.rows_mut().skip(top);
    for (row, drawn) in rows.zip(pixels.chunks_exact(width)) {
        if let Some(part) = row.get_mut(left..left + width) {
            part.copy_from_slice(drawn);
        }
    }
}

fn status(sheet: &mut Sheet, screen: &Screen) {
    let status = &screen.status;
    sheet.rule(STATUS);
    sheet.text(1, STATUS, &status.position_type, sheet.message);
    for (place, axis) in status.axes.iter().enumerate().take(6) {
        let text = format!("{}{:>12}", axis.label, axis.value);
        sheet.text(8 + 24 * (place % 3), STATUS + 1 + place / 3, &text, sheet.fore);
    }
    let star = match status.star {
        Star::Off => ' ',
        Star::Steady | Star::Blinking => '*',
    };
    let tool_axis = status.tool_axis.as_deref().unwrap_or("");
    let text = format!(
        "{star} T {} {tool_axis}   S {}   F {}   {}   {}",
        status.tool,
        status.s,
        status.f,
        status.m,
        status.flags.join(" ")
    );
    sheet.text(1, STATUS + 4, &fitting(&text, COLUMNS - 2), sheet.fore);
    sheet.text(
        1,
        STATUS + 5,
        &fitting(&status.waiting, COLUMNS - 2),
        sheet.message,
    );
}

/// As much of a text as there is room.
fn fitting(text: &str, columns: usize) -> String {
    text.chars().take(columns).collect()
}

/// A text in lines of so many columns, broken between words; a word that is longer is cut.
fn broken(text: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= columns => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(fitting(word, columns)),
        }
    }
    lines
}

/// A picture as a BMP file: 24 bits for a pixel, the last row first.
pub fn bmp(image: &Image) -> Vec<u8> {
    /// Heads of file and picture.
    const HEAD: u32 = 14 + 40;
    /// 72 dots per inch, in dots per metre.
    const DOTS: u32 = 2835;
    let width = image.width().max(1);
    let row = (width * 3).next_multiple_of(4);
    let size = row * image.height();
    let mut bytes = Vec::with_capacity((HEAD + size) as usize);
    bytes.extend(b"BM");
    let file = [HEAD + size, 0, HEAD];
    let picture = [40, width, image.height()];
    let planes_and_bits = [1 | 24 << 16];
    let rest = [0, size, DOTS, DOTS, 0, 0];
    let head = file.iter().chain(&picture).chain(&planes_and_bits).chain(&rest);
    bytes.extend(head.flat_map(|number: &u32| number.to_le_bytes()));
    for pixels in image.pixels().chunks_exact(width as usize).rev() {
        let begin = bytes.len();
        bytes.extend(pixels.iter().flat_map(|[red, green, blue]| [*blue, *green, *red]));
        bytes.resize(begin + row as usize, 0);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows begin at multiples of four bytes, the lowest one first, and colours stand blue, green, red.
    #[test]
    fn a_bmp_file_is_what_its_head_says() {
        let mut image = Image::new(3, 2, [1, 2, 3]);
        image.rectangle([0.0, 0.0], [1.0, 1.0], [200, 100, 50]);
        let bytes = bmp(&image);
        let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!(
            (&bytes[..2], number(2), number(10)),
            (b"BM".as_slice(), bytes.len(), 54)
        );
        assert_eq!((number(18), number(22), number(34)), (3, 2, 2 * 12));
        assert_eq!(bytes[54..57], [3, 2, 1]);
        assert_eq!(bytes[54 + 12..54 + 15], [50, 100, 200]);
    }

    #[test]
    fn what_is_written_can_be_read() {
        assert_eq!(readable([250, 250, 240], [255; 3]), [0; 3]);
        assert_eq!(readable([10, 10, 10], [0; 3]), [255; 3]);
        assert_eq!(readable([255, 255, 0], [0, 0, 120]), [255, 255, 0]);
        assert_eq!(of_text("#d28220"), Some([0xd2, 0x82, 0x20]));
    }

    /// A soft key has 9 columns; what is longer goes on in its next line.
    #[test]
    fn a_soft_key_is_broken_between_words() {
        assert_eq!(broken("TOOL TABLE", SOFT_KEY), ["TOOL", "TABLE"]);
        assert_eq!(broken("RESTORE POS. AT N", SOFT_KEY), ["RESTORE", "POS. AT N"]);
        assert_eq!(broken("ABCDEFGHIJK L", SOFT_KEY), ["ABCDEFGHI", "L"]);
        assert!(broken("", SOFT_KEY).is_empty());
    }

    #[test]
    fn a_screen_shows_its_words() {
        let screen = Screen {
            headings: vec![bahn_service::Heading {
                title: "MANUAL OPERATION".to_owned(),
                ..Default::default()
            }],
            ..Screen::default()
        };
        let image = draw(&screen, None);
        let labels: String = image.labels().iter().map(|label| label.text.as_str()).collect();
        assert!(labels.starts_with("MANUAL"), "{labels}");
        assert_eq!((image.width(), image.height()), (640, 480));
    }
}
