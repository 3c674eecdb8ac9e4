//! Monte Carlo: every hinge is off by random amounts, every panel is moved by all hinges on its way from the root.

use super::histogram::Histogram;
use super::normal::Normal;
use super::{Chain, HingeErrors, Spread};
use glam::{DAffine3, DQuat, DVec3};
use zygote_stacking::CutEdge;

/// What the samples amount to.
pub(super) struct Sampled {
    pub(super) panels: Spread,
    pub(super) gaps: Spread,
    /// Of every panel.
    pub(super) panel_mean_squares: Vec<f64>,
}

/// Draws samples; the same seed gives the same ones.
pub(super) fn sample(
    chain: &Chain,
    cut_edges: &[CutEdge],
    errors: HingeErrors,
    samples: usize,
    seed: u64,
) -> Sampled {
    let count = chain.corners.len();
    let mut normal = Normal::new(seed);
    let (mut panels, mut gaps) = (Histogram::default(), Histogram::default());
    let mut sums = vec![0.0; count];
    let mut displaced = vec![DAffine3::IDENTITY; count];
    for _ in 0..samples {
        displace(chain, errors, &mut normal, &mut displaced);
        for (panel, displacement) in displaced.iter().enumerate() {
            let centre = chain.centre(panel);
            let off = displacement.transform_point3(centre).distance(centre);
            sums[panel] += off * off;
            panels.add(off);
        }
        for cut_edge in cut_edges {
            let [p, q] = cut_edge.panels.map(|panel| displaced[panel]);
            let square = |end: DVec3| p.transform_point3(end).distance_squared(q.transform_point3(end));
            gaps.add((chain.ends(cut_edge).map(square).iter().sum::<f64>() / 2.0).sqrt());
        }
    }
    Sampled {
        panels: panels.spread(),
        gaps: gaps.spread(),
        panel_mean_squares: sums.iter().map(|sum| sum / samples.max(1) as f64).collect(),
    }
}

/// For every panel the motion from its place in the target to where random errors bring it.
pub(super) fn displace(chain: &Chain, errors: HingeErrors, normal: &mut Normal, displaced: &mut [DAffine3]) {
    displaced[chain.root] = DAffine3::IDENTITY;
    for joint in &chain.joints {
        let turn = DQuat::from_axis_angle(joint.axis, errors.angle_rad * normal.next());
        let offset = DVec3::from_array([0; 3].map(|_| normal.next())) * errors.offset;
        let at_hinge = DAffine3::from_translation(joint.anchor + offset)
            * DAffine3::from_quat(turn)
            * DAffine3::from_translation(-joint.anchor);
        displaced[joint.child] = displaced[joint.parent] * at_hinge;
    }
}
