//! Hinges as thin bars along the edges that they join, as one instanced mesh; where each is, labels ask too.

import { BoxGeometry, Color, DynamicDrawUsage, InstancedMesh, Matrix4, MeshLambertMaterial, Vector3 } from "three";
import type { Rgb } from "./colour";
import { carry, SIZE } from "./pose";
import type { Hinge } from "./scene";

const LENGTH = 0.86;
/** Half the width of a bar, over the half thickness of a plate; at least. */
const WIDER = 1.25;
const LEAST = 0.016;
/** Edges nearer to each other than this are joined, however thick a layer is. */
const TOGETHER = 0.15;

const CORNERS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] as const;

/** Middle of the edge of a panel, and the way along it. */
function edge(
  frames: Float64Array, apart: Float64Array, explode: number, panel: number, edge: number, middle: Vector3, along: Vector3,
): void {
  const a = carry(frames, panel * SIZE, CORNERS[edge % 4]!);
  const b = carry(frames, panel * SIZE, CORNERS[(edge + 1) % 4]!);
  along.set(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  middle.set((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2);
  for (let axis = 0; axis < 3; axis++) {
    middle.setComponent(axis, middle.getComponent(axis) + explode * apart[panel * 3 + axis]!);
  }
}

export class HingeBars {
  readonly mesh: InstancedMesh;
  /** Middles of all hinges, in the picture. */
  readonly middles: readonly Vector3[];
  private readonly shown: (hinge: number) => boolean = (hinge) => this.all || this.picked.has(hinge);
  private all = false;
  private picked: ReadonlySet<number> = new Set();

  constructor(private readonly hinges: readonly Hinge[], half: number) {
    const width = 2 * Math.max(half * WIDER, LEAST);
    this.mesh = new InstancedMesh(new BoxGeometry(LENGTH, width, width), new MeshLambertMaterial(), hinges.length);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.middles = hinges.map(() => new Vector3());
  }

  /** Shows all hinges, or those of a panel alone. */
  show(all: boolean, picked: readonly number[]): void {
    this.all = all;
    this.picked = new Set(picked);
    this.mesh.visible = all || picked.length > 0;
  }

  place(frames: Float64Array, apart: Float64Array, explode: number): void {
    if (!this.mesh.visible) return;
    const matrix = new Matrix4();
    const [a, b, along, other, up, across] = Array.from({ length: 6 }, () => new Vector3()) as [
      Vector3, Vector3, Vector3, Vector3, Vector3, Vector3,
    ];
    this.hinges.forEach((hinge, number) => {
      edge(frames, apart, explode, hinge.panels[0], hinge.edges[0], a, along);
      edge(frames, apart, explode, hinge.panels[1], hinge.edges[1], b, other);
      // Of panels drawn apart it stays with the first.
      const middle = this.middles[number]!.copy(a);
      if (a.distanceTo(b) < TOGETHER) middle.add(b).multiplyScalar(0.5);
      if (!this.shown(number)) {
        this.mesh.setMatrixAt(number, matrix.makeScale(0, 0, 0));
        return;
      }
      const at = hinge.panels[0] * SIZE;
      up.set(frames[at + 6]!, frames[at + 7]!, frames[at + 8]!);
      across.crossVectors(up, along);
      this.mesh.setMatrixAt(number, matrix.makeBasis(along, across, up).setPosition(this.middles[number]!));
    });
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  paint(colours: readonly Rgb[]): void {
    const colour = new Color();
    // Deeper than the panels, so that a bar shows on a panel of its own colour.
    colours.forEach((rgb, hinge) => this.mesh.setColorAt(hinge, colour.setRGB(...rgb).multiplyScalar(0.5)));
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }
}
