//! What may be asked for of a run: the stage that it is in, and a button for each order that is taken there.

import { element } from "./element";
import type { Choice, RunStage, Said } from "./messages";
import { minutes } from "./timeline";

const NAMES: Readonly<Record<string, string>> = {
  arm: "Arm", start: "Start", disarm: "Disarm", pause: "Pause", go_on: "Don't pause", resume: "Resume", clear: "I have looked at the rig",
  unload: "Give up", end: "End the program",
};
/** The one that leads on. */
const ONWARD = ["arm", "start", "resume", "clear"];

const STAGES: Readonly<Record<string, string>> = {
  idle: "Ready", busy: "Working", loaded: "Loaded", armed: "Armed", running: "Running", pausing: "Pausing", paused: "Paused", safe: "Safe",
  cleared: "Cleared", over: "Done", gone: "Ended",
};

export class Controls {
  readonly root = element("div", { class: "controls" });
  private stage: RunStage = { stage: "busy", told: "Connecting.", can: [], interrupted: [] };
  private choices: readonly Choice[] = [];
  private control = { you: false, taken: false, pages: 1 };
  private open = false;

  constructor(private readonly say: (said: Said) => void) {
    this.draw();
  }

  enter(stage: RunStage): void {
    this.stage = stage;
    this.draw();
  }

  offer(choices: readonly Choice[]): void {
    this.choices = choices;
    this.draw();
  }

  controlled(control: { you: boolean; taken: boolean; pages: number }): void {
    this.control = control;
    this.draw();
  }

  connected(open: boolean): void {
    this.open = open;
    this.draw();
  }

  private draw(): void {
    const { stage, told, can, interrupted } = this.stage;
    const gone = stage === "gone";
    const parts: HTMLElement[] = [element("h2", { "data-stage": stage }, STAGES[stage] ?? stage), element("p", {}, told)];
    if (!this.open && !gone) {
      parts.push(element("p", { class: "bad", role: "alert" },
        "No line to the program. A run goes on without this page: Ctrl-C where zygote was started stops it, or cut the power."));
    } else if (this.control.you) {
      if (can.includes("choose")) parts.push(this.runs());
      parts.push(...this.buttons(can.filter((order) => order !== "choose"), interrupted));
    } else if (!gone) {
      parts.push(...this.watching());
    }
    // Who works with keys goes on where they were.
    const focused = document.activeElement instanceof HTMLElement ? document.activeElement.dataset["order"] : undefined;
    const had = this.root.contains(document.activeElement);
    this.root.replaceChildren(...parts);
    if (had) (this.root.querySelector<HTMLElement>(`[data-order="${focused}"]`) ?? this.root.querySelector("button"))?.focus();
  }

  private runs(): HTMLElement {
    return element("ul", { class: "runs" }, ...this.choices.map((choice, run) => {
      const load = element("button", { type: "button", "data-order": `choose-${run}`, "aria-label": `Load ${choice.file}` }, "Load");
      load.addEventListener("click", () => this.say({ type: "order", order: "choose", run }));
      const way = choice.direction === "fold" ? "back, " : "";
      const note = element("span", { class: "note" }, `${way}${choice.hinges} hinges, ${minutes(choice.expected_s)}`);
      return element("li", {}, element("span", {}, element("b", {}, choice.file), note), load);
    }));
  }

  private buttons(can: readonly string[], interrupted: readonly number[]): HTMLElement[] {
    const parts: HTMLElement[] = [];
    const back = element("input", { type: "checkbox" });
    const unsure = can.includes("resume") && interrupted.length > 0;
    if (unsure) {
      const hinges = interrupted.join(", ");
      parts.push(element("label", { class: "back" }, back,
        `The servos of hinges ${hinges} were interrupted. I have put them back to where they started.`));
    }
    const row = element("div", { class: "orders" });
    for (const order of can) {
      const kind = ONWARD.includes(order) ? "onward" : undefined;
      const made = element("button", { type: "button", class: kind, "data-order": order }, NAMES[order] ?? order);
      made.disabled = order === "resume" && unsure;
      if (order === "resume" && unsure) back.addEventListener("change", () => (made.disabled = !back.checked));
      made.addEventListener("click", () => this.say({ type: "order", order, ...(order === "resume" ? { back: back.checked } : {}) }));
      row.append(made);
    }
    if (can.length > 0) parts.push(row);
    return parts;
  }

  private watching(): HTMLElement[] {
    const { taken } = this.control;
    const told = taken ? "Another page has control; this one watches, and can stop." : "Nobody has control.";
    const take = element("button", { type: "button", "data-order": "control" }, "Take control");
    take.addEventListener("click", () => this.say({ type: "control", take: true }));
    return [element("p", { class: "note" }, told), ...(taken ? [] : [element("div", { class: "orders" }, take)])];
  }
}
