//! What a page of a run has besides the picture: card, schedule against the clock, and for a run that goes on its controls and its stop.

import { Controls } from "./controls";
import { element } from "./element";
import { Gantt } from "./gantt";
import { Line } from "./line";
import { type Told, VERSION } from "./messages";
import type { Run } from "./run";
import { RunCard } from "./runCard";
import { LiveRun, RecordedRun } from "./runSource";
import type { Scene } from "./scene";
import { Stop } from "./stop";

export class RunPage {
  readonly card: RunCard;
  readonly gantt = new Gantt();
  readonly parts: HTMLElement[];
  private readonly stop: Stop | undefined;
  private readonly controls: Controls | undefined;
  private line: Line | undefined;
  private shown = "";
  private of: Run | undefined;

  constructor(
    readonly source: LiveRun | RecordedRun, private readonly scene: Scene, private readonly changed: () => void,
    seek: (time: number) => void,
  ) {
    if (source instanceof LiveRun) {
      this.controls = new Controls((said) => this.line?.say(said));
      this.stop = new Stop((id) => this.line?.say({ type: "stop", id }) ?? false);
    }
    this.card = new RunCard(scene, this.controls?.root, source instanceof RecordedRun ? seek : undefined);
    this.parts = [element("div", { id: "left" }, this.card.root, ...(this.stop ? [this.stop.root] : []))];
  }

  /** Opens the line, where the run goes on. */
  start(): void {
    if (!(this.source instanceof LiveRun)) return;
    const token = location.hash.slice(1);
    this.line = new Line(token, (told) => this.hear(told), (open) => {
      document.documentElement.dataset["line"] = open ? "open" : "broken";
      this.controls?.connected(open);
    });
    this.line.start();
  }

  private hear(told: Told): void {
    const { source, controls, stop } = this;
    switch (told.type) {
      case "begin":
        if (told.version !== VERSION) return this.card.trouble(`messages: expected version ${VERSION}, found ${told.version}`);
        // Another run is of another plan: its scene is there already.
        if (this.scene.run?.from === "live" && told.run !== this.scene.run.number) return location.reload();
        break;
      case "stage":
        document.documentElement.dataset["stage"] = told.stage;
        controls?.enter(told);
        break;
      case "choices": controls?.offer(told.runs); break;
      case "control": controls?.controlled(told); break;
      case "event":
        if (told.kind === "state") stop?.state(told.state ?? "");
        if (told.kind === "stop_confirmed") stop?.acknowledge();
        if (told.kind === "lost") stop?.fail(told.message ?? "");
        break;
      case "unconfirmed": stop?.fail(told.why); break;
      case "refused": this.card.trouble(told.order === null ? `Not let in: ${told.why}` : told.why); break;
      case "trouble": this.card.trouble(told.told); break;
      case "welcome": case "stopping": case "look": case "report": break;
    }
    if (source instanceof LiveRun) source.take(told);
    // What goes wrong doesn't wait for a frame.
    if (told.type === "event" && ["fault", "lost", "state"].includes(told.kind)) this.update(source.state.fractions);
    this.changed();
  }

  update(fractions: Float64Array): void {
    const { run, time } = this.source;
    if (run === undefined) return;
    // Going around changes nothing of it.
    const now = `${time} ${run.happenings.length} ${run.lookAt(time)?.mcu_us} ${run.report !== undefined} ${innerWidth} ${innerHeight} ${document.documentElement.dataset["theme"]}`;
    if (now === this.shown && run === this.of) return;
    this.shown = now;
    this.of = run;
    this.card.update(run, time, fractions);
    const end = this.source instanceof RecordedRun ? this.source.timeline.end : Math.max(run.expectedEnd * 1.05, time, 1);
    this.gantt.draw(run, time, end);
  }
}
