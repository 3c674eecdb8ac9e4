//! Binary STL: every panel of a stack a closed body of its own, millimetres.

use crate::soup::Point;
use crate::stack::{Gaps, Stack};
use stl_io::{Normal, Triangle, Vertex};

/// More than a file of this format can say.
#[derive(Debug, thiserror::Error)]
pub enum StlError {
    /// The format counts triangles in 32 bits.
    #[error("STL: {found} triangles, the format has room for {} at most", u32::MAX)]
    Triangles {
        /// Triangles of the stack.
        found: usize,
    },
    /// Numbers of this format are too coarse for the gaps of so large a stack.
    #[error(
        "STL: a stack of {size:.0} mm is told to {step} mm in this format, too coarse for a gap of {gap} mm"
    )]
    Coarse {
        /// The longest side, millimetres.
        size: f64,
        /// Distance of two neighbouring numbers there, millimetres.
        step: f64,
        /// The narrowest gap, millimetres.
        gap: f64,
    },
    /// It couldn't be written.
    #[error("STL: {0}")]
    Write(#[from] std::io::Error),
}

/// Steps of the format's numbers in the narrowest gap, at the least.
const STEPS_IN_A_GAP: f64 = 20.0;

/// The bytes of a stack with such gaps.
///
/// # Errors
/// [`StlError`] if the stack is larger than the format has room for.
pub fn stl(stack: &Stack, gaps: Gaps) -> Result<Vec<u8>, StlError> {
    let found = stack.triangles();
    if u32::try_from(found).is_err() {
        return Err(StlError::Triangles { found });
    }
    let size = stack.box_mm.into_iter().fold(0.0, f64::max);
    let step = size * f64::from(f32::EPSILON);
    let gap = gaps.layers_mm.min(gaps.piles_mm);
    if step * STEPS_IN_A_GAP > gap {
        return Err(StlError::Coarse { size, step, gap });
    }
    let triangles: Vec<Triangle> = stack
        .middles
        .iter()
        .flat_map(|middle| {
            stack.body.triangles.iter().map(move |triangle| Triangle {
                normal: Normal::new(normal(triangle)),
                vertices: triangle.map(|point| Vertex::new(placed(point, *middle))),
            })
        })
        .collect();
    let mut bytes = Vec::with_capacity(84 + 50 * found);
    stl_io::write_stl(&mut bytes, triangles.iter())?;
    Ok(bytes)
}

fn placed(point: Point, middle: Point) -> [f32; 3] {
    [0, 1, 2].map(|axis| single(point[axis] + middle[axis]))
}

fn normal([a, b, c]: &[Point; 3]) -> [f32; 3] {
    let (u, v) = ([0, 1, 2].map(|axis| b[axis] - a[axis]), [0, 1, 2].map(|axis| c[axis] - a[axis]));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = cross.iter().map(|part| part * part).sum::<f64>().sqrt();
    cross.map(|part| single(part / length))
}

#[expect(clippy::cast_possible_truncation, reason = "the format has single precision")]
fn single(value: f64) -> f32 {
    value as f32
}
