//! Ticks, what stands at them, and the titles of axes.

use super::{EM, GAP, Plot, TITLE_ROOM};
use crate::figures::FigureError;
use crate::figures::canvas::{Canvas, Lettering, Pen};
use crate::figures::clip::Rectangle;
use crate::figures::palette::BLACK;
use crate::figures::ticks::Ticks;
use plotters::style::text_anchor::HPos;

/// Size of the letters of titles of axes, pixels.
const TITLE_EM: f64 = 13.0;
/// Length of labelled ticks and of small ones, pixels.
const TICKS: (f64, f64) = (6.0, 3.0);

impl Plot<'_> {
    /// Ticks on all four sides, to the inside.
    pub(super) fn draw_ticks(&self, canvas: &mut Canvas<'_>, area: &Rectangle) -> Result<(), FigureError> {
        let pen = Pen { ink: BLACK, thickness: 1.0 };
        let both = |ticks: &Ticks| {
            let labelled = ticks.labelled.iter().map(|(value, _)| (*value, TICKS.0));
            labelled.chain(ticks.small.iter().map(|value| (*value, TICKS.1))).collect::<Vec<_>>()
        };
        for (value, length) in both(&self.ticks.0) {
            let (x, _) = self.place(area, value, self.ends.1.0);
            canvas.line(&[(x, area.bottom()), (x, area.bottom() - length)], pen)?;
            canvas.line(&[(x, area.top), (x, area.top + length)], pen)?;
        }
        for (value, length) in both(&self.ticks.1) {
            let (_, y) = self.place(area, self.ends.0.0, value);
            canvas.line(&[(area.left, y), (area.left + length, y)], pen)?;
            canvas.line(&[(area.right(), y), (area.right() - length, y)], pen)?;
        }
        Ok(())
    }

    /// What stands at the ticks, and the titles of the axes.
    pub(super) fn draw_labels(&self, canvas: &mut Canvas<'_>, area: &Rectangle) -> Result<(), FigureError> {
        let style = |em: f64, side: HPos| Lettering { ink: BLACK, em, side, upright: false };
        if self.said.0 {
            let line = area.bottom() + GAP + EM;
            for (value, label) in &self.ticks.0.labelled {
                let (x, _) = self.place(area, *value, self.ends.1.0);
                canvas.text(label, (x, line), style(EM, HPos::Center))?;
            }
            let line = line + TITLE_ROOM - GAP;
            let title = self.chart.x.title();
            canvas.text(&title, (area.left + area.width / 2.0, line), style(TITLE_EM, HPos::Center))?;
            let factor = &self.ticks.0.factor;
            if !factor.is_empty() {
                canvas.text(factor, (area.right(), line), style(EM, HPos::Right))?;
            }
        }
        if self.said.1 {
            for (value, label) in &self.ticks.1.labelled {
                let (_, y) = self.place(area, self.ends.0.0, *value);
                canvas.text(label, (area.left - GAP, y + 0.36 * EM), style(EM, HPos::Right))?;
            }
            let upright = Lettering { upright: true, ..style(TITLE_EM, HPos::Center) };
            let place = (area.left - self.left() + TITLE_EM, area.top + area.height / 2.0);
            canvas.text(&self.chart.y.title(), place, upright)?;
            if self.crowned() {
                let place = (area.left - GAP, area.top - 5.0);
                canvas.text(&self.ticks.1.factor, place, style(EM, HPos::Left))?;
            }
        }
        Ok(())
    }
}
