// The net, seen.

import { make } from "../dom.js";

/** Show the model's net in an element. */
export function mountScene(model, holder) {
  holder.append(make("canvas", { id: "net" }));
}
