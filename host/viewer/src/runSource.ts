//! A run as a source of states: one that goes on is shown as it is now, one that was recorded at any time of it.

import type { Told } from "./messages";
import { Run } from "./run";
import type { Scene } from "./scene";
import { Player, type Source, type State } from "./source";
import { Timeline } from "./timeline";

/** Recordings are played at least so fast, in seconds of the run a second, and take no longer than this, s. */
const SLOWEST = 1;
const LONGEST = 40;

/** What both have in common. */
abstract class RunSource implements Source {
  abstract readonly timeline: Timeline;
  abstract readonly seekable: boolean;
  abstract readonly playing: boolean;
  abstract readonly time: number;
  run: Run | undefined;
  private readonly fractions: Float64Array;
  private readonly celsius: Float64Array;

  constructor(protected readonly scene: Scene) {
    this.fractions = new Float64Array(scene.hinges.length);
    this.celsius = new Float64Array(scene.hinges.length).fill(NaN);
  }

  get state(): State {
    const { run, time } = this;
    if (run === undefined) return { time: 0, share: 0, fractions: this.fractions.fill(0) };
    const fractions = run.fractions(time, this.fractions);
    const share = fractions.length === 0 ? 1 : fractions.reduce((sum, fraction) => sum + fraction, 0) / fractions.length;
    return { time, share, fractions, celsius: run.celsius(time, this.celsius) };
  }

  abstract advance(seconds: number): boolean;
  abstract seek(time: number): void;
  abstract play(on: boolean): void;
}

/** A run that goes on. */
export class LiveRun extends RunSource {
  readonly seekable = false;
  readonly playing = false;
  readonly timeline: Timeline;
  private changed = true;

  constructor(scene: Scene) {
    super(scene);
    this.timeline = new Timeline(scene);
  }

  get time(): number {
    return this.run?.now ?? 0;
  }

  take(told: Told): void {
    if (told.type === "begin") this.run = new Run(told, this.scene);
    else this.run?.take(told);
    // A look at a rig on which nothing moves changes nothing of the picture.
    this.changed ||= told.type !== "look" || told.motions.length > 0;
  }

  advance(): boolean {
    const { changed } = this;
    this.changed = false;
    return changed;
  }

  seek(): void {}
  play(): void {}
}

/** A run that was recorded. */
export class RecordedRun extends RunSource {
  readonly seekable = true;
  readonly timeline: Timeline;
  private readonly player: Player;

  constructor(scene: Scene, told: readonly Told[]) {
    super(scene);
    const [begin] = told;
    if (begin?.type !== "begin") throw new Error("the recording doesn't say what ran");
    const run = new Run(begin, scene);
    for (const one of told) run.take(one);
    this.run = run;
    const end = Math.max(run.now, 1e-3);
    const spans = run.courses.map(({ started, opened }): readonly [number, number] => [started ?? Infinity, opened ?? Infinity]);
    this.timeline = new Timeline({ ...scene, scheduled: true, end, spans });
    this.player = new Player(end, Math.max(SLOWEST, end / LONGEST));
  }

  get playing(): boolean {
    return this.player.playing;
  }

  get time(): number {
    return this.player.time;
  }

  advance(seconds: number): boolean {
    return this.player.advance(seconds);
  }

  seek(time: number): void {
    this.player.seek(time);
  }

  play(on: boolean): void {
    this.player.play(on);
  }
}
