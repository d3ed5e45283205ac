// The page: a model, and what shows it.

import "./style/tokens.css";
import "./style/base.css";
import "./style/layout.css";
import "./style/scene.css";
import "./style/ask.css";
import "./theme.js";

import { mountAsk } from "./ask.js";
import { Model } from "./model.js";
import { mountPanels } from "./panels/index.js";
import { mountScene } from "./scene/index.js";
import { language, text } from "./texts/index.js";

const model = new Model();
const { dataset } = document.body;

document.documentElement.lang = language;
document.querySelector(".skip").textContent = text("page.skip");
for (const id of ["scene", "panels"]) document.getElementById(id).ariaLabel = text(`page.region.${id}`);

model.on("connection", (connection) => { dataset.connection = connection; });
model.on("view", (view) => {
  dataset.mode = view.mode;
  dataset.valid = view.state.valid;
});
model.on("age", (view) => { dataset.stale = Boolean(view?.stale); });

mountAsk(model);
mountScene(model, document.getElementById("scene"));
mountPanels(model);
model.open();
// A link with a token, followed where the page is open already, loads nothing by itself.
addEventListener("hashchange", () => model.open());
