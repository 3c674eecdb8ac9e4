//! `npm run measure`: how long the page itself works at a frame with 4,000 panels, while they unfold. What the graphics card does
//! comes on top; here there is none, so frames are counted by the page's own clock alone.

import { join } from "node:path";
import { expect, test } from "vitest";
import { repository, scratch, show, zygote } from "./shown";

const PANELS = 4000;

test("frames of 4,000 panels", async () => {
  const place = scratch();
  zygote(place.folder, "plan", join(repository, "models/bird4000.txt"), "--piles", "4", "-o", "bird.fold");
  const shown = await show(place.folder, "bird.fold");
  try {
    const { page } = shown;
    for (const [what, keys] of [["panels", []], ["with hinges and words", ["h"]]] as const) {
      for (const key of ["Home", ...keys, " "]) await page.keyboard.press(key);
      await page.waitForTimeout(12_000);
      await page.keyboard.press(" ");
      const work = await page.evaluate(() => globalThis.zygote!.work.splice(0).slice(3).sort((a, b) => a - b));
      expect(work.length).toBeGreaterThan(4);
      const at = (share: number) => work[Math.floor(share * (work.length - 1))]!.toFixed(1);
      console.log(`${PANELS} panels, ${what}: ${work.length} frames, median ${at(0.5)} ms, 90 % ${at(0.9)} ms, most ${at(1)} ms`);
    }
  } finally {
    await shown.close();
    place.clean();
  }
});
