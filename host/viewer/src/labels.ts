//! Words at hinges: the side and the angle. As many as can be read, those on the near side first.

import { type Camera, Vector3 } from "three";
import { angleAt } from "./panelText";
import { SIZE } from "./pose";
import type { Scene } from "./scene";

/** More would only hide each other. */
const MOST = 160;
/** Where a panel is less wide than this, in pixels, nothing is written. */
const SMALLEST = 34;

export class Labels {
  private readonly pool: HTMLElement[] = [];

  constructor(private readonly parent: HTMLElement, private readonly scene: Scene) {}

  /** Writes at these hinges; `facing` leaves out those on the far side. */
  show(
    hinges: readonly number[], facing: boolean, fractions: Float64Array, frames: Float64Array,
    middles: readonly Vector3[], camera: Camera, size: { width: number; height: number },
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
    const shown = found.slice(0, MOST);
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

  private add(): HTMLElement {
    const label = document.createElement("span");
    label.className = "label";
    this.parent.append(label);
    this.pool.push(label);
    return label;
  }
}
