//! Where the panels are in the picture: kinematics, the slow turn from how the stack stands to how the shape does, and piles
//! drawn apart.

import { Quaternion, Matrix4, Vector3 } from "three";
import { Kinematics } from "./kinematics";
import { carry, SIZE } from "./pose";
import type { Places, Playback } from "./scene";
import type { State } from "./source";
import { ease } from "./timeline";

/** How far piles stand apart when they are drawn apart, in cells. */
const APART = 0.9;
/** Layers are lifted by so much each, and by so much altogether at most. */
const LIFT = 0.22;
const MOST_LIFT = 7;

export class Motion {
  /** Frames of all panels in the picture, before they are drawn apart. */
  readonly frames: Float64Array;
  /** By how much each is moved when drawn fully apart. */
  readonly apart: Float64Array;
  private readonly kinematics: Kinematics;
  private readonly middle: Vector3;
  private readonly toTarget: Quaternion;
  /** In the space of the zygote, and in that of the target. */
  private readonly apartInStack: Vector3[];
  private readonly apartInTarget: Vector3[];

  constructor(playback: Playback, private readonly places: Places) {
    this.kinematics = new Kinematics(playback);
    this.frames = this.kinematics.frames;
    this.apart = new Float64Array(places.panels * 3);
    const m = playback.target_from_zygote;
    // prettier-ignore
    const turn = new Matrix4().set(
      m[0]!, m[3]!, m[6]!, 0, m[1]!, m[4]!, m[7]!, 0, m[2]!, m[5]!, m[8]!, 0, 0, 0, 0, 1);
    this.toTarget = new Quaternion().setFromRotationMatrix(turn);
    const closed = new Float64Array(playback.hinges.length);
    this.kinematics.place(closed);
    this.middle = new Vector3(...this.centre(playback.root));
    const cells = playback.piles.map((pile) => new Vector3(pile.cell[0], pile.cell[1], 0));
    const cell = mean(cells);
    const lift = Math.min(LIFT, MOST_LIFT / Math.max(playback.piles[0]?.panels.length ?? 1, 1));
    this.apartInStack = places.of.map(({ pile, height }) =>
      cells[pile]!.clone().sub(cell).multiplyScalar(APART).add(new Vector3(0, 0, lift * height)));
    this.place({ time: playback.end, share: 1, fractions: closed.map(() => 1) });
    const centres = playback.piles.map((pile) => mean(pile.panels.map((panel) => new Vector3(...this.centre(panel)))));
    const whole = mean(centres);
    this.apartInTarget = centres.map((centre) => centre.clone().sub(whole).multiplyScalar(APART));
  }

  /** Places all panels. */
  place(state: State): void {
    const share = ease(state.share);
    const turn = new Quaternion().slerp(this.toTarget, share);
    const space = new Matrix4().makeRotationFromQuaternion(turn);
    const shift = this.middle.clone().applyQuaternion(turn).negate();
    const e = space.elements;
    const numbers = [e[0]!, e[1]!, e[2]!, e[4]!, e[5]!, e[6]!, e[8]!, e[9]!, e[10]!, shift.x, shift.y, shift.z];
    this.kinematics.place(state.fractions, numbers);
    if (this.apartInTarget === undefined) return;
    const offset = new Vector3();
    for (let panel = 0; panel < this.places.panels; panel++) {
      offset.copy(this.apartInStack[panel]!).applyQuaternion(turn).multiplyScalar(1 - share);
      offset.addScaledVector(this.apartInTarget[this.places.of[panel]!.pile]!, share);
      offset.toArray(this.apart, panel * 3);
    }
  }

  /** The middle of a panel in the picture, not drawn apart. */
  centre(panel: number): [number, number, number] {
    return carry(this.frames, panel * SIZE, [0.5, 0.5, 0]);
  }

  /** The lowest and the highest corner of all, with panels drawn apart by a share. */
  bounds(explode: number): { low: Vector3; high: Vector3 } {
    const [low, high] = [new Vector3(Infinity, Infinity, Infinity), new Vector3(-Infinity, -Infinity, -Infinity)];
    const { frames, apart } = this;
    for (let panel = 0; panel < this.places.panels; panel++) {
      const at = panel * SIZE;
      for (let axis = 0; axis < 3; axis++) {
        const origin = frames[at + 9 + axis]! + explode * apart[panel * 3 + axis]!;
        const [u, v] = [frames[at + axis]!, frames[at + 3 + axis]!];
        const least = origin + Math.min(u, 0) + Math.min(v, 0);
        const most = origin + Math.max(u, 0) + Math.max(v, 0);
        if (least < low.getComponent(axis)) low.setComponent(axis, least);
        if (most > high.getComponent(axis)) high.setComponent(axis, most);
      }
    }
    return { low, high };
  }
}

function mean(points: readonly Vector3[]): Vector3 {
  const sum = points.reduce((sum, point) => sum.add(point), new Vector3());
  return sum.divideScalar(Math.max(points.length, 1));
}
