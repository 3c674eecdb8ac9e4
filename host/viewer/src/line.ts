//! The line to the program: opened again whenever it breaks, and told everything anew then.

import { type Said, type Told, VERSION } from "./messages";

/** How long until it tries again, in milliseconds. */
const AGAIN = 500;

export class Line {
  private socket: WebSocket | undefined;
  /** The page was let in. */
  open = false;
  private shut = false;
  /** It had control when the line broke, or would have it from the start. */
  wantsControl = true;

  constructor(
    private readonly token: string, private readonly heard: (told: Told) => void, private readonly changed: (open: boolean) => void,
  ) {}

  start(): void {
    const socket = new WebSocket(`ws://${location.host}/live`);
    this.socket = socket;
    socket.addEventListener("open", () => {
      socket.send(JSON.stringify({ type: "hello", version: VERSION, token: this.token, control: this.wantsControl } satisfies Said));
    });
    socket.addEventListener("message", (event) => {
      const told = JSON.parse(String(event.data)) as Told;
      if (told.type === "welcome") this.set(true);
      // Asking again would change nothing.
      if (told.type === "refused" && !this.open) this.shut = true;
      if (told.type === "control") this.wantsControl = told.you;
      this.heard(told);
    });
    socket.addEventListener("close", () => {
      this.set(false);
      if (!this.shut) setTimeout(() => this.start(), AGAIN);
    });
  }

  private set(open: boolean): void {
    this.open = open;
    this.changed(open);
  }

  /** Says something; whether there is anybody to hear it. */
  say(said: Said): boolean {
    if (!this.open || this.socket === undefined) return false;
    this.socket.send(JSON.stringify(said));
    return true;
  }
}
