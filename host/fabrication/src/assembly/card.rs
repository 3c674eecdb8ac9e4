//! A card a panel: where it is laid, and which hinges are mounted then.

use super::Assembly;
use crate::mounts::{Mount, Mounts, Towards, by_side};
use crate::svg::escaped;
use std::fmt::Write as _;
use zygote_stacking::Plan;

/// How a reader understands the cards.
pub(super) const HOW: &str = "<p>One card a panel, in the order in which they are laid: a layer of all piles, then the next. You look from above; \
    N is the side of the stack away from you.</p><p>A bold bar is a hinge to mount now, broad for a bridge to the next pile; a dashed one comes \
    later. Blue is a valley of the shape, red a mountain, green stays flat, all seen on the outer side. The angle is what the \
    hinge opens to, measured where the two panels touch, of a bridge on the outer side.</p>";

/// A panel to lay.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub(super) panel: usize,
    pile: usize,
    height: usize,
}

/// All panels, layer by layer.
pub(super) fn in_order(plan: &Plan) -> Vec<Step> {
    let layer = |height: usize| {
        let step = move |(pile, of): (usize, &zygote_stacking::Pile)| {
            Some(Step { panel: *of.panels.get(height)?, pile, height })
        };
        plan.piles.iter().enumerate().filter_map(step).collect::<Vec<_>>()
    };
    (0..plan.height()).flat_map(layer).collect()
}

/// The card of a panel.
pub(super) fn card(about: &Assembly<'_>, mounts: &[Mounts], step: &Step) -> String {
    let Assembly { plan, drives, .. } = about;
    let Step { panel, pile, height } = *step;
    let [i, j] = plan.piles[pile].cell;
    let below = height.checked_sub(1).map(|below| plan.piles[pile].panels[below]);
    let places = plan.places();
    // Of a bridge the second panel is there when the later one is laid.
    let now = |mount: &Mount| match mount.towards {
        Towards::Below => true,
        Towards::Above => false,
        Towards::Beside => places[mount.to].0 < pile,
    };
    let up = if height.is_multiple_of(2) { "outer" } else { "inner" };
    let mut html = format!(
        "<div class=\"card\"><h3>Panel {panel}<small>cell ({i},{j}), height {height}</small></h3>\n{}<ul><li>Lay it {}, {up} side up.{}</li>",
        drawing(panel, up, &mounts[panel], now),
        below.map_or_else(|| "down".to_owned(), |below| format!("on {below}")),
        if panel == plan.root { " It stays fixed." } else { "" },
    );
    for (side, mount) in by_side(&mounts[panel]).filter(|(_, mount)| now(mount)) {
        let Mount { hinge, to, towards, fold, opening_deg } = mount;
        let drive = drives
            .and_then(|drives| drives.words(hinge))
            .map_or_else(String::new, |words| format!(", {words}"));
        let _infallible = write!(
            html,
            "<li>Hinge {hinge} at {} to {to} {}: {} {opening_deg}°{}.</li>",
            side.letter(),
            towards.name(),
            fold.name(),
            escaped(&drive),
        );
    }
    if below.is_some() && !mounts[panel].iter().flatten().any(|mount| mount.towards == Towards::Below) {
        html.push_str("<li>No hinge to the panel below.</li>");
    }
    html.push_str("</ul></div>\n");
    html
}

/// The panel from above with its hinges.
fn drawing(panel: usize, up: &str, mounts: &Mounts, now: impl Fn(&Mount) -> bool) -> String {
    let mut svg = format!(
        "<svg viewBox=\"-14 0 128 100\"><rect class=\"panel {up}\" x=\"20\" y=\"20\" width=\"60\" height=\"60\"/>\
         <text class=\"north\" x=\"10\" y=\"14\">N ↑</text><text class=\"number\" x=\"50\" y=\"57\">{panel}</text>"
    );
    for (side, mount) in by_side(mounts) {
        let [x, y] = side.step().map(f64::from);
        let (middle_x, middle_y) = (50.0 + 30.0 * x, 50.0 - 30.0 * y);
        let (along_x, along_y) = (21.0 * y.abs(), 21.0 * x.abs());
        let class = if now(&mount) {
            let broad = if mount.towards == Towards::Beside { " bridge" } else { "" };
            format!("bar{broad} {}", mount.fold.name())
        } else {
            "to-come".to_owned()
        };
        let _infallible = write!(
            svg,
            "<path class=\"{class}\" d=\"M{} {}L{} {}\"/>",
            middle_x - along_x,
            middle_y - along_y,
            middle_x + along_x,
            middle_y + along_y
        );
        if now(&mount) {
            // Beyond the bar.
            let [x, y] = [50.0 + 45.0 * x, 53.0 - 40.0 * y];
            let _infallible = write!(svg, "<text x=\"{x}\" y=\"{y}\">{}°</text>", mount.opening_deg);
        }
    }
    svg.push_str("</svg>\n");
    svg
}
