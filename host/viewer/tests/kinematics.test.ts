import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { Kinematics } from "../src/kinematics";
import { SIZE } from "../src/pose";
import type { Playback } from "../src/scene";
import { Timeline } from "../src/timeline";

/** Plans, and where `host/deployment` says that their panels are. */
interface Golden {
  readonly playback: Playback;
  readonly moments: readonly { readonly share: number; readonly frames: readonly (readonly number[])[] }[];
}

const goldens = JSON.parse(readFileSync(new URL("poses.json", import.meta.url), "utf8")) as Golden[];

/** Golden numbers have nine digits behind the point. */
const SAME = 2e-9;

for (const { playback, moments } of goldens) {
  test(`panels of the ${playback.model} are where the program says`, () => {
    const kinematics = new Kinematics(playback);
    const timeline = new Timeline(playback);
    for (const { share, frames } of moments) {
      const fractions = timeline.fractions(share * playback.end, new Float64Array(playback.hinges.length));
      const found = kinematics.place(fractions);
      expect(found.length).toBe(frames.length * SIZE);
      const farthest = Math.max(...frames.flat().map((number, at) => Math.abs(number - found[at]!)));
      expect(farthest).toBeLessThan(SAME);
    }
  });
}

test("a wrong turn would be seen", () => {
  const { playback, moments } = goldens[1]!;
  const joints = playback.joints.map((joint, at) => (at === 3 ? { ...joint, turn: joint.turn * 1.001 } : joint));
  const found = new Kinematics({ ...playback, joints }).place(new Float64Array(playback.hinges.length).fill(1));
  const open = moments.at(-1)!.frames.flat();
  expect(Math.max(...open.map((number, at) => Math.abs(number - found[at]!)))).toBeGreaterThan(1e-4);
});

test("a turn and a shift of the whole carry every panel along", () => {
  const { playback } = goldens[2]!;
  const fractions = new Float64Array(playback.hinges.length).fill(0.4);
  const still = Float64Array.from(new Kinematics(playback).place(fractions));
  // A quarter turn about z, and up by 5.
  const turned = new Kinematics(playback).place(fractions, [0, 1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 5]);
  for (let at = 0; at < still.length; at += 3) {
    const [x, y, z] = [still[at]!, still[at + 1]!, still[at + 2]!];
    const up = at % SIZE === 9 ? 5 : 0;
    expect([turned[at], turned[at + 1], turned[at + 2]]).toEqual([
      expect.closeTo(-y, 9), expect.closeTo(x, 9), expect.closeTo(z + up, 9),
    ]);
  }
});
