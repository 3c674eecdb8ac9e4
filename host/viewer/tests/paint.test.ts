import { expect, test } from "vitest";
import { css, DRIVES, KINDS, loadColour, NEUTRAL, oklch, pileColour, scaleColour } from "../src/colour";
import { missing, MODES, paint } from "../src/paint";
import { Places } from "../src/scene";
import { byHand } from "./byHand";

const scene = byHand();
const places = new Places(scene);

test("white, black and grey have no hue, and are written as style sheets write them", () => {
  expect(css(oklch(1, 0, 30))).toBe("rgb(255 255 255)");
  expect(css(oklch(0, 0, 30))).toBe("rgb(0 0 0)");
  expect(new Set(oklch(0.5, 0, 200).map((light) => light.toFixed(6))).size).toBe(1);
});

test("the scale grows lighter from end to end", () => {
  const light = Array.from({ length: 21 }, (_, at) => scaleColour(at / 20)).map(([r, g, b]) => 0.21 * r + 0.72 * g + 0.07 * b);
  expect(light).toEqual([...light].sort((a, b) => a - b));
  expect(new Set(light.map((light) => light.toFixed(3))).size).toBe(21);
});

test("piles have colours of their own", () => {
  expect(new Set(Array.from({ length: 16 }, (_, pile) => css(pileColour(pile)))).size).toBe(16);
});

test("panels are coloured by what moves them, the root by nothing", () => {
  const { panels } = paint("hinge", scene, places);
  expect(panels).toEqual([NEUTRAL, KINDS["fold 270°"], KINDS["fold 180°"], KINDS["bridge"]]);
  expect(paint("drive", scene, places).panels[2]).toEqual(DRIVES["servo"]);
  expect(paint("pile", scene, places).panels[3]).toEqual(pileColour(1));
  expect(paint("height", scene, places).panels[2]).toEqual(scaleColour(1));
  expect(paint("time", scene, places).panels[2]).toEqual(scaleColour(0.4));
});

test("an overloaded hinge is red, another is not", () => {
  const { hinges } = paint("torque", scene, places);
  expect(hinges.map(([r, g]) => r > 3 * g)).toEqual([false, true, false]);
  expect(loadColour(1.0001)).not.toEqual(loadColour(1));
});

test("legends name only what there is", () => {
  const words = (mode: "hinge" | "pile") => {
    const { legend } = paint(mode, scene, places);
    return legend.kind === "swatches" ? legend.entries.map(({ word }) => word) : [];
  };
  expect(words("hinge")).toEqual(["fold 180°", "fold 270°", "bridge", "root"]);
  expect(words("pile")).toEqual(["0", "1"]);
});

test("modes without data say what they lack", () => {
  const { drives: _, loads: __, ...bare } = scene;
  expect(MODES.filter((mode) => missing(mode, bare) !== undefined)).toEqual(["drive", "torque", "temperature"]);
  expect(MODES.filter((mode) => missing(mode, scene) !== undefined)).toEqual(["temperature"]);
  expect(missing("temperature", byHand({ run: { from: "live", number: 0 } }))).toBeUndefined();
});
