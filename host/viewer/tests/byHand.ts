//! A scene by hand: three panels in one pile and a second pile of one, for what is said and coloured of it.

import type { Scene } from "../src/scene";

const STILL = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];

export function byHand(more: Partial<Scene> = {}): Scene {
  const joint = (hinge: number, parent: number, child: number) => ({
    hinge, parent, child, parent_from_child: STILL, anchor: [1, 0, 0] as const, axis: [0, 1, 0] as const, turn: 1, lift: 1,
  });
  return {
    version: 1, program: "test", file: "hand.fold", model: "hand.txt", panel_length_mm: 10, thickness: 0.1,
    expansion_ratio: 2, root: 0, root_pose: STILL, target_from_zygote: STILL,
    piles: [{ cell: [0, 0], panels: [0, 1, 2] }, { cell: [1, 0], panels: [3] }],
    hinges: [
      { kind: "fold", panels: [0, 1], edges: [1, 3], side: "E", closed_deg: 0, opening_deg: 270 },
      { kind: "fold", panels: [1, 2], edges: [1, 3], side: "N", closed_deg: 0, opening_deg: 180 },
      { kind: "bridge", panels: [0, 3], edges: [1, 3], side: "E", closed_deg: 180, opening_deg: 90 },
    ],
    joints: [joint(0, 0, 1), joint(1, 1, 2), joint(2, 0, 3)],
    scheduled: true, end: 100, spans: [[0, 40], [40, 80], [60, 100]],
    drives: ["sma", "servo", "sma"],
    loads: [
      { torque_mnm: -1.25, rating_mnm: 5, factor: 0.25, role: "turning" },
      { torque_mnm: 8, rating_mnm: 4, factor: 2, role: "holding" },
      { torque_mnm: 0, rating_mnm: 4, factor: 0, role: "turning" },
    ],
    checked: { told: "1 collision", known: true, collisions: [{ told: "step 1: panel 2 meets panel 3", panels: [2, 3] }] },
    ...more,
  };
}
