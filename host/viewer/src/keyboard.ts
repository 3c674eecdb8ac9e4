//! What keys do.

/** Keys in words, for the page and the book. */
export const KEYS: readonly (readonly [string, string])[] = [
  ["Space", "play, pause"],
  ["← →", "to the moment before or after at which a hinge starts or is open"],
  ["Home, End", "the stack, the shape"],
  ["C", "colour by something else"],
  ["X", "piles apart, and together"],
  ["H", "hinges with side and angle"],
  ["[ ]", "the panel below or above in its pile"],
  ["N", "the panel at the other end of the hinge, one hinge after the other"],
  ["W A S D", "go around"],
  ["+ −", "nearer, farther"],
  ["F", "look at everything"],
  ["T", "light or dark"],
  ["?", "this list"],
  ["Esc", "pick nothing"],
];

/** Of a run that goes on. */
export const LIVE_KEYS: typeof KEYS = [
  ["Esc", "STOP: everything off, at once, from anywhere"],
  ...KEYS.filter(([key]) => !["Space", "← →", "Home, End", "Esc"].includes(key)),
  ["Backspace", "pick nothing"],
];

export interface Doings {
  playOrPause(): void;
  step(forward: boolean): void;
  end(last: boolean): void;
  nextColour(): void;
  apart(): void;
  hinges(): void;
  inPile(up: boolean): void;
  across(): void;
  orbit(around: number, up: number, factor: number): void;
  frame(): void;
  theme(): void;
  help(): void;
  nothing(): void;
}

const TURN = Math.PI / 24;
const NEARER = 1 / 1.12;

/** What a key does; nothing where it is none of ours. */
export function doing(key: string, doings: Doings): (() => void) | undefined {
  switch (key.length === 1 ? key.toLowerCase() : key) {
    case " ": return () => doings.playOrPause();
    case "ArrowLeft": return () => doings.step(false);
    case "ArrowRight": return () => doings.step(true);
    case "Home": return () => doings.end(false);
    case "End": return () => doings.end(true);
    case "c": return () => doings.nextColour();
    case "x": return () => doings.apart();
    case "h": return () => doings.hinges();
    case "[": return () => doings.inPile(false);
    case "]": return () => doings.inPile(true);
    case "n": return () => doings.across();
    case "a": return () => doings.orbit(-TURN, 0, 1);
    case "d": return () => doings.orbit(TURN, 0, 1);
    case "w": return () => doings.orbit(0, TURN, 1);
    case "s": return () => doings.orbit(0, -TURN, 1);
    case "+":
    case "=": return () => doings.orbit(0, 0, NEARER);
    case "-": return () => doings.orbit(0, 0, 1 / NEARER);
    case "f": return () => doings.frame();
    case "t": return () => doings.theme();
    case "?": return () => doings.help();
    case "Backspace":
    case "Escape": return () => doings.nothing();
    default: return undefined;
  }
}

/** Listens, except where somebody writes or chooses, or the list of keys is open. */
export function listen(doings: Doings): void {
  addEventListener("keydown", (event) => {
    const { target } = event;
    const busy = target instanceof HTMLElement && target.closest("select, dialog, input[type=number]") !== null;
    const presses = target instanceof HTMLElement && target.closest("button, input[type=checkbox]") !== null && event.key === " ";
    // What is chosen with arrows keeps them.
    const slides = target instanceof HTMLInputElement && target.type === "range" && /^(Arrow|Home|End)/.test(event.key);
    if (busy || presses || slides || event.ctrlKey || event.metaKey || event.altKey) return;
    const does = doing(event.key, doings);
    if (does === undefined) return;
    event.preventDefault();
    does();
  });
}
