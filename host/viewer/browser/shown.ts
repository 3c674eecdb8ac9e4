//! A plan shown by the program in a real browser, for the tests of the page. `ZYGOTE` and `BROWSER_PROGRAM` name the two programs.

import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
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

/** Serves a plan, and opens the page. */
export async function show(folder: string, ...options: string[]): Promise<Shown> {
  const server = spawn(named("ZYGOTE"), ["view", ...options, "--no-open"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  const address = await new Promise<string>((resolve, reject) => {
    let said = "";
    server.stdout.on("data", (part: Buffer) => {
      said += part.toString();
      const found = /http:\/\/\S+\//.exec(said);
      if (found) resolve(found[0]);
    });
    server.on("exit", (code) => reject(new Error(`zygote view ended with ${code}: ${said}`)));
  });
  const context = await chromium.launchPersistentContext(join(folder, "profile"), {
    executablePath: named("BROWSER_PROGRAM"), args: FLAGS, viewport: { width: 840, height: 560 }, colorScheme: "light",
  });
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
      server.kill();
    },
  };
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
