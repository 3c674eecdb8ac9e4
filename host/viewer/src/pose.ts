//! Poses as twelve numbers in a row of them: columns of a rotation, then the translation.

export const SIZE = 12;

/** c = a b */
export function multiply(
  a: ArrayLike<number>, atA: number, b: ArrayLike<number>, atB: number, c: Float64Array, atC: number,
): void {
  const a0 = a[atA]!, a1 = a[atA + 1]!, a2 = a[atA + 2]!;
  const a3 = a[atA + 3]!, a4 = a[atA + 4]!, a5 = a[atA + 5]!;
  const a6 = a[atA + 6]!, a7 = a[atA + 7]!, a8 = a[atA + 8]!;
  for (let column = 0; column < SIZE; column += 3) {
    const x = b[atB + column]!, y = b[atB + column + 1]!, z = b[atB + column + 2]!;
    c[atC + column] = a0 * x + a3 * y + a6 * z;
    c[atC + column + 1] = a1 * x + a4 * y + a7 * z;
    c[atC + column + 2] = a2 * x + a5 * y + a8 * z;
  }
  c[atC + 9]! += a[atA + 9]!;
  c[atC + 10]! += a[atA + 10]!;
  c[atC + 11]! += a[atA + 11]!;
}

/** A turn by an angle about an axis of length 1 through a point, after a shift. */
export function turnAbout(
  axis: readonly [number, number, number], angle: number, point: readonly [number, number, number],
  shift: readonly [number, number, number],
): Float64Array {
  const [x, y, z] = axis;
  const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
  const rest = 1 - cos;
  const pose = new Float64Array([
    cos + x * x * rest, y * x * rest + z * sin, z * x * rest - y * sin,
    x * y * rest - z * sin, cos + y * y * rest, z * y * rest + x * sin,
    x * z * rest + y * sin, y * z * rest - x * sin, cos + z * z * rest,
    0, 0, 0,
  ]);
  const [u, v, w] = [shift[0] - point[0], shift[1] - point[1], shift[2] - point[2]];
  for (let row = 0; row < 3; row++) {
    pose[9 + row] = pose[row]! * u + pose[3 + row]! * v + pose[6 + row]! * w + point[row]!;
  }
  return pose;
}

/** A point where a pose puts it. */
export function carry(
  pose: ArrayLike<number>, at: number, point: readonly [number, number, number],
): [number, number, number] {
  const [x, y, z] = point;
  const row = (row: number) =>
    pose[at + row]! * x + pose[at + 3 + row]! * y + pose[at + 6 + row]! * z + pose[at + 9 + row]!;
  return [row(0), row(1), row(2)];
}
