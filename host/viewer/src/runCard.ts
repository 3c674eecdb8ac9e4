//! The card of a run: what is measured, which hinges are under way and which wait, what went wrong, what happened.

import { element } from "./element";
import type { Run } from "./run";
import type { Scene } from "./scene";
import { minutes } from "./timeline";
import { angleAt } from "./panelText";

/** More rows than these say nothing at a glance. */
const MOST_MOVING = 5;
const MOST_WAITING = 3;
const MOST_HAPPENINGS = 200;

export class RunCard {
  readonly root: HTMLElement;
  private readonly readings = element("dl", {});
  private readonly moving = element("ul", { class: "moving" });
  private readonly waiting = element("p", { class: "note waiting" });
  private readonly bad = element("div", { class: "faults", role: "alert" });
  private readonly result = element("p", { class: "result" });
  private readonly list = element("ol", { tabindex: "0", "aria-label": "What happened" });
  private told = { run: undefined as Run | undefined, happenings: 0 };

  /** `controls` stand on top where the run can be steered; `seek` where times can be gone to. */
  constructor(private readonly scene: Scene, controls: HTMLElement | undefined, private readonly seek?: (time: number) => void) {
    const log = element("details", {}, element("summary", {}, "What happened"), this.list);
    this.root = element("section", { id: "run", "aria-label": "Run" },
      ...(controls ? [controls] : []), this.bad, this.readings, this.moving, this.waiting, this.result, log);
  }

  /** What the program says went wrong. */
  trouble(told: string): void {
    this.bad.append(element("p", { class: "bad" }, told));
  }

  update(run: Run, time: number, fractions: Float64Array): void {
    if (this.told.run !== run) {
      this.told = { run, happenings: 0 };
      this.list.replaceChildren();
      this.bad.replaceChildren();
    }
    this.numbers(run, time);
    this.hinges(run, time, fractions);
    this.happenings(run);
    const { report } = run;
    const over = report !== undefined && time >= run.now;
    this.result.hidden = !over;
    if (over) this.result.textContent = `${report.outcome.replace("_", " ")}: ${report.next}`;
  }

  private numbers(run: Run, time: number): void {
    const look = run.lookAt(time);
    const { pace, current_limit_a, line, rig } = run.begin;
    const rows: [string, string][] = [
      ["Rig", `${rig} on ${line}${pace === 1 ? "" : `, ×\u202f${pace}`}`],
      ["Clock", `${minutes(time)} of ${minutes(run.expectedEnd)}`],
      ["Open", `${run.opened(time)} of ${run.courses.length} hinges`],
      ["Current", look ? `${look.current_a.toFixed(2)} A of ${current_limit_a.toFixed(1)} A` : "–"],
      ["Supply", look ? `${look.supply_v.toFixed(2)} V` : "–"],
    ];
    this.readings.replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
  }

  private hinges(run: Run, time: number, fractions: Float64Array): void {
    const look = run.lookAt(time);
    const motions = look?.motions ?? [];
    const rows = motions.slice(0, MOST_MOVING).map(({ hinge, phase, temperature_c, duty }) => {
      const heat = temperature_c === undefined ? "" : `${temperature_c.toFixed(0)} °C`;
      const angle = `${Math.round(angleAt(this.scene, hinge, fractions[hinge] ?? 0))}°`;
      const power = duty === undefined ? "" : ` ${Math.round(duty * 100)} %`;
      return element("li", {}, element("b", {}, `Hinge ${hinge}`), element("span", {}, `${phase}${power}`), element("span", {}, heat), element("span", {}, angle));
    });
    if (motions.length > rows.length) rows.push(element("li", { class: "note" }, `and ${motions.length - rows.length} more`));
    this.moving.replaceChildren(...rows);
    const waits = run.steps.filter((hinge) => !((run.courses[hinge]!.started ?? Infinity) <= time));
    const next = waits.slice(0, MOST_WAITING).map((hinge) => {
      const before = run.courses[hinge]!.expected?.after.filter((other) => !((run.courses[other]!.opened ?? Infinity) <= time)) ?? [];
      return before.length > 0 ? `${hinge} (after ${before.join(", ")})` : String(hinge);
    });
    const more = waits.length - next.length;
    this.waiting.textContent = waits.length === 0 ? "" : `Waiting: ${next.join(", ")}${more > 0 ? ` and ${more} more` : ""}`;
  }

  private happenings(run: Run): void {
    const fresh = run.happenings.slice(this.told.happenings);
    this.told.happenings = run.happenings.length;
    for (const { time, told, bad } of fresh) {
      const at = time === undefined ? "" : `${time.toFixed(1)} s`;
      const said = element("span", bad ? { class: "bad" } : {}, told);
      const clock = this.seek && time !== undefined ? element("button", { type: "button", class: "link" }, at) : element("i", {}, at);
      if (this.seek && time !== undefined) clock.addEventListener("click", () => this.seek?.(time));
      this.list.prepend(element("li", {}, clock, said));
      if (bad) this.bad.append(element("p", { class: "bad" }, `${told}${time === undefined ? "" : ` (at ${at})`}`));
    }
    while (this.list.children.length > MOST_HAPPENINGS) this.list.lastElementChild!.remove();
  }
}
