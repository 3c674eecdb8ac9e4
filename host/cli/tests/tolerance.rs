//! `zygote tolerance` as a user meets it: the tree beside the single strip.

#![expect(clippy::unwrap_used, reason = "a table without its lines fails the test")]

mod scratch;

use scratch::{Run, Scratch, model};

fn planned(name: &str, shape: &str, piles: &str) -> Scratch {
    let place = Scratch::new(name);
    let run = place.zygote(&["plan", &model(shape), "--piles", piles, "-o", "plan.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    place
}

/// The figures of a line: T, P, P/T.
#[track_caller]
fn figures(run: &Run, start: &str, nth: usize) -> [f64; 3] {
    let line = run.output.lines().filter(|line| line.trim().starts_with(start)).nth(nth).unwrap();
    let figures: Vec<f64> =
        line.trim()[start.len()..].split_whitespace().map(|word| word.parse().unwrap()).collect();
    figures.try_into().unwrap()
}

#[test]
fn tree_and_single_strip_stand_side_by_side_in_first_order_and_sampled() {
    let place = planned("tolerance_table", "fish144.txt", "4");
    let command =
        ["tolerance", "plan.fold", "--hinge-sigma", "0.1deg", "--gap", "0.01mm", "--samples", "400"];
    let run = place.zygote(&command);
    assert_eq!(run.code, 0, "{}", run.errors);
    for kind in 0..2 {
        let (first, sampled) = (figures(&run, "first order, rms", kind), figures(&run, "samples, rms", kind));
        for column in 0..2 {
            let off = (first[column] / sampled[column] - 1.0).abs();
            assert!(off < 0.1, "small errors: first order {first:?}, samples {sampled:?}");
        }
        let half = figures(&run, "50th percentile", kind);
        let most = figures(&run, "95th percentile", kind);
        let greatest = figures(&run, "greatest", kind);
        assert!(half[0] < most[0] && most[0] < greatest[0], "{}", run.output);
    }
    let depth = figures(&run, "depth in hinges", 0);
    assert!(depth[1] >= 71.0 && depth[0] < depth[1], "a strip of 144 from its middle: {depth:?}");
    assert_eq!(place.zygote(&command).output, run.output, "the same seed, the same figures");
    let other = place.zygote(&[&command[..], &["--seed", "1"]].concat());
    assert_ne!(other.output, run.output);
}

#[test]
fn errors_grow_with_those_of_the_hinges() {
    let place = planned("tolerance_grows", "fish92.txt", "2");
    let first = |sigma: &str, gap: &str| {
        let run =
            place.zygote(&["tolerance", "plan.fold", "--hinge-sigma", sigma, "--gap", gap, "--samples", "0"]);
        assert_eq!(run.code, 0, "{}", run.errors);
        figures(&run, "first order, rms", 0)[0]
    };
    assert!((first("2deg", "0mm") / first("1deg", "0mm") - 2.0).abs() < 1e-3);
    assert!((first("0deg", "500um") / first("0deg", "0.1mm") - 5.0).abs() < 5e-2);
}

#[test]
fn the_errors_are_drawn_for_both() {
    let place = planned("tolerance_svg", "l14.txt", "2");
    let run = place.zygote(&["tolerance", "plan.fold", "--samples", "20", "--svg", "errors.svg"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    let svg = place.read("errors.svg");
    assert!(svg.contains("Tree T") && svg.contains("Single strip P"), "{svg}");
}

#[test]
fn a_sheet_in_one_row_has_no_gaps() {
    let place = Scratch::new("tolerance_row");
    place.write("row.seq", "(0,0): E180 W180 E180 .\n");
    assert_eq!(place.zygote(&["sequence", "--parse", "row.seq", "-o", "row.fold"]).code, 0);
    let run = place.zygote(&["tolerance", "row.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.ends_with("no cut edges close in this shape: no gaps\n"), "{}", run.output);
}

#[test]
fn quantities_without_a_unit_or_out_of_range_are_refused() {
    let place = planned("tolerance_refused", "cube6.txt", "1");
    for (options, told) in [
        (["--hinge-sigma", "1"], "an angle with its unit"),
        (["--hinge-sigma", "1mm"], "an angle with its unit"),
        (["--hinge-sigma", "90deg"], "from 0 to 45 deg"),
        (["--gap", "0.1"], "a length with its unit"),
        (["--gap=-1mm", "--samples=1"], "at least 0 mm"),
        (["--samples", "9999999"], "a whole number, 0 to 1000000"),
    ] {
        let arguments = [&["tolerance", "plan.fold", "--svg", "out.svg"][..], &options].concat();
        let run = place.zygote(&arguments);
        assert_eq!(run.code, 2, "{options:?}");
        assert!(run.errors.contains(told), "{options:?}: {}", run.errors);
    }
    assert_eq!(place.zygote(&["tolerance", "none.fold"]).code, 2);
    assert_eq!(place.files(), ["plan.fold"]);
}
