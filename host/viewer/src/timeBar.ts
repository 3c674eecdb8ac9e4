//! The bar below: play, the way from stack to shape, and how much moves when.

import { element, icon, ICONS } from "./element";
import type { Source } from "./source";

/** Parts in which motion is counted. */
const PARTS = 160;
const STEPS = 10_000;

export class TimeBar {
  readonly root: HTMLElement;
  private readonly button: HTMLButtonElement;
  private readonly slider: HTMLInputElement;
  private readonly clock = element("span", { class: "clock" });
  private readonly told = element("span", { class: "told" });

  /** `above` is drawn in place of how much moves when. */
  constructor(private readonly source: Source, play: () => void, changed: () => void, above?: HTMLElement) {
    this.button = element("button", { class: "play", type: "button" });
    this.button.addEventListener("click", play);
    this.slider = element("input", {
      type: "range", min: "0", max: String(STEPS), step: "1", "aria-label": "From the stack to the shape",
      disabled: !source.seekable,
    });
    this.slider.addEventListener("input", () => {
      source.play(false);
      source.seek((Number(this.slider.value) / STEPS) * source.timeline.end);
      changed();
    });
    const ends = element("div", { class: "ends" }, element("span", {}, "stack"), this.told, element("span", {}, "shape"));
    this.slider.hidden = this.button.hidden = !source.seekable;
    ends.hidden = !source.seekable;
    const track = element("div", { class: "track" }, above ?? activity(source), this.slider, ends);
    this.root = element("section", { id: "time", "aria-label": "Time" }, this.button, track, this.clock);
    this.update();
  }

  update(): void {
    const { timeline, state, playing, seekable } = this.source;
    if (!seekable) return;
    const share = timeline.end > 0 ? state.time / timeline.end : 1;
    this.slider.value = String(Math.round(share * STEPS));
    this.slider.style.setProperty("--share", `${(share * 100).toFixed(2)}%`);
    const told = timeline.told(state.time);
    const clock = timeline.clock(state.time);
    this.slider.setAttribute("aria-valuetext", clock === undefined ? told : `${clock}, ${told}`);
    this.told.textContent = told;
    this.clock.textContent = clock ?? "";
    this.clock.hidden = clock === undefined;
    const name = playing ? "Pause" : "Play";
    if (this.button.getAttribute("aria-label") !== name) {
      this.button.setAttribute("aria-label", name);
      this.button.title = `${name} (space)`;
      this.button.replaceChildren(icon(playing ? ICONS.pause : ICONS.play));
    }
  }
}

/** A quiet curve of how many hinges move. */
function activity(source: Source): SVGSVGElement {
  const counts = source.timeline.activity(PARTS);
  const most = Math.max(...counts, 1);
  // Where as much moves all the time there is nothing to see.
  const even = Math.min(...counts) > 0.9 * most;
  const drawing = icon(
    `M0 24 ${counts.map((count, at) => `L${at} ${(24 - (20 * count) / most).toFixed(2)} L${at + 1} ${(24 - (20 * count) / most).toFixed(2)}`).join(" ")} L${PARTS} 24Z`,
  );
  drawing.setAttribute("viewBox", `0 0 ${PARTS} 24`);
  drawing.setAttribute("preserveAspectRatio", "none");
  drawing.classList.add("activity");
  if (even) drawing.style.display = "none";
  return drawing;
}
