//! What the program tells a page of a run, and what a page may say; `docs/src/live.md` has them in words.

/** The version that this page understands. */
export const VERSION = 1;

export interface Expected {
  readonly hinge: number;
  readonly kind: string;
  readonly start_s: number;
  readonly opened_s: number;
  /** Hinges that have to be open before. */
  readonly after: readonly number[];
}

export interface Begin {
  readonly version: number;
  readonly run: number;
  readonly file: string;
  readonly rig: string;
  readonly line: string;
  readonly direction: "deploy" | "fold";
  readonly pace: number;
  readonly current_limit_a: number;
  readonly steps: readonly Expected[];
  readonly open: readonly number[];
}

export interface Moving {
  readonly hinge: number;
  readonly phase: string;
  readonly temperature_c?: number;
  readonly duty?: number;
  readonly opening_deg?: number;
}

export interface Look {
  readonly mcu_us: number;
  readonly supply_v: number;
  readonly current_a: number;
  readonly opened: number;
  readonly motions: readonly Moving[];
}

/** A line of the event log: `kind` says which of these there are. */
export interface LogEvent {
  readonly kind: string;
  readonly mcu_us?: number;
  readonly hinge?: number;
  readonly state?: string;
  readonly fault?: string;
  readonly value?: number;
  readonly limit?: number;
  readonly peak_c?: number;
  readonly after_us?: number;
  readonly message?: string;
  readonly line?: string;
  readonly board?: string;
  readonly firmware?: string;
  readonly steps?: number;
}

export interface RunStage {
  readonly stage: string;
  readonly told: string;
  readonly can: readonly string[];
  readonly interrupted: readonly number[];
}

export interface Report {
  readonly outcome: string;
  readonly why?: string;
  readonly next: string;
  readonly duration_s: number;
  readonly hinges: readonly { readonly hinge: number; readonly outcome: string }[];
}

export interface Choice {
  readonly file: string;
  readonly hinges: number;
  readonly direction: "deploy" | "fold";
  readonly expected_s: number;
}

export type Told =
  | { readonly type: "welcome"; readonly version: number }
  | { readonly type: "refused"; readonly order: string | null; readonly why: string }
  | { readonly type: "choices"; readonly runs: readonly Choice[] }
  | ({ readonly type: "begin" } & Begin)
  | ({ readonly type: "event" } & LogEvent)
  | ({ readonly type: "look" } & Look)
  | ({ readonly type: "stage" } & RunStage)
  | { readonly type: "control"; readonly you: boolean; readonly taken: boolean; readonly pages: number }
  | { readonly type: "stopping"; readonly id: number }
  | { readonly type: "unconfirmed"; readonly why: string }
  | { readonly type: "trouble"; readonly told: string }
  | ({ readonly type: "report" } & Report);

export type Said =
  | { readonly type: "hello"; readonly version: number; readonly token: string; readonly control: boolean }
  | { readonly type: "control"; readonly take: boolean }
  | { readonly type: "order"; readonly order: string; readonly run?: number; readonly back?: boolean }
  | { readonly type: "stop"; readonly id: number };
