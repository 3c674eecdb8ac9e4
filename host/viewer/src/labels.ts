//! Words at hinges: the side and the angle. As many as can be read, those on the near side first.

import { type Camera, Vector3 } from "three";
import { angleAt } from "./panelText";
import { SIZE } from "./pose";
import type { Scene } from "./scene";

/** By how much panels are moved when drawn apart, and by which share of it they are. */
export interface Moved {
  readonly by: Float64Array;
  readonly share: number;
}

/** More would only hide each other. */
const MOST = 160;
/** Where a panel is less wide than this, in pixels, nothing is written. */
const SMALLEST = 34;
/** What passes so near to a panel's edge isn't behind it. */
const RIM = 0.03;

export class Labels {
  private readonly pool: HTMLElement[] = [];

  constructor(private readonly parent: HTMLElement, private readonly scene: Scene) {}

  /** Writes at these hinges; `facing` leaves out those on the far side. */
  show(
    hinges: readonly number[], facing: boolean, fractions: Float64Array, frames: Float64Array,
    apart: Moved, middles: readonly Vector3[], camera: Camera, size: { width: number; height: number },
  ): void {
    const found: { hinge: number; distance: number; at: Vector3 }[] = [];
    const toEye = new Vector3();
    const at = new Vector3();
    for (const hinge of hinges) {
      const middle = middles[hinge]!;
      toEye.copy(camera.position).sub(middle);
      const distance = toEye.length();
      const scale = size.height / (2 * distance * Math.tan(((camera as { fov?: number }).fov ?? 30) * (Math.PI / 360)));
      if (facing && (scale < SMALLEST || this.outward(hinge, frames, middle).dot(toEye) < 0.12 * distance)) continue;
      at.copy(middle).project(camera);
      if (at.z > 1 || Math.abs(at.x) > 1 || Math.abs(at.y) > 1) continue;
      found.push({ hinge, distance, at: at.clone() });
    }
    found.sort((a, b) => a.distance - b.distance);
    const shown: typeof found = [];
    for (const label of found) {
      if (shown.length === MOST) break;
      if (!facing || !this.isHidden(label.hinge, camera.position, frames, apart, middles)) shown.push(label);
    }
    shown.forEach(({ hinge, at }, index) => {
      const label = this.pool[index] ?? this.add();
      const { side } = this.scene.hinges[hinge]!;
      const text = `${side} ${Math.round(angleAt(this.scene, hinge, fractions[hinge] ?? 0))}°`;
      if (label.textContent !== text) label.textContent = text;
      const x = ((at.x + 1) / 2) * size.width;
      const y = ((1 - at.y) / 2) * size.height;
      label.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      label.hidden = false;
    });
    for (const label of this.pool.slice(shown.length)) label.hidden = true;
  }

  /** Where a hinge is seen from: outside of both its panels, and away from their middles. */
  private outward(hinge: number, frames: Float64Array, middle: Vector3): Vector3 {
    const out = new Vector3();
    for (const panel of this.scene.hinges[hinge]!.panels) {
      const at = panel * SIZE;
      for (let axis = 0; axis < 3; axis++) {
        const centre = frames[at + 9 + axis]! + (frames[at + axis]! + frames[at + 3 + axis]!) / 2;
        out.setComponent(axis, out.getComponent(axis) + frames[at + 6 + axis]! + middle.getComponent(axis) - centre);
      }
    }
    return out.lengthSq() > 1e-9 ? out.normalize() : out;
  }

  /** Whether another panel stands between a hinge and the eye. */
  private isHidden(
    hinge: number, eye: Vector3, frames: Float64Array, apart: Moved, middles: readonly Vector3[],
  ): boolean {
    const { panels } = this.scene.hinges[hinge]!;
    const { x, y, z } = middles[hinge]!;
    const [dx, dy, dz] = [eye.x - x, eye.y - y, eye.z - z];
    for (let at = 0, panel = 0; at < frames.length; at += SIZE, panel++) {
      if (panel === panels[0] || panel === panels[1]) continue;
      // The line to the eye in the panel's own frame: where does it pass the panel's plane?
      const by = panel * 3;
      const ox = x - frames[at + 9]! - apart.share * apart.by[by]!;
      const oy = y - frames[at + 10]! - apart.share * apart.by[by + 1]!;
      const oz = z - frames[at + 11]! - apart.share * apart.by[by + 2]!;
      const rise = dx * frames[at + 6]! + dy * frames[at + 7]! + dz * frames[at + 8]!;
      const share = -(ox * frames[at + 6]! + oy * frames[at + 7]! + oz * frames[at + 8]!) / rise;
      if (!(share > 1e-3 && share < 1)) continue;
      const [px, py, pz] = [ox + share * dx, oy + share * dy, oz + share * dz];
      const u = px * frames[at]! + py * frames[at + 1]! + pz * frames[at + 2]!;
      const v = px * frames[at + 3]! + py * frames[at + 4]! + pz * frames[at + 5]!;
      if (u > RIM && u < 1 - RIM && v > RIM && v < 1 - RIM) return true;
    }
    return false;
  }

  private add(): HTMLElement {
    const label = document.createElement("span");
    label.className = "label";
    this.parent.append(label);
    this.pool.push(label);
    return label;
  }
}
