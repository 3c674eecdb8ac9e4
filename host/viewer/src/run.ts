//! A run as far as it is known: messages go in, and out comes where every hinge is at a time, how warm, and what happened.

import type { Begin, Expected, LogEvent, Look, Report, Told } from "./messages";
import type { Scene } from "./scene";

/** A temperature that is older than this, in seconds of the run, is no longer true. */
const STALE = 1.5;

/** When a hinge did what, in seconds of the run. */
export interface Course {
  readonly expected: Expected | undefined;
  started?: number;
  opened?: number;
  done?: number;
  /** Where it was seen last when the run ended. */
  readonly times: number[];
  readonly degrees: number[];
  readonly celsius: number[];
}

export interface Happening {
  readonly time: number | undefined;
  readonly told: string;
  readonly bad: boolean;
}

/** The last index of a rising list whose value is at most this; -1 where there is none. */
export function lastUpTo(times: readonly number[], time: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle]! <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

export class Run {
  readonly courses: readonly Course[];
  readonly looks: Look[] = [];
  readonly lookTimes: number[] = [];
  readonly happenings: Happening[] = [];
  readonly faults: Happening[] = [];
  report: Report | undefined;
  /** What the MCU says that it is. */
  state = "";
  /** Hinges of this part of the run, in its order. */
  readonly steps: readonly number[];
  private startedUs: number | undefined;
  /** When it was over, s. */
  private ended: number | undefined;
  /** The newest look of before the start, or of after the end: it is no part of the run. */
  private still: Look | undefined;
  private newest = 0;

  constructor(readonly begin: Begin, private readonly scene: Scene) {
    const courses = scene.hinges.map((): Course => ({ expected: undefined, times: [], degrees: [], celsius: [] }));
    for (const expected of begin.steps) courses[expected.hinge] = { ...courses[expected.hinge]!, expected };
    for (const hinge of begin.open) courses[hinge] = { ...courses[hinge]!, started: -Infinity, opened: -Infinity, done: -Infinity };
    this.courses = courses;
    this.steps = begin.steps.map(({ hinge }) => hinge);
  }

  /** The latest time that anything is known of, s. */
  get now(): number {
    return this.newest;
  }

  get running(): boolean {
    return this.startedUs !== undefined && this.report === undefined && this.state === "running";
  }

  /** When all should be open, s. */
  get expectedEnd(): number {
    return Math.max(0, ...this.begin.steps.map(({ opened_s }) => opened_s));
  }

  private seconds(us: number | undefined): number | undefined {
    return us === undefined || this.startedUs === undefined ? undefined : (us - this.startedUs) / 1e6;
  }

  take(told: Told): void {
    if (told.type === "event") this.event(told);
    else if (told.type === "look") this.look(told);
    else if (told.type === "report") this.report = told;
  }

  private event(event: LogEvent): void {
    if (event.kind === "state") {
      this.state = event.state ?? "";
      if (event.state === "running") this.startedUs = event.mcu_us;
      else this.ended ??= this.seconds(event.mcu_us);
    }
    const time = this.seconds(event.mcu_us);
    if (time !== undefined && time <= (this.ended ?? Infinity)) this.newest = Math.max(this.newest, time);
    const course = event.hinge === undefined ? undefined : this.courses[event.hinge];
    if (course && time !== undefined) {
      if (event.kind === "started") course.started = time;
      if (event.kind === "opened") course.opened = time;
      if (event.kind === "done") course.done = time;
    }
    const told = sentence(event);
    if (told === undefined) return;
    const happening = { time, told, bad: event.kind === "fault" || event.kind === "lost" };
    this.happenings.push(happening);
    if (happening.bad) this.faults.push(happening);
  }

  private look(look: Look): void {
    const time = this.seconds(look.mcu_us);
    if (time === undefined || time < 0 || time > (this.ended ?? Infinity)) {
      this.still = look;
      return;
    }
    // The newest one may come again after the one that was kept.
    if (time <= (this.lookTimes.at(-1) ?? -1)) return;
    this.looks.push(look);
    this.lookTimes.push(time);
    this.newest = Math.max(this.newest, time);
    for (const { hinge, opening_deg, temperature_c } of look.motions) {
      const course = this.courses[hinge];
      course?.times.push(time);
      course?.degrees.push(opening_deg ?? NaN);
      course?.celsius.push(temperature_c ?? NaN);
    }
  }

  lookAt(time: number): Look | undefined {
    const over = this.lookTimes.length === 0 || (this.ended !== undefined && time >= this.ended);
    if (over && this.still !== undefined) return this.still;
    return this.looks[Math.max(lastUpTo(this.lookTimes, time), 0)];
  }

  /** Of each hinge how far it is from the zygote (0) to the target (1). */
  fractions(time: number, into: Float64Array): Float64Array {
    const [from, to] = this.begin.direction === "fold" ? [1, 0] : [0, 1];
    this.courses.forEach((course, hinge) => {
      if (course.opened !== undefined && course.opened <= time) into[hinge] = to;
      else if (course.started === undefined || course.started > time) into[hinge] = from;
      else {
        const degrees = course.degrees[lastUpTo(course.times, time)];
        const { closed_deg, opening_deg } = this.scene.hinges[hinge]!;
        const way = opening_deg - closed_deg;
        const known = degrees !== undefined && !Number.isNaN(degrees) && way !== 0;
        into[hinge] = known ? Math.min(Math.max((degrees - closed_deg) / way, 0), 1) : from;
      }
    });
    return into;
  }

  /** Of each hinge its temperature, °C; not a number where nothing is measured. */
  celsius(time: number, into: Float64Array): Float64Array {
    this.courses.forEach((course, hinge) => {
      const at = lastUpTo(course.times, time);
      into[hinge] = at >= 0 && time - course.times[at]! < STALE ? course.celsius[at]! : NaN;
    });
    return into;
  }

  opened(time: number): number {
    return this.courses.filter(({ opened }) => opened !== undefined && opened <= time).length;
  }
}

/** An event in words; none for what is seen anyway. */
function sentence(event: LogEvent): string | undefined {
  switch (event.kind) {
    case "connected": return `Connected to ${event.board}, firmware ${event.firmware}, on ${event.line}`;
    case "uploaded": return `${event.steps} steps loaded`;
    case "state": return `The MCU is ${event.state}`;
    case "started": return `Hinge ${event.hinge} starts`;
    case "opened": return `Hinge ${event.hinge} is at its angle`;
    case "done": return event.peak_c === undefined ? undefined : `Hinge ${event.hinge} is cool, was ${event.peak_c.toFixed(0)} °C at most`;
    case "fault": {
      const place = event.hinge === undefined ? "" : ` at hinge ${event.hinge}`;
      return `${event.fault}${place}: measured ${event.value}, limit ${event.limit}`;
    }
    case "paused": return "Paused: everything is off";
    case "stop_requested": return "Stop asked for";
    case "stop_confirmed": return `The MCU has confirmed the stop, ${((event.after_us ?? 0) / 1000).toFixed(0)} ms after it was sent`;
    case "lost": return `The session broke: ${event.message}`;
    default: return undefined;
  }
}
