import { expect, test } from "vitest";
import { angleAt, panelText } from "../src/panelText";
import { Places, readScene } from "../src/scene";
import { byHand } from "./byHand";

const scene = byHand();
const places = new Places(scene);

test("a panel is told with its place and its hinges", () => {
  const text = panelText(scene, places, 1);
  expect([text.title, text.place]).toEqual(["Panel 1", "Pile 0, height 1 of 2"]);
  expect(text.hinges.map(({ hinge, other, moves, kind, side }) => [hinge, other, moves, kind, side])).toEqual([
    [0, 0, true, "fold 270°", "E"],
    [1, 2, false, "fold 180°", "N"],
  ]);
  expect(text.hinges[0]!.notes).toEqual(["shape-memory", "0:00 to 0:40", "1.3 mNm, 0.25 of its rating"]);
  expect(text.collisions).toEqual([]);
});

test("a bridge stands on the other side of the other panel", () => {
  expect(panelText(scene, places, 0).title).toBe("Panel 0, the root");
  expect(panelText(scene, places, 0).hinges.map(({ side }) => side)).toEqual(["E", "E"]);
  expect(panelText(scene, places, 3).hinges.map(({ side, angles }) => [side, angles])).toEqual([["W", "180° to 90°"]]);
});

test("a panel that collides says so", () => {
  expect(panelText(scene, places, 2).collisions).toEqual(["step 1: panel 2 meets panel 3"]);
});

test("without a schedule the number in the order stands for the time", () => {
  const { drives: _, loads: __, ...bare } = byHand({ scheduled: false, spans: [[0, 1], [1, 2], [2, 3]], end: 3 });
  expect(panelText(bare, places, 2).hinges[0]!.notes).toEqual(["number 2 in the order"]);
});

test("angles go from the stack to the shape", () => {
  expect([angleAt(scene, 0, 0), angleAt(scene, 0, 0.5), angleAt(scene, 2, 1)]).toEqual([0, 135, 90]);
});

test("a scene of another version is refused", () => {
  expect(() => readScene({ ...scene, version: 2 })).toThrow("expected version 1, found 2");
  expect(() => readScene(null)).toThrow("found none");
});
