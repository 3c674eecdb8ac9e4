//! Panels and stacks as bodies: closed, of the right volume, with room for the magnet, and apart from each other.

#![expect(clippy::unwrap_used, reason = "what cannot be read fails the test")]

mod shapes;

use proptest::prelude::*;
use shapes::planned;
use std::collections::BTreeMap;
use zygote_fabrication::{
    Gaps, Holes, Magnet, Panel, PanelError, Point, Rim, Screws, Soup, Stack, StlError, stl,
};

/// Sides of the holes' prisms.
const MAGNET_SIDES: f64 = 12.0;
const SCREW_SIDES: f64 = 24.0;

fn panel(rim: Rim, holes: Holes) -> Panel {
    Panel { side_mm: 90.0, thickness_mm: 4.8, rim, holes }
}

fn every_panel() -> Vec<Panel> {
    let holes = [Holes::None, Holes::Magnets(Magnet::default()), Holes::Screws(Screws::default())];
    [Rim::Square, Rim::Round].into_iter().flat_map(|rim| holes.map(|holes| panel(rim, holes))).collect()
}

/// Every edge has two triangles, which run along it in opposite directions, and none is without area.
fn is_closed(soup: &[[[u32; 3]; 3]]) -> Result<(), String> {
    let mut edges: BTreeMap<_, i32> = BTreeMap::new();
    for triangle in soup {
        for corner in 0..3 {
            let (from, to) = (triangle[corner], triangle[(corner + 1) % 3]);
            if from == to {
                return Err(format!("an edge without length at {from:?}"));
            }
            *edges.entry((from, to)).or_default() += 1;
        }
    }
    match edges.iter().find(|((from, to), count)| **count != 1 || edges.get(&(*to, *from)) != Some(&1)) {
        None => Ok(()),
        Some((edge, count)) => Err(format!("{edge:?} runs {count} times")),
    }
}

fn single_bits(soup: &Soup) -> Vec<[[u32; 3]; 3]> {
    #[expect(clippy::cast_possible_truncation, reason = "as the file has it")]
    let bits = |value: f64| (value as f32).to_bits();
    soup.triangles.iter().map(|triangle| triangle.map(|point| point.map(bits))).collect()
}

/// The volume from areas of sections, which are quadratic in the height between two corners of the profile: Simpson's rule is exact.
fn volume_by_sections(panel: &Panel) -> f64 {
    let half = panel.thickness_mm / 2.0;
    let round = |z: f64| match panel.rim {
        Rim::Square => panel.side_mm / 2.0,
        Rim::Round => panel.side_mm / 2.0 - half + (half * half - z * z).max(0.0).sqrt(),
    };
    let mut levels = vec![-half, half];
    let mut hole: Vec<(f64, f64)> = Vec::new();
    if let Holes::Magnets(magnet) = panel.holes {
        let radius = magnet.hole_mm() / 2.0 / (std::f64::consts::PI / MAGNET_SIDES).cos();
        hole = (0..=6)
            .map(|k| f64::from(k * 30 - 90).to_radians().sin() * radius)
            .map(|z| (z, (radius * radius - z * z).max(0.0).sqrt()))
            .collect();
        levels.extend(hole.iter().map(|(z, _)| *z));
    }
    if panel.rim == Rim::Round {
        levels.extend((1..8).map(|k| (f64::from(k) * 22.5 - 90.0).to_radians().sin() * half));
    }
    levels.sort_by(f64::total_cmp);
    // Both the reach and the hole's width are straight between their corners.
    let straight = |points: &[(f64, f64)], z: f64| {
        points.windows(2).find(|w| (w[0].0..=w[1].0).contains(&z)).map_or(0.0, |w| {
            let share = (z - w[0].0) / (w[1].0 - w[0].0).max(1e-300);
            w[0].1 * (1.0 - share) + w[1].1 * share
        })
    };
    let profile: Vec<_> = levels.iter().map(|z| (*z, round(*z))).collect();
    let area = |z: f64| {
        let reach = straight(&profile, z);
        let mut area = 4.0 * reach * reach;
        if let Holes::Magnets(magnet) = panel.holes {
            area -= 4.0 * 2.0 * straight(&hole, z) * (reach + magnet.length_mm / 2.0);
        }
        if let Holes::Screws(screws) = panel.holes {
            let radius = screws.diameter_mm / 2.0 / (std::f64::consts::PI / SCREW_SIDES).cos();
            area -= 8.0 * SCREW_SIDES / 2.0 * radius * radius * (std::f64::consts::TAU / SCREW_SIDES).sin();
        }
        area
    };
    let simpson =
        |w: &[f64]| (w[1] - w[0]) / 6.0 * (area(w[0]) + 4.0 * area(f64::midpoint(w[0], w[1])) + area(w[1]));
    levels.windows(2).map(simpson).sum()
}

/// Whether a point is inside, by the solid angle of all triangles.
fn is_inside(soup: &Soup, point: Point) -> bool {
    let minus = |a: Point| [0, 1, 2].map(|axis| a[axis] - point[axis]);
    let dot = |a: Point, b: Point| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let length = |a: Point| dot(a, a).sqrt();
    let angle = |[a, b, c]: [Point; 3]| {
        let triple = a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
        let (la, lb, lc) = (length(a), length(b), length(c));
        2.0 * triple.atan2(la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    };
    let turns: f64 = soup.triangles.iter().map(|triangle| angle(triangle.map(minus))).sum();
    turns > std::f64::consts::TAU
}

/// The triangles of a file, read as the format's description says.
fn read_stl(bytes: &[u8]) -> Vec<[[f32; 3]; 3]> {
    let word = |at: usize| <[u8; 4]>::try_from(&bytes[at..at + 4]).unwrap();
    let count = u32::from_le_bytes(word(80)) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    assert_ne!(&bytes[..5], b"solid");
    let number = |at: usize| f32::from_le_bytes(word(at));
    (0..count)
        .map(|triangle| {
            let at = 84 + 50 * triangle;
            [0, 1, 2].map(|corner| [0, 1, 2].map(|axis| number(at + 12 + 12 * corner + 4 * axis)))
        })
        .collect()
}

#[test]
fn every_body_is_closed_and_its_volume_is_that_of_its_sections() {
    for panel in every_panel() {
        let body = panel.body().unwrap();
        is_closed(&single_bits(&body)).unwrap_or_else(|why| panic!("{panel:?}: {why}"));
        let (found, expected) = (body.volume(), volume_by_sections(&panel));
        assert!((found - expected).abs() < 1e-6 * expected, "{panel:?}: {found} {expected}");
    }
}

#[test]
fn a_square_panel_without_holes_is_a_cuboid_of_twelve_triangles() {
    let body = panel(Rim::Square, Holes::None).body().unwrap();
    assert_eq!(body.triangles.len(), 12);
    assert!((body.volume() - 90.0 * 90.0 * 4.8).abs() < 1e-9);
}

#[test]
fn a_magnet_slides_from_the_side_to_its_middle_and_has_wall_all_around() {
    for rim in [Rim::Square, Rim::Round] {
        let magnet = Magnet::default();
        let panel = panel(rim, Holes::Magnets(magnet));
        let body = panel.body().unwrap();
        // From 14.9 mm beyond the middle out to the side, and a little wider than the magnet.
        for x in [14.9, 0.0, -14.9, -30.0, -44.9] {
            for step in 0..16 {
                let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 16.0).sin_cos();
                for (radius, inside) in [(0.0, false), (1.0, false), (1.04, false), (1.12, true), (1.4, true)]
                {
                    // Near the round rim the outside is near as well.
                    if x < -40.0 && inside {
                        continue;
                    }
                    let point = [x, -42.6 + radius * cos, radius * sin];
                    assert_eq!(is_inside(&body, point), inside, "{rim:?} {point:?}");
                    // And the same at the three other sides.
                    let turned = [42.6 - radius * cos, x, radius * sin];
                    assert_eq!(is_inside(&body, turned), inside, "{rim:?} {turned:?}");
                }
            }
        }
        assert!(is_inside(&body, [15.1, -42.6, 0.0]), "the hole ends where the magnet does");
        assert!(!is_inside(&body, [-45.1, -42.6, 0.0]), "the hole is open");
    }
}

#[test]
fn a_screw_goes_through_every_hole() {
    let screws = Screws::default();
    let body = panel(Rim::Round, Holes::Screws(screws)).body().unwrap();
    for [x, y] in screws.middles(90.0) {
        for z in [-2.3, 0.0, 2.3] {
            assert!(!is_inside(&body, [x, y, z]) && !is_inside(&body, [x + 1.05, y, z]));
            assert!(is_inside(&body, [x * 0.9, y * 0.9, z]));
        }
    }
}

#[test]
fn in_a_printed_stack_every_panel_is_closed_and_the_gap_is_what_was_asked_for() {
    let plan = planned("fish92.txt", 4);
    let panel = panel(Rim::Round, Holes::Magnets(Magnet::default()));
    let gaps = Gaps { layers_mm: 0.2, piles_mm: 0.3 };
    let stack = Stack::new(&plan, &panel, gaps).unwrap();
    let bytes = stl(&stack, gaps).unwrap();
    assert_eq!(bytes, stl(&stack, gaps).unwrap(), "the same bytes again");
    let triangles = read_stl(&bytes);
    assert_eq!(triangles.len(), stack.triangles());
    let bits: Vec<_> =
        triangles.iter().map(|triangle| triangle.map(|point| point.map(f32::to_bits))).collect();
    is_closed(&bits).unwrap();
    // A body after the other, as the panels are numbered.
    let boxes: Vec<[[f32; 2]; 3]> = triangles
        .chunks(triangles.len() / plan.panels())
        .map(|body| {
            [0, 1, 2].map(|axis| {
                let values = || body.iter().flatten().map(|point| point[axis]);
                [values().fold(f32::INFINITY, f32::min), values().fold(f32::NEG_INFINITY, f32::max)]
            })
        })
        .collect();
    let mut narrowest = [f32::INFINITY; 3];
    for (number, a) in boxes.iter().enumerate() {
        for b in &boxes[..number] {
            let between = [0, 1, 2].map(|axis| (a[axis][0] - b[axis][1]).max(b[axis][0] - a[axis][1]));
            let widest = between.into_iter().fold(f32::NEG_INFINITY, f32::max);
            let axis = between.iter().position(|gap| *gap >= widest).unwrap();
            narrowest[axis] = narrowest[axis].min(widest);
        }
    }
    assert!((narrowest[2] - 0.2).abs() < 1e-4, "{narrowest:?}");
    for (axis, cells) in plan.grid().into_iter().enumerate() {
        if cells > 1 {
            assert!((narrowest[axis] - 0.3).abs() < 1e-4, "{narrowest:?}");
        } else {
            assert!(narrowest[axis].is_infinite(), "{narrowest:?}");
        }
        let most = boxes.iter().map(|bounds| bounds[axis][1]).fold(0.0, f32::max);
        assert!((f64::from(most) - stack.box_mm[axis]).abs() < 1e-4);
    }
    assert!(boxes.iter().flatten().all(|[low, _]| *low >= 0.0));
}

#[test]
fn the_papers_stack_of_92_panels_has_the_papers_height() {
    let plan = planned("fish92.txt", 2);
    let stack = Stack::new(&plan, &panel(Rim::Round, Holes::None), Gaps::default()).unwrap();
    // 23 cm in the paper.
    assert!((stack.box_mm[2] - (46.0 * 4.8 + 45.0 * 0.2)).abs() < 1e-9, "{:?}", stack.box_mm);
}

#[test]
fn holes_that_open_to_another_pile_are_counted() {
    let with = |holes| {
        let stack = Stack::new(&planned("fish92.txt", 2), &panel(Rim::Round, holes), Gaps::default());
        stack.unwrap().hidden_holes
    };
    assert_eq!(with(Holes::Magnets(Magnet::default())), 92);
    assert_eq!(with(Holes::None), 0);
}

#[test]
fn what_cannot_be_is_refused_with_the_least_that_could() {
    let magnets = |side_mm, thickness_mm| Panel {
        side_mm,
        thickness_mm,
        rim: Rim::Round,
        holes: Holes::Magnets(Magnet::default()),
    };
    let told = |panel: Panel| panel.check().unwrap_err().to_string();
    assert_eq!(
        told(magnets(90.0, 0.9)),
        "magnet hole: 2.17 mm wide with 0.4 mm of wall on either face needs a panel 2.97 mm thick or more, got 0.90 mm"
    );
    assert!(told(magnets(30.0, 4.8)).contains("needs a panel side of 37.77 mm or more, got 30.00 mm"));
    assert!(told(magnets(f64::NAN, 4.8)).contains("panel side: expected a length above 0 mm, got NaN"));
    assert!(told(magnets(4.0, 4.8)).contains("got 4.8 mm of thickness on 4 mm"));
    let screws = |inset_mm, apart_mm| Panel {
        holes: Holes::Screws(Screws { diameter_mm: 2.2, inset_mm, apart_mm }),
        ..magnets(20.0, 2.0)
    };
    assert!(told(screws(2.0, 6.0)).contains("expected 2.50 mm or more from the side"));
    assert!(told(screws(3.0, 2.5)).contains("the two of a side leave 0.30 mm of wall"));
    assert!(told(screws(3.0, 12.0)).contains("those of two sides leave -0.79 mm"));
    let plan = planned("cube6.txt", 1);
    let touching = Gaps { layers_mm: 0.0, piles_mm: 0.2 };
    let refusal = Stack::new(&plan, &magnets(90.0, 4.8), touching).unwrap_err();
    assert_eq!(refusal, PanelError::Length { what: "gap between layers", found: 0.0 });
    // A tower of kilometres.
    let coarse = Gaps { layers_mm: 1e-6, piles_mm: 0.2 };
    let stack = Stack::new(&plan, &magnets(90.0, 4.8), coarse).unwrap();
    assert!(matches!(stl(&stack, coarse), Err(StlError::Coarse { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_panel_that_is_allowed_is_closed(
        side_mm in 5.0..300.0,
        thickness_mm in 0.3..12.0,
        round in any::<bool>(),
        kind in 0..3,
        diameter_mm in 0.5..6.0,
        length_mm in 1.0..120.0,
    ) {
        let holes = match kind {
            0 => Holes::None,
            1 => Holes::Magnets(Magnet { diameter_mm, length_mm, clearance_mm: 0.1 }),
            _ => Holes::Screws(Screws { diameter_mm, inset_mm: 2.0 * diameter_mm, apart_mm: length_mm }),
        };
        let rim = if round { Rim::Round } else { Rim::Square };
        let panel = Panel { side_mm, thickness_mm, rim, holes };
        prop_assume!(panel.check().is_ok());
        let body = panel.body().unwrap();
        {
            prop_assert!(is_closed(&single_bits(&body)).is_ok(), "{:?}", is_closed(&single_bits(&body)));
            let (found, expected) = (body.volume(), volume_by_sections(&panel));
            prop_assert!((found - expected).abs() < 1e-6 * expected, "{found} {expected}");
        }
    }
}
