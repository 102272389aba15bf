//! The font of figures and snapshots: DejaVu Sans, which the program carries.

use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};
use std::sync::OnceLock;

/// The font's family, and what a viewer without it may take.
pub(crate) const FAMILY: &str = "DejaVu Sans, sans-serif";

/// The size that plotters has to be told for letters of one pixel per em: what its measure counts is from
/// the deepest to the highest point of the font.
const HEIGHT_PER_EM: f64 = (1901.0 + 483.0) / 2048.0;

/// Pixels per em at which texts are measured: plotters tells whole pixels.
const MEASURED_EM: f64 = 1000.0;

/// Makes the font known to plotters, once; false if it is not usable.
pub(crate) fn known() -> bool {
    static KNOWN: OnceLock<bool> = OnceLock::new();
    *KNOWN.get_or_init(|| register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular()).is_ok())
}

/// Width of `text` in letters of `em` pixels, pixels.
pub(super) fn width(text: &str, em: f64) -> f64 {
    let font = FontDesc::new(FontFamily::Name(FAMILY), MEASURED_EM * HEIGHT_PER_EM, FontStyle::Normal);
    font.box_size(text).map_or(0.0, |size| f64::from(size.0) / MEASURED_EM * em)
}
