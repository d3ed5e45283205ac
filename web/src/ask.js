// Dialog for a token, with the reason where a token does not open the service.

import { make } from "./dom.js";
import { text } from "./texts/index.js";

/** Add the dialog, which opens when the model asks. */
export function mountAsk(model) {
  const input = make("input", {
    id: "token", type: "password", autocomplete: "off", spellcheck: false, required: true,
  });
  const why = make("p", { className: "ask-why", role: "alert", hidden: true });
  const form = make("form", { method: "dialog" },
    make("h2", { id: "ask-title" }, text("ask.title")),
    make("p", {}, ...text("ask.about").split("`").map((part, k) => (k % 2 ? make("code", {}, part) : part))),
    why,
    make("label", { htmlFor: "token" }, text("ask.token")),
    make("div", { className: "ask-row" }, input, make("button", { type: "submit" }, text("ask.open"))));
  const dialog = make("dialog", { id: "ask", "aria-labelledby": "ask-title" }, form);
  document.body.append(dialog);

  // Without a token there is nothing behind the dialog to go back to.
  dialog.addEventListener("cancel", (event) => event.preventDefault());
  form.addEventListener("submit", () => {
    const given = input.value.trim();
    input.value = "";
    if (given) model.enter(given);
  });
  model.on("connection", (connection) => {
    const asks = connection === "asking";
    why.hidden = !model.why;
    why.textContent = model.why;
    if (asks && !dialog.open) dialog.showModal();
    if (!asks && dialog.open) dialog.close();
  });
}
