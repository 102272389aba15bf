//! Panels that show discs in their box.

use super::FigureError;
use super::canvas::{Canvas, Place};
use super::palette::{BLACK, Ink, RED};
use meniscus_core::torus::{Position, Torus};

/// A box with its discs at true size, those of clusters red (Figs. 3 and 4).
#[derive(Clone, Debug, PartialEq)]
pub struct Discs {
    /// The box.
    pub torus: Torus,
    /// Where the discs are.
    pub positions: Vec<Position>,
    /// For each disc, whether it belongs to a cluster; one without an entry does not.
    pub clustered: Vec<bool>,
    /// Stands above the box; may be empty.
    pub caption: String,
}

/// Decimal places of positions, R0.
const DIGITS: usize = 2;

impl Discs {
    /// Draws the box, `size` pixels wide, from its upper left `corner`.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>, corner: Place, size: f64) -> Result<(), FigureError> {
        let side = self.torus.side();
        // Plain discs first, so that those of clusters are seen whole.
        let elements: String = [(BLACK, false), (RED, true)]
            .into_iter()
            .map(|(ink, of_cluster)| self.discs(ink, of_cluster, side / size))
            .collect();
        let line = side / size;
        let frame = format!(
            "<rect width=\"{side}\" height=\"{side}\" fill=\"none\" stroke=\"black\" stroke-width=\"{}\"/>\n",
            2.0 * line
        );
        canvas.picture(corner, size, side, &(elements + &frame));
        Ok(())
    }

    /// One path of all discs of a kind: a line of no length with round ends is a disc. In a box so large
    /// that a disc is smaller than a pixel, `pixel` R0 wide, it is drawn as one.
    fn discs(&self, ink: Ink, of_cluster: bool, pixel: f64) -> String {
        let side = self.torus.side();
        let mut path = String::new();
        for (id, position) in self.positions.iter().enumerate() {
            if self.clustered.get(id).copied().unwrap_or(false) != of_cluster {
                continue;
            }
            let (x, y) = (self.torus.coordinate(position.x), side - self.torus.coordinate(position.y));
            for x in images(x, side) {
                for y in images(y, side) {
                    path.push_str(&format!("M{x:.DIGITS$} {y:.DIGITS$}h0"));
                }
            }
        }
        if path.is_empty() {
            return path;
        }
        let Ink(red, green, blue) = ink;
        let diameter = pixel.max(2.0);
        format!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"#{red:02X}{green:02X}{blue:02X}\" \
             stroke-width=\"{diameter}\" stroke-linecap=\"round\"/>\n"
        )
    }
}

/// A coordinate, and that of its image across the border if the disc reaches over it.
fn images(at: f64, side: f64) -> impl Iterator<Item = f64> {
    let across = if at < 1.0 {
        Some(at + side)
    } else if at > side - 1.0 {
        Some(at - side)
    } else {
        None
    };
    std::iter::once(at).chain(across)
}
