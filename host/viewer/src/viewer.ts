//! The page: a source, the stage that shows it, and the tools around it.

import { element } from "./element";
import { listen } from "./keyboard";
import { Labels } from "./labels";
import { missing, type Mode, MODES, type Paint, paint } from "./paint";
import { PanelCard } from "./panelCard";
import { Places, type Scene } from "./scene";
import { RunPage } from "./runPage";
import { LiveRun, RecordedRun } from "./runSource";
import type { Source } from "./source";
import { Stage } from "./stage";
import { ThemeChoice } from "./theme";
import { TimeBar } from "./timeBar";
import { Toolbar } from "./toolbar";

/** A pointer that went less far, in pixels, picked something. */
const DRAG = 4;
/** A frame of a run that takes longer, in milliseconds, so many times in a row, is drawn with less: keys come first. */
const SLOW = 120;
const SLOW_FRAMES = 3;

export class Viewer {
  private readonly places: Places;
  private readonly stage: Stage;
  private readonly labels: Labels;
  private readonly bar: TimeBar;
  private readonly card: PanelCard;
  private readonly tools: Toolbar;
  private readonly themes: ThemeChoice;
  private readonly run: RunPage | undefined;
  private mode: Mode = "pile";
  private colours: Paint;
  private explode = 0;
  private explodeTo = 0;
  private hinges = false;
  private picked: number | undefined;
  private across = 0;
  private asked = false;
  private last = 0;
  /** The picture isn't what was asked for, whatever the source says. */
  private stale = true;
  /** News are shown no sooner than this. */
  private rest = 0;
  private waiting = false;
  private slow = 0;
  /** How long the last frames took, in milliseconds of this page's own work. */
  readonly work: number[] = [];

  constructor(
    private readonly scene: Scene, private readonly source: Source,
    private readonly app: HTMLElement, private readonly canvas: HTMLCanvasElement, labels: HTMLElement,
  ) {
    this.places = new Places(scene);
    this.stage = new Stage(canvas, scene, this.places, () => this.ask());
    this.labels = new Labels(labels, scene);
    this.colours = paint(this.mode, scene, this.places);
    if (source instanceof LiveRun || source instanceof RecordedRun) {
      this.run = new RunPage(source, scene, () => this.news(), (time) => this.seek(time));
      document.documentElement.dataset["run"] = scene.run?.from;
    }
    this.bar = new TimeBar(source, () => this.playOrPause(), () => this.ask(), this.run?.gantt.root);
    this.card = new PanelCard(scene, this.places, (panel) => this.pick(panel));
    this.tools = new Toolbar(scene, this.places.panels, {
      colour: (mode) => this.colour(mode),
      explode: (share) => this.apart(share),
      hinges: (on) => this.showHinges(on),
      pick: (panel) => this.pick(panel),
      frame: () => this.frame(),
      theme: () => this.themes.toggle(),
      help: () => this.help(),
    });
    this.themes = new ThemeChoice((theme) => {
      this.stage.theme(theme);
      this.ask();
    });
    const side = element("div", { id: "side" }, this.tools.root, this.card.root);
    app.append(heading(scene), ...(this.run?.parts ?? []), side, this.bar.root, this.tools.help);
  }

  start(): void {
    this.themes.apply();
    this.colour(this.run ? "temperature" : "pile");
    this.pick(undefined);
    this.listen();
    this.resize();
    this.draw(0);
    this.stage.reset();
    this.ask();
    this.run?.start();
  }

  /** Draws soon. */
  private ask(): void {
    this.stale = true;
    this.frameSoon();
  }

  /** Shows what is new of a run. A page that draws slowly keeps half its time for keys, and for what the program says. */
  private news(): void {
    const wait = this.rest - performance.now();
    if (wait <= 0) return this.frameSoon();
    if (this.waiting) return;
    this.waiting = true;
    setTimeout(() => {
      this.waiting = false;
      this.frameSoon();
    }, wait);
  }

  private frameSoon(): void {
    if (this.asked) return;
    this.asked = true;
    const asked = performance.now();
    requestAnimationFrame((now) => {
      this.asked = false;
      const passed = this.last === 0 ? 0 : (now - this.last) / 1000;
      this.draw(passed);
      const done = performance.now();
      this.rest = done + Math.min(2 * (done - asked), 1000);
      this.slow = done - asked > SLOW ? this.slow + 1 : 0;
      if (this.run && this.slow === SLOW_FRAMES) this.stage.lighten();
      this.last = this.asked ? now : 0;
    });
  }

  private draw(passed: number): void {
    const start = performance.now();
    const moved = this.source.advance(passed);
    const { state, playing } = this.source;
    // Apart and together in a quarter of a second.
    const way = this.explodeTo - this.explode;
    this.explode += Math.abs(way) < 0.004 ? way : way * Math.min(1, passed * 12 + 0.05);
    if (moved || this.stale) {
      this.stale = false;
      if (this.mode === "temperature") this.stage.paint(paint(this.mode, this.scene, this.places, state.celsius));
      this.stage.place(state, state.share, this.explode);
      this.stage.render();
      const { motion, bars, camera, size } = this.stage;
      const all = this.scene.hinges.map((_, hinge) => hinge);
      const own = this.picked === undefined ? [] : [...this.places.hinges[this.picked]!];
      const shown = this.hinges ? all : own;
      const apart = { by: motion.apart, share: this.explode };
      this.labels.show(shown, this.hinges, state.fractions, motion.frames, apart, bars.middles, camera, size);
    }
    this.bar.update();
    this.card.update(state.fractions);
    this.run?.update(state.fractions);
    this.work.push(performance.now() - start);
    if (this.work.length > 240) this.work.shift();
    if (playing || this.explode !== this.explodeTo) this.ask();
  }

  private playOrPause(): void {
    this.source.play(!this.source.playing);
    this.ask();
  }

  private seek(time: number): void {
    this.source.play(false);
    this.source.seek(time);
    this.ask();
  }

  private colour(mode: Mode): void {
    if (missing(mode, this.scene) !== undefined) return;
    this.mode = mode;
    this.colours = paint(mode, this.scene, this.places, this.source.state.celsius);
    this.stage.paint(this.colours);
    this.told();
  }

  private apart(share: number): void {
    this.explodeTo = share;
    this.told();
  }

  private showHinges(on: boolean): void {
    this.hinges = on;
    this.stage.bars.show(on, this.picked === undefined ? [] : this.places.hinges[this.picked]!);
    this.told();
  }

  private told(): void {
    this.tools.update(this.mode, this.explodeTo, this.hinges, this.colours.legend);
    this.ask();
  }

  pick(panel: number | undefined): void {
    this.picked = panel;
    this.across = 0;
    const hinges = panel === undefined ? [] : this.places.hinges[panel]!;
    const joined = hinges.map((hinge) => this.other(hinge, panel!));
    this.stage.plates.mark(panel, joined);
    this.card.show(panel);
    this.showHinges(this.hinges);
  }

  private other(hinge: number, panel: number): number {
    const [a, b] = this.scene.hinges[hinge]!.panels;
    return a === panel ? b : a;
  }

  private help(): void {
    // Where there is something to stop, the button stays in reach.
    if (this.scene.run?.from === "live") this.tools.help.show();
    else this.tools.help.showModal();
  }

  private frame(): void {
    this.stage.reset();
    this.ask();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    // What the tools leave free; they may cover a little of a wide page, but not the middle of a narrow one.
    const sides = Math.min(200, Math.max(0, width - height));
    const inset = { left: this.run ? sides : 0, right: sides, bottom: this.run ? height / 4 : Math.min(100, height / 5) };
    this.stage.resize(width, height, devicePixelRatio, inset);
    this.ask();
  }

  private listen(): void {
    new ResizeObserver(() => this.resize()).observe(this.app);
    let down: { x: number; y: number } | undefined;
    this.canvas.addEventListener("pointerdown", (event) => (down = { x: event.clientX, y: event.clientY }));
    this.canvas.addEventListener("pointerup", (event) => {
      // What was dragged was no pick.
      if (down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < DRAG) {
        const box = this.canvas.getBoundingClientRect();
        this.pick(this.stage.pick(event.clientX - box.left, event.clientY - box.top));
      }
      down = undefined;
    });
    const place = () => (this.picked === undefined ? undefined : this.places.of[this.picked]!);
    listen({
      playOrPause: () => this.playOrPause(),
      step: (forward) => this.seek(this.source.timeline.step(this.source.state.time, forward)),
      end: (last) => this.seek(last ? this.source.timeline.end : 0),
      nextColour: () => {
        const modes = MODES.filter((mode) => missing(mode, this.scene) === undefined);
        this.colour(modes[(modes.indexOf(this.mode) + 1) % modes.length]!);
      },
      apart: () => this.apart(this.explodeTo > 0 ? 0 : 1),
      hinges: () => this.showHinges(!this.hinges),
      inPile: (up) => {
        const at = place() ?? { pile: 0, height: up ? -1 : 1 };
        const panel = this.scene.piles[at.pile]!.panels[at.height + (up ? 1 : -1)];
        if (panel !== undefined) this.pick(panel);
      },
      across: () => {
        if (this.picked === undefined) return this.pick(this.scene.root);
        const hinges = this.places.hinges[this.picked]!;
        const next = hinges[this.across % hinges.length];
        if (next !== undefined) this.pick(this.other(next, this.picked));
      },
      orbit: (around, up, factor) => {
        this.stage.orbit(around, up, factor);
        this.ask();
      },
      frame: () => this.frame(),
      theme: () => this.themes.toggle(),
      help: () => this.help(),
      nothing: () => this.pick(undefined),
    });
  }

  /** Where a panel is on the page, for tests. */
  where(panel: number): { x: number; y: number } {
    const box = this.canvas.getBoundingClientRect();
    const { x, y } = this.stage.where(panel, this.explode);
    return { x: box.left + x, y: box.top + y };
  }
}

/** What the plan is, in three lines. */
function heading(scene: Scene): HTMLElement {
  const panels = scene.joints.length + 1;
  const piles = scene.piles.length === 1 ? "1 pile" : `${scene.piles.length} piles`;
  const high = scene.piles[0]?.panels.length ?? 0;
  const name = scene.model.replace(/\.[a-z0-9]+$/i, "");
  const { told, collisions } = scene.checked;
  return element(
    "header", { id: "what" },
    element("h1", {}, name),
    element("p", {}, `${panels} panels in ${piles} of ${high} · ${scene.expansion_ratio.toFixed(1)} times the volume`),
    ...(scene.run && collisions.length === 0 ? [] : [element("p", { class: collisions.length > 0 ? "note bad" : "note" }, told)]),
    ...(scene.scheduled || scene.run ? [] : [element("p", { class: "note" }, "No schedule: hinges open in the order of the tree")]),
  );
}
