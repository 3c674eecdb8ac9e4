//! The panel as a thing: how long, how thick, which sides, which holes; and whether such a panel can be.

/// What a printer still prints and a cutter still leaves standing, millimetres: one line of a 0.4 mm nozzle.
pub const LEAST_WALL_MM: f64 = 0.4;

/// A panel that every pile is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// Length of its sides, millimetres.
    pub side_mm: f64,
    /// Its thickness, millimetres.
    pub thickness_mm: f64,
    /// Form of its four sides.
    pub rim: Rim,
    /// What is drilled into it.
    pub holes: Holes,
}

/// Form of a panel's sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rim {
    /// Upright.
    Square,
    /// Half a cylinder as thick as the panel: two panels roll on each other (paper, section 5).
    Round,
}

/// What is drilled into a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Holes {
    /// Nothing.
    None,
    /// Along each side a blind hole for a cylindrical magnet, which ends up at the middle of the side.
    Magnets(Magnet),
    /// At each side two holes through the panel, to screw or rivet a hinge on.
    Screws(Screws),
}

/// A cylindrical magnet: one along each side serves as a hinge of any angle (paper, section 5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Magnet {
    /// Its diameter, millimetres.
    pub diameter_mm: f64,
    /// Its length, millimetres.
    pub length_mm: f64,
    /// How much wider the hole is, millimetres.
    pub clearance_mm: f64,
}

/// Two holes at each side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screws {
    /// Diameter of the holes, millimetres.
    pub diameter_mm: f64,
    /// From the side to the middle of the holes, millimetres.
    pub inset_mm: f64,
    /// From one hole to the other, millimetres.
    pub apart_mm: f64,
}

/// A panel that can't be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PanelError {
    /// A length that isn't one.
    #[error("{what}: expected a length above 0 mm, got {found} mm")]
    Length {
        /// Which length.
        what: &'static str,
        /// What was given.
        found: f64,
    },
    /// Thicker than long.
    #[error(
        "panel: expected to be thinner than its sides are long, got {thickness} mm of thickness on {side} mm"
    )]
    Block {
        /// Side, millimetres.
        side: f64,
        /// Thickness, millimetres.
        thickness: f64,
    },
    /// No room for the hole between the faces.
    #[error(
        "magnet hole: {hole:.2} mm wide with {LEAST_WALL_MM} mm of wall on either face needs a panel {needed:.2} mm thick or more, \
         got {found:.2} mm"
    )]
    Thin {
        /// Diameter of the hole, millimetres.
        hole: f64,
        /// The least thickness, millimetres.
        needed: f64,
        /// The panel's thickness, millimetres.
        found: f64,
    },
    /// No room for the hole along the side.
    #[error(
        "magnet hole: a magnet of {magnet:.2} mm along each side, none in the way of another, needs a panel side of {needed:.2} mm \
         or more, got {found:.2} mm"
    )]
    Short {
        /// Length of the magnet, millimetres.
        magnet: f64,
        /// The least side, millimetres.
        needed: f64,
        /// The panel's side, millimetres.
        found: f64,
    },
    /// A screw hole too near to the rim.
    #[error("screw holes: expected {needed:.2} mm or more from the side to their middle, got {found:.2} mm")]
    Rim {
        /// The least distance, millimetres.
        needed: f64,
        /// The distance given, millimetres.
        found: f64,
    },
    /// Screw holes that run into each other.
    #[error("screw holes: {what} leave {found:.2} mm of wall, expected {LEAST_WALL_MM} mm or more")]
    Crowded {
        /// Which holes.
        what: &'static str,
        /// What is left between them, millimetres.
        found: f64,
    },
}

impl Magnet {
    /// Diameter of its hole, millimetres.
    pub fn hole_mm(&self) -> f64 {
        self.diameter_mm + self.clearance_mm
    }
}

impl Default for Magnet {
    /// The paper's: 2 mm wide, 30 mm long.
    fn default() -> Self {
        Self { diameter_mm: 2.0, length_mm: 30.0, clearance_mm: 0.1 }
    }
}

impl Screws {
    /// Middles of the eight holes, millimetres from the middle of the panel.
    pub fn middles(&self, side_mm: f64) -> [[f64; 2]; 8] {
        let (far, near) = (side_mm / 2.0 - self.inset_mm, self.apart_mm / 2.0);
        [
            [far, -near],
            [far, near],
            [near, far],
            [-near, far],
            [-far, near],
            [-far, -near],
            [-near, -far],
            [near, -far],
        ]
    }
}

impl Default for Screws {
    /// For M2, as far apart as a small hinge is wide.
    fn default() -> Self {
        Self { diameter_mm: 2.2, inset_mm: 5.0, apart_mm: 12.0 }
    }
}

impl Panel {
    /// Whether such a panel can be made.
    ///
    /// # Errors
    /// [`PanelError`] with what is too small, and how large it must be.
    pub fn check(&self) -> Result<(), PanelError> {
        length("panel side", self.side_mm)?;
        length("panel thickness", self.thickness_mm)?;
        if self.thickness_mm >= self.side_mm {
            return Err(PanelError::Block { side: self.side_mm, thickness: self.thickness_mm });
        }
        match self.holes {
            Holes::None => Ok(()),
            Holes::Magnets(magnet) => self.check_magnet(magnet),
            Holes::Screws(screws) => self.check_screws(screws),
        }
    }

    /// How far the flat of a face ends before the panel does, millimetres.
    pub(crate) fn rim_mm(&self) -> f64 {
        match self.rim {
            Rim::Square => 0.0,
            Rim::Round => self.thickness_mm / 2.0,
        }
    }

    fn check_magnet(&self, magnet: Magnet) -> Result<(), PanelError> {
        length("magnet diameter", magnet.diameter_mm)?;
        length("magnet length", magnet.length_mm)?;
        if !(magnet.clearance_mm.is_finite() && magnet.clearance_mm >= 0.0) {
            return Err(PanelError::Length { what: "clearance of the magnet", found: magnet.clearance_mm });
        }
        // As wide as the many-sided hole is at its corners.
        let hole = 2.0 * crate::bore::corner_radius(magnet.hole_mm());
        let needed = hole + 2.0 * LEAST_WALL_MM;
        if self.thickness_mm < needed {
            return Err(PanelError::Thin { hole, needed, found: self.thickness_mm });
        }
        // Each hole begins at a corner, beside the end of another: from the magnet's end over the wall to that hole.
        let needed = magnet.length_mm + self.thickness_mm + hole + 2.0 * LEAST_WALL_MM;
        if self.side_mm < needed {
            return Err(PanelError::Short { magnet: magnet.length_mm, needed, found: self.side_mm });
        }
        Ok(())
    }

    fn check_screws(&self, screws: Screws) -> Result<(), PanelError> {
        length("screw hole", screws.diameter_mm)?;
        length("screw holes apart", screws.apart_mm)?;
        let needed = self.rim_mm() + screws.diameter_mm / 2.0 + LEAST_WALL_MM;
        if screws.inset_mm.is_nan() || screws.inset_mm < needed {
            return Err(PanelError::Rim { needed, found: screws.inset_mm });
        }
        let (far, near) = (self.side_mm / 2.0 - screws.inset_mm, screws.apart_mm / 2.0);
        for (what, apart) in [
            ("the two of a side", screws.apart_mm),
            ("those of two sides", (far - near) * std::f64::consts::SQRT_2),
        ] {
            let found = apart - screws.diameter_mm;
            if found < LEAST_WALL_MM {
                return Err(PanelError::Crowded { what, found });
            }
        }
        Ok(())
    }
}

pub(crate) fn length(what: &'static str, found: f64) -> Result<(), PanelError> {
    if found.is_finite() && found > 0.0 { Ok(()) } else { Err(PanelError::Length { what, found }) }
}
