//! Pictures: pixels, lines and text.
//!
//! The face of this room: [`Image`] with what is drawn on it, [`Colour`] and [`mix`], [`Anchor`] and
//! [`text_width`], [`Label`] for what was written where. Places are pixels from the upper left corner, fractions count.
//!
//! ```
//! use bahn_picture::{Anchor, Image};
//!
//! let mut image = Image::new(200, 40, [255; 3]);
//! image.line([10.0, 30.0], [190.0, 30.0], 1.5, [30, 60, 120]);
//! image.text([100.0, 15.0], Anchor::Centre, 14.0, [0; 3], "X.lag, mm");
//! let mut png = Vec::new();
//! image.write_png(&mut png)?;
//! assert_eq!(&png[1..4], b"PNG");
//! assert_eq!(Image::read_png(std::io::Cursor::new(png))?, image);
//! # Ok::<(), bahn_picture::ImageError>(())
//! ```

mod image;
mod text;

pub use image::{Colour, Image, ImageError, Label, mix};
pub use text::{Anchor, text_width};
