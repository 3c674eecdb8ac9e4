//! Poses of plans on their way, and our verdicts on them, for programs that look at collisions of boxes. Arguments: a folder;
//! degrees from pose to pose; `forwards`, or `backwards` for the last hinge of the schedule first, come what may; then plan files that
//! hold a schedule with a certificate.
//!
//! Of every plan three files:
//!
//! * `NAME.json`: panels, half edges of a core, `touching` (deeper is a collision for us), `free` (whether
//!   nothing collides, as the certificate has it), the number of poses and of `one_by_one` ones among them, which come first, and the seconds
//!   that our verdicts took.
//! * `NAME.poses`: pose, panel, then the centre of its core and the directions of its three edges, as 12 doubles; only of
//!   panels that aren't where the pose before had them.
//! * `NAME.pairs`: pose, two panels, and how far their cores are apart along the direction that shows the most, below 0 the
//!   shortest way out of each other; three 32-bit numbers and a double.
//!
//! One by one, in the order of the schedule, every turn is sampled, ends included; pairs are those of a panel that moves and
//! one that doesn't. Then, of plans that are free, moments of runs where all that may move at once does, each hinge at a
//! speed of its own; pairs are all. Before both, all pairs in the zygote. Pairs whose centres are too far from each other for
//! two cores to meet are left out. All numbers are little endian.
#![expect(clippy::print_stdout, reason = "its output is what it is for")]
#![expect(clippy::unwrap_used, reason = "a tool for developers, as tests are")]

use glam::{DAffine3, DVec3};
use serde_json::json;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::{Duration, Instant};
use zygote_deployment::Order;
use zygote_deployment::dense::Scheduled;
use zygote_deployment::motion::{Cuboid, Linkage, Options, Thickness, check};
use zygote_stacking::fold;

/// Runs of hinges at once, and moments of each that are looked at.
const RUNS: u64 = 5;
const MOMENTS: u32 = 20;

/// Where the files go, and what is in them so far.
struct Out {
    poses: BufWriter<File>,
    pairs: BufWriter<File>,
    plates: Thickness,
    /// Where the pose before had the panels.
    frames: Vec<DAffine3>,
    count: u32,
    pairs_count: u64,
    took: Duration,
}

impl Out {
    fn new(folder: &Path, name: &str, plates: Thickness) -> Self {
        let file = |ending| BufWriter::new(File::create(folder.join(format!("{name}.{ending}"))).unwrap());
        let (poses, pairs) = (file("poses"), file("pairs"));
        Self { poses, pairs, plates, frames: Vec::new(), count: 0, pairs_count: 0, took: Duration::ZERO }
    }

    /// Half the edges of a core.
    fn half(&self) -> DVec3 {
        let side = 0.5 - self.plates.rim;
        DVec3::new(side, side, 0.5 * self.plates.thickness)
    }

    fn core(&self, pose: &DAffine3) -> Cuboid {
        let half = self.half();
        Cuboid {
            centre: pose.transform_point3(DVec3::new(0.5, 0.5, -half.z)),
            half: [DVec3::X * half.x, DVec3::Y * half.y, DVec3::Z * half.z]
                .map(|half| pose.transform_vector3(half)),
        }
    }

    /// Writes a pose, and our verdict on every two panels that are asked for.
    fn pose(&mut self, frames: &[DAffine3], asked: impl Fn(usize, usize) -> bool) {
        let reach = 2.0 * self.half().length();
        let cores: Vec<_> = frames.iter().map(|frame| self.core(frame)).collect();
        for (panel, (core, frame)) in cores.iter().zip(frames).enumerate() {
            if self.frames.get(panel) == Some(frame) {
                continue;
            }
            for number in [self.count, u32::try_from(panel).unwrap()] {
                self.poses.write_all(&number.to_le_bytes()).unwrap();
            }
            let axes = frame.matrix3;
            for vector in [core.centre, axes.x_axis, axes.y_axis, axes.z_axis] {
                for number in vector.to_array() {
                    self.poses.write_all(&number.to_le_bytes()).unwrap();
                }
            }
        }
        self.frames = frames.to_vec();
        let mut near = Vec::new();
        for (a, core) in cores.iter().enumerate() {
            let met = cores[..a].iter().enumerate().filter(|(b, other)| {
                asked(a, *b) && core.centre.distance_squared(other.centre) <= reach * reach
            });
            near.extend(met.map(|(b, _)| (a, b)));
        }
        let begin = Instant::now();
        let gaps: Vec<_> = near.iter().map(|(a, b)| cores[*a].gap(&cores[*b])).collect();
        self.took += begin.elapsed();
        for ((a, b), gap) in near.into_iter().zip(gaps) {
            for number in [self.count, u32::try_from(a).unwrap(), u32::try_from(b).unwrap()] {
                self.pairs.write_all(&number.to_le_bytes()).unwrap();
            }
            self.pairs.write_all(&gap.to_le_bytes()).unwrap();
            self.pairs_count += 1;
        }
        self.count += 1;
    }
}

/// Every turn of the order, one after the other.
fn one_by_one(out: &mut Out, linkage: &Linkage, order: &Order, step_deg: f64) {
    let mut fractions = vec![0.0; linkage.hinges()];
    out.pose(&linkage.poses_at(&fractions), |_, _| true);
    for hinge in &order.hinges {
        let mut moves = vec![false; linkage.panels()];
        linkage.moved(*hinge).for_each(|panel| moves[panel] = true);
        let samples = (linkage.turn_deg(*hinge) / step_deg).ceil();
        let mut sample = 0.0;
        while sample <= samples && samples > 0.0 {
            fractions[*hinge] = sample / samples;
            out.pose(&linkage.poses_at(&fractions), |a, b| moves[a] != moves[b]);
            sample += 1.0;
        }
        fractions[*hinge] = 1.0;
    }
}

/// Numbers from 0 to below 1 (`SplitMix64`).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        f64::from(u32::try_from((z ^ (z >> 31)) >> 32).unwrap()) / (f64::from(u32::MAX) + 1.0)
    }
}

/// Moments of runs in which every hinge starts soon after all that it waits for are open.
fn at_once(out: &mut Out, linkage: &Linkage, order: &Order) {
    for seed in 0..RUNS {
        let mut random = Random(seed);
        let mut times = vec![[0.0, 0.0]; linkage.hinges()];
        for hinge in &order.hinges {
            let ready = order.waits_for[*hinge].iter().map(|other| times[*other][1]).fold(0.0, f64::max);
            let start = ready + (random.next() - 0.5).max(0.0);
            times[*hinge] = [start, start + 8_f64.powf(-random.next())];
        }
        let all = times.iter().map(|[_, end]| *end).fold(0.0, f64::max);
        for moment in 0..MOMENTS {
            let now = all * (f64::from(moment) + random.next()) / f64::from(MOMENTS);
            let fraction = |[start, end]: &[f64; 2]| ((now - start) / (end - start)).clamp(0.0, 1.0);
            let fractions: Vec<_> = times.iter().map(fraction).collect();
            out.pose(&linkage.poses_at(&fractions), |_, _| true);
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, step, way, plans @ ..] = arguments.as_slice() else {
        panic!("expected FOLDER DEGREES forwards|backwards PLAN.fold...");
    };
    let (folder, step_deg) = (Path::new(folder), step.parse::<f64>().unwrap());
    assert!(step_deg > 0.0, "expected degrees above 0, found {step_deg}");
    for path in plans {
        let stem = Path::new(path).file_stem().unwrap().to_str().unwrap();
        let mut plan = fold::read(&fs::read(path).unwrap()).unwrap();
        let schedule = plan.schedule.take().unwrap_or_else(|| panic!("{path}: no schedule"));
        let Scheduled { mut order, certificate, .. } = Scheduled::read(&plan, &schedule).unwrap();
        let proved = certificate.unwrap_or_else(|| panic!("{path}: no certificate"));
        let plates = Thickness { thickness: proved.thickness, rim: proved.rim };
        let (mut name, mut free) = (stem.to_owned(), proved.is_free());
        if way == "backwards" {
            name = format!("{stem}-backwards");
            order = Order::one_by_one(order.hinges.into_iter().rev().collect());
            free = check(&plan, &order.hinges, plates, &Options::default()).unwrap().is_free();
        }
        let linkage = Linkage::new(&plan, plates).unwrap();
        let mut out = Out::new(folder, &name, plates);
        one_by_one(&mut out, &linkage, &order, step_deg);
        let poses_one_by_one = out.count;
        if free {
            at_once(&mut out, &linkage, &order);
        }
        out.poses.flush().unwrap();
        out.pairs.flush().unwrap();
        let head = json!({
            "name": name,
            "panels": plan.panels(),
            "half": out.half().to_array(),
            "touching": plates.touching(),
            "free": free,
            "poses": out.count,
            "one_by_one": poses_one_by_one,
            "pairs": out.pairs_count,
            "seconds": out.took.as_secs_f64(),
        });
        fs::write(folder.join(format!("{name}.json")), head.to_string()).unwrap();
        println!("{name}: {} poses, {} pairs", out.count, out.pairs_count);
    }
}
