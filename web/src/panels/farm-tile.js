// A cage among others: what it does in three seconds, in a tile.

import { make } from "../dom.js";
import { word } from "../service-words.js";
import { text } from "../texts/index.js";
import { bearing, inputAge, known, percent, withUnit } from "./format.js";
import { icon } from "./icons.js";
import { rank } from "./ranks.js";
import { concerned } from "./verdict.js";
import { waterArrow } from "./water-arrow.js";

/** What a tile says: {kind, icon, words, detail}. */
export function tileVerdict(cage) {
  const { waiting, worst_severity: severity, worst_title: title, valid, reason } = cage;
  if (waiting) {
    const kind = rank(severity);
    return { kind, icon: kind, words: text("count.alarms", { count: waiting }), detail: title ?? "" };
  }
  if (!valid) return { kind: "none", icon: "none", words: text("verdict.invalid"), detail: reason ?? "" };
  const concern = concerned(cage);
  if (concern) return { kind: concern.kind, icon: concern.icon, words: concern.headline, detail: concern.detail };
  return { kind: "well", icon: "well", words: text("verdict.well"), detail: "" };
}

/** How many there are, and how many of them are well. */
export function summed(cages) {
  const well = cages.filter((cage) => tileVerdict(cage).kind === "well").length;
  if (cages.length === 1) return well ? text("farm.oneWell") : text("farm.oneNotWell");
  const values = { cages: text("count.cages", { count: cages.length }), count: well };
  if (!well) return text("farm.noneWell", values);
  return well === cages.length ? text("farm.allWell", values) : text("farm.someWell", values);
}

const PLACE = { critical: 0, warning: 1, none: 2, note: 3, beyond: 4, caution: 5, well: 6 };

/** The worst first, then by name. */
export function byNeed(cages) {
  return [...cages].sort((a, b) => PLACE[tileVerdict(a).kind] - PLACE[tileVerdict(b).kind]
    || (b.worst_severity ?? 0) - (a.worst_severity ?? 0) || a.name.localeCompare(b.name, "en", { numeric: true }));
}

/** Make a tile; `enter` is called when it is chosen. */
export function tile(cage, { present, enter }) {
  const { kind, icon: shape, words, detail } = tileVerdict(cage);
  const { arrow, turn } = waterArrow("current");
  turn(cage.valid ? cage.current_to_deg : null);
  const fill = make("span", { className: "share-fill" });
  fill.style.width = `${Math.min(100, 100 * (cage.max_utilisation ?? 0))}%`;
  const current = cage.valid && known(cage.current_speed_m_s)
    ? text("farm.current", { speed: withUnit(cage.current_speed_m_s, "m/s", 2), direction: bearing(cage.current_to_deg) })
    : text("farm.noCurrent");
  const button = make("button", { type: "button", className: "tile", onclick: () => enter(cage.name) },
    make("span", { className: "tile-name" }, cage.name,
      cage.origin === "measured" ? "" : make("span", { className: "badge origin" }, word(cage.origin))),
    make("span", { className: "tile-verdict" }, icon(shape), make("span", {},
      make("strong", {}, words), make("span", { className: "tile-detail" }, detail))),
    make("span", { className: "tile-load" },
      make("span", { className: "share-line" }, make("span", { className: "share-bar" }, fill),
        make("span", { className: "share" }, percent(cage.max_utilisation))),
      make("span", { className: "tile-note" }, text("farm.load"))),
    make("span", { className: "tile-sea" }, arrow, current),
    make("span", { className: "tile-age" }, inputAge(cage.age_s)));
  button.dataset.kind = kind;
  if (present) button.setAttribute("aria-current", "true");
  return button;
}
