//! A picture instead of a page: draws once, and posts what it drew to the server.

import { paint } from "./paint";
import { Places, type Scene } from "./scene";
import { FilePlayback } from "./source";
import { Stage } from "./stage";
import { THEMES } from "./theme";
import type { PictureWish } from "./wishes";

export async function postPicture(scene: Scene, wish: PictureWish, canvas: HTMLCanvasElement): Promise<void> {
  const places = new Places(scene);
  const stage = new Stage(canvas, scene, places, () => undefined);
  const source = new FilePlayback(scene, wish.at);
  stage.resize(wish.width, wish.height, 1);
  stage.theme(THEMES[wish.dark ? "dark" : "light"]);
  stage.paint(paint(wish.mode, scene, places));
  stage.plates.mark(undefined, []);
  stage.bars.show(false, []);
  stage.place(source.state, wish.at, wish.explode);
  stage.reset();
  stage.render();
  // In the same turn: afterwards the browser may have cleared it.
  const png = await new Promise<Blob>((resolve, reject) => {
    canvas.toBlob((blob) => (blob === null ? reject(new Error("the canvas gave no picture")) : resolve(blob)), "image/png");
  });
  await post("/picture", png);
}

export async function post(path: string, body: Blob | string): Promise<void> {
  const answer = await fetch(path, { method: "POST", body });
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
}
