//! The card of the panel that was picked, with its neighbours to go on to.

import { element, icon, ICONS } from "./element";
import { angleAt, panelText } from "./panelText";
import type { Places, Scene } from "./scene";

export class PanelCard {
  readonly root = element("aside", { id: "panel", "aria-label": "Picked panel", hidden: true });
  private angles: { hinge: number; into: HTMLElement }[] = [];

  constructor(
    private readonly scene: Scene, private readonly places: Places, private readonly pick: (panel?: number) => void,
  ) {}

  show(panel: number | undefined): void {
    this.root.hidden = panel === undefined;
    this.angles = [];
    if (panel === undefined) {
      this.root.replaceChildren();
      return;
    }
    const text = panelText(this.scene, this.places, panel);
    const close = element("button", { type: "button", class: "quiet", "aria-label": "Close", title: "Close (Esc)" }, icon(ICONS.close));
    close.addEventListener("click", () => this.pick());
    const hinges = text.hinges.map((hinge) => {
      const now = element("b", {});
      this.angles.push({ hinge: hinge.hinge, into: now });
      const other = element("button", { type: "button", class: "link" }, `panel ${hinge.other}`);
      other.addEventListener("click", () => this.pick(hinge.other));
      return element(
        "li", {},
        element("div", { class: "row" }, element("span", {}, `${hinge.side} · ${hinge.kind}`), now),
        element("div", { class: "note" }, `Hinge ${hinge.hinge} to `, other, hinge.moves ? ", moves this panel" : ""),
        element("div", { class: "note" }, [hinge.angles, ...hinge.notes].join(" · ")),
      );
    });
    this.root.replaceChildren(
      element("header", {}, element("h2", {}, text.title), close),
      element("p", {}, text.place),
      element("ul", {}, ...hinges),
      ...this.collisions(text.collisions),
    );
  }

  private collisions(told: readonly string[]): HTMLElement[] {
    if (told.length > 0) {
      return [element("h3", { class: "bad" }, "Collisions"), element("ul", { class: "bad" }, ...told.map((told) => element("li", {}, told)))];
    }
    const { known } = this.scene.checked;
    return [element("p", { class: "note" }, known ? "Collides with nothing" : "Collisions not checked")];
  }

  /** The angles as they are now. */
  update(fractions: Float64Array): void {
    for (const { hinge, into } of this.angles) {
      into.textContent = `${Math.round(angleAt(this.scene, hinge, fractions[hinge] ?? 0))}°`;
    }
  }
}
