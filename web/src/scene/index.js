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

  options.on((name) => name === "view" && choose());
  mountControls(model, options, holder, { scene: () => scene, flatOnly });
  mountNotice(model, holder);
  choose();
}

function canDraw3d() {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}
