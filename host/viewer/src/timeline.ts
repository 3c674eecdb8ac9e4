//! How far each hinge is at a time, and the time in words.

import type { Playback } from "./scene";

/** From 0 to 1 with a slow start and a slow end. */
export function ease(share: number): number {
  return share * share * (3 - 2 * share);
}

export class Timeline {
  readonly end: number;
  readonly scheduled: boolean;
  /** All times at which something starts or ends, rising. */
  readonly moments: readonly number[];

  constructor(private readonly playback: Playback) {
    this.end = playback.end;
    this.scheduled = playback.scheduled;
    this.moments = [...new Set([0, ...playback.spans.flat().filter((time) => time > 0 && time < Infinity), playback.end])].sort((a, b) => a - b);
  }

  /** Of each hinge, how far it is from the zygote (0) to the target (1). */
  fractions(time: number, into: Float64Array): Float64Array {
    this.playback.spans.forEach(([start, end], hinge) => {
      const share = (time - start) / Math.max(end - start, 1e-9);
      into[hinge] = ease(Math.min(Math.max(share, 0), 1));
    });
    return into;
  }

  opened(time: number): number {
    return this.playback.spans.filter(([, end]) => end <= time + 1e-9).length;
  }

  /** How many hinges move in each of so many equal parts of the time, on average. */
  activity(parts: number): number[] {
    const counts = Array.from({ length: parts }, () => 0);
    if (this.end <= 0) return counts;
    for (const span of this.playback.spans) {
      const [start, end] = span.map((time) => (time / this.end) * parts) as [number, number];
      for (let part = Math.floor(start); part < Math.min(Math.ceil(end), parts); part++) {
        counts[part]! += Math.min(end, part + 1) - Math.max(start, part);
      }
    }
    return counts;
  }

  /** The next moment after a time, or the last one before it. */
  step(time: number, forward: boolean): number {
    const near = 1e-6;
    if (forward) return this.moments.find((moment) => moment > time + near) ?? this.end;
    return [...this.moments].reverse().find((moment) => moment < time - near) ?? 0;
  }

  /** The time as a clock says it; without a schedule there is none. */
  clock(time: number): string | undefined {
    return this.scheduled ? `${minutes(time)} / ${minutes(this.end)}` : undefined;
  }

  /** What is open, in words. */
  told(time: number): string {
    const hinges = this.playback.spans.length;
    return `${this.opened(time)} of ${hinges} hinges open`;
  }
}

export function minutes(seconds: number): string {
  const whole = Math.round(seconds);
  const [hours, rest] = [Math.floor(whole / 3600), whole % 3600];
  const pair = (number: number) => String(number).padStart(2, "0");
  const tail = `${hours > 0 ? pair(Math.floor(rest / 60)) : Math.floor(rest / 60)}:${pair(rest % 60)}`;
  return hours > 0 ? `${hours}:${tail}` : tail;
}
