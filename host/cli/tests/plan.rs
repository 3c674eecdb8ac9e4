//! `zygote plan` as a user meets it: files, messages, exit codes.

mod scratch;

use scratch::{Scratch, model};

#[test]
fn a_plan_is_written_and_its_summary_printed() {
    let place = Scratch::new("plan_summary");
    let run = place.zygote(&["plan", &model("fish92.txt"), "--piles", "4", "-o", "fish.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(
        run.output.starts_with("fish.fold: N = 92 panels, K = 4 piles, 23 high, on 2 x 2 cells"),
        "{}",
        run.output
    );
    assert!(run.output.contains("can be bridges)\nroot: panel "), "{}", run.output);
    let (_, beside) = run.output.split_once("between neighbouring piles: ").unwrap_or_default();
    let numbers: Vec<usize> = beside.split(' ').filter_map(|word| word.parse().ok()).collect();
    assert!(matches!(numbers[..], [beside, most, ..] if 0 < beside && beside <= most), "{}", run.output);
    assert_eq!(place.files(), ["fish.fold"]);
}

#[test]
fn bridges_partition_and_grid_can_be_asked_for() {
    let place = Scratch::new("plan_options");
    let plan = |options: &[&str]| {
        let model = model("fish92.txt");
        let run = place.zygote(&[&["plan", &model, "--piles", "4", "-o", "fish.fold"], options].concat());
        (run.code, run.output + &run.errors)
    };
    for partition in ["mincut", "arcs", "auto"] {
        let (code, output) = plan(&["--partition", partition, "--bridges", "least"]);
        assert_eq!(code, 0, "{output}");
        assert!(output.contains("\nbridges: 3,") && output.contains("\nbreaks: 0,"), "{output}");
    }
    let (code, output) = plan(&["--grid", "4x1"]);
    assert!(code == 0 && output.contains("on 4 x 1 cells"), "{output}");
    let (code, output) = plan(&["--grid", "3x1"]);
    assert!(code == 2 && output.contains("a grid of 3 x 1 cells, expected room for 4 piles"), "{output}");
    let (code, output) = plan(&["--grid", "four"]);
    assert!(code == 2 && output.contains("'four', expected cells in x and y"), "{output}");
}

#[test]
fn a_plan_that_opens_freely_can_be_asked_for() {
    let place = Scratch::new("plan_free");
    let plan = |name: &str, options: &[&str]| {
        let model = model(name);
        let run = place.zygote(&[&["plan", &model, "-o", "free.fold", "--free"], options].concat());
        (run.code, run.output + &run.errors)
    };
    let (code, output) = plan("fish92.txt", &["ideal", "--piles", "4"]);
    assert!(code == 0 && output.contains("motion: free, from the root outwards"), "{output}");
    assert!(output.contains("\nbridges: 3,"), "around a base: {output}");
    let (code, output) = plan("l14.txt", &["thick", "--piles", "2", "--thickness", "0.05"]);
    assert!(code == 0 && output.contains("motion: free,"), "{output}");
    // Panels as thick as they are long don't open.
    let (code, output) = plan("i14.txt", &["thick", "--thickness", "0.4", "--tries", "1"]);
    assert!(code == 1 && output.contains("of 1 plans none opens freely"), "{output}");
}

#[test]
fn the_same_command_writes_the_same_bytes() {
    let place = Scratch::new("plan_bytes");
    for name in ["a.fold", "b.fold"] {
        assert_eq!(place.zygote(&["plan", &model("fish144.txt"), "--piles", "4", "-o", name]).code, 0);
    }
    assert_eq!(place.read("a.fold"), place.read("b.fold"));
}

#[test]
fn a_closed_mesh_is_cut_into_voxels_of_the_size_given() {
    let place = Scratch::new("plan_mesh");
    let run =
        place.zygote(&["plan", &model("house.stl"), "--voxel", "0.5", "--piles", "2", "-o", "house.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.contains("N = 280 panels"), "{}", run.output);
}

#[test]
fn a_closed_mesh_is_cut_into_the_number_of_panels_given_and_its_distance_told() {
    let place = Scratch::new("plan_panels");
    let run =
        place.zygote(&["plan", &model("bird.obj"), "--panels", "1000", "--piles", "4", "-o", "bird.fold"]);
    assert_eq!(run.code, 0, "{}", run.errors);
    assert!(run.output.contains("N = 1000 panels, K = 4 piles"), "{}", run.output);
    assert!(run.output.contains("distance to the mesh: Hausdorff"), "{}", run.output);
    assert!(place.read("bird.fold").contains("\"hausdorff_voxels\":"));
}

/// Runs `zygote plan` on something that can't be planned; the message goes to standard error, and no file is left.
#[track_caller]
fn assert_refused(name: &str, options: &[&str], code: i32, told: &[&str]) {
    let place = Scratch::new(&format!("plan_refused_{}", std::panic::Location::caller().line()));
    let file = model(name);
    let arguments = [&["plan", &file, "-o", "out.fold"][..], options].concat();
    let run = place.zygote(&arguments);
    assert_eq!(run.code, code, "{name}: {}", run.errors);
    for part in told.iter().copied().chain([name]) {
        assert!(run.errors.contains(part), "{name}: expected {part:?} in {}", run.errors);
    }
    assert!(place.files().is_empty(), "{name}: left {:?}", place.files());
}

#[test]
fn an_unknown_format_is_refused() {
    assert_refused("README.md", &[], 2, &["unknown format '.md', expected .txt"]);
}

#[test]
fn a_file_that_is_not_there_is_refused() {
    assert_refused("no_such.txt", &[], 2, &["cannot be read"]);
}

#[test]
fn empty_ragged_and_garbled_voxel_files_are_refused() {
    assert_refused("bad/empty.txt", &[], 2, &["empty: expected rows of '#' and '.'"]);
    assert_refused("bad/no_voxels.txt", &[], 2, &["no voxel is solid"]);
    assert_refused("bad/ragged.txt", &[], 2, &["line 2: a row of 2 characters, expected 3"]);
    assert_refused("bad/character.txt", &[], 2, &["line 2, column 2: found 'o', expected '#'"]);
}

#[test]
fn a_surface_in_several_pieces_is_refused_with_their_number_sizes_and_places() {
    let told = "the surface is in 2 pieces, expected one: 54 panels with the face at (0, 0, 0); 6 panels with the face at (1, 1, 1)";
    assert_refused("bad/cavity.txt", &[], 2, &[told]);
    assert_refused("bad/touching.txt", &[], 2, &["in 2 pieces"]);
}

#[test]
fn quads_that_are_none_on_the_lattice_are_refused_with_their_line() {
    assert_refused("bad/triangle.obj", &[], 2, &["line 5: a face with 3 corners, expected 4"]);
    assert_refused(
        "bad/off_lattice.obj",
        &[],
        2,
        &["line 4: vertex coordinate 1.5, expected a whole number", "give --voxel SIZE or --panels N"],
    );
    assert_refused(
        "bad/long.obj",
        &[],
        2,
        &["the face on line 6: corners", "expected a unit square", "give --voxel SIZE or --panels N"],
    );
    assert_refused("bad/twice.obj", &[], 2, &["the face on line 7", "the face on line 6", "every face once"]);
}

#[test]
fn a_mesh_without_a_voxel_size_is_refused_with_the_options_that_help() {
    for mesh in ["house.stl", "knot.off", "bird.obj"] {
        assert_refused(mesh, &[], 2, &["--voxel SIZE", "--panels N"]);
    }
}

#[test]
fn sheets_that_cross_or_turn_over_are_refused_with_the_place() {
    assert_refused(
        "bad/unlike.obj",
        &[],
        2,
        &["line 8", "line 9", "the same way along the edge (1, 0, 0) (1, 1, 0)"],
    );
    assert_refused("bad/crossing.obj", &[], 2, &["sheets cross at the edge (1, 0, 1) (1, 1, 1)", "line 15"]);
    assert_refused("bad/three.obj", &[], 2, &["sheets cross at the edge (1, 0, 0) (1, 1, 0)"]);
}

#[test]
fn a_mesh_with_a_hole_is_refused_with_the_number_of_open_edges() {
    assert_refused(
        "bad/hole.stl",
        &["--voxel", "1"],
        2,
        &["4 open edges", "the first from (0, 3, 0) to (0, 3, 2)"],
    );
    assert_refused("bad/bowl.obj", &["--panels", "1000"], 2, &["16 open edges", "close its holes"]);
    assert_refused(
        "bad/moebius.off",
        &["--voxel", "1"],
        2,
        &["edges between triangles of unlike orientation; the first from ("],
    );
}

#[test]
fn a_voxel_size_is_needed_for_a_mesh_and_only_for_a_mesh() {
    assert_refused("house.stl", &[], 2, &["give --voxel SIZE"]);
    assert_refused("house.stl", &["--voxel", "0"], 2, &["voxel size 0, expected a length above 0"]);
    assert_refused("house.stl", &["--voxel", "100"], 2, &["no voxel of size 100", "4 x 3 x 4"]);
    assert_refused(
        "house.stl",
        &["--voxel", "1e-6"],
        2,
        &["voxels of size 0.000001", "expected a larger size"],
    );
    assert_refused("i14.txt", &["--voxel", "1"], 2, &["for meshes only: this format has voxels already"]);
    assert_refused("i14.txt", &["--panels", "20"], 2, &["for meshes only: this format has voxels already"]);
}

#[test]
fn a_number_of_panels_that_no_solid_has_is_refused_with_the_nearest() {
    assert_refused("house.stl", &["--panels", "999"], 2, &["999 panels", "the nearest", "998 and 1000"]);
    assert_refused("house.stl", &["--panels", "8"], 2, &["8 panels", "6 and 10"]);
    assert_refused("house.stl", &["--panels", "0"], 2, &["0 panels", "one has: 6"]);
    let place = Scratch::new("plan_panels_and_voxel");
    let both = ["plan", &model("house.stl"), "--panels", "100", "--voxel", "1", "-o", "out.fold"];
    let run = place.zygote(&both);
    assert_eq!(run.code, 2, "{}", run.errors);
    assert!(place.files().is_empty());
}

#[test]
fn a_number_of_piles_that_does_not_divide_the_panels_is_refused() {
    let told = "92 panels don't make 3 equally high piles; the nearest numbers that do: 2 and 4";
    assert_refused("fish92.txt", &["--piles", "3"], 2, &[told]);
}

#[test]
fn a_sheet_without_a_strip_through_all_panels_fails_with_the_reason() {
    assert_refused("bad/cross.obj", &[], 1, &["4 panels have one neighbour only"]);
}

#[test]
fn a_folder_that_is_not_there_leaves_no_file() {
    let place = Scratch::new("plan_no_folder");
    let run = place.zygote(&["plan", &model("i14.txt"), "-o", "nowhere/i14.fold"]);
    assert_eq!(run.code, 1);
    assert!(run.errors.contains("nowhere/i14.fold: cannot be written"), "{}", run.errors);
    assert!(place.files().is_empty());
}
