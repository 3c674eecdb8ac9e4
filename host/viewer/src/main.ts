//! Where the page begins: asks the server what there is to show, and shows it.

import "./style.css";
import { element } from "./element";
import { post, postPicture } from "./picture";
import { readScene, type Scene } from "./scene";
import type { Told } from "./messages";
import { LiveRun, RecordedRun } from "./runSource";
import { FilePlayback, type Source } from "./source";
import { Viewer } from "./viewer";
import { pictureWish } from "./wishes";

declare global {
  /** The page, for tests in a browser. */
  var zygote: Viewer | undefined;
}

async function read(path: string): Promise<unknown> {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
  return answer.json();
}

async function source(scene: Scene): Promise<Source> {
  switch (scene.run?.from) {
    case undefined: return new FilePlayback(scene);
    case "live": return new LiveRun(scene);
    case "recording": return new RecordedRun(scene, (await read("/run.json")) as Told[]);
  }
}

async function main(): Promise<void> {
  const scene = readScene(await read("/scene.json"));
  const [app, canvas, labels] = ["app", "stage", "labels"].map((id) => document.getElementById(id)!);
  const wish = scene.run ? undefined : pictureWish(location.hash);
  if (wish) {
    document.documentElement.dataset["picture"] = "";
    await postPicture(scene, wish, canvas as HTMLCanvasElement);
    return;
  }
  document.title = `${scene.model} · zygote`;
  const viewer = new Viewer(scene, await source(scene), app!, canvas as HTMLCanvasElement, labels!);
  viewer.start();
  globalThis.zygote = viewer;
  document.documentElement.dataset["ready"] = "";
}

main().catch((error: unknown) => {
  const told = error instanceof Error ? error.message : String(error);
  if (pictureWish(location.hash)) post("/trouble", told).catch(() => undefined);
  document.getElementById("app")?.append(element("p", { class: "trouble", role: "alert" }, `This plan can't be shown: ${told}`));
});
