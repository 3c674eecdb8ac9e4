import { expect, test } from "vitest";
import { doing, KEYS } from "../src/keyboard";
import { pictureWish } from "../src/wishes";

test("without the word the page is a page", () => {
  expect(pictureWish("")).toBeUndefined();
  expect(pictureWish("#panel=3")).toBeUndefined();
});

test("a picture is as the address asks", () => {
  const asked = "#picture&at=0.25&colour=time&explode=1&width=800&height=600&theme=dark";
  expect(pictureWish(asked)).toEqual({ at: 0.25, mode: "time", explode: 1, width: 800, height: 600, dark: true });
});

test("what can't be is as usual, or as near as can be", () => {
  const asked = "#picture&at=7&colour=sound&explode=-1&width=1e9&height=x";
  expect(pictureWish(asked)).toEqual({ at: 1, mode: "pile", explode: 0, width: 4096, height: 800, dark: false });
});

test("every key of the list does something", () => {
  const nothing = new Proxy({}, { get: () => () => undefined }) as Parameters<typeof doing>[1];
  const names: Record<string, string> = { Space: " ", "←": "ArrowLeft", "→": "ArrowRight", Esc: "Escape", "−": "-" };
  for (const [keys] of KEYS) {
    for (const key of keys.split(/,? /)) expect(doing(names[key] ?? key, nothing), key).toBeTypeOf("function");
  }
  expect(doing("q", nothing)).toBeUndefined();
});
