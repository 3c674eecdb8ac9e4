//! What others' programs make of our files: the library of FOLD's authors folds them, Khronos's validator reads scenes.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { afterAll, beforeAll, expect, test } from "vitest";
import { repository, scratch, zygote } from "./shown";

type Point = readonly number[];

interface Fold {
  vertices_coords: Point[];
  faces_vertices: number[][];
  edges_vertices: number[][];
  edges_faces: (number | null)[][];
  edges_assignment: string[];
  edges_foldAngle: number[];
  faces_edges?: number[][];
  vertices_flatFoldCoords?: Point[];
  faces_flatFoldOrientation?: number[];
  file_frames?: { vertices_coords: Point[] }[];
  "zygote:piles"?: { panels: number[] }[];
}

/** What is used of the library. It has no types of its own. */
interface Library {
  filter: Record<"numVertices" | "numEdges" | "numFaces", (fold: Fold) => number> &
    Record<"mountainEdges" | "valleyEdges" | "flatEdges" | "boundaryEdges" | "cutEdges", (fold: Fold) => number[]> &
    Record<"removeDuplicateEdges_vertices" | "removeLoopEdges", (fold: Fold) => unknown>;
  convert: {
    deepCopy(fold: Fold): Fold;
    toJSON(fold: Fold): string;
    faces_vertices_to_edges(fold: Partial<Fold>): Fold;
    faces_vertices_to_faces_edges(fold: Fold): Fold;
    flatFoldedGeometry(fold: Fold, rootFace: number): number;
  };
}

interface Validator {
  validateBytes(bytes: Uint8Array): Promise<{ issues: { numErrors: number; numWarnings: number; messages: unknown[] } }>;
}

const require = createRequire(import.meta.url);
const { filter, convert } = require("fold") as Library;
const validator = require("gltf-validator") as Validator;

const place = scratch();
afterAll(place.clean);

const SHAPES = [["fish92.txt", 1], ["fish92.txt", 4], ["torus32.txt", 4], ["sheet12.obj", 4]] as const;
const named = (shape: string, piles: number) => `${shape}.${piles}`;
const read = (name: string) => JSON.parse(readFileSync(join(place.folder, name), "utf8")) as Fold;

beforeAll(() => {
  for (const [shape, piles] of SHAPES) {
    const name = named(shape, piles);
    zygote(place.folder, "plan", join(repository, "models", shape), "--piles", `${piles}`, "-o", `${name}.fold`);
    const files = ["--crease", `${name}.crease.fold`, "--gltf", `${name}.glb`, "--target", `${name}.target.glb`];
    zygote(place.folder, "export", `${name}.fold`, ...files);
  }
});

test.each(SHAPES)("the FOLD library finds the vertices, edges and hinges of %s in %d piles as they are written", (shape, piles) => {
  for (const name of [`${named(shape, piles)}.fold`, `${named(shape, piles)}.crease.fold`]) {
    const plan = read(name);
    const panels = plan.faces_vertices.length;
    expect([filter.numVertices(plan), filter.numEdges(plan), filter.numFaces(plan)]).toEqual([2 * panels + 2, 3 * panels + 1, panels]);
    const hinges = [filter.mountainEdges(plan), filter.valleyEdges(plan), filter.flatEdges(plan)].flat();
    expect(hinges.length).toBe(panels - 1);
    expect(filter.boundaryEdges(plan).length).toBe(2 * panels + 2);
    expect(filter.cutEdges(plan)).toEqual([]);
    // From the faces alone it comes to the same edges, with the same faces at them.
    const key = (edge: number[]) => [...edge].sort((a, b) => a - b).join();
    const faces = (edge: (number | null)[] | undefined) => edge?.filter((face) => face !== null).sort((a, b) => a! - b!);
    const found = convert.faces_vertices_to_edges({ faces_vertices: plan.faces_vertices.map((face) => [...face]) });
    const facesAt = new Map(found.edges_vertices.map((edge, at) => [key(edge), faces(found.edges_faces[at])]));
    expect(facesAt.size).toBe(plan.edges_vertices.length);
    plan.edges_vertices.forEach((edge, at) => expect(facesAt.get(key(edge))).toEqual(faces(plan.edges_faces[at])));
    // It has nothing to clean up, and writes what it read.
    const cleaned = convert.deepCopy(plan);
    filter.removeDuplicateEdges_vertices(cleaned);
    filter.removeLoopEdges(cleaned);
    expect(cleaned.edges_vertices).toEqual(plan.edges_vertices);
    expect(JSON.parse(convert.toJSON(plan))).toEqual(plan);
  }
});

test("folded flat by the FOLD library, the crease pattern of a single pile is its stack", () => {
  const plan = read("fish92.txt.1.fold");
  const pattern = read("fish92.txt.1.crease.fold");
  convert.faces_vertices_to_faces_edges(pattern);
  expect(convert.flatFoldedGeometry(pattern, 0)).toBe(0);
  // The frame of the zygote, seen from its first panel as the library sees it.
  const zygote = plan.file_frames![0]!.vertices_coords;
  const [origin, x, , y] = plan.faces_vertices[0]!.map((vertex) => zygote[vertex]!);
  const [netOrigin, netX, , netY] = plan.faces_vertices[0]!.map((vertex) => pattern.vertices_coords[vertex]!);
  const minus = (a: Point, b: Point) => [a[0]! - b[0]!, a[1]! - b[1]!] as const;
  const dot = (a: Point, b: Point) => a[0]! * b[0]! + a[1]! * b[1]!;
  const [alongX, alongY] = [minus(x!, origin!), minus(y!, origin!)];
  const [toX, toY] = [minus(netX!, netOrigin!), minus(netY!, netOrigin!)];
  pattern.vertices_flatFoldCoords!.forEach((folded, vertex) => {
    const arm = minus(zygote[vertex]!, origin!);
    const [across, up] = [dot(arm, alongX), dot(arm, alongY)];
    const found = minus(folded, netOrigin!);
    const off = minus(found, [across * toX[0] + up * toY[0], across * toX[1] + up * toY[1]]);
    expect(Math.hypot(...off)).toBe(0);
  });
  // Outer sides are up and down by turns.
  const sides = plan["zygote:piles"]![0]!.panels.map((panel) => pattern.faces_flatFoldOrientation![panel]!);
  sides.slice(1).forEach((side, below) => expect(side).toBe(-sides[below]!));
});

test.each(SHAPES)("the glTF validator has nothing to say of the scenes of %s in %d piles", async (shape, piles) => {
  for (const ending of ["glb", "target.glb"]) {
    const bytes = readFileSync(join(place.folder, `${named(shape, piles)}.${ending}`));
    const { issues } = await validator.validateBytes(new Uint8Array(bytes));
    expect(issues.messages).toEqual([]);
    expect([issues.numErrors, issues.numWarnings]).toEqual([0, 0]);
  }
});
