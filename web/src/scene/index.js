// The net, seen: in three dimensions where the browser can, flat where it cannot.

import { make } from "../dom.js";
import { mountControls } from "./controls.js";
import { FlatView } from "./flat.js";
import { mountNotice } from "./notice.js";
import { Options } from "./options.js";

/** Show the model's net in an element. */
export function mountScene(model, holder) {
  const options = new Options();
  model.options = options; // the panels colour the bridles alike
  const stage = make("div", { className: "stage" });
  holder.append(stage);
  const flatOnly = !canDraw3d();
  let scene = null;
  let turn = 0;

  async function choose() {
    const wanted = flatOnly || options.view === "flat" ? "flat" : "3d";
    if (stage.dataset.view === wanted) return;
    stage.dataset.view = wanted;
    const mine = (turn += 1);
    scene?.close();
    scene = null;
    if (wanted === "flat") scene = new FlatView(model, options, stage);
    else {
      // Half a megabyte that a browser without WebGL never loads.
      const { View3d } = await import("./view3d.js");
      if (mine === turn) scene = new View3d(model, options, stage);
    }
  }

  /** Look from a side; where the net is drawn flat, that leads back to three dimensions. */
  async function look(name) {
    const atOnce = options.view === "flat";
    if (atOnce) options.set("view", "3d");
    await chosen;
    scene?.look(name, { atOnce });
  }

  let chosen = null;
  options.on((name) => { if (name === "view") chosen = choose(); });
  mountControls(model, options, holder, { look, flatOnly });
  mountNotice(model, holder);
  chosen = choose();
}

function canDraw3d() {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}
