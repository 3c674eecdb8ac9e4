//! Where every panel is when the hinges stand anywhere between the zygote and the target, with the root fixed.
//! The same as `host/deployment/src/kinematics.rs`, whose poses it is tested against.

import { multiply, SIZE, turnAbout } from "./pose";
import type { Joint, Playback } from "./scene";

export class Kinematics {
  /** Frames of all panels in space, one after the other. */
  readonly frames: Float64Array;
  private readonly closed: Float64Array[];
  private readonly open: Float64Array[];

  constructor(private readonly playback: Playback) {
    this.frames = new Float64Array((playback.joints.length + 1) * SIZE);
    this.closed = playback.joints.map((joint) => this.local(joint, 0));
    this.open = playback.joints.map((joint) => this.local(joint, 1));
  }

  /** Places all panels; `spaceFromZygote` turns and shifts the whole. */
  place(fractions: Float64Array, spaceFromZygote?: ArrayLike<number>): Float64Array {
    const { frames, playback } = this;
    const root = playback.root * SIZE;
    if (spaceFromZygote === undefined) frames.set(playback.root_pose, root);
    else multiply(spaceFromZygote, 0, playback.root_pose, 0, frames, root);
    playback.joints.forEach((joint, index) => {
      const fraction = fractions[joint.hinge] ?? 0;
      // Most hinges stand at one end.
      const local =
        fraction <= 0 ? this.closed[index]! : fraction >= 1 ? this.open[index]! : this.local(joint, fraction);
      multiply(frames, joint.parent * SIZE, local, 0, frames, joint.child * SIZE);
    });
    return frames;
  }

  /** The child's frame in the parent's. */
  private local(joint: Joint, fraction: number): Float64Array {
    const lift = joint.lift * this.playback.thickness * (1 - fraction);
    const turn = turnAbout(joint.axis, joint.turn * fraction, joint.anchor, [0, 0, lift]);
    const pose = new Float64Array(SIZE);
    multiply(turn, 0, joint.parent_from_child, 0, pose, 0);
    return pose;
  }
}
