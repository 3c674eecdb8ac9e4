//! Where the page gets its state from: a plan that is played; runs are in `runSource.ts`.

import { Timeline } from "./timeline";
import type { Playback } from "./scene";

/** What there is to show at a moment. */
export interface State {
  readonly time: number;
  /** How far the whole is from the stack (0) to the shape (1). */
  readonly share: number;
  /** Of each hinge how far it is from the zygote (0) to the target (1). */
  readonly fractions: Float64Array;
  /** Of each hinge its temperature, °C; not a number where nothing is measured, missing where nothing can be. */
  readonly celsius?: Float64Array;
}

export interface Source {
  readonly timeline: Timeline;
  /** A file can be gone through at will, a run goes on by itself. */
  readonly seekable: boolean;
  readonly playing: boolean;
  readonly state: State;
  /** Called with the seconds since the last call; says whether there is something new to show. */
  advance(seconds: number): boolean;
  seek(time: number): void;
  play(on: boolean): void;
}

/** Playing takes so many seconds, whatever the schedule takes. */
function duration(hinges: number): number {
  return Math.min(Math.max(6, 5 * Math.log10(1 + hinges)), 24);
}

/** A time that is gone through: it plays to its end, and is led anywhere. */
export class Player {
  playing = false;
  private changed = true;

  constructor(readonly end: number, private readonly rate: number, public time = 0) {}

  advance(seconds: number): boolean {
    const { changed } = this;
    this.changed = false;
    if (!this.playing) return changed;
    // A page that was hidden goes on where it was.
    this.time = Math.min(this.time + Math.min(seconds, 0.1) * this.rate, this.end);
    if (this.time >= this.end) this.playing = false;
    return true;
  }

  seek(time: number): void {
    this.time = Math.min(Math.max(time, 0), this.end);
    this.changed = true;
  }

  play(on: boolean): void {
    // From the end it starts anew.
    if (on && this.time >= this.end) this.time = 0;
    this.playing = on && this.end > 0;
    this.changed = true;
  }
}

/** A plan that is played. */
export class FilePlayback implements Source {
  readonly seekable = true;
  readonly timeline: Timeline;
  private readonly player: Player;
  private readonly fractions: Float64Array;

  constructor(playback: Playback, share = 0) {
    this.timeline = new Timeline(playback);
    const { end } = this.timeline;
    this.player = new Player(end, end / duration(playback.hinges.length), share * end);
    this.fractions = new Float64Array(playback.hinges.length);
  }

  get playing(): boolean {
    return this.player.playing;
  }

  get state(): State {
    const { time, end } = this.player;
    return { time, share: end > 0 ? time / end : 1, fractions: this.timeline.fractions(time, this.fractions) };
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
