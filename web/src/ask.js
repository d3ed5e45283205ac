// The question for a token, and what is said where a token does not do.

import { make } from "./dom.js";

/** Add the dialog, which opens when the model asks. */
export function mountAsk(model) {
  const input = make("input", {
    id: "token", type: "password", autocomplete: "off", spellcheck: false, required: true,
  });
  const why = make("p", { className: "ask-why", role: "alert", hidden: true });
  const form = make("form", { method: "dialog" },
    make("h2", { id: "ask-title" }, "Open the cage’s page"),
    make("p", {}, "The service asks who reads. ", make("code", {}, "seacage serve"),
      " printed a link with a token when it started; ", make("code", {}, "seacage token new"),
      " makes others."),
    why,
    make("label", { htmlFor: "token" }, "Token"),
    make("div", { className: "ask-row" }, input, make("button", { type: "submit" }, "Open")));
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
