//! Where the eye looks and how far it sees at each time: at the middle of what there is, smoothed so that nothing jerks.

import { Vector3 } from "three";
import type { Motion } from "./motion";
import type { Playback } from "./scene";
import { Timeline } from "./timeline";

export interface Frame {
  readonly middle: Vector3;
  readonly radius: number;
}

/** Moments that are looked at. */
const SAMPLES = 49;

export class Framing {
  private readonly together: readonly Frame[];
  private readonly apart: readonly Frame[];

  constructor(motion: Motion, playback: Playback) {
    const timeline = new Timeline(playback);
    const fractions = new Float64Array(playback.hinges.length);
    const together: Frame[] = [];
    const apart: Frame[] = [];
    for (let sample = 0; sample < SAMPLES; sample++) {
      const time = (playback.end * sample) / (SAMPLES - 1);
      motion.place({ time, share: sample / (SAMPLES - 1), fractions: timeline.fractions(time, fractions) });
      together.push(frame(motion, 0));
      apart.push(frame(motion, 1));
    }
    this.together = smooth(together);
    this.apart = smooth(apart);
  }

  /** At a share of the time, with piles drawn apart by a share. */
  at(share: number, explode: number): Frame {
    const place = Math.min(Math.max(share, 0), 1) * (SAMPLES - 1);
    const index = Math.min(Math.floor(place), SAMPLES - 2);
    const of = (frames: readonly Frame[]) => between(frames[index]!, frames[index + 1]!, place - index);
    return between(of(this.together), of(this.apart), explode);
  }
}

function frame(motion: Motion, explode: number): Frame {
  const { low, high } = motion.bounds(explode);
  const middle = low.clone().add(high).multiplyScalar(0.5);
  return { middle, radius: Math.max(low.distanceTo(high) / 2, 0.8) };
}

function between(a: Frame, b: Frame, share: number): Frame {
  return { middle: a.middle.clone().lerp(b.middle, share), radius: a.radius + (b.radius - a.radius) * share };
}

/** Each becomes the mean of those around it, as far to either side as there are some. */
export function smooth(frames: readonly Frame[]): Frame[] {
  const most = Math.floor(frames.length / 12);
  return frames.map((_, index) => {
    const reach = Math.min(most, index, frames.length - 1 - index);
    const near = frames.slice(index - reach, index + reach + 1);
    const middle = near.reduce((sum, frame) => sum.add(frame.middle), new Vector3()).divideScalar(near.length);
    return { middle, radius: near.reduce((sum, frame) => sum + frame.radius, 0) / near.length };
  });
}
