//! What colours say: of every mode a colour for each panel and each hinge, and the legend.

import { COLDEST, css, DRIVES, heatColour, HOTTEST, KINDS, loadColour, NEUTRAL, pileColour, type Rgb, scaleColour } from "./colour";
import type { Hinge, Places, Scene } from "./scene";
import { minutes } from "./timeline";

export const MODES = ["pile", "height", "time", "hinge", "drive", "torque", "temperature"] as const;
export type Mode = (typeof MODES)[number];

export const MODE_NAMES: Readonly<Record<Mode, string>> = {
  pile: "Pile",
  height: "Height",
  time: "Opening time",
  hinge: "Hinge and angle",
  drive: "Actuator",
  torque: "Torque",
  temperature: "Temperature",
};

/** Swatches with words, or a scale from one word to another. */
export type Legend =
  | { readonly kind: "swatches"; readonly entries: readonly { colour: string; word: string }[] }
  | { readonly kind: "scale"; readonly colours: readonly string[]; readonly from: string; readonly to: string };

export interface Paint {
  readonly panels: readonly Rgb[];
  readonly hinges: readonly Rgb[];
  readonly legend: Legend;
}

/** Why a mode has nothing to show; nothing where it has. */
export function missing(mode: Mode, scene: Scene): string | undefined {
  if (mode === "drive" && scene.drives === undefined) return "needs a schedule";
  if (mode === "torque" && scene.loads === undefined) return "needs --rig";
  if (mode === "temperature" && scene.run === undefined) return "in runs";
  return undefined;
}

export function hingeKind(hinge: Hinge): string {
  return hinge.kind === "bridge" ? "bridge" : `fold ${hinge.opening_deg}°`;
}

/** Most piles that a legend names. */
const MOST_NAMED = 8;

/** `celsius` is that of the hinges, where a run is shown. */
export function paint(mode: Mode, scene: Scene, places: Places, celsius?: Float64Array): Paint {
  const byHinge = (colour: (hinge: number) => Rgb) => {
    const hinges = scene.hinges.map((_, hinge) => colour(hinge));
    const panels = places.movedBy.map((hinge) => (hinge === undefined ? NEUTRAL : hinges[hinge]!));
    return { panels, hinges };
  };
  const kinds = (table: Readonly<Record<string, Rgb>>, name: (hinge: number) => string): Paint => {
    const found = new Set(scene.hinges.map((_, hinge) => name(hinge)));
    const named = Object.entries(table).filter(([word]) => found.has(word));
    const entries = named.map(([word, colour]) => ({ colour: css(colour), word }));
    return {
      ...byHinge((hinge) => table[name(hinge)] ?? NEUTRAL),
      legend: { kind: "swatches", entries: [...entries, { colour: css(NEUTRAL), word: "root" }] },
    };
  };
  const byPlace = (colour: (panel: number) => Rgb) => {
    const panels = places.of.map((_, panel) => colour(panel));
    return { panels, hinges: scene.hinges.map((hinge) => panels[hinge.panels[0]]!) };
  };
  const scale = (from: string, to: string, colour: (share: number) => Rgb = scaleColour): Legend => {
    const colours = Array.from({ length: 13 }, (_, index) => css(colour(index / 12)));
    return { kind: "scale", colours, from, to };
  };
  switch (mode) {
    case "pile": {
      const named = scene.piles.slice(0, MOST_NAMED);
      const entries = named.map((_, pile) => ({ colour: css(pileColour(pile)), word: String(pile) }));
      const more = scene.piles.length - named.length;
      if (more > 0) entries.push({ colour: "transparent", word: `and ${more} more` });
      return {
        ...byPlace((panel) => pileColour(places.of[panel]!.pile)),
        legend: { kind: "swatches", entries },
      };
    }
    case "height": {
      const top = Math.max((scene.piles[0]?.panels.length ?? 1) - 1, 1);
      return {
        ...byPlace((panel) => scaleColour(places.of[panel]!.height / top)),
        legend: scale("bottom, 0", `top, ${top}`),
      };
    }
    case "time": {
      const end = Math.max(scene.end, 1e-9);
      return {
        ...byHinge((hinge) => scaleColour((scene.spans[hinge]?.[0] ?? 0) / end)),
        legend: scene.scheduled ? scale("0:00", minutes(scene.end)) : scale("first", "last"),
      };
    }
    case "hinge":
      return kinds(KINDS, (hinge) => hingeKind(scene.hinges[hinge]!));
    case "drive":
      return kinds(DRIVES, (hinge) => scene.drives?.[hinge] ?? "");
    case "torque": {
      return {
        ...byHinge((hinge) => loadColour(scene.loads?.[hinge]?.factor ?? 0)),
        legend: {
          kind: "scale",
          colours: [...Array.from({ length: 10 }, (_, index) => css(loadColour(index / 10))), css(loadColour(2))],
          from: "none",
          to: "over its rating",
        },
      };
    }
    case "temperature":
      return {
        ...byHinge((hinge) => (Number.isNaN(celsius?.[hinge] ?? NaN) ? NEUTRAL : heatColour(celsius![hinge]!))),
        legend: scale(`${COLDEST} °C`, `${HOTTEST} °C`, (share) => heatColour(COLDEST + share * (HOTTEST - COLDEST))),
      };
  }
}
