//! Colours: a hue a pile, one chroma and lightness for all so that no pile shouts, shaded by the light.

use crate::rig::Kind;
use std::fmt;

/// An sRGB colour; prints as `#rrggbb`, or `#rgb` where that is the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Colour([u8; 3]);

/// Hues in degrees of OKLCH, for piles in their order: neighbours in the list lie far apart.
const HUES: [f64; 8] = [235.0, 55.0, 150.0, 350.0, 95.0, 290.0, 190.0, 20.0];
/// Beyond the list hues go on by the golden angle, which never comes back to one, from where the next eight keep clear of the list.
const GOLDEN_ANGLE: f64 = 137.508;
const BEYOND: f64 = 181.0;

/// Steps of light: few enough that panels of one pile share their colours.
const STEPS: f64 = 24.0;

fn hue(pile: usize) -> f64 {
    HUES.get(pile).copied().unwrap_or_else(|| (BEYOND + pile as f64 * GOLDEN_ANGLE) % 360.0)
}

/// The colour of a panel's side; `light` is 0 in shade and 1 in full light. The inner side is paler.
pub(crate) fn panel(pile: usize, outer: bool, light: f64) -> Colour {
    let light = (light.clamp(0.0, 1.0) * STEPS).round() / STEPS;
    let (low, high, chroma) = if outer { (0.50, 0.80, 0.115) } else { (0.62, 0.92, 0.035) };
    oklch(low + (high - low) * light, chroma, hue(pile))
}

/// The colour of a panel's edges.
pub(crate) fn edge(pile: usize) -> Colour {
    oklch(0.34, 0.07, hue(pile))
}

/// The colour of what a hinge of a kind does.
pub(super) fn kind(kind: Kind) -> Colour {
    match kind {
        Kind::Sma => oklch(0.66, 0.16, 45.0),
        Kind::Servo => oklch(0.60, 0.13, 245.0),
        Kind::Spring => oklch(0.64, 0.13, 150.0),
    }
}

/// The colour of a place where so many panels of a net lie on each other.
pub(super) fn overlap(panels: usize) -> Colour {
    oklch((0.66 - 0.06 * (panels as f64 - 2.0)).max(0.42), 0.19, 25.0)
}

/// A colour of a scale from 0 to 1, dark and bluish to bright and yellow, lit as a panel is; the inner side is duller.
pub(super) fn scale(value: f64, outer: bool, light: f64) -> Colour {
    let value = (value.clamp(0.0, 1.0) * STEPS).round() / STEPS;
    let light = (light.clamp(0.0, 1.0) * STEPS).round() / STEPS;
    let lightness = 0.40 + 0.42 * value + 0.10 * light;
    let chroma = if outer { 0.13 } else { 0.07 };
    oklch(lightness, chroma, 280.0 - 190.0 * value)
}

impl Colour {
    /// Linear shares of red, green and blue, and opaque.
    pub(crate) fn linear(self) -> [f64; 4] {
        let [r, g, b] = self.0.map(decode);
        [r, g, b, 1.0]
    }
}

/// From OKLCH (Ottosson 2020) to sRGB.
fn oklch(lightness: f64, chroma: f64, hue_deg: f64) -> Colour {
    let (sin, cos) = hue_deg.to_radians().sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    Colour(
        [
            4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
            -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
            -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
        ]
        .map(encode),
    )
}

/// A linear share of light as a byte of sRGB.
fn encode(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
    let byte = (encoded * 255.0).round() as u8;
    byte
}

/// A byte of sRGB as a linear share of light.
fn decode(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.iter().all(|byte| byte >> 4 == byte & 15) {
            let [r, g, b] = self.0.map(|byte| byte & 15);
            return write!(f, "#{r:x}{g:x}{b:x}");
        }
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_black_and_grey_have_no_hue() {
        assert_eq!(oklch(1.0, 0.0, 30.0).to_string(), "#fff");
        assert_eq!(oklch(0.0, 0.0, 30.0).to_string(), "#000");
        let Colour([r, g, b]) = oklch(0.5, 0.0, 200.0);
        assert_eq!((r, g), (g, b));
    }

    #[test]
    fn a_byte_of_light_comes_back() {
        assert!((0..=255).all(|byte| encode(decode(byte)) == byte));
    }

    #[test]
    fn no_two_of_sixteen_piles_look_alike() {
        let apart = |a: f64, b: f64| ((a - b).abs()).min(360.0 - (a - b).abs());
        for pile in 0..16 {
            assert!((0..pile).all(|other| apart(hue(pile), hue(other)) > 10.0), "pile {pile}");
        }
    }

    #[test]
    fn neighbouring_piles_differ_and_light_brightens() {
        assert_ne!(panel(0, true, 0.5), panel(1, true, 0.5));
        let (Colour(dark), Colour(light)) = (panel(0, true, 0.1), panel(0, true, 0.9));
        assert!(dark.iter().zip(light).all(|(dark, light)| *dark < light));
    }
}
