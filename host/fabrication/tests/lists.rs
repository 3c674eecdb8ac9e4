//! The bill and the assembly sheet against the plan.

#![expect(clippy::unwrap_used, reason = "what cannot be read fails the test")]

mod shapes;

use shapes::planned;
use std::path::PathBuf;
use zygote_deployment::Rig;
use zygote_fabrication::{Assembly, Bill, Drives, Holes, Magnet, Panel, Rim, Screws, assembly};
use zygote_stacking::{HingeKind, Plan, Sequence};

const PANEL: Panel = Panel { side_mm: 90.0, thickness_mm: 4.5, rim: Rim::Round, holes: Holes::None };

fn drives(plan: &Plan, rig: &str) -> Drives {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models/rigs").join(rig);
    let rig = Rig::read(rig, &std::fs::read_to_string(path).unwrap()).unwrap();
    Drives::of(plan, &rig).unwrap()
}

fn count(bill: &Bill, part: &str, detail: &str) -> usize {
    bill.items
        .iter()
        .filter(|item| item.part == part && item.detail.contains(detail))
        .map(|item| item.count)
        .sum()
}

fn html(plan: &Plan, drives: Option<&Drives>) -> String {
    assembly(&Assembly { plan, panel: &PANEL, drives }).unwrap()
}

fn pages(html: &str) -> Vec<&str> {
    html.split("<section class=\"page\">").skip(1).collect()
}

#[test]
fn a_bill_counts_hinges_by_kind_and_angle_and_what_holds_them() {
    let plan = planned("fish92.txt", 4);
    let magnets = Panel { holes: Holes::Magnets(Magnet::default()), ..PANEL };
    let bill = Bill::new(&plan, &magnets, None);
    assert_eq!(count(&bill, "panel", "90 x 90 x 4.5 mm"), 92);
    assert_eq!(count(&bill, "magnet", "2 x 30 mm"), 368, "as the paper has it");
    for (kind, word) in [(HingeKind::Fold, "fold"), (HingeKind::Bridge, "bridge")] {
        for angle in [90, 180, 270] {
            let expected =
                plan.hinges.iter().filter(|hinge| hinge.kind == kind && hinge.opening_deg == angle).count();
            assert_eq!(count(&bill, "hinge", &format!("{word}, opens to {angle} degrees")), expected);
        }
    }
    assert_eq!(bill.total, 92 + 368 + 91);
    let screws = Panel { holes: Holes::Screws(Screws::default()), ..PANEL };
    assert_eq!(count(&Bill::new(&plan, &screws, None), "screw", "2.2 mm"), 364);
}

#[test]
fn with_a_rig_the_bill_has_channels_and_sensors_of_every_board_in_use() {
    let plan = planned("i14.txt", 2);
    let bill = Bill::new(&plan, &PANEL, Some(&drives(&plan, "mixed.toml")));
    // Two hinges of alloy, two of springs, servos the rest.
    for (part, detail, expected) in [
        ("hinge", "sma, ", 2),
        ("hinge", "spring, ", 2),
        ("hinge", "servo, ", 9),
        ("board", "nucleo", 1),
        ("MOSFET channel", "heater, nucleo", 2),
        ("MOSFET channel", "burn wire or latch, nucleo", 2),
        ("thermistor", "nucleo", 2),
        ("servo channel", "nucleo", 9),
    ] {
        assert_eq!(count(&bill, part, detail), expected, "{part} {detail}");
    }
}

#[test]
fn a_bill_says_the_same_as_csv_json_and_table() {
    let plan = planned("i14.txt", 2);
    let bill = Bill::new(&plan, &PANEL, Some(&drives(&plan, "mixed.toml")));
    let json: serde_json::Value = serde_json::from_str(&bill.json().unwrap()).unwrap();
    assert_eq!(json["total"], bill.total);
    let (csv, table) = (bill.csv(), bill.table());
    let (mut rows, mut lines) = (csv.lines().skip(1), table.lines());
    for (number, item) in bill.items.iter().enumerate() {
        assert_eq!(rows.next().unwrap(), format!("{},\"{}\",{}", item.part, item.detail, item.count));
        let line = lines.next().unwrap().trim_start();
        assert!(line.starts_with(&item.count.to_string()) && line.ends_with(&item.detail), "{line}");
        assert_eq!(json["items"][number]["count"], item.count);
    }
    assert_eq!(rows.next(), Some(format!("total,,{}", bill.total).as_str()));
    assert!(lines.next().unwrap().trim_start().starts_with(&bill.total.to_string()));
}

#[test]
fn every_hinge_is_mounted_once_at_its_side_when_both_its_panels_are_there() {
    let plan = planned("fish92.txt", 4);
    let html = html(&plan, None);
    let cards: Vec<&str> = html.split("<div class=\"card\">").skip(1).collect();
    assert_eq!(cards.len(), 92);
    let (mut laid, mut mounted) = (vec![false; 92], vec![0; 91]);
    for card in cards {
        let number =
            |text: &str| text.chars().take_while(char::is_ascii_digit).collect::<String>().parse::<usize>();
        let panel = number(card.strip_prefix("<h3>Panel ").unwrap()).unwrap();
        laid[panel] = true;
        for told in card.split("<li>Hinge ").skip(1) {
            let hinge = number(told).unwrap();
            mounted[hinge] += 1;
            let expected = &plan.hinges[hinge];
            assert!(
                expected.panels.contains(&panel) && expected.panels.iter().all(|panel| laid[*panel]),
                "{told}"
            );
            let side = if expected.panels[0] == panel || expected.kind == HingeKind::Fold {
                expected.side
            } else {
                expected.side.opposite()
            };
            assert!(told.contains(&format!(" at {} to ", side.letter())), "{told}");
            assert!(told.contains(&format!(" {}°.", expected.opening_deg)), "{told}");
        }
        assert_eq!(card.matches("class=\"bar").count(), card.matches("<li>Hinge ").count());
    }
    assert!(mounted.iter().all(|times| *times == 1), "{mounted:?}");
}

#[test]
fn a_small_shape_is_two_pages_and_names_the_channel_of_each_hinge() {
    let plan = planned("i14.txt", 2);
    let drives = drives(&plan, "mixed.toml");
    let html = html(&plan, Some(&drives));
    assert_eq!(pages(&html).len(), 2);
    assert_eq!(html.matches(" at nucleo, channel ").count(), plan.hinges.len());
}

#[test]
fn four_thousand_panels_are_a_few_pages_of_the_coded_sequence() {
    let plan = planned("fish4000.txt", 4);
    let html = html(&plan, None);
    let pages = pages(&html);
    assert!((12..20).contains(&pages.len()), "{}", pages.len());
    // All words of the sequence in its order, each after its panel's number.
    let found: Vec<String> = html
        .split("<span><b>")
        .skip(1)
        .map(|word| word.split("</span>").next().unwrap().replace("</b>", " "))
        .collect();
    let sequence = Sequence::of(&plan).to_string();
    let mut expected = Vec::new();
    for (line, pile) in sequence.lines().zip(&plan.piles) {
        for (word, panel) in line.split(' ').skip(1).zip(&pile.panels) {
            expected.push(format!("{panel} {word}"));
        }
    }
    assert_eq!(found, expected);
}
