//! What the address asks for behind its `#`: a picture instead of a page.

import { type Mode, MODES } from "./paint";

export interface PictureWish {
  readonly at: number;
  readonly mode: Mode;
  readonly explode: number;
  readonly width: number;
  readonly height: number;
  readonly dark: boolean;
}

/** The wish for a picture; none where a page is wanted. */
export function pictureWish(hash: string): PictureWish | undefined {
  const words = new URLSearchParams(hash.replace(/^#/, ""));
  if (!words.has("picture")) return undefined;
  const number = (key: string, usual: number, least: number, most: number) => {
    const value = Number(words.get(key) ?? usual);
    return Number.isFinite(value) ? Math.min(Math.max(value, least), most) : usual;
  };
  return {
    at: number("at", 1, 0, 1),
    mode: MODES.find((mode) => mode === words.get("colour")) ?? "pile",
    explode: number("explode", 0, 0, 1),
    width: number("width", 1200, 64, 4096),
    height: number("height", 800, 64, 4096),
    dark: words.get("theme") === "dark",
  };
}
