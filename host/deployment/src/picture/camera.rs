//! An orthographic camera above one corner of the scene.

use glam::{DVec2, DVec3};

/// From the scene to the eye, z up: enough from above to see the top, enough from the side to see a stack's layers.
const TO_EYE: DVec3 = DVec3::new(0.52, -0.78, 0.56);

/// Looks at a scene whose z is up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    right: DVec3,
    up: DVec3,
    to_eye: DVec3,
}

impl Camera {
    pub(super) fn new() -> Self {
        let to_eye = TO_EYE.normalize();
        let right = DVec3::Z.cross(to_eye).normalize();
        Self { right, up: to_eye.cross(right), to_eye }
    }

    /// The unit vector from the scene to the eye.
    pub(super) fn to_eye(self) -> DVec3 {
        self.to_eye
    }

    /// Where a point is on the picture, in panel lengths; y is down, as in SVG.
    pub(super) fn project(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), -point.dot(self.up))
    }
}

/// A rectangle of the picture, in panel lengths.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub(super) low: DVec2,
    pub(super) high: DVec2,
}

impl Bounds {
    /// Around nothing.
    pub(super) const NOTHING: Self = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };

    /// Around all points.
    pub(super) fn around(points: impl Iterator<Item = DVec2>) -> Self {
        points.fold(Self::NOTHING, |bounds, point| Self {
            low: bounds.low.min(point),
            high: bounds.high.max(point),
        })
    }

    /// Around both.
    pub(super) fn join(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The same, elsewhere.
    pub(super) fn moved(self, by: DVec2) -> Self {
        Self { low: self.low + by, high: self.high + by }
    }

    pub(super) fn size(&self) -> DVec2 {
        (self.high - self.low).max(DVec2::ZERO)
    }
}
