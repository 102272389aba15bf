//! SVG made pixels.

use super::{FigureError, PNG_SCALE};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{Rgb, RgbImage};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::sync::Arc;

/// The figure `svg` as PNG, [`PNG_SCALE`] pixels for each of its measures, with the program's own font.
pub(crate) fn png(svg: &str) -> Result<Vec<u8>, FigureError> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_source(fontdb::Source::Binary(Arc::new(dejavu::sans::regular())));
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(raster)?;
    let size = tree.size().to_int_size();
    let (width, height) = (size.width() * PNG_SCALE, size.height() * PNG_SCALE);
    let mut pixels = Pixmap::new(width, height)
        .ok_or_else(|| FigureError::Raster(format!("{width} x {height} pixels cannot be held")))?;
    let larger = Transform::from_scale(PNG_SCALE as f32, PNG_SCALE as f32);
    resvg::render(&tree, larger, &mut pixels.as_mut());
    let picture = RgbImage::from_fn(width, height, |x, y| {
        pixels.pixel(x, y).map_or(Rgb([255; 3]), |pixel| Rgb([pixel.red(), pixel.green(), pixel.blue()]))
    });
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    picture.write_with_encoder(encoder).map_err(raster)?;
    Ok(bytes)
}

fn raster(error: impl std::fmt::Display) -> FigureError {
    FigureError::Raster(error.to_string())
}
