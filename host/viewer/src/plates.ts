//! All panels as one instanced mesh of thin plates: the outer side in the panel's colour, the inner side paler, edges darker.

import {
  BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, InstancedBufferAttribute, InstancedMesh, MeshLambertMaterial,
} from "three";
import type { Rgb } from "./colour";
import { SIZE } from "./pose";

/** From the edge of a panel to that of its plate. */
const GAP = 0.012;
/** Thickness of a plate over that of a layer, so that layers stay apart. */
const PART = 0.8;
/** A plate is at least so thick, so that it has an edge to see. */
const LEAST = 0.0025;

/** How a panel stands out. */
export const enum Mark {
  None = 0,
  /** Joined to the picked one. */
  Joined = 1,
  Picked = 2,
}

export function halfThickness(thickness: number): number {
  return Math.max((PART * thickness) / 2, LEAST);
}

export class Plates {
  readonly mesh: InstancedMesh<BufferGeometry, MeshLambertMaterial>;
  private readonly marks: InstancedBufferAttribute;
  private readonly paper = { value: new Color() };
  private readonly accent = { value: new Color() };

  constructor(panels: number, thickness: number) {
    const material = new MeshLambertMaterial({ color: 0xffffff });
    material.onBeforeCompile = (shader) => {
      shader.uniforms["paper"] = this.paper;
      shader.uniforms["accent"] = this.accent;
      shader.vertexShader = shader.vertexShader
        .replace("#include <common>", `#include <common>\n${VARYINGS_IN}`)
        .replace("#include <begin_vertex>", "#include <begin_vertex>\nvFace = face; vMark = mark;");
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", `#include <common>\n${VARYINGS_OUT}`)
        .replace("#include <color_fragment>", `#include <color_fragment>\n${COLOUR}`);
    };
    const geometry = plate(halfThickness(thickness));
    this.marks = new InstancedBufferAttribute(new Float32Array(panels), 1);
    geometry.setAttribute("mark", this.marks);
    this.mesh = new InstancedMesh(geometry, material, panels);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
  }

  place(frames: Float64Array, apart: Float64Array, explode: number): void {
    const into = this.mesh.instanceMatrix.array;
    for (let panel = 0, at = 0, to = 0; panel < this.mesh.count; panel++, at += SIZE, to += 16) {
      for (let column = 0; column < 4; column++) {
        for (let row = 0; row < 3; row++) into[to + column * 4 + row] = frames[at + column * 3 + row]!;
      }
      for (let row = 0; row < 3; row++) into[to + 12 + row]! += explode * apart[panel * 3 + row]!;
      into[to + 15] = 1;
    }
    this.mesh.instanceMatrix.needsUpdate = true;
    // Made anew when something is picked.
    this.mesh.boundingSphere = null;
    this.mesh.boundingBox = null;
  }

  paint(colours: readonly Rgb[]): void {
    const colour = new Color();
    colours.forEach((rgb, panel) => this.mesh.setColorAt(panel, colour.setRGB(...rgb)));
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  mark(picked: number | undefined, joined: readonly number[]): void {
    this.marks.array.fill(Mark.None);
    for (const panel of joined) this.marks.array[panel] = Mark.Joined;
    if (picked !== undefined) this.marks.array[picked] = Mark.Picked;
    this.marks.needsUpdate = true;
  }

  theme(paper: string, accent: string): void {
    this.paper.value.set(paper);
    this.accent.value.set(accent);
  }
}

const VARYINGS_IN = `
attribute vec3 face;
attribute float mark;
varying vec3 vFace;
varying float vMark;
`;

const VARYINGS_OUT = `
uniform vec3 paper;
uniform vec3 accent;
varying vec3 vFace;
varying float vMark;
`;

// face.xy: where on the square; face.z: 0 outer side, 1 inner side, 2 edge.
const COLOUR = `
vec3 own = diffuseColor.rgb;
if (vFace.z > 1.5) {
  diffuseColor.rgb = mix(own * 0.62, accent, step(1.5, vMark));
} else {
  if (vFace.z > 0.5) diffuseColor.rgb = mix(own, paper, 0.66);
  vec2 border = min(vFace.xy, 1.0 - vFace.xy);
  float edge = min(border.x, border.y);
  float pixel = fwidth(edge);
  // A hairline, which fades where panels are but few pixels wide.
  float line = 1.0 - smoothstep(0.014, 0.014 + 1.5 * pixel, edge);
  diffuseColor.rgb = mix(diffuseColor.rgb, own * 0.42, 0.55 * line * clamp(1.3 - 22.0 * pixel, 0.0, 1.0));
  float width = vMark > 1.5 ? 0.085 : 0.03;
  float frame = (1.0 - smoothstep(width, width + pixel, edge)) * step(0.5, vMark);
  diffuseColor.rgb = mix(diffuseColor.rgb, accent, frame);
  if (vMark > 1.5) diffuseColor.rgb = mix(diffuseColor.rgb, accent, 0.16);
}
`;

/** A plate in a panel's frame: the square from (0, 0) to (1, 1), its outer side up. */
function plate(half: number): BufferGeometry {
  const positions: number[] = [];
  const normals: number[] = [];
  const faces: number[] = [];
  const low = GAP;
  const high = 1 - GAP;
  const square = [[low, low], [high, low], [high, high], [low, high]] as const;
  const add = (corners: readonly (readonly [number, number, number])[], normal: readonly number[], kind: number) => {
    for (const index of [0, 1, 2, 0, 2, 3]) {
      const [x, y, z] = corners[index]!;
      positions.push(x, y, z);
      normals.push(...normal);
      faces.push((x - low) / (high - low), (y - low) / (high - low), kind);
    }
  };
  const at = (index: number, z: number) => [...square[index % 4]!, z] as const;
  add([0, 1, 2, 3].map((index) => at(index, half)), [0, 0, 1], 0);
  add([0, 3, 2, 1].map((index) => at(index, -half)), [0, 0, -1], 1);
  const outward = [[0, -1, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0]];
  for (let side = 0; side < 4; side++) {
    add([at(side, -half), at(side + 1, -half), at(side + 1, half), at(side, half)], outward[side]!, 2);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("normal", new BufferAttribute(new Float32Array(normals), 3));
  geometry.setAttribute("face", new BufferAttribute(new Float32Array(faces), 3));
  return geometry;
}
