import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { afterAll, beforeAll, beforeEach, expect, test } from "vitest";
import { faultsByAxe, mosaic, repository, scratch, show, type Shown, zygote } from "./shown";

const place = scratch();
let shown: Shown;

beforeAll(async () => {
  const { folder } = place;
  zygote(folder, "plan", join(repository, "models/fish92.txt"), "--piles", "4", "--free", "ideal", "-o", "fish.fold");
  zygote(folder, "schedule", "fish.fold", "--rig", join(repository, "models/rigs/sma-160.toml"), "--output", "fish.json");
  shown = await show(folder, "fish.fold", "--schedule", "fish.json");
});

afterAll(async () => {
  await shown?.close();
  place.clean();
});

beforeEach(async () => {
  await shown.page.keyboard.press("Escape");
  await shown.page.locator("#stage").focus();
  await shown.page.keyboard.press("Home");
});

/** What was asked for is drawn with the next frame. */
const drawn = () =>
  shown.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done)))));
const told = async () => {
  await drawn();
  return shown.page.locator("#time .told").textContent();
};
const card = () => shown.page.locator("#panel h2");
/** The panel at a height of a pile, and where its middle is on the page. */
const panelAt = (pile: number, height: number) =>
  shown.page.evaluate(async ([pile, height]) => {
    const scene = (await (await fetch("/scene.json")).json()) as { piles: { panels: number[] }[] };
    const panel = scene.piles[pile]!.panels.at(height)!;
    return { panel, ...globalThis.zygote!.where(panel) };
  }, [pile, height] as const);

test("the page says what the plan is, asks nobody else and complains of nothing", async () => {
  const { page, address } = shown;
  expect(await page.title()).toBe("fish92.txt · zygote");
  expect(await page.locator("#what").innerText()).toMatch(/^fish92\s+92 panels in 4 piles of 23 · [\d.]+ times the volume\s+No collision/);
  expect(await told()).toBe("0 of 91 hinges open");
  expect(shown.asked.every((url) => url.startsWith(address) || url.startsWith("data:"))).toBe(true);
  expect(shown.complaints).toEqual([]);
});

test("what a script from elsewhere would do, the page's policy forbids", async () => {
  const { page } = shown;
  const outcome = await page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "document.title = 'taken over'";
    document.body.append(script);
    return fetch("http://127.0.0.1:1/").then(() => "asked", (error: Error) => error.message);
  });
  expect(outcome).toContain("Failed to fetch");
  expect(await page.title()).toBe("fish92.txt · zygote");
  expect(shown.complaints.splice(0).filter((text) => text.includes("Content Security Policy")).length).toBeGreaterThanOrEqual(2);
});

test("the slider goes from the stack to the shape", async () => {
  const { page } = shown;
  const slider = page.getByRole("slider", { name: "From the stack to the shape" });
  const stack = await mosaic(page, 24, 16);
  await slider.fill("10000");
  expect(await told()).toBe("91 of 91 hinges open");
  expect(await slider.getAttribute("aria-valuetext")).toMatch(/^\d+:\d\d.* \/ .*, 91 of 91 hinges open$/);
  expect(await mosaic(page, 24, 16)).not.toEqual(stack);
  await slider.fill("5000");
  expect(Number.parseInt((await told()) ?? "")).toBeGreaterThan(10);
});

test("it plays, and stops when asked to", async () => {
  const { page } = shown;
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => Number.parseInt(document.querySelector("#time .told")!.textContent!) > 2);
  await page.getByRole("button", { name: "Pause" }).click();
  const at = await told();
  await page.waitForTimeout(300);
  expect(await told()).toBe(at);
});

test("a click on a panel tells of that panel, a click beside picks nothing", async () => {
  const { page } = shown;
  for (const pile of [0, 3]) {
    await drawn();
    const { panel, x, y } = await panelAt(pile, -1);
    await page.mouse.click(x, y);
    expect(await card().textContent()).toMatch(new RegExp(`^Panel ${panel}\\b`));
    expect(await page.locator("#panel").innerText()).toContain(`Pile ${pile}, height 22 of 22`);
  }
  await page.mouse.click(30, 300);
  expect(await page.locator("#panel").isHidden()).toBe(true);
});

test("a panel can be named, and its neighbours gone to", async () => {
  const { page } = shown;
  await page.getByLabel("Panel", { exact: true }).fill("17");
  await page.keyboard.press("Tab");
  expect(await card().textContent()).toMatch(/^Panel 17\b/);
  const other = page.locator("#panel .link").first();
  const name = (await other.textContent())!.replace("panel", "Panel");
  await other.click();
  expect(await card().textContent()).toMatch(new RegExp(`^${name}\\b`));
});

test("everything can be done with keys", async () => {
  const { page } = shown;
  const press = (...keys: string[]) => keys.reduce((before, key) => before.then(() => page.keyboard.press(key)), Promise.resolve());
  await press("ArrowRight", "ArrowRight");
  expect(await told()).not.toBe("0 of 91 hinges open");
  await press("End");
  expect(await told()).toBe("91 of 91 hinges open");
  await press("]", "]");
  expect(await page.locator("#panel").innerText()).toContain("Pile 0, height 1 of 22");
  await press("[");
  expect(await page.locator("#panel").innerText()).toContain("height 0 of 22");
  const first = await card().textContent();
  await press("n");
  expect(await card().textContent()).not.toBe(first);
  await press("c");
  expect(await page.getByRole("combobox", { name: "Colour" }).inputValue()).toBe("height");
  for (const mode of ["time", "hinge", "drive", "pile"]) {
    await press("c");
    expect(await page.getByRole("combobox", { name: "Colour" }).inputValue()).toBe(mode);
  }
  await press("h");
  await drawn();
  expect(await page.locator(".label:visible").count()).toBeGreaterThan(20);
  expect(await page.locator(".label:visible").first().textContent()).toMatch(/^[ENWS] (90|180|270)°$/);
  const together = await mosaic(page, 24, 16);
  await press("h", "x");
  expect(await page.getByLabel("Apart").inputValue()).toBe("1");
  await page.waitForTimeout(700);
  expect(await mosaic(page, 24, 16)).not.toEqual(together);
  await press("x", "?");
  expect(await page.getByRole("dialog", { name: "Keys" }).isVisible()).toBe(true);
  await press("Escape");
  expect(await page.getByRole("dialog").count()).toBe(0);
});

test("it is light or dark as the system says, until somebody chooses", async () => {
  const { page } = shown;
  const corner = async () => (await mosaic(page, 24, 16)).slice(0, 3).reduce((sum, byte) => sum + byte, 0) / 3;
  expect(await corner()).toBeGreaterThan(200);
  await page.emulateMedia({ colorScheme: "dark" });
  expect(await corner()).toBeLessThan(60);
  await page.keyboard.press("t");
  expect(await corner()).toBeGreaterThan(200);
  await page.reload();
  await page.waitForSelector("html[data-ready]");
  expect(await corner()).toBeGreaterThan(200);
  await page.evaluate(() => localStorage.clear());
  await page.emulateMedia({ colorScheme: "light" });
  await page.reload();
  await page.waitForSelector("html[data-ready]");
});

/** A picture may differ by so much of full light on average: another version of the browser draws edges otherwise. */
const LOOSE = 5;

test("the pictures are those that were looked at", async () => {
  const { page } = shown;
  const golden = new URL("mosaics.json", import.meta.url);
  const found: Record<string, number[]> = {};
  for (const key of ["Home", "End"]) {
    await page.keyboard.press(key);
    await page.keyboard.press("f");
    await page.waitForTimeout(300);
    found[key] = await mosaic(page, 24, 16);
  }
  if (process.env["UPDATE_GOLDEN"]) writeFileSync(golden, `${JSON.stringify(found)}\n`);
  const looked = JSON.parse(readFileSync(golden, "utf8")) as Record<string, number[]>;
  const difference = (a: number[], b: number[]) => a.reduce((sum, byte, at) => sum + Math.abs(byte - b[at]!), 0) / a.length;
  for (const key of ["Home", "End"]) expect(difference(found[key]!, looked[key]!), key).toBeLessThan(LOOSE);
  expect(difference(looked["Home"]!, looked["End"]!)).toBeGreaterThan(2 * LOOSE);
});

test("nobody is shut out", async () => {
  const { page } = shown;
  await page.keyboard.press("]");
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    expect(await faultsByAxe(page), colorScheme).toEqual([]);
  }
  await page.emulateMedia({ colorScheme: "light" });
});

test("a picture is written as asked", () => {
  const { folder } = place;
  const browser = process.env["BROWSER_PROGRAM"]!;
  const said = zygote(folder, "view", "fish.fold", "--png", "fish.png", "--at", "0.4", "--size", "400x300", "--browser", browser);
  const png = readFileSync(join(folder, "fish.png"));
  expect(png.subarray(1, 4).toString()).toBe("PNG");
  expect([png.readUInt32BE(16), png.readUInt32BE(20)]).toEqual([400, 300]);
  // A picture of nothing would be far smaller.
  expect(png.length).toBeGreaterThan(8_000);
  expect(said).toMatch(/^fish\.png: \d+ kB\n$/);
});
