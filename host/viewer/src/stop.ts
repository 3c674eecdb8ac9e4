//! Emergency stop: one key and one button, from anywhere in the page, and what the MCU said to it.

import { element } from "./element";

/** A stop that isn't confirmed within this, in milliseconds, is told as one that failed. */
const PATIENCE = 1000;

export const CUT = "NOT CONFIRMED. Cut the power.";

export class Stop {
  readonly root: HTMLElement;
  private readonly button: HTMLButtonElement;
  private readonly told = element("p", { class: "told", role: "alert" });
  private id = 0;
  /** When the key went down, of a stop that isn't confirmed yet. */
  private since: number | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private acknowledged = false;
  private safe = false;

  /** `send` gives whether anybody heard it. */
  constructor(private readonly send: (id: number) => boolean) {
    this.button = element("button", { type: "button", class: "stop" }, element("b", {}, "STOP"), element("kbd", {}, "Esc"));
    this.button.addEventListener("click", () => this.press());
    this.root = element("section", { id: "stop", "aria-label": "Emergency stop" }, this.told, this.button);
    // Before anything else on the page, dialogs too, gets to see the key.
    addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.preventDefault();
      event.stopImmediatePropagation();
      if (!event.repeat) this.press();
    }, { capture: true });
  }

  press(): void {
    this.since = performance.now();
    this.acknowledged = false;
    clearTimeout(this.timer);
    if (!this.send(++this.id)) {
      this.fail("The line to the program is broken.");
      return;
    }
    this.say("Stopping …", "under-way");
    this.timer = setTimeout(() => this.fail("The MCU hasn't confirmed the stop."), PATIENCE);
  }

  /** The MCU has acknowledged a stop. */
  acknowledge(): void {
    this.acknowledged = true;
    this.look();
  }

  /** What the MCU is. */
  state(name: string): void {
    this.safe = name === "safe";
    if (!this.safe && this.since === undefined) this.say("", "");
    this.look();
  }

  /** The program says that no MCU has confirmed. */
  fail(why: string): void {
    if (this.since === undefined) return;
    clearTimeout(this.timer);
    this.say(`${CUT} ${why}`, "failed");
  }

  private look(): void {
    if (this.since === undefined || !this.acknowledged || !this.safe) return;
    clearTimeout(this.timer);
    const took = performance.now() - this.since;
    this.since = undefined;
    this.root.dataset["took"] = took.toFixed(1);
    this.say(`Confirmed by the MCU ${Math.round(took)} ms after the key: it is Safe, everything is off.`, "confirmed");
  }

  private say(text: string, how: string): void {
    this.told.textContent = text;
    this.root.dataset["how"] = how;
  }
}
