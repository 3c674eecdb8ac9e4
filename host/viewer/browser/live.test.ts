//! Runs that go on, and one that was recorded, in a real browser against the simulator.

import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { join } from "node:path";
import type { BrowserContext, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect, test } from "vitest";
import { browser, faultsByAxe, mosaic, repository, scratch, serve, type Served, zygote } from "./shown";

const place = scratch();
const { folder } = place;
let context: BrowserContext;
let open: Served[] = [];

beforeAll(async () => {
  const rig = join(repository, "sim/scenarios/rigs/sma.toml");
  zygote(folder, "plan", join(repository, "models/cube6.txt"), "-o", "cube.fold");
  zygote(folder, "schedule", "cube.fold", "--rig", rig, "--parallel", "2");
  context = await browser(folder);
});

afterEach(async () => {
  for (const page of context.pages().slice(1)) await page.close();
  for (const { program } of open) program.kill();
  open = [];
});

afterAll(async () => {
  await context?.close();
  place.clean();
});

const RIG = join(repository, "sim/scenarios/rigs/sma.toml");

async function deploy(...options: string[]): Promise<Served> {
  const served = await serve(folder, "deploy", "cube.fold", "--rig", RIG, "--sim", "--view", ...options);
  open.push(served);
  return served;
}

async function look(address: string): Promise<Page> {
  const page = await context.newPage();
  page.on("pageerror", (error) => expect.fail(`the page fell over: ${error.message}`));
  await page.goto(address);
  await page.waitForSelector("html[data-ready]");
  return page;
}

const order = (page: Page, name: string) => page.locator(`[data-order="${name}"]`).click();
const stage = (page: Page, name: string) => page.waitForSelector(`html[data-stage="${name}"]`);
const opened = async (page: Page) => Number.parseInt(/(\d+) of 5 hinges/.exec(await page.locator("#run dl").innerText())![1]!);

/** Arms, starts, and waits until a hinge is seen to be heated. */
async function start(page: Page): Promise<void> {
  await stage(page, "loaded");
  await order(page, "arm");
  await stage(page, "armed");
  await order(page, "start");
  await stage(page, "running");
  await page.locator("#run .moving", { hasText: /Hinge \d\s*heating \d+ %\s*\d+ °C\s*\d+°/ }).waitFor();
}

test("a run is armed, started and seen through to its end", async () => {
  const served = await deploy("--pace", "8", "--record", "whole.mcap");
  const page = await look(served.address);
  await stage(page, "loaded");
  const still = await mosaic(page, 24, 16);
  await page.waitForTimeout(300);
  expect(await opened(page)).toBe(0);
  expect(await page.locator("#run .waiting").textContent()).toMatch(/^Waiting: \d.*after \d/);
  await start(page);
  expect(await page.getByRole("listbox", { name: "Colour" }).inputValue()).toBe("temperature");
  await stage(page, "over");
  expect(await opened(page)).toBe(5);
  expect(await page.locator("#run .result").textContent()).toContain("deployed: nothing: every hinge is open");
  expect(await mosaic(page, 24, 16)).not.toEqual(still);
  await order(page, "end");
  expect(await served.ended).toBe(0);
  expect(served.said()).toContain("true angles: 5 of 5 hinges within 1°");
});

test("one key stops it, with a dialog open too, and the page says when the MCU has confirmed", async () => {
  const page = await look((await deploy("--pace", "1")).address);
  await start(page);
  await page.keyboard.press("?");
  expect(await page.getByRole("dialog", { name: "Keys" }).isVisible()).toBe(true);
  await page.keyboard.press("Escape");
  await page.locator('#stop[data-how="confirmed"]').waitFor();
  expect(await page.locator("#stop .told").textContent()).toMatch(/^Confirmed by the MCU \d+ ms after the key: it is Safe, everything is off\.$/);
  const took = Number(await page.locator("#stop").getAttribute("data-took"));
  console.log(`from the key to the MCU's confirmation: ${took} ms`);
  expect(took).toBeLessThan(1000);
  await stage(page, "safe");
  expect(await opened(page)).toBeLessThan(5);
  // Nobody goes on before somebody has looked; then what is left is loaded, armed and started as the whole was.
  await order(page, "clear");
  await stage(page, "cleared");
  await order(page, "resume");
  await stage(page, "loaded");
  expect(await page.locator("#stop .told").textContent()).toBe("");
  await page.getByRole("button", { name: /STOP/ }).click();
  await page.locator('#stop[data-how="confirmed"]').waitFor();
});

test("a run is paused, and goes on from there", async () => {
  const page = await look((await deploy("--pace", "6")).address);
  await start(page);
  await order(page, "pause");
  await stage(page, "paused");
  expect(await page.locator("#run .controls").innerText()).toContain("Everything is off");
  const before = await opened(page);
  await page.waitForTimeout(500);
  expect(await opened(page)).toBe(before);
  await order(page, "resume");
  await stage(page, "running");
  await stage(page, "over");
  expect(await opened(page)).toBe(5);
});

test("a page without control watches and can stop; one that comes back sees all of it", async () => {
  const { address } = await deploy("--pace", "0.5");
  const page = await look(address);
  await start(page);
  const second = await look(address);
  await second.locator("#run .controls", { hasText: "Another page has control" }).waitFor();
  expect(await second.locator('[data-order="pause"]').count()).toBe(0);
  await page.close();
  await order(second, "control");
  await second.locator('[data-order="pause"]').waitFor();
  const third = await look(address);
  await stage(third, "running");
  expect(await third.locator("#run li", { hasText: "The MCU is armed" }).count()).toBe(1);
  // A list that drops down would keep the key to itself.
  await third.getByRole("listbox", { name: "Colour" }).selectOption("pile");
  await third.getByRole("listbox", { name: "Colour" }).click();
  await third.keyboard.press("Escape");
  await third.locator('#stop[data-how="confirmed"]').waitFor();
  await stage(second, "safe");
});

test("without the secret, and from another page's address, nobody is let in", async () => {
  const { address } = await deploy("--pace", "4");
  const bare = address.replace(/#.*/, "");
  const page = await look(`${bare}#${"0".repeat(32)}`);
  await page.locator("#run .faults", { hasText: "Not let in" }).waitFor();
  expect(await page.locator("html").getAttribute("data-stage")).toBe(null);
  const elsewhere = createServer((_, answer) => answer.setHeader("Content-Type", "text/html").end("<title>elsewhere</title>"));
  await new Promise<void>((done) => elsewhere.listen(0, "127.0.0.1", done));
  const foreign = await context.newPage();
  await foreign.goto(`http://127.0.0.1:${(elsewhere.address() as AddressInfo).port}/`);
  const outcome = await foreign.evaluate((live) => new Promise<string>((done) => {
    const socket = new WebSocket(live);
    socket.onopen = () => done("let in");
    socket.onclose = ({ code }) => done(`closed with ${code}`);
  }), `${bare.replace("http", "ws")}live`);
  elsewhere.close();
  expect(outcome).toBe("closed with 1006");
});

test("a stop that nobody can confirm is told loudly", async () => {
  const served = await deploy("--pace", "1");
  const page = await look(served.address);
  await start(page);
  served.program.kill("SIGKILL");
  await page.waitForSelector('html[data-line="broken"]');
  await page.keyboard.press("Escape");
  expect(await page.locator("#stop .told").textContent()).toMatch(/^NOT CONFIRMED\. Cut the power\./);
  expect(await page.locator("#run .controls").innerText()).toContain("No line to the program");
});

test("a fault is told, and where", async () => {
  const scenario = join(repository, "sim/scenarios/s06-heater-open.toml");
  const page = await look((await deploy("--pace", "15", "--yes", "--scenario", scenario, "--record", "fault.mcap")).address);
  await stage(page, "safe");
  await page.locator("#run .faults", { hasText: /F\d\d: .* at hinge \d/ }).waitFor();
});

test("runs are chosen from a page, one after the other", async () => {
  const rig = join(repository, "sim/scenarios/rigs/servo.toml");
  for (const name of ["one", "two"]) {
    zygote(folder, "plan", join(repository, "models/cube6.txt"), "-o", `${name}.fold`);
    zygote(folder, "schedule", `${name}.fold`, "--rig", rig);
  }
  const served = await serve(folder, "serve", "one.fold", "two.fold", "--rig", rig, "--sim", "--pace", "20");
  open.push(served);
  const page = await look(served.address);
  await stage(page, "idle");
  for (const file of ["two.fold", "one.fold"]) {
    await page.getByRole("button", { name: `Load ${file}` }).click();
    await stage(page, "loaded");
    await order(page, "arm");
    await stage(page, "armed");
    await order(page, "start");
    await stage(page, "over");
    expect(await opened(page)).toBe(5);
  }
  await order(page, "end");
  expect(await served.ended).toBe(0);
});

test("a recorded run is gone through, with its temperatures and its fault", async () => {
  const whole = await serve(folder, "replay", "whole.mcap", "--view");
  open.push(whole);
  const page = await look(whole.address);
  const slider = page.getByRole("slider", { name: "From the stack to the shape" });
  expect(await opened(page)).toBe(0);
  await slider.fill("5000");
  await page.locator("#run .moving", { hasText: "°C" }).waitFor();
  const half = await opened(page);
  expect(half).toBeGreaterThan(0);
  expect(half).toBeLessThan(5);
  const coloured = await mosaic(page, 24, 16);
  await page.getByRole("combobox", { name: "Colour" }).selectOption("pile");
  expect(await mosaic(page, 24, 16)).not.toEqual(coloured);
  await slider.fill("10000");
  expect(await opened(page)).toBe(5);
  expect(await page.locator("#stop").count()).toBe(0);
  const fault = await serve(folder, "replay", "fault.mcap", "--view");
  open.push(fault);
  const other = await look(fault.address);
  expect(await other.locator("#run .faults").innerText()).toMatch(/F\d\d: .* at hinge \d/);
});

test("nobody is shut out of a run", async () => {
  const page = await look((await deploy("--pace", "1")).address);
  await start(page);
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    expect(await faultsByAxe(page), colorScheme).toEqual([]);
  }
  await page.emulateMedia({ colorScheme: "light" });
});
