//! Cut sheets, read back from both formats.

#![expect(clippy::unwrap_used, reason = "what cannot be read fails the test")]

mod shapes;

use shapes::planned;
use std::collections::BTreeMap;
use zygote_fabrication::{
    Cut, Drawing, Holes, Magnet, Panel, Rim, Screws, Sheet, SheetError, dxf, mounts, sheets, svg,
};
use zygote_stacking::{Plan, Side};

const PANEL: Panel =
    Panel { side_mm: 90.0, thickness_mm: 3.0, rim: Rim::Square, holes: Holes::Screws(SCREWS) };
const SCREWS: Screws = Screws { diameter_mm: 2.2, inset_mm: 5.0, apart_mm: 12.0 };

fn fish() -> (Plan, Vec<Drawing>) {
    let plan = planned("fish92.txt", 4);
    let drawings = sheets(&plan, &PANEL, &Sheet::default()).unwrap();
    (plan, drawings)
}

fn rectangles(drawing: &Drawing) -> Vec<([f64; 2], [f64; 2])> {
    let rectangle = |cut: &Cut| match *cut {
        Cut::Rectangle { low, high } => Some((low, high)),
        Cut::Circle { .. } => None,
    };
    drawing.cuts.iter().filter_map(rectangle).collect()
}

#[test]
fn every_panel_is_cut_once_half_a_kerf_wide_and_clear_of_its_neighbours_and_the_border() {
    let (plan, drawings) = fish();
    // 6 x 4 on a sheet.
    assert_eq!(
        drawings.iter().map(|drawing| rectangles(drawing).len()).collect::<Vec<_>>(),
        [24, 24, 24, 20]
    );
    for drawing in &drawings {
        let rectangles = rectangles(drawing);
        for (number, (low, high)) in rectangles.iter().enumerate() {
            for axis in 0..2 {
                assert!((high[axis] - low[axis] - 90.2).abs() < 1e-9);
                assert!(low[axis] >= 5.0 - 1e-9 && high[axis] <= drawing.size_mm[axis] - 5.0 + 1e-9);
            }
            for (other_low, other_high) in &rectangles[..number] {
                let apart =
                    (0..2).map(|axis| (low[axis] - other_high[axis]).max(other_low[axis] - high[axis]));
                assert!(apart.fold(f64::NEG_INFINITY, f64::max) >= 2.0 - 1e-9);
            }
        }
        assert_eq!(drawing.cuts.len(), 9 * rectangles.len(), "two holes at each side");
    }
    let numbers: Vec<usize> = drawings
        .iter()
        .flat_map(|drawing| &drawing.texts)
        .filter_map(|text| text.text.parse().ok())
        .collect();
    let by_pile: Vec<usize> = plan.piles.iter().flat_map(|pile| pile.panels.clone()).collect();
    assert_eq!(numbers, by_pile, "pile by pile from the bottom up");
}

#[test]
fn a_panel_says_its_place_and_every_hinge_at_its_side_and_no_line_leaves_it() {
    let (plan, drawings) = fish();
    let (mounts, places) = (mounts(&plan), plan.places());
    let mut said = 0;
    for drawing in &drawings {
        for (low, high) in rectangles(drawing) {
            let middle = [f64::midpoint(low[0], high[0]), f64::midpoint(low[1], high[1])];
            let on_it: BTreeMap<&str, Vec<[f64; 2]>> = drawing
                .texts
                .iter()
                .map(|text| (text.text.as_str(), text.strokes.concat()))
                .filter(|(_, points)| (0..2).all(|axis| (points[0][axis] - middle[axis]).abs() < 45.0))
                .collect();
            let number: usize = on_it.keys().find_map(|text| text.parse().ok()).unwrap();
            let (pile, height) = places[number];
            assert!(on_it.contains_key(format!("PILE {pile} HEIGHT {height}").as_str()), "{on_it:?}");
            for point in on_it.values().flatten() {
                assert!((0..2).all(|axis| (point[axis] - middle[axis]).abs() < 43.0), "{point:?}");
                for [x, y] in SCREWS.middles(90.0) {
                    let off = (point[0] - middle[0] - x).hypot(point[1] - middle[1] - y);
                    assert!(off > 1.1, "a line runs into a hole: {point:?}");
                }
            }
            for (side, mount) in Side::ALL.into_iter().zip(mounts[number]) {
                let Some(mount) = mount else { continue };
                let (to, towards) = (mount.to, mount.towards.name().to_uppercase());
                let text =
                    format!("{} {}{} TO {to} {towards}", mount.hinge, mount.fold.letter(), mount.opening_deg);
                let points = &on_it[text.as_str()];
                let out: f64 = points
                    .iter()
                    .map(|point| {
                        let [x, y] = side.step().map(f64::from);
                        (point[0] - middle[0]) * x + (point[1] - middle[1]) * y
                    })
                    .sum();
                assert!(out / points.len() as f64 > 30.0, "{text} is not at side {side:?}");
                said += 1;
            }
        }
    }
    assert_eq!(said, 2 * plan.hinges.len(), "each hinge at both its panels");
}

#[test]
fn an_svg_has_the_sheets_lines_in_two_layers_and_its_size_in_millimetres() {
    let (_, drawings) = fish();
    for drawing in &drawings {
        let text = svg(drawing);
        let file = roxmltree::Document::parse(&text).unwrap();
        let root = file.root_element();
        assert_eq!(root.attribute("width"), Some("600mm"));
        assert_eq!(root.attribute("viewBox"), Some("0 0 600 400"));
        let layer = |id: &str| root.children().find(|node| node.attribute("id") == Some(id)).unwrap();
        let lines = |id: &str| layer(id).children().filter(roxmltree::Node::is_element).collect::<Vec<_>>();
        let cut = lines("cut");
        assert_eq!(cut.len(), drawing.cuts.len());
        for (line, cut) in cut.iter().zip(&drawing.cuts) {
            match *cut {
                Cut::Circle { middle: [x, y], radius } => {
                    let number = |name: &str| line.attribute(name).unwrap().parse::<f64>().unwrap();
                    let off = [number("cx") - x, number("cy") - (400.0 - y), number("r") - radius];
                    assert!(off.iter().all(|off| off.abs() < 6e-4), "{off:?}");
                }
                Cut::Rectangle { low, high } => {
                    let path = line.attribute("d").unwrap();
                    let run = path.strip_prefix('M').unwrap().strip_suffix('z').unwrap();
                    let corners: Vec<f64> = run.split(['L', ' ']).map(|part| part.parse().unwrap()).collect();
                    let expected = [
                        low[0],
                        400.0 - low[1],
                        high[0],
                        400.0 - low[1],
                        high[0],
                        400.0 - high[1],
                        low[0],
                        400.0 - high[1],
                    ];
                    assert_eq!(corners.len(), 8);
                    assert!(corners.iter().zip(expected).all(|(a, b)| (a - b).abs() < 6e-4), "{path}");
                }
            }
        }
        let engraved = lines("engrave");
        assert_eq!(engraved.len(), drawing.texts.len());
        for (line, text) in engraved.iter().zip(&drawing.texts) {
            assert_eq!(line.attribute("aria-label"), Some(text.text.as_str()));
            assert_eq!(line.attribute("d").unwrap().matches('M').count(), text.strokes.len());
        }
    }
}

/// Layer, closed or not, corners.
type Polyline = (String, bool, Vec<[f64; 2]>);

/// The polylines and the circles of a file: layer, and points.
fn read_dxf(text: &str) -> (Vec<Polyline>, Vec<[f64; 3]>) {
    let lines: Vec<&str> = text.split("\r\n").collect();
    assert_eq!(lines.last(), Some(&""), "ends with a line's end");
    let pairs: Vec<(u16, &str)> =
        lines[..lines.len() - 1].chunks(2).map(|pair| (pair[0].parse().unwrap(), pair[1])).collect();
    assert_eq!(pairs.last(), Some(&(0, "EOF")));
    let version = pairs.iter().position(|pair| *pair == (9, "$ACADVER")).unwrap();
    assert_eq!(pairs[version + 1], (1, "AC1009"));
    let start = pairs.iter().position(|pair| *pair == (2, "ENTITIES")).unwrap();
    let layers: Vec<&str> =
        pairs[..start].windows(2).filter(|pair| pair[0] == (0, "LAYER")).map(|pair| pair[1].1).collect();
    let (mut polylines, mut circles): (Vec<Polyline>, _) = (Vec::new(), Vec::new());
    let mut entities: Vec<Vec<(u16, &str)>> = Vec::new();
    for pair in &pairs[start + 1..] {
        if pair.0 == 0 {
            entities.push(vec![*pair]);
        } else {
            entities.last_mut().unwrap().push(*pair);
        }
    }
    for entity in &entities {
        let value = |code: u16| entity.iter().find(|pair| pair.0 == code).map(|pair| pair.1);
        let number = |code: u16| value(code).unwrap().parse::<f64>().unwrap();
        match entity[0].1 {
            "POLYLINE" => polylines.push((value(8).unwrap().to_owned(), value(70) == Some("1"), Vec::new())),
            "VERTEX" => {
                let polyline = polylines.last_mut().unwrap();
                assert_eq!(value(8), Some(polyline.0.as_str()));
                polyline.2.push([number(10), number(20)]);
            }
            "CIRCLE" => circles.push([number(10), number(20), number(40)]),
            "SEQEND" | "ENDSEC" | "EOF" => {}
            other => panic!("{other} is no entity of ours"),
        }
        if let Some(layer) = value(8) {
            assert!(layers.contains(&layer), "{layer} is not in the table of layers");
        }
    }
    (polylines, circles)
}

#[test]
fn a_dxf_has_the_sheets_lines_and_every_layer_in_its_table() {
    let (_, drawings) = fish();
    for drawing in &drawings {
        let (polylines, circles) = read_dxf(&dxf(drawing));
        let (cut, engraved): (Vec<_>, Vec<_>) = polylines.iter().partition(|(layer, ..)| layer == "CUT");
        let rectangles = rectangles(drawing);
        assert_eq!(cut.len(), rectangles.len());
        for ((_, closed, corners), (low, high)) in cut.iter().zip(&rectangles) {
            assert!(closed);
            let expected = [*low, [high[0], low[1]], *high, [low[0], high[1]]];
            let off = corners.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs());
            assert!(corners.len() == 4 && off.fold(0.0, f64::max) < 6e-4, "{corners:?}");
        }
        assert_eq!(circles.len(), 8 * rectangles.len());
        assert!(
            circles.iter().all(|[.., radius]| (radius - 1.0).abs() < 1e-9),
            "half a kerf less than 1.1 mm"
        );
        let strokes: Vec<_> = drawing.texts.iter().flat_map(|text| &text.strokes).collect();
        assert_eq!(engraved.len(), strokes.len());
        for ((layer, closed, points), stroke) in engraved.iter().zip(strokes) {
            assert!(layer == "ENGRAVE" && !closed);
            let off = points.iter().flatten().zip(stroke.iter().flatten()).map(|(a, b)| (a - b).abs());
            assert!(points.len() == stroke.len() && off.fold(0.0, f64::max) < 6e-4);
        }
    }
}

#[test]
fn what_fits_exactly_fits_and_a_hair_less_is_refused_with_its_numbers() {
    let plan = planned("cube6.txt", 1);
    let on = |width_mm, height_mm| sheets(&plan, &PANEL, &Sheet { width_mm, height_mm, ..Sheet::default() });
    // Two panels of 90.2 mm, 2 mm between them, 5 mm of margin at either end.
    assert_eq!(on(192.4, 100.2).unwrap().len(), 3);
    assert_eq!(on(192.3, 100.2).unwrap().len(), 6);
    let refusal = on(192.4, 100.1).unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "sheet: a panel of 90 mm with its cuts and the margins takes 100.2 x 100.2 mm, got a sheet of 192.4 x 100.1 mm"
    );
    let kerf = Sheet { kerf_mm: -0.1, ..Sheet::default() };
    assert_eq!(sheets(&plan, &PANEL, &kerf).unwrap_err(), SheetError::Length { what: "kerf", found: -0.1 });
    assert!(on(f64::INFINITY, 100.2).unwrap_err().to_string().starts_with("sheet width: expected a length"));
}

#[test]
fn a_panel_too_thin_for_its_magnets_can_still_be_cut() {
    let plan = planned("cube6.txt", 1);
    let thin = Panel { thickness_mm: 0.9, holes: Holes::Magnets(Magnet::default()), ..PANEL };
    let drawings = sheets(&plan, &thin, &Sheet::default()).unwrap();
    assert_eq!(drawings[0].cuts.len(), 6, "outlines alone");
}
