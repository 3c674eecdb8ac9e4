//! `npm run pictures`: the pictures of the viewer in the book, made by the program.

import { statSync } from "node:fs";
import { join } from "node:path";
import { expect, test } from "vitest";
import { browser, repository, scratch, serve, show, zygote } from "./shown";

/** All of them together. */
const MOST_BYTES = 400_000;

test("the book's pictures", async () => {
  const { folder, clean } = scratch();
  const images = join(repository, "docs/src/images");
  zygote(folder, "plan", join(repository, "models/fish92.txt"), "--piles", "4", "--free", "ideal", "-o", "fish.fold");
  zygote(folder, "schedule", "fish.fold", "--rig", join(repository, "models/rigs/sma-160.toml"));
  const apart = ["--explode", "0.7", "--colour", "hinge", "--size", "640x440"];
  zygote(folder, "view", "fish.fold", "--png", join(images, "viewer-apart.png"), ...apart, "--browser", process.env["BROWSER_PROGRAM"]!);
  const shown = await show(folder, "fish.fold");
  try {
    const { page } = shown;
    await page.setViewportSize({ width: 960, height: 600 });
    const slider = page.getByRole("slider", { name: "From the stack to the shape" });
    const shot = async (name: string) => {
      await page.evaluate(() => (document.activeElement as HTMLElement).blur());
      await page.waitForTimeout(1500);
      await page.screenshot({ path: join(images, name) });
    };
    await slider.fill("8000");
    await page.keyboard.press("f");
    await shot("viewer-fish.png");
    for (const key of ["End", "f", "h", "t", "d", "d"]) await page.keyboard.press(key);
    await page.getByLabel("Panel", { exact: true }).fill("41");
    await page.keyboard.press("Tab");
    await shot("viewer-panel.png");
  } finally {
    await shown.close();
  }
  const rig = join(repository, "models/rigs/sma-160.toml");
  const live = await serve(folder, "deploy", "fish.fold", "--rig", rig, "--sim", "--view", "--yes", "--pace", "12");
  const context = await browser(join(folder, "live"));
  try {
    const page = await context.newPage();
    await page.setViewportSize({ width: 1120, height: 720 });
    await page.goto(live.address);
    await page.waitForFunction(() => /(5\d|6\d) of 91/.test(document.querySelector("#run dl")?.textContent ?? ""), null, { timeout: 120_000 });
    await page.screenshot({ path: join(images, "viewer-live.png") });
  } finally {
    await context.close();
    live.program.kill();
    clean();
  }
  const bytes = ["fish", "panel", "apart", "live"].map((name) => statSync(join(images, `viewer-${name}.png`)).size);
  expect(bytes.reduce((sum, size) => sum + size)).toBeLessThan(MOST_BYTES);
});
