//! The schedule against the clock: a row a hinge, what was expected pale, what happened dark; below it the current.

import { css, DRIVES, NEUTRAL } from "./colour";
import { element } from "./element";
import type { Run } from "./run";
import { lastUpTo } from "./run";
import { minutes } from "./timeline";

const CURRENT = 26;
const GAP = 6;

export class Gantt {
  readonly root: HTMLElement;
  private readonly canvas = element("canvas", { role: "img" });

  constructor() {
    this.root = element("div", { class: "gantt" }, this.canvas);
  }

  /** Draws a run at a time; what is later isn't known yet. */
  draw(run: Run, time: number, end: number): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0) return;
    const ratio = Math.min(devicePixelRatio, 2);
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
    }
    const pen = this.canvas.getContext("2d")!;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const style = getComputedStyle(this.canvas);
    const ink = style.color;
    const scale = width / Math.max(end, 1e-9);
    const rows = height - CURRENT - GAP;
    const row = rows / Math.max(run.steps.length, 1);
    const thick = row < 3 ? row : Math.min(row - 1, 9);
    run.steps.forEach((hinge, index) => {
      const { expected, started, opened, done } = run.courses[hinge]!;
      const top = index * row + (row - thick) / 2;
      const bar = (from: number, to: number, share = 1) =>
        pen.fillRect(from * scale, top + (thick * (1 - share)) / 2, Math.max((to - from) * scale, 1), thick * share);
      const colour = css(DRIVES[expected?.kind ?? ""] ?? NEUTRAL);
      pen.fillStyle = colour;
      if (expected) {
        pen.globalAlpha = 0.25;
        bar(expected.start_s, expected.opened_s);
      }
      pen.globalAlpha = 1;
      if (started === undefined || started > time) return;
      const over = Math.min(opened ?? time, time);
      bar(started, over);
      if (opened !== undefined && opened <= time && done !== undefined) {
        pen.globalAlpha = 0.55;
        bar(opened, Math.min(done, time), 0.3);
        pen.globalAlpha = 1;
      }
    });
    this.current(pen, run, time, scale, height, ink);
    pen.fillStyle = ink;
    pen.globalAlpha = 0.8;
    pen.fillRect(Math.min(time * scale, width - 1), 0, 1, height);
    pen.globalAlpha = 1;
    this.canvas.setAttribute("aria-label",
      `Schedule against the clock: ${run.opened(time)} of ${run.courses.length} hinges at their angle at ${minutes(time)}, expected end ${minutes(run.expectedEnd)}`);
  }

  private current(pen: CanvasRenderingContext2D, run: Run, time: number, scale: number, height: number, ink: string): void {
    const last = lastUpTo(run.lookTimes, time);
    const most = Math.max(run.begin.current_limit_a, 1e-9);
    pen.fillStyle = ink;
    pen.globalAlpha = 0.16;
    pen.beginPath();
    pen.moveTo(0, height);
    for (let index = 0; index <= last; index++) {
      const y = height - CURRENT * Math.min(run.looks[index]!.current_a / most, 1);
      pen.lineTo(run.lookTimes[index]! * scale, y);
    }
    if (last >= 0) pen.lineTo(run.lookTimes[last]! * scale, height);
    pen.fill();
    pen.globalAlpha = 0.3;
    pen.fillRect(0, height - CURRENT - 1, pen.canvas.width, 0.5);
    pen.globalAlpha = 1;
  }
}
