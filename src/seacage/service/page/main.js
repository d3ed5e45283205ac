// The page: from the live connection to what is seen.

import { Bridles } from "./bridles.js";
import { byId } from "./dom.js";
import { day, time } from "./format.js";
import { NetViews } from "./net.js";
import { Sensors } from "./sensors.js";
import { ask, connect, dropToken, keepToken, token } from "./service.js";
import { Verdict } from "./verdict.js";

const HISTORY_MS = 24 * 3600e3;
const JUMP_MS = 30 * 60e3; // a longer step of the clock means that something was missed

const verdict = new Verdict(byId("verdict"));
const net = new NetViews({
  side: byId("side"), plan: byId("plan"), caption: byId("side-caption"),
  choice: byId("view-choice"), legend: byId("net-legend"),
});
const bridles = new Bridles({
  table: byId("bridle-table"), capacity: byId("capacity"), legend: byId("bridle-legend"),
});
const sensors = new Sensors({ grid: byId("sensor-grid"), legend: byId("sensor-legend") });
const parts = [verdict, net, bridles, sensors];

let cage, clock, speed;

/** What the page is doing; the style sheet shows it. */
function phase(name, words) {
  document.body.dataset.phase = name;
  byId("link").textContent = words;
}

function topology(message) {
  speed = message.speed;
  byId("origin").textContent = message.origin;
  byId("origin").hidden = message.origin === "measured";
  parts.forEach((part) => part.topology(message));
  clock = undefined;
}

async function state(frame) {
  const now = Date.parse(frame.state.t);
  const missed = clock === undefined || now < clock || now - clock > JUMP_MS;
  clock = now;
  document.body.dataset.valid = frame.state.valid;
  phase("live", speed === 1 ? "Live" : `Replay, ${speed} ×`);
  byId("clock").textContent = `${day(now)}, ${time(now)} UTC`;
  document.title = `${cage} · ${frame.state.valid ? "live" : "no valid input"} · seacage`;
  if (missed) await past(now);
  verdict.show(frame);
  net.show(frame);
  bridles.show(frame.state);
  sensors.show(frame.state);
}

async function past(now) {
  const from = new Date(now - HISTORY_MS).toISOString();
  try {
    sensors.history(await ask(`cages/${encodeURIComponent(cage)}/history?from=${from}&limit=500`));
  } catch (error) {
    console.warn(`No history: ${error.message}`);
  }
}

function askForToken(why) {
  dropToken();
  phase("asking", "Waiting for a token");
  if (why) byId("ask-why").textContent = why;
  byId("ask").hidden = false;
  byId("token").focus();
}

byId("ask").addEventListener("submit", (event) => {
  event.preventDefault();
  keepToken(byId("token").value.trim());
  byId("token").value = "";
  byId("ask").hidden = true;
  open();
});

async function open() {
  if (!token()) return askForToken();
  phase("connecting", "Connecting");
  try {
    const { cages } = await ask("cages");
    const wanted = new URLSearchParams(location.search).get("cage");
    cage = (cages.find(({ name }) => name === wanted) ?? cages[0]).name;
  } catch (error) {
    if (error.status) return askForToken("This token does not open the service. It may have " +
      "been minted for an earlier start; take the link that `seacage serve` printed last.");
    phase("lost", "The service does not answer; trying again");
    return setTimeout(open, 3000);
  }
  byId("cage").textContent = cage;
  connect(cage, {
    topology,
    state,
    lost: (seconds) => {
      phase("lost", `Connection lost; trying again in ${seconds} s`);
      verdict.lost(`from ${byId("clock").textContent}`);
    },
    refused: () => askForToken("This token is no longer good. Take the link that " +
      "`seacage serve` printed last."),
  });
}

open();
