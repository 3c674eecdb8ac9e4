//! Triangles in space, each counter-clockwise seen from outside. Corners that are one point are so to the last bit: that makes a
//! body closed.

/// A point, millimetres.
pub type Point = [f64; 3];

/// The triangles of a body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Soup {
    /// Its triangles.
    pub triangles: Vec<[Point; 3]>,
}

impl Soup {
    /// Adds the strip between two runs of points that lie side by side and go one way; seen from outside `left` is on the left.
    /// A run may be a single point. Of two diagonals the one to the point that is less far along is taken.
    pub(crate) fn strip(&mut self, left: &[Point], right: &[Point]) {
        let (mut l, mut r) = (0, 0);
        let along = |points: &[Point], at: usize| {
            let (first, last) = (points[0], points[points.len() - 1]);
            (0..3).map(|axis| (points[at][axis] - first[axis]) * (last[axis] - first[axis])).sum::<f64>()
                / distance_squared(first, last).max(f64::MIN_POSITIVE)
        };
        while l + 1 < left.len() || r + 1 < right.len() {
            let on_left =
                l + 1 < left.len() && (r + 1 == right.len() || along(left, l + 1) <= along(right, r + 1));
            if on_left {
                self.triangles.push([left[l], right[r], left[l + 1]]);
                l += 1;
            } else {
                self.triangles.push([left[l], right[r], right[r + 1]]);
                r += 1;
            }
        }
    }

    /// The same four times, a quarter turn about z between them.
    #[must_use]
    pub(crate) fn four_times(self) -> Self {
        let mut all = self.triangles;
        let count = all.len();
        for quarter in 1..4 {
            for triangle in 0..count {
                let last = all[(quarter - 1) * count + triangle];
                all.push(last.map(quarter_turn));
            }
        }
        Self { triangles: all }
    }

    /// What is inside, cubic millimetres.
    pub fn volume(&self) -> f64 {
        let six_times = |[a, b, c]: &[Point; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        self.triangles.iter().map(six_times).sum::<f64>() / 6.0
    }
}

fn quarter_turn([x, y, z]: Point) -> Point {
    // Without a negative zero, which is another number to the last bit.
    [0.0 - y, x, z]
}

fn distance_squared(a: Point, b: Point) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum()
}
