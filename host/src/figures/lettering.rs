//! Texts with parts set lower or higher.

use super::font;

/// The sign of negative numbers.
pub(super) const MINUS: &str = "\u{2212}";

/// How a part of a text stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Height {
    Line,
    Lower,
    Higher,
}

impl Height {
    /// Size of letters, of those on the line.
    pub(super) fn size(self) -> f64 {
        if self == Self::Line { 1.0 } else { 0.7 }
    }

    /// How far letters stand above the line, of the size of those on the line.
    pub(super) fn rise(self) -> f64 {
        match self {
            Self::Line => 0.0,
            Self::Lower => -0.22,
            Self::Higher => 0.42,
        }
    }
}

/// The parts of a text: `_c`, `_{ab}` lower, `^2`, `^{-2}` higher. A sign at the end is itself, as is one
/// after `\`.
pub(super) fn parts(text: &str) -> Vec<(String, Height)> {
    let mut parts: Vec<(String, Height)> = Vec::new();
    let mut put = |letters: &str, height: Height| match parts.last_mut() {
        Some((last, same)) if *same == height => last.push_str(letters),
        _ => parts.push((letters.to_owned(), height)),
    };
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let after = &rest[letter.len_utf8()..];
        let height = match letter {
            '_' => Height::Lower,
            '^' => Height::Higher,
            _ => Height::Line,
        };
        if let Some(sign) = after.chars().next().filter(|sign| letter == '\\' && "_^\\".contains(*sign)) {
            put(&sign.to_string(), Height::Line);
            rest = &after[sign.len_utf8()..];
        } else if height == Height::Line || after.is_empty() {
            put(&letter.to_string(), Height::Line);
            rest = after;
        } else if let Some((inside, behind)) = after.strip_prefix('{').and_then(|open| open.split_once('}')) {
            put(&inside.replace('-', MINUS), height);
            rest = behind;
        } else {
            let next = after.chars().next().map_or(0, char::len_utf8);
            put(&after[..next].replace('-', MINUS), height);
            rest = &after[next..];
        }
    }
    parts
}

/// The parts of a text in letters of `em` pixels, each with how far after the text's begin it starts, and the width of
/// all, pixels. What is higher stands above what is lower before it. Spaces at the ends of parts are room.
pub(super) fn placed(text: &str, em: f64) -> (Vec<(String, Height, f64)>, f64) {
    let (mut placed, mut end) = (Vec::new(), 0.0_f64);
    let mut lower_start = None;
    for (letters, height) in parts(text) {
        let size = em * height.size();
        let start = if height == Height::Higher { lower_start.unwrap_or(end) } else { end };
        lower_start = (height == Height::Lower).then_some(end);
        end = end.max(start + font::width(&letters, size));
        let shown = letters.trim_start();
        let room = font::width(&letters[..letters.len() - shown.len()], size);
        placed.push((shown.trim_end().to_owned(), height, start + room));
    }
    (placed, end)
}

/// Width of a text in letters of `em` pixels, pixels.
pub(super) fn width(text: &str, em: f64) -> f64 {
    placed(text, em).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_set_the_next_letter_or_those_in_braces() {
        let found = parts(r"n_c / L^{-2}\_x^");
        let found: Vec<(&str, Height)> =
            found.iter().map(|(text, height)| (text.as_str(), *height)).collect();
        let (line, lower, higher) = (Height::Line, Height::Lower, Height::Higher);
        assert_eq!(found, [("n", line), ("c", lower), (" / L", line), ("\u{2212}2", higher), ("_x^", line)]);
    }
}
