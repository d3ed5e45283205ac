// Notice over the scene where there is no net to show, or where it is not the net of now.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { lasting } from "./words.js";

/** Which notice a model calls for: {kind, title, words, retry} or null. */
export function noticeFor({ connection, why, view }) {
  if (connection === "asking") return null; // the dialog asks
  if (connection === "refused") {
    return { kind: "refused", title: text("notice.refused"), words: why };
  }
  if (connection === "lost") {
    return { kind: "lost", title: text("notice.lost"),
      words: view ? text("notice.lastSeen", { why }) : why, retry: true };
  }
  if (!view) return { kind: "connecting", title: text("connection.state.connecting"), words: text("notice.asking") };
  if (!view.state.valid) {
    const never = view.state.age_s === null;
    return {
      kind: never ? "empty" : "invalid",
      title: never ? text("notice.empty") : text("verdict.invalid"),
      words: text("notice.still", { reason: view.state.reason || text("notice.noCurrent") }),
    };
  }
  if (view.stale) {
    return { kind: "stale", title: text("notice.stale"),
      words: text("notice.staleFor", { age: lasting(view.ageS) }) };
  }
  return null;
}

/** The notice as an element that follows the model. */
export function mountNotice(model, holder) {
  const title = make("strong");
  const words = make("p");
  const retry = make("button", { type: "button", hidden: true }, text("notice.retry"));
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
