//! The picture: panels, hinges, light, a shadow on the ground, and the eye that goes around them.

import {
  Color, DirectionalLight, HemisphereLight, Mesh, PCFShadowMap, PerspectiveCamera, PlaneGeometry, Raycaster,
  Scene as Space, ShadowMaterial, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Frame } from "./framing";
import { Framing } from "./framing";
import { HingeBars } from "./hingeBars";
import { Motion } from "./motion";
import type { Paint } from "./paint";
import { halfThickness, Plates } from "./plates";
import type { Places, Scene } from "./scene";
import type { State } from "./source";
import type { Theme } from "./theme";

/** From the scene to the eye at first: enough from above to see the top, enough from the side to see layers. */
const TO_EYE = new Vector3(0.52, -0.78, 0.5).normalize();
const TO_LIGHT = new Vector3(-0.35, -0.5, 1).normalize();
/** Narrow, so that far panels look nearly as large as near ones. */
const FIELD_OF_VIEW = 24;
/** Pixels of the picture over those of the page, where drawing is slow. */
const COARSE = 0.6;

export class Stage {
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.1, 1000);
  readonly motion: Motion;
  readonly bars: HingeBars;
  readonly plates: Plates;
  readonly size = { width: 1, height: 1 };
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly space = new Space();
  private readonly sun = new DirectionalLight(0xffffff, 2.1);
  private readonly sky = new HemisphereLight(0xffffff, 0xffffff, 1.5);
  private readonly ground: Mesh<PlaneGeometry, ShadowMaterial>;
  private readonly framing: Framing;
  private frame: Frame;
  /** The smaller side of what isn't covered, over the height. */
  private free = 1;
  private coarse = false;
  private inset = { left: 0, right: 0, bottom: 0 };

  constructor(canvas: HTMLCanvasElement, scene: Scene, places: Places, changed: () => void) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: false });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.motion = new Motion(scene, places);
    this.framing = new Framing(this.motion, scene);
    this.frame = this.framing.at(0, 0);
    this.plates = new Plates(places.panels, scene.thickness);
    this.bars = new HingeBars(scene.hinges, halfThickness(scene.thickness));
    this.ground = new Mesh(new PlaneGeometry(1, 1), new ShadowMaterial());
    this.ground.receiveShadow = true;
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 7;
    this.space.add(this.plates.mesh, this.bars.mesh, this.ground, this.sun, this.sun.target, this.sky);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", changed);
  }

  /** `inset` is how much of each side is covered, in pixels: the middle is that of the rest. */
  resize(width: number, height: number, pixelRatio: number, inset = { left: 0, right: 0, bottom: 0 }): void {
    Object.assign(this.size, { width, height });
    this.inset = inset;
    this.free = Math.min(1 - inset.bottom / height, (width - inset.left - inset.right) / height);
    this.camera.setViewOffset(width, height, (inset.right - inset.left) / 2, inset.bottom / 2, width, height);
    this.renderer.setPixelRatio(this.coarse ? COARSE : Math.min(pixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** The eye back to where it began. */
  reset(): void {
    const field = (FIELD_OF_VIEW * Math.PI) / 360;
    const distance = (0.96 * this.frame.radius) / Math.sin(Math.atan(Math.tan(field) * this.free));
    this.controls.target.copy(this.frame.middle);
    this.camera.position.copy(TO_EYE).multiplyScalar(distance).add(this.frame.middle);
    this.controls.update();
  }

  /** Turns the eye by angles, and goes nearer or farther by a factor. */
  orbit(around: number, up: number, factor: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    offset.applyAxisAngle(this.camera.up, around);
    const level = new Vector3().crossVectors(this.camera.up, offset).normalize();
    const raised = offset.clone().applyAxisAngle(level, -up);
    if (Math.abs(raised.clone().normalize().z) < 0.995) offset.copy(raised);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  /** Puts everything where it is in a state; the eye follows what there is to see. */
  place(state: State, share: number, explode: number): void {
    const { motion, frame } = this;
    motion.place(state);
    this.plates.place(motion.frames, motion.apart, explode);
    this.bars.place(motion.frames, motion.apart, explode);
    const next = this.framing.at(share, explode);
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(next.radius / frame.radius);
    this.controls.target.add(next.middle).sub(frame.middle);
    this.camera.position.copy(this.controls.target).add(offset);
    this.camera.lookAt(this.controls.target);
    this.frame = next;
    const { radius, middle } = next;
    const reach = radius * 1.5;
    this.ground.position.set(middle.x, middle.y, motion.bounds(explode).low.z - 0.004 * radius - 0.01);
    this.ground.scale.setScalar(radius * 12);
    this.sun.target.position.copy(middle);
    this.sun.position.copy(TO_LIGHT).multiplyScalar(radius * 6).add(middle);
    const { camera } = this.sun.shadow;
    Object.assign(camera, { left: -reach, right: reach, bottom: -reach, top: reach, near: radius, far: radius * 14 });
    camera.updateProjectionMatrix();
    // Plates must not shade themselves: by as much as a texel of the shadow is wide.
    this.sun.shadow.normalBias = Math.min((2.5 * reach) / 2048, 0.02);
    this.sun.shadow.bias = -0.0004;
  }

  paint(paint: Paint): void {
    this.plates.paint(paint.panels);
    this.bars.paint(paint.hinges);
  }

  theme(theme: Theme): void {
    this.space.background = new Color(theme.background);
    this.plates.theme(theme.paper, theme.accent);
    this.ground.material.opacity = theme.shadow;
    this.sky.groundColor.set(theme.bounce);
    this.sky.intensity = theme.sky;
    this.sun.intensity = theme.sun;
  }

  /** For a machine that draws slowly: no shadow, and coarser. */
  lighten(): void {
    this.sun.castShadow = false;
    this.ground.visible = false;
    this.coarse = true;
    this.resize(this.size.width, this.size.height, 1, this.inset);
  }

  render(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(distance - this.frame.radius * 4, distance / 100);
    this.camera.far = distance + this.frame.radius * 12;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.space, this.camera);
  }

  /** The panel at a point of the canvas, in pixels. */
  pick(x: number, y: number): number | undefined {
    const point = new Vector2((x / this.size.width) * 2 - 1, 1 - (y / this.size.height) * 2);
    const ray = new Raycaster();
    this.camera.updateMatrixWorld();
    ray.setFromCamera(point, this.camera);
    return ray.intersectObject(this.plates.mesh, false)[0]?.instanceId;
  }

  /** Where the middle of a panel is on the canvas, in pixels. */
  where(panel: number, explode: number): { x: number; y: number } {
    const at = new Vector3(...this.motion.centre(panel));
    at.add(new Vector3().fromArray(this.motion.apart, panel * 3).multiplyScalar(explode)).project(this.camera);
    return { x: ((at.x + 1) / 2) * this.size.width, y: ((1 - at.y) / 2) * this.size.height };
  }
}
