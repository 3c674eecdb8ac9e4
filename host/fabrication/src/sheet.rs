//! Panels laid out on sheets, pile by pile from the bottom up, each with its number and its hinges.
//!
//! A panel is drawn as it lies in the stack, seen from above: the engraved face is up, north is where its number has its head.

use crate::drawing::{Cut, Drawing, Engraved};
use crate::mounts::{Mount, by_side, mounts};
use crate::panel::{Holes, Panel, PanelError, length};
use zygote_stacking::{Plan, Side};

/// What panels are cut from, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    /// Width, millimetres.
    pub width_mm: f64,
    /// Height, millimetres.
    pub height_mm: f64,
    /// What stays free at its border, millimetres.
    pub margin_mm: f64,
    /// What stays between two cuts, millimetres.
    pub spacing_mm: f64,
    /// Width of the cut, millimetres: lines are half of it beside the panel.
    pub kerf_mm: f64,
}

impl Default for Sheet {
    /// A common bed, plastic, a laser.
    fn default() -> Self {
        Self { width_mm: 600.0, height_mm: 400.0, margin_mm: 5.0, spacing_mm: 2.0, kerf_mm: 0.2 }
    }
}

/// Panels that can't be laid out.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SheetError {
    /// A panel that can't be made.
    #[error(transparent)]
    Panel(#[from] PanelError),
    /// A length that isn't one.
    #[error("sheet: {what}: expected 0 mm or more, got {found} mm")]
    Length {
        /// Which length.
        what: &'static str,
        /// What was given.
        found: f64,
    },
    /// Not one panel fits.
    #[error(
        "sheet: a panel of {side} mm with its cuts and the margins takes {needed:.1} x {needed:.1} mm, got a sheet of {width} x \
         {height} mm"
    )]
    NoRoom {
        /// Side of a panel, millimetres.
        side: f64,
        /// What it takes each way, millimetres.
        needed: f64,
        /// Width of the sheet, millimetres.
        width: f64,
        /// Height of the sheet, millimetres.
        height: f64,
    },
}

/// Lays out all panels of a plan.
///
/// # Errors
/// [`SheetError`] if a panel can't be made, or none fits on a sheet.
pub fn sheets(plan: &Plan, panel: &Panel, sheet: &Sheet) -> Result<Vec<Drawing>, SheetError> {
    // A magnet's hole lies inside the sheet, where no cutter gets: whether it had room is no question here.
    let holes = if matches!(panel.holes, Holes::Screws(_)) { panel.holes } else { Holes::None };
    let panel = Panel { holes, ..*panel };
    panel.check()?;
    let [columns, rows] = sheet.cells(panel.side_mm)?;
    let numbers: Vec<(usize, usize, usize)> = plan
        .piles
        .iter()
        .enumerate()
        .flat_map(|(pile, of)| {
            of.panels.iter().enumerate().map(move |(height, number)| (pile, height, *number))
        })
        .collect();
    let mounts = mounts(plan);
    let step = panel.side_mm + sheet.kerf_mm + sheet.spacing_mm;
    let count = numbers.len().div_ceil(columns * rows);
    let drawing = |(page, on_it): (usize, &[(usize, usize, usize)])| {
        let mut drawing = Drawing {
            title: format!("{}: sheet {} of {count}", plan.source.model, page + 1),
            size_mm: [sheet.width_mm, sheet.height_mm],
            cuts: Vec::new(),
            texts: Vec::new(),
        };
        for (place, (pile, height, number)) in on_it.iter().enumerate() {
            let [column, row] = [place % columns, place / columns].map(|cell| cell as f64);
            let first = sheet.margin_mm + f64::midpoint(sheet.kerf_mm, panel.side_mm);
            // From the upper left, as one reads.
            let middle = [first + column * step, sheet.height_mm - first - row * step];
            cut(&mut drawing, &panel, sheet.kerf_mm, middle);
            let about = Labels { plan, panel: &panel, number: *number, middle };
            about.place(&mut drawing, *pile, *height);
            for (side, mount) in by_side(&mounts[*number]) {
                about.hinge(&mut drawing, side, &mount);
            }
        }
        drawing
    };
    Ok(numbers.chunks(columns * rows).enumerate().map(drawing).collect())
}

impl Sheet {
    /// How many panels fit across and down.
    fn cells(&self, side: f64) -> Result<[usize; 2], SheetError> {
        length("sheet width", self.width_mm)?;
        length("sheet height", self.height_mm)?;
        for (what, found) in
            [("margin", self.margin_mm), ("spacing", self.spacing_mm), ("kerf", self.kerf_mm)]
        {
            if !(found.is_finite() && found >= 0.0) {
                return Err(SheetError::Length { what, found });
            }
        }
        let needed = side + self.kerf_mm + 2.0 * self.margin_mm;
        let fit = |room: f64| {
            let more = (room - needed) / (side + self.kerf_mm + self.spacing_mm);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 or a few hundred")]
            let more = (more + 1e-9).floor() as usize;
            more + 1
        };
        let (width, height) = (self.width_mm, self.height_mm);
        if width + 1e-9 < needed || height + 1e-9 < needed {
            return Err(SheetError::NoRoom { side, needed, width, height });
        }
        Ok([fit(width), fit(height)])
    }
}

fn cut(drawing: &mut Drawing, panel: &Panel, kerf: f64, middle: [f64; 2]) {
    let half = f64::midpoint(panel.side_mm, kerf);
    // Holes first: what is cut out moves.
    if let Holes::Screws(screws) = panel.holes {
        for [x, y] in screws.middles(panel.side_mm) {
            let radius = ((screws.diameter_mm - kerf) / 2.0).max(0.0);
            drawing.cuts.push(Cut::Circle { middle: [middle[0] + x, middle[1] + y], radius });
        }
    }
    drawing.cuts.push(Cut::Rectangle {
        low: middle.map(|middle| middle - half),
        high: middle.map(|middle| middle + half),
    });
}

/// The texts of one panel.
struct Labels<'a> {
    plan: &'a Plan,
    panel: &'a Panel,
    number: usize,
    middle: [f64; 2],
}

impl Labels<'_> {
    /// Its number, and where it lies.
    fn place(&self, drawing: &mut Drawing, pile: usize, height: usize) {
        let side = self.panel.side_mm;
        let mut line = |text: String, size: f64, up: f64| {
            let foot = [self.middle[0], self.middle[1] + up * side];
            drawing.texts.push(Engraved::new(text, size * side, foot, 0));
        };
        line(self.number.to_string(), 0.1, 0.0);
        line(format!("PILE {pile} HEIGHT {height}"), 0.03, -0.07);
        let up = if height.is_multiple_of(2) { "OUTER SIDE UP" } else { "INNER SIDE UP" };
        let stays = if self.number == self.plan.root { " STAYS" } else { "" };
        line(format!("{up}{stays}"), 0.03, -0.12);
    }

    /// A hinge along its side, read from that side.
    fn hinge(&self, drawing: &mut Drawing, side: Side, mount: &Mount) {
        let free = match self.panel.holes {
            Holes::Screws(screws) => screws.inset_mm + screws.diameter_mm,
            Holes::None | Holes::Magnets(_) => self.panel.side_mm * 0.05,
        };
        let out = self.panel.side_mm / 2.0 - free;
        let [x, y] = side.step().map(f64::from);
        let quarters = match side {
            Side::S => 0,
            Side::E => 1,
            Side::N => 2,
            Side::W => 3,
        };
        let Mount { hinge, to, towards, fold, opening_deg } = mount;
        let text =
            format!("{hinge} {}{opening_deg} TO {to} {}", fold.letter(), towards.name().to_uppercase());
        let foot = [self.middle[0] + x * out, self.middle[1] + y * out];
        drawing.texts.push(Engraved::new(text, self.panel.side_mm * 0.03, foot, quarters));
    }
}
