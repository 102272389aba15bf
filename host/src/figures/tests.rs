//! What all figures keep to, whatever is drawn.

use super::axis::{Axis, Scale};
use super::chart::{Chart, Colour, Dash, Marker, Point, Series, Style};
use super::{Discs, Figure, FigureError, PNG_SCALE, Panel, font};
use meniscus_core::torus::{Position, Torus};
use roxmltree::Document;

const STYLES: [Style; 4] = [
    Style::Points(Marker::Circle),
    Style::Line(Dash::Dashed),
    Style::PointsAndLine(Marker::OpenTriangle, Dash::Solid),
    Style::Band(Dash::DashDotted),
];

fn figure(scale: Scale, style: Style, points: &[Point]) -> Figure {
    let axis = |label: &str| Axis { scale, ..Axis::linear(label, "R_0") };
    let series = Series::styled("<one> & \"two\"", Colour::Ordered(0.5), style, points.to_vec());
    Figure::new("figure", [Panel::Chart(Chart::new("", axis("x"), axis("y")).with(series))])
}

/// All texts, put together.
fn texts(svg: &str) -> String {
    let document = Document::parse(svg).unwrap();
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    texts
        .map(|node| {
            assert_eq!(node.attribute("font-family"), Some(font::FAMILY));
            node.text().unwrap().trim().to_owned()
        })
        .collect::<Vec<_>>()
        .join(" ")
}

#[test]
fn the_same_figure_has_the_same_bytes_and_its_text_is_text() {
    let points = [(1.0, 2.0, 0.5), (2.0, 3.0, 0.1)].map(Point::from);
    for style in STYLES {
        let svg = figure(Scale::Linear, style, &points).svg().unwrap();
        assert_eq!(svg, figure(Scale::Linear, style, &points).svg().unwrap());
        assert!(texts(&svg).contains("<one> & \"two\""), "{}", texts(&svg));
    }
}

#[test]
fn no_numbers_break_a_figure() {
    let values = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        0.0,
        -1.0,
        1e308,
        -1e308,
        5e-324,
        1.0,
        1.0 + f64::EPSILON,
    ];
    for scale in [Scale::Linear, Scale::Log] {
        for style in STYLES {
            for (number, one) in values.into_iter().enumerate() {
                for other in values.into_iter().skip(number) {
                    let points = [(one, other, Some(other)), (other, one, None), (1.0, one, Some(one))];
                    let svg = figure(scale, style, &points.map(Point::from)).svg().unwrap();
                    Document::parse(&svg).unwrap();
                    let found =
                        ["NaN", "inf", "2147483647", "-2147483648"].into_iter().find(|bad| svg.contains(bad));
                    assert_eq!(found, None, "{scale:?} {style:?} {one} {other}");
                }
            }
        }
    }
}

#[test]
fn few_points_or_none_make_a_figure() {
    for scale in [Scale::Linear, Scale::Log] {
        for style in STYLES {
            let none = figure(scale, style, &[]).svg().unwrap();
            assert!(texts(&none).contains("no data"));
            for count in 1..4 {
                let svg = figure(scale, style, &vec![Point::from((3.0, 3.0, 0.0)); count]).svg().unwrap();
                assert!(!texts(&svg).contains("no data"));
                // Labels of ticks on both axes.
                assert!(texts(&svg).matches(char::is_numeric).count() > 4, "{}", texts(&svg));
            }
        }
    }
}

#[test]
fn a_logarithmic_axis_says_what_it_cannot_show() {
    let points = [(1.0, 1.0), (2.0, 0.0), (3.0, -4.0), (4.0, 10.0), (5.0, f64::NAN)].map(Point::from);
    let svg = figure(Scale::Log, Style::Points(Marker::Circle), &points).svg().unwrap();
    assert!(texts(&svg).contains("2 points at or below zero have no place on a logarithmic axis"));
    // Two points, and the sample in the legend.
    assert_eq!(svg.matches("<circle").count(), 3);
}

#[test]
fn points_outside_of_a_range_are_not_drawn() {
    let mut figure = figure(
        Scale::Linear,
        Style::Points(Marker::Circle),
        &[(0.5, 0.5), (0.5, 2.0), (-1.0, 0.5)].map(Point::from),
    );
    if let Some(Panel::Chart(chart)) = figure.panels.first_mut() {
        chart.x.range = Some((0.0, 1.0));
        chart.y.range = Some((0.0, 1.0));
    }
    assert_eq!(figure.svg().unwrap().matches("<circle").count(), 2);
}

#[test]
fn a_png_has_twice_the_figures_pixels_and_its_text_is_drawn() {
    let figure = figure(Scale::Linear, STYLES[0], &[(1.0, 2.0), (2.0, 3.0)].map(Point::from));
    let svg = figure.svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    let size = ["width", "height"]
        .map(|name| document.root_element().attribute(name).unwrap().parse::<u32>().unwrap());
    let picture = image::load_from_memory(&figure.png().unwrap()).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (PNG_SCALE * size[0], PNG_SCALE * size[1]));
    // The title, above the plotting area.
    let dark = picture.enumerate_pixels().filter(|(_, y, pixel)| *y < 70 && pixel.0 == [0; 3]).count();
    assert!(dark > 50, "{dark} black pixels above the plotting area");
}

#[test]
fn discs_have_their_size_and_those_of_clusters_are_red() {
    let torus = Torus::new(40.0).unwrap();
    let at = |x, y| Position { x: torus.fraction(x).unwrap(), y: torus.fraction(y).unwrap() };
    // The first is seen at all four corners.
    let positions = vec![at(0.2, 0.2), at(20.0, 10.0), at(20.0, 30.0)];
    let discs = Discs { torus, positions, clustered: vec![false, true], caption: String::new() };
    let figure = Figure { panel_width: 200.0, ..Figure::new("", [Panel::Discs(discs)]) };
    let picture = image::load_from_memory(&figure.png().unwrap()).unwrap().to_rgb8();
    // Ten pixels are 1 R0; the rim is mixed with white.
    let count = |colour: [u8; 3]| picture.pixels().filter(|pixel| pixel.0 == colour).count() as f64;
    let area = core::f64::consts::PI * 100.0;
    assert!((area - 70.0..area).contains(&count([228, 72, 32])), "{} of {area}", count([228, 72, 32]));
    let middle = picture.width() / 2;
    let red: Vec<u32> =
        picture.enumerate_pixels().filter(|pixel| pixel.2.0 == [228, 72, 32]).map(|pixel| pixel.1).collect();
    // Rows are counted from above.
    assert!(red.iter().all(|row| *row > middle));
    assert_eq!(figure.svg().unwrap().matches('M').count(), 6);
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let said = |figure: &Figure| figure.svg().unwrap_err().to_string();
    let none = Figure::new("nothing", []);
    assert!(matches!(none.svg(), Err(FigureError::NoPanels { .. })));
    assert_eq!(said(&none), "the figure \"nothing\" has no panels: give it at least one");
    for (scale, range) in
        [(Scale::Linear, (1.0, 1.0)), (Scale::Linear, (0.0, f64::NAN)), (Scale::Log, (0.0, 1.0))]
    {
        let mut figure = figure(scale, STYLES[0], &[]);
        if let Some(Panel::Chart(chart)) = figure.panels.first_mut() {
            chart.x.range = Some(range);
        }
        assert!(said(&figure).starts_with("the axis \"x\" has the range"), "{}", said(&figure));
    }
    let large = Figure { panel_width: f64::INFINITY, ..figure(Scale::Linear, STYLES[0], &[]) };
    assert!(said(&large).contains("at most 8000 a side"), "{}", said(&large));
}
