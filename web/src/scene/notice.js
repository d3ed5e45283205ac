// What is said over the scene where there is no net to show, or where it is not what it seems.

import { make } from "../dom.js";
import { lasting } from "./words.js";

/** Which notice a model calls for: {kind, title, words, retry} or null. */
export function noticeFor({ connection, why, view }) {
  if (connection === "asking") return null; // the dialog asks
  if (connection === "refused") {
    return { kind: "refused", title: "This cage cannot be shown", words: why };
  }
  if (connection === "lost") {
    return { kind: "lost", title: "No connection", words: view
      ? `${why} What you see is the last that was received.` : why, retry: true };
  }
  if (!view) return { kind: "connecting", title: "Connecting", words: "Asking for the cage’s shape." };
  if (!view.state.valid) {
    const never = view.state.age_s === null;
    return {
      kind: never ? "empty" : "invalid",
      title: never ? "Waiting for the first reading" : "No valid input",
      words: `${view.state.reason || "No current has been measured yet."} The net is drawn as it ` +
        "hangs in still water; nothing is predicted.",
    };
  }
  if (view.stale) {
    return { kind: "stale", title: "Old input",
      words: `The current was measured ${lasting(view.ageS)} ago. This is not the net as it is now.` };
  }
  return null;
}

/** The notice as an element that follows the model. */
export function mountNotice(model, holder) {
  const title = make("strong");
  const words = make("p");
  const retry = make("button", { type: "button", hidden: true }, "Try now");
  const box = make("div", { className: "scene-notice", role: "status", hidden: true },
    make("span", { className: "notice-mark", "aria-hidden": "true" }), make("div", {}, title, words),
    retry);
  holder.append(box);
  retry.addEventListener("click", () => model.retry());
  const show = () => {
    const notice = noticeFor(model);
    box.hidden = !notice;
    if (!notice) return;
    box.dataset.kind = notice.kind;
    retry.hidden = !notice.retry;
    if (title.textContent !== notice.title) title.textContent = notice.title;
    if (words.textContent !== notice.words) words.textContent = notice.words;
  };
  for (const name of ["connection", "view", "age"]) model.on(name, show);
  show();
}
