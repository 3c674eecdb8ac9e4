//! The tools above: what colours say, piles apart, hinges, light and dark, and the keys.

import { element, icon, ICONS } from "./element";
import { type Legend, missing, type Mode, MODE_NAMES, MODES } from "./paint";
import { KEYS, LIVE_KEYS } from "./keyboard";
import type { Scene } from "./scene";

export interface Tools {
  colour(mode: Mode): void;
  explode(share: number): void;
  hinges(on: boolean): void;
  pick(panel: number): void;
  frame(): void;
  theme(): void;
  help(): void;
}

export class Toolbar {
  readonly root: HTMLElement;
  readonly help: HTMLDialogElement;
  private readonly mode: HTMLSelectElement;
  private readonly explode: HTMLInputElement;
  private readonly hinges: HTMLInputElement;
  private readonly legend = element("div", { class: "legend", "aria-label": "Colours", role: "group" });

  constructor(scene: Scene, panels: number, tools: Tools) {
    this.mode = element("select", {}, ...MODES.map((mode) => {
      const why = missing(mode, scene);
      const words = why === undefined ? MODE_NAMES[mode] : `${MODE_NAMES[mode]} (${why})`;
      return element("option", { value: mode, disabled: why !== undefined }, words);
    }));
    // A list that drops down would keep the key that stops a run to itself.
    if (scene.run?.from === "live") this.mode.size = MODES.length;
    this.mode.addEventListener("change", () => tools.colour(this.mode.value as Mode));
    this.explode = element("input", { type: "range", min: "0", max: "1", step: "0.01", value: "0" });
    this.explode.addEventListener("input", () => tools.explode(Number(this.explode.value)));
    this.hinges = element("input", { type: "checkbox" });
    this.hinges.addEventListener("change", () => tools.hinges(this.hinges.checked));
    const number = element("input", {
      type: "number", min: "0", max: String(panels - 1), step: "1", placeholder: `0 to ${panels - 1}`,
    });
    number.addEventListener("change", () => {
      if (number.value !== "" && number.checkValidity()) tools.pick(Number(number.value));
    });
    this.help = keys(scene.run?.from === "live" ? LIVE_KEYS : KEYS);
    const button = (name: string, path: string, does: () => void) => {
      const made = element("button", { type: "button", class: "quiet", "aria-label": name, title: name }, icon(path));
      made.addEventListener("click", does);
      return made;
    };
    const row = (name: string, input: HTMLElement) => element("label", {}, element("span", {}, name), input);
    this.root = element(
      "section", { id: "tools", "aria-label": "View" },
      element("div", { class: "buttons" },
        button("Look at everything (F)", ICONS.frame, () => tools.frame()),
        button("Light or dark (T)", ICONS.theme, () => tools.theme()),
        button("Keys (?)", ICONS.help, () => tools.help())),
      row("Colour", this.mode),
      this.legend,
      row("Apart", this.explode),
      row("Hinges", this.hinges),
      row("Panel", number),
    );
  }

  update(mode: Mode, explode: number, hinges: boolean, legend: Legend): void {
    this.mode.value = mode;
    this.explode.value = String(explode);
    this.hinges.checked = hinges;
    this.legend.replaceChildren(...drawn(legend));
  }
}

function drawn(legend: Legend): HTMLElement[] {
  if (legend.kind === "swatches") {
    return legend.entries.map(({ colour, word }) => {
      const swatch = element("i", {});
      swatch.style.background = colour;
      return element("span", { class: "swatch" }, swatch, word);
    });
  }
  const bar = element("i", { class: "scale" });
  bar.style.background = `linear-gradient(to right, ${legend.colours.join(", ")})`;
  return [bar, element("span", { class: "from" }, legend.from), element("span", { class: "to" }, legend.to)];
}

function keys(list: typeof KEYS): HTMLDialogElement {
  const rows = list.map(([keys, does]) => element("tr", {}, element("th", { scope: "row" }, keys), element("td", {}, does)));
  const close = element("button", { type: "submit" }, "Close");
  const title = element("h2", { id: "keys" }, "Keys");
  return element(
    "dialog", { "aria-labelledby": "keys" },
    element("form", { method: "dialog" }, title, element("table", {}, element("tbody", {}, ...rows)), close),
  );
}
