//! No part of a figure covers another.

use super::*;
use crate::figures::axis::Axis;
use crate::figures::chart::{Colour, Marker, Series};
use crate::figures::clip::Rectangle;
use cell::lettered;
use roxmltree::Document;

/// Two panels with different series under one legend.
fn figure(legend: Legend) -> Figure {
    let series = |number: usize| {
        let points = (0..20).map(|x| (f64::from(x), libm::sin(f64::from(x)) * (number + 1) as f64, 0.3));
        Series::points(
            &format!("a long label, number {number}"),
            Colour::Category(number),
            Marker::Circle,
            points,
        )
    };
    let chart = |first: usize| {
        let axes = (Axis::linear("t", "T"), Axis::linear("n_c / L^2", "R_0^{-2}"));
        Panel::Chart(Chart::new("", axes.0, axes.1).with(series(first)).with(series(first + 1)))
    };
    Figure { legend, ..Figure::new("title", [chart(0), chart(1), chart(3)]) }
}

/// The middles of all circles, pixels.
fn circles(svg: &str) -> Vec<(f64, f64)> {
    let document = Document::parse(svg).unwrap();
    let nodes = document.descendants().filter(|node| node.has_tag_name("circle"));
    let number = |text: Option<&str>| text.unwrap().parse::<f64>().unwrap() / 10.0;
    nodes.map(|node| (number(node.attribute("cx")), number(node.attribute("cy")))).collect()
}

fn apart(one: &Rectangle, other: &Rectangle) -> bool {
    one.right() <= other.left
        || other.right() <= one.left
        || one.bottom() <= other.top
        || other.bottom() <= one.top
}

#[test]
fn all_points_are_in_their_areas_and_legends_are_not() {
    for legend in [Legend::Right, Legend::Below] {
        let figure = figure(legend);
        let layout = Layout::new(&figure).unwrap();
        let (entries, place) = layout.legend.as_ref().unwrap();
        assert!(entries.clear());
        let page = Rectangle { left: 0.0, top: 0.0, width: layout.size.0, height: layout.size.1 };
        for (number, cell) in layout.cells.iter().enumerate() {
            assert!(apart(&cell.area, place), "{legend:?}: {place:?} covers {:?}", cell.area);
            assert!(layout.cells.iter().skip(number + 1).all(|other| apart(&cell.area, &other.area)));
        }
        for place in layout.cells.iter().map(|cell| &cell.area).chain([place]) {
            assert!(page.contains((place.left, place.top)) && page.contains((place.right(), place.bottom())));
        }
        let circles = circles(&layout.svg().unwrap());
        let inside = |area: &Rectangle| circles.iter().filter(|circle| area.contains(**circle)).count();
        assert!(layout.cells.iter().all(|cell| inside(&cell.area) == 40));
        // Numbers 0, 1, 2, 3, 4, and nothing elsewhere.
        assert_eq!((inside(place), circles.len()), (5, 125));
    }
}

#[test]
fn panels_have_their_own_legends_where_one_look_means_two_things() {
    let mut figure = figure(Legend::Right);
    if let Some(Panel::Chart(chart)) = figure.panels.last_mut() {
        chart.series[0].colour = Colour::Category(0);
    }
    let layout = Layout::new(&figure).unwrap();
    assert!(layout.legend.is_none());
    let places: Vec<&Rectangle> = layout.cells.iter().map(|cell| &cell.legend.as_ref().unwrap().1).collect();
    for place in &places {
        assert!(layout.cells.iter().all(|cell| apart(&cell.area, place)), "{place:?}");
    }
    assert!(layout.cells.iter().all(|cell| cell.area.right() <= layout.size.0));
}

#[test]
fn letters_go_on_after_z() {
    assert_eq!([0, 25, 26, 53].map(lettered), ["(a)", "(z)", "(aa)", "(bb)"]);
}
