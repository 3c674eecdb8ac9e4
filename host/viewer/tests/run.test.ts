import { expect, test } from "vitest";
import { heatColour, NEUTRAL } from "../src/colour";
import type { Begin, Told } from "../src/messages";
import { paint } from "../src/paint";
import { lastUpTo, Run } from "../src/run";
import { RecordedRun } from "../src/runSource";
import { Places } from "../src/scene";
import { byHand } from "./byHand";

const scene = byHand({ run: { from: "recording" } });

function begin(more: Partial<Begin> = {}): { type: "begin" } & Begin {
  const step = (hinge: number, start_s: number) => ({ hinge, kind: "sma", start_s, opened_s: start_s + 10, after: [] });
  return {
    type: "begin", version: 1, run: 0, file: "hand.fold", rig: "bench", line: "simulator", direction: "deploy", pace: 1,
    current_limit_a: 2, steps: [step(0, 0), step(1, 10), step(2, 20)], open: [], ...more,
  };
}

const at = (seconds: number) => 5_000_000 + seconds * 1e6;
const event = (kind: string, seconds: number, hinge: number): Told => ({ type: "event", kind, mcu_us: at(seconds), hinge });
const running: Told = { type: "event", kind: "state", state: "running", mcu_us: at(0) };
const look = (seconds: number, hinge: number, opening_deg: number, temperature_c: number): Told => ({
  type: "look", mcu_us: at(seconds), supply_v: 5, current_a: 1, opened: 0, motions: [{ hinge, phase: "heating", opening_deg, temperature_c }],
});

/** Hinge 0 of 0 to 270 degrees, half open at 2 s and open at 4 s; hinge 1 on its way at 6 s. */
const told: readonly Told[] = [
  begin(), running, event("started", 1, 0), look(1, 0, 0, 30), look(2, 0, 135, 70), event("opened", 4, 0), event("started", 5, 1),
  look(6, 1, 45, 90),
];

function filled(messages: readonly Told[]): Run {
  const run = new Run(messages[0] as Begin, scene);
  for (const one of messages) run.take(one);
  return run;
}

const rounded = (numbers: Float64Array) => [...numbers].map((number) => Math.round(number * 1000) / 1000);

test("hinges stand where they were measured, at any time", () => {
  const run = filled(told);
  const fractions = (time: number) => rounded(run.fractions(time, new Float64Array(3)));
  expect(fractions(0)).toEqual([0, 0, 0]);
  expect(fractions(2.5)).toEqual([0.5, 0, 0]);
  expect(fractions(4)).toEqual([1, 0, 0]);
  expect(fractions(6)).toEqual([1, 0.25, 0]);
  expect([run.opened(3.9), run.opened(4)]).toEqual([0, 1]);
});

test("a run back begins open, and one that goes on from an earlier one where that ended", () => {
  const back = filled([begin({ direction: "fold" }), running, event("started", 1, 0), event("opened", 2, 0)]);
  expect(rounded(back.fractions(1.5, new Float64Array(3)))).toEqual([1, 1, 1]);
  expect(rounded(back.fractions(2, new Float64Array(3)))).toEqual([0, 1, 1]);
  const rest = filled([begin({ open: [2] }), running]);
  expect(rounded(rest.fractions(0, new Float64Array(3)))).toEqual([0, 0, 1]);
});

test("temperatures are those measured last, and none once nobody measures", () => {
  const run = filled(told);
  const celsius = (time: number) => [...run.celsius(time, new Float64Array(3))];
  expect(celsius(2.2)).toEqual([70, NaN, NaN]);
  expect(celsius(5)).toEqual([NaN, NaN, NaN]);
  const { panels } = paint("temperature", scene, new Places(scene), run.celsius(6, new Float64Array(3)));
  expect(panels[2]).toEqual(heatColour(90));
  expect([panels[0], panels[1]]).toEqual([NEUTRAL, NEUTRAL]);
});

test("warmer is redder", () => {
  const red = [20, 50, 80, 110, 140].map((celsius) => heatColour(celsius)).map(([r, , b]) => r - b);
  expect(red).toEqual([...red].sort((a, b) => a - b));
  expect(heatColour(500)).toEqual(heatColour(140));
});

test("looks that come twice, or before the start, count once or not", () => {
  const run = filled([begin(), look(-3, 0, 0, 20), running, ...told.slice(2), look(6, 1, 45, 90), look(5.5, 1, 40, 80)]);
  expect(run.lookTimes).toEqual([1, 2, 6]);
  expect(run.lookAt(0.5)?.motions[0]?.temperature_c).toBe(30);
});

test("a recording's slider knows when what happened", () => {
  const source = new RecordedRun(scene, [...told, { type: "event", kind: "fault", mcu_us: at(8), hinge: 1, fault: "F06: it breaks", value: 1, limit: 2 }]);
  expect(source.timeline.end).toBe(8);
  expect(source.timeline.moments).toEqual([0, 1, 4, 5, 8]);
  expect(source.timeline.told(8)).toBe("1 of 3 hinges open");
  source.seek(99);
  expect(source.time).toBe(8);
  expect(source.run?.faults.map(({ told }) => told)).toEqual(["F06: it breaks at hinge 1: measured 1, limit 2"]);
  expect(source.state.share).toBeCloseTo(1.25 / 3);
});

test("a place in a list is found", () => {
  expect([0, 1, 2.5, 9].map((time) => lastUpTo([1, 2, 3], time))).toEqual([-1, 0, 1, 2]);
  expect(lastUpTo([], 1)).toBe(-1);
});
