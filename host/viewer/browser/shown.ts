//! A plan shown by the program in a real browser, for the tests of the page. `ZYGOTE` and `BROWSER_PROGRAM` name the two programs.

import { type ChildProcess, execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { type BrowserContext, chromium, type Page } from "playwright-core";

/** Without a graphics card, and without a word to anyone. */
const FLAGS = [
  "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu",
  "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];

function named(variable: string): string {
  const value = process.env[variable];
  if (!value) throw new Error(`${variable} must name a program; run \`cargo xtask viewer --test\``);
  return value;
}

export const repository = fileURLToPath(new URL("../../../", import.meta.url));

/** Runs the program to its end. */
export function zygote(folder: string, ...options: string[]): string {
  return execFileSync(named("ZYGOTE"), options, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
}

/** A folder that is gone at the end of the tests. */
export function scratch(): { folder: string; clean: () => void } {
  const folder = mkdtempSync(join(tmpdir(), "zygote-viewer-"));
  return { folder, clean: () => rmSync(folder, { recursive: true, force: true, maxRetries: 20, retryDelay: 50 }) };
}

export interface Shown {
  readonly page: Page;
  readonly context: BrowserContext;
  readonly address: string;
  /** What the page complained of, and whom it asked. */
  readonly complaints: string[];
  readonly asked: string[];
  close(): Promise<void>;
}

export interface Served {
  readonly address: string;
  readonly program: ChildProcess;
  /** What it said so far. */
  readonly said: () => string;
  /** Its exit code, once it has ended. */
  readonly ended: Promise<number | null>;
}

/** Has the program serve a page; `verb` says what of. */
export async function serve(folder: string, verb: string, ...options: string[]): Promise<Served> {
  const program = spawn(named("ZYGOTE"), [verb, ...options, "--no-open"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  let said = "";
  const ended = new Promise<number | null>((resolve) => program.on("exit", resolve));
  const address = await new Promise<string>((resolve, reject) => {
    program.stdout.on("data", (part: Buffer) => {
      said += part.toString();
      const found = /http:\/\/\S+(?= )/.exec(said);
      if (found) resolve(found[0]);
    });
    void ended.then((code) => reject(new Error(`zygote ${verb} ended with ${code}: ${said}`)));
  });
  return { address, program, said: () => said, ended };
}

/** A browser with a profile of its own in the folder. */
export function browser(folder: string): Promise<BrowserContext> {
  return chromium.launchPersistentContext(join(folder, "profile"), {
    executablePath: named("BROWSER_PROGRAM"), args: FLAGS, viewport: { width: 840, height: 560 }, colorScheme: "light",
  });
}

/** Serves a plan, and opens the page. */
export async function show(folder: string, ...options: string[]): Promise<Shown> {
  const server = await serve(folder, "view", ...options);
  const { address } = server;
  const context = await browser(folder);
  const page = context.pages()[0] ?? (await context.newPage());
  const complaints: string[] = [];
  const asked: string[] = [];
  page.on("console", (message) => {
    // Drawing without a graphics card is slow, says the browser.
    if (["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("request", (request) => asked.push(request.url()));
  await page.goto(address);
  await page.waitForSelector("html[data-ready]");
  return {
    page, context, address, complaints, asked,
    close: async () => {
      await context.close();
      server.program.kill();
    },
  };
}

/** What axe finds wrong for people who don't see, or don't use a mouse. */
export async function faultsByAxe(page: Page): Promise<string[]> {
  await page.evaluate(readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8"));
  return page.evaluate(async () => {
    const run = (globalThis as unknown as { axe: { run(): Promise<{ violations: { id: string; nodes: { html: string }[] }[] }> } }).axe.run();
    return (await run).violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" ")}`);
  });
}

/** Colours of the picture, in so many columns and rows: red, green and blue, 0 to 255. */
export async function mosaic(page: Page, columns: number, rows: number): Promise<number[]> {
  const shot = (await page.locator("#stage").screenshot()).toString("base64");
  return page.evaluate(
    async ([shot, columns, rows]) => {
      const bytes = Uint8Array.from(atob(shot), (letter) => letter.charCodeAt(0));
      const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }), {
        resizeWidth: columns, resizeHeight: rows, resizeQuality: "high",
      });
      const drawing = new OffscreenCanvas(columns, rows).getContext("2d")!;
      drawing.drawImage(image, 0, 0);
      return [...drawing.getImageData(0, 0, columns, rows).data].filter((_, at) => at % 4 < 3);
    },
    [shot, columns, rows] as const,
  );
}
