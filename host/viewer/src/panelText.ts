//! What is said of a panel that was picked.

import { hingeKind } from "./paint";
import type { Places, Scene } from "./scene";
import { minutes } from "./timeline";

export interface HingeText {
  readonly hinge: number;
  readonly other: number;
  /** Whether this hinge moves the panel. */
  readonly moves: boolean;
  readonly kind: string;
  readonly side: string;
  /** From the stack to the shape. */
  readonly angles: string;
  readonly notes: readonly string[];
}

export interface PanelText {
  readonly title: string;
  readonly place: string;
  readonly hinges: readonly HingeText[];
  readonly collisions: readonly string[];
}

const ACROSS = { E: "W", N: "S", W: "E", S: "N" } as const;
const DRIVE_NAMES: Readonly<Record<string, string>> = { sma: "shape-memory", servo: "servo", spring: "spring" };

/** The angle between the two panels of a hinge, degrees, when it is a fraction of its way. */
export function angleAt(scene: Scene, hinge: number, fraction: number): number {
  const { closed_deg, opening_deg } = scene.hinges[hinge]!;
  return closed_deg + (opening_deg - closed_deg) * fraction;
}

export function panelText(scene: Scene, places: Places, panel: number): PanelText {
  const place = places.of[panel]!;
  const height = scene.piles[place.pile]!.panels.length;
  const hinges = places.hinges[panel]!.map((number): HingeText => {
    const hinge = scene.hinges[number]!;
    const first = hinge.panels[0] === panel;
    const notes: string[] = [];
    const drive = scene.drives?.[number];
    if (drive) notes.push(DRIVE_NAMES[drive] ?? drive);
    const [start, end] = scene.spans[number]!;
    notes.push(scene.scheduled ? `${minutes(start)} to ${minutes(end)}` : `number ${Math.round(start) + 1} in the order`);
    const load = scene.loads?.[number];
    if (load) notes.push(`${Math.abs(load.torque_mnm).toFixed(1)} mNm, ${load.factor.toFixed(2)} of its rating`);
    return {
      hinge: number,
      other: hinge.panels[first ? 1 : 0],
      moves: places.movedBy[panel] === number,
      kind: hingeKind(hinge),
      // A fold stands on one side of the cell for both; a bridge is seen from the other cell across.
      side: first || hinge.kind === "fold" ? hinge.side : ACROSS[hinge.side],
      angles: `${hinge.closed_deg}° to ${hinge.opening_deg}°`,
      notes,
    };
  });
  return {
    title: panel === scene.root ? `Panel ${panel}, the root` : `Panel ${panel}`,
    place: `Pile ${place.pile}, height ${place.height} of ${height - 1}`,
    hinges,
    collisions: scene.checked.collisions.filter((met) => met.panels.includes(panel)).map((met) => met.told),
  };
}
