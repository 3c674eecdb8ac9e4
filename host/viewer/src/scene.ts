//! What the server tells of a plan (`scene.json`), and what follows from it: where each panel stands and hangs.

/** Columns of a rotation, then the translation. */
export type Pose = readonly number[];

export interface Pile {
  readonly cell: readonly [number, number];
  readonly panels: readonly number[];
}

export interface Hinge {
  readonly kind: "fold" | "bridge";
  readonly panels: readonly [number, number];
  readonly edges: readonly [number, number];
  readonly side: "E" | "N" | "W" | "S";
  readonly closed_deg: number;
  readonly opening_deg: number;
}

export interface Joint {
  readonly hinge: number;
  readonly parent: number;
  readonly child: number;
  readonly parent_from_child: Pose;
  readonly anchor: readonly [number, number, number];
  readonly axis: readonly [number, number, number];
  readonly turn: number;
  readonly lift: number;
}

export interface Load {
  readonly torque_mnm: number;
  readonly rating_mnm: number;
  readonly factor: number;
  readonly role: string;
}

/** The part of the scene that the kinematics need. */
export interface Playback {
  readonly model: string;
  readonly panel_length_mm: number;
  readonly thickness: number;
  readonly expansion_ratio: number;
  readonly root: number;
  readonly root_pose: Pose;
  readonly target_from_zygote: Pose;
  readonly piles: readonly Pile[];
  readonly hinges: readonly Hinge[];
  readonly joints: readonly Joint[];
  readonly scheduled: boolean;
  readonly end: number;
  readonly spans: readonly (readonly [number, number])[];
}

export interface Collision {
  readonly told: string;
  readonly panels: readonly number[];
}

export interface Scene extends Playback {
  readonly version: number;
  readonly program: string;
  readonly file: string;
  readonly drives?: readonly string[];
  readonly loads?: readonly Load[];
  readonly checked: {
    readonly told: string;
    readonly known: boolean;
    readonly collisions: readonly Collision[];
  };
  /** What run the page shows; none where a plan is shown by itself. */
  readonly run?: { readonly from: "live"; readonly number: number } | { readonly from: "recording" };
}

/** The version that this page understands. */
const VERSION = 1;

export function readScene(json: unknown): Scene {
  const scene = json as Partial<Scene> | null;
  if (scene?.version !== VERSION) {
    throw new Error(`scene: expected version ${VERSION}, found ${scene?.version ?? "none"}; load the page again`);
  }
  return scene as Scene;
}

/** Where a panel stands in the stack. */
export interface Place {
  readonly pile: number;
  readonly height: number;
}

/** Where every panel stands, and what it hangs on. */
export class Places {
  readonly of: readonly Place[];
  /** The hinge that moves a panel; none for the root. */
  readonly movedBy: readonly (number | undefined)[];
  /** All hinges of a panel. */
  readonly hinges: readonly (readonly number[])[];

  constructor(playback: Playback) {
    const panels = playback.joints.length + 1;
    const of: Place[] = Array.from({ length: panels }, () => ({ pile: 0, height: 0 }));
    playback.piles.forEach((column, pile) => {
      column.panels.forEach((panel, height) => (of[panel] = { pile, height }));
    });
    const movedBy: (number | undefined)[] = Array.from({ length: panels });
    for (const joint of playback.joints) movedBy[joint.child] = joint.hinge;
    const hinges: number[][] = Array.from({ length: panels }, () => []);
    playback.hinges.forEach((hinge, number) => {
      for (const panel of hinge.panels) hinges[panel]?.push(number);
    });
    this.of = of;
    this.movedBy = movedBy;
    this.hinges = hinges;
  }

  get panels(): number {
    return this.of.length;
  }
}
