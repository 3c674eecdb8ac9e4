//! The build of the page, and its two kinds of tests.

import { defineConfig } from "vitest/config";
import { oneFile } from "./inline";

export default defineConfig({
  plugins: [oneFile()],
  build: {
    outDir: "page",
    // It holds a file that says what it is for.
    emptyOutDir: false,
    cssCodeSplit: false,
    modulePreload: false,
    chunkSizeWarningLimit: 2000,
    target: "es2022",
  },
  test: {
    fileParallelism: false,
    projects: [
      { test: { name: "unit", include: ["tests/**/*.test.ts"] } },
      {
        test: {
          name: "browser",
          include: ["browser/**/*.test.ts"],
          testTimeout: 60_000,
          hookTimeout: 60_000,
        },
      },
      // No part of the tests: the book's pictures, and how long the page works at a frame.
      { test: { name: "pictures", include: ["browser/pictures.ts"], testTimeout: 300_000, hookTimeout: 300_000 } },
      { test: { name: "measure", include: ["browser/measure.ts"], testTimeout: 300_000, hookTimeout: 300_000 } },
    ],
  },
});
