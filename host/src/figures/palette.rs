//! The colours of figures, which colour-blind readers can tell apart.
//!
//! ```
//! use meniscus::figures::chart::Colour;
//! use meniscus::figures::palette::{self, Ink};
//!
//! assert_eq!(palette::ink(Colour::Category(0)), Ink(0, 114, 178));
//! assert_eq!(palette::ink(Colour::Category(8)), palette::ink(Colour::Category(0)));
//! ```

use super::chart::Colour;
use plotters::style::colors::colormaps::{ColorMap, ViridisRGB};

/// Red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ink(pub u8, pub u8, pub u8);

impl Ink {
    /// The colour of a pixel.
    pub(crate) const fn rgb(self) -> image::Rgb<u8> {
        image::Rgb([self.0, self.1, self.2])
    }
}

/// Discs in no cluster, frames and letters.
pub const BLACK: Ink = Ink(0, 0, 0);
/// Discs in clusters: red as in the paper, and bright enough to have a contrast of 3.7 to black for eyes
/// without red receptors (after Viénot, Brettel and Mollon 1999).
pub const RED: Ink = Ink(228, 72, 32);
/// Where nothing is.
pub const PAPER: Ink = Ink(255, 255, 255);
/// What stands behind, and notes.
pub const GREY: Ink = Ink(110, 110, 110);

/// The colours of Okabe and Ito (Color Universal Design, 2008), those that are seen best on white first.
const CATEGORIES: [Ink; 8] = [
    Ink(0, 114, 178),
    Ink(213, 94, 0),
    Ink(0, 158, 115),
    Ink(204, 121, 167),
    Ink(230, 159, 0),
    Ink(86, 180, 233),
    Ink(0, 0, 0),
    Ink(190, 175, 30),
];

/// Where viridis ends here: its yellow cannot be seen on white.
const BRIGHTEST: f64 = 0.88;

/// What a colour is drawn with.
#[must_use]
pub fn ink(colour: Colour) -> Ink {
    match colour {
        Colour::Category(number) => CATEGORIES.get(number % CATEGORIES.len()).copied().unwrap_or(BLACK),
        Colour::Ordered(place) => {
            let place = if place.is_finite() { place.clamp(0.0, 1.0) } else { 0.0 };
            let colour = ViridisRGB.get_color(place * BRIGHTEST);
            Ink(colour.0, colour.1, colour.2)
        }
        Colour::Black => BLACK,
        Colour::Grey => GREY,
    }
}
