//! A panel as a closed body about the origin, z up.
//!
//! Its side is made of bands between levels, from one corner of the profile to the next. Where a magnet's hole opens, a band is
//! what is left of it on either side of the hole. One side is made and turned: the four holes follow each other around the panel,
//! each beginning at a corner and ending before the next one begins, so that none meets another.

use crate::bore::Bore;
use crate::drill::drilled_faces;
use crate::panel::{Holes, Panel, PanelError, Rim};
use crate::soup::{Point, Soup};
use std::f64::consts::PI;

/// Bands of a round side; even, so that its middle is as far out as the side.
const BANDS: i32 = 8;
/// Levels nearer to each other than this, millimetres, are one.
const ONE_LEVEL: f64 = 1e-6;

impl Panel {
    /// The panel as a body.
    ///
    /// # Errors
    /// [`PanelError`] if such a panel can't be made.
    pub fn body(&self) -> Result<Soup, PanelError> {
        self.check()?;
        let bore = match &self.holes {
            Holes::Magnets(magnet) => Some(Bore::new(self, magnet)),
            Holes::None | Holes::Screws(_) => None,
        };
        let levels = self.levels(bore.as_ref());
        let mut side = Soup::default();
        for band in levels.windows(2) {
            self.band(&mut side, band[0], band[1], bore.as_ref());
        }
        let mut body = side.four_times();
        let (half, flat) = (self.thickness_mm / 2.0, self.reach(self.thickness_mm / 2.0));
        if let Holes::Screws(screws) = &self.holes {
            drilled_faces(&mut body, flat, half, screws, self.side_mm);
        } else {
            for (z, turn) in [(half, 1.0), (-half, -1.0)] {
                // Seen from below, left and right change places.
                let [left, right] = [-flat * turn, flat * turn];
                body.strip(&[[left, -flat, z], [left, flat, z]], &[[right, -flat, z], [right, flat, z]]);
            }
        }
        Ok(body)
    }

    /// How far the panel reaches at a height, from its middle.
    fn reach(&self, z: f64) -> f64 {
        let radius = self.rim_mm();
        self.side_mm / 2.0 - radius + (radius.powi(2) - z.powi(2)).max(0.0).sqrt()
    }

    /// The heights at which the side or the hole has a corner, from the bottom up.
    fn levels(&self, bore: Option<&Bore>) -> Vec<f64> {
        let half = self.thickness_mm / 2.0;
        let mut levels = vec![-half, half];
        // The hole's own come first: another one so near gives way.
        let mut more = bore.map_or_else(Vec::new, Bore::levels);
        if self.rim == Rim::Round {
            let level = |step: i32| half * (PI * f64::from(2 * step - BANDS) / f64::from(2 * BANDS)).sin();
            more.extend((1..BANDS).map(level));
        }
        for level in more {
            if levels.iter().all(|other: &f64| (other - level).abs() > ONE_LEVEL) {
                levels.push(level);
            }
        }
        levels.sort_by(f64::total_cmp);
        levels
    }

    /// The band of the west side between two levels, with the piece of the hole behind it.
    fn band(&self, side: &mut Soup, low: f64, high: f64, bore: Option<&Bore>) {
        let at = |z: f64, y: f64| [-self.reach(z), y, z];
        let ends = |z: f64| [at(z, -self.reach(z)), at(z, self.reach(z))];
        let ([south_low, north_low], [south_high, north_high]) = (ends(low), ends(high));
        // The band's edge at a level, from north to south; with a point where the hole's top or bottom is.
        let edge = |z: f64, [south, north]: [Point; 2]| match bore {
            Some(bore) if bore.half_width(z).is_some() => vec![north, at(z, bore.y), south],
            _ => vec![north, south],
        };
        let through = bore.and_then(|bore| Some((bore, bore.half_width(low)?, bore.half_width(high)?)));
        let Some((bore, low_width, high_width)) = through else {
            side.strip(&edge(high, [south_high, north_high]), &edge(low, [south_low, north_low]));
            return;
        };
        let mouth = |z: f64, width: f64| [at(z, bore.y - width), at(z, bore.y + width)];
        let ([low_s, low_n], [high_s, high_n]) = (mouth(low, low_width), mouth(high, high_width));
        side.strip(&[north_high, high_n], &[north_low, low_n]);
        side.strip(&[high_s, south_high], &[low_s, south_low]);
        let end = |[_, y, z]: Point| [bore.end_x, y, z];
        // Seen from inside the hole: its north wall, its south wall, and its end.
        side.strip(&[high_n, end(high_n)], &[low_n, end(low_n)]);
        side.strip(&[end(high_s), high_s], &[end(low_s), low_s]);
        let across = |north: Point, south: Point, width: f64| {
            if width > 0.0 { vec![end(north), end(south)] } else { vec![end(north)] }
        };
        side.strip(&across(high_n, high_s, high_width), &across(low_n, low_s, low_width));
    }
}
