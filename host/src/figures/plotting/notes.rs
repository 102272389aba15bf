//! What stands below a chart.

use super::{NOTE_LINE, Plot, drawn, has_place};
use crate::figures::FigureError;
use crate::figures::canvas::{Canvas, Lettering};
use crate::figures::chart::{Chart, Point};
use crate::figures::clip::Rectangle;
use crate::figures::lettering;
use crate::figures::palette::GREY;
use plotters::style::text_anchor::HPos;

/// Size of the letters of notes, pixels.
const NOTE_EM: f64 = 10.0;

impl Plot<'_> {
    /// Draws the notes, line by line.
    pub(super) fn draw_notes(&self, canvas: &mut Canvas<'_>, area: &Rectangle) -> Result<(), FigureError> {
        let below = area.bottom() + self.bottom() - NOTE_LINE * self.notes.len() as f64;
        for (number, note) in self.notes.iter().enumerate() {
            let line = below + NOTE_LINE * (number as f64 + 0.75);
            let style = Lettering { ink: GREY, em: NOTE_EM, side: HPos::Left, upright: false };
            canvas.text(note, (area.left, line), style)?;
        }
        Ok(())
    }
}

/// What stands below a chart: its note, and what of it cannot be seen.
pub(super) fn notes(chart: &Chart) -> Vec<String> {
    let all = || chart.series.iter().flat_map(|series| &series.points);
    let finite = |point: &&Point| point.x.is_finite() && point.y.is_finite();
    let lost = all().filter(finite).filter(|point| !has_place(chart, point)).count();
    let mut notes = Vec::new();
    if !chart.note.is_empty() {
        notes.push(chart.note.clone());
    }
    if drawn(chart).next().is_none() {
        notes.push("no data".to_owned());
    }
    match lost {
        0 => {}
        1 => notes.push("1 point at or below zero has no place on a logarithmic axis".to_owned()),
        _ => notes.push(format!("{lost} points at or below zero have no place on a logarithmic axis")),
    }
    notes
}

/// A note in lines that fit `width` pixels.
pub(super) fn wrapped(note: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in note.split_whitespace() {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match longer.filter(|line| lettering::width(line, NOTE_EM) <= width) {
            Some(line) => {
                lines.pop();
                lines.push(line);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}
