import { expect, test } from "vitest";
import { FilePlayback } from "../src/source";
import { ease, minutes, Timeline } from "../src/timeline";
import { byHand } from "./byHand";

test("a hinge moves from its start to its end, slowly at both", () => {
  const timeline = new Timeline(byHand());
  expect([...timeline.fractions(20, new Float64Array(3))]).toEqual([0.5, 0, 0]);
  expect([...timeline.fractions(70, new Float64Array(3))]).toEqual([1, ease(0.75), ease(0.25)]);
  expect([...timeline.fractions(500, new Float64Array(3))]).toEqual([1, 1, 1]);
  expect([timeline.opened(39), timeline.opened(40), timeline.opened(100)]).toEqual([0, 1, 3]);
});

test("steps go from moment to moment and stop at the ends", () => {
  const timeline = new Timeline(byHand());
  expect(timeline.moments).toEqual([0, 40, 60, 80, 100]);
  expect([timeline.step(0, true), timeline.step(41, true), timeline.step(100, true)]).toEqual([40, 60, 100]);
  expect([timeline.step(100, false), timeline.step(41, false), timeline.step(0, false)]).toEqual([80, 40, 0]);
});

test("activity counts the hinges that move", () => {
  expect(new Timeline(byHand()).activity(5)).toEqual([1, 1, 1, 2, 1].map((count) => expect.closeTo(count)));
  expect(new Timeline(byHand()).activity(2)).toEqual([expect.closeTo(1), expect.closeTo(1.4)]);
});

test("times are told as a clock tells them, and without a schedule not at all", () => {
  expect([minutes(9), minutes(65), minutes(3600 + 125)]).toEqual(["0:09", "1:05", "1:02:05"]);
  expect(new Timeline(byHand()).clock(40)).toBe("0:40 / 1:40");
  expect(new Timeline(byHand({ scheduled: false })).clock(1)).toBeUndefined();
  expect(new Timeline(byHand()).told(41)).toBe("1 of 3 hinges open");
});

test("a plan plays to its end, stops there, and plays again from the start", () => {
  const source = new FilePlayback(byHand());
  source.play(true);
  for (let frame = 0; frame < 200 && source.playing; frame++) source.advance(0.05);
  expect([source.playing, source.state.time]).toEqual([false, 100]);
  source.play(true);
  expect([source.playing, source.state.time]).toEqual([true, 0]);
  // A page that was hidden for an hour goes on where it was.
  source.advance(3600);
  expect(source.state.time).toBeLessThan(5);
});

test("times beyond the ends are the ends", () => {
  const source = new FilePlayback(byHand());
  source.seek(-3);
  expect(source.state.time).toBe(0);
  source.seek(1e9);
  expect(source.state.time).toBe(100);
});
