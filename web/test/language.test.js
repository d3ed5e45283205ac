// The page in Norwegian, as a browser of that language gets it.

import assert from "node:assert/strict";
import { test } from "node:test";

globalThis.localStorage = { getItem: () => null };
Object.defineProperty(globalThis, "navigator", { value: { languages: ["fr-FR", "no", "en"] }, configurable: true });

const { language, text } = await import("../src/texts/index.js");
const { amount, day, dayOfYear, half, percent, plain, span, time } = await import("../src/panels/format.js");
const { alarmIn, alarmName, cageIn, sentences, stateIn, word } = await import("../src/service-words.js");
const { change } = await import("../src/panels/sea-wanted.js");

const NOON = Date.parse("2018-01-26T12:05:09Z");

test("the first language of the browser that has a file is taken, whatever it is called", () => {
  assert.equal(language, "nb");
  assert.equal(text("verdict.well"), "Alt i orden");
});

test("numbers have a comma, and days are written as in Norway", () => {
  assert.equal(amount(12.34, "kN"), "12,3");
  assert.equal(half({ mean: 12, lower: 10.5, upper: 13.5 }, "kN"), "± 1,5");
  assert.equal(half({ mean: 12, lower: 12, upper: 12 }, "kN"), "± <0,1");
  assert.equal(change(1, 2.5, "m", 1), "+1,5");
  assert.equal(percent(0.5), "50 %");
  assert.equal(span(5400), "1,5 t");
  assert.deepEqual([day(NOON), dayOfYear(NOON), time(NOON), time(NOON, true)],
    ["26.01.2018", "26.01", "12:05", "12:05:09"]);
});

test("lines and sensors have the words of the field", () => {
  assert.deepEqual(["bridle-3", "anchor-12", "depth-1", "north-buoy"].map(plain),
    ["hanefot 3", "ankerline 12", "dybdemåler 1", "north buoy"]);
  assert.equal(word("virtual field"), "virtuelt felt");
});

const LOAD = { id: "load.bridle-7", title: "High load on bridle-7", message: "Bridle-7 bears …", key: "load.active",
  values: { source: "bridle-7", value_share: 0.85, worst_share: 0.9, raise_at_share: 0.8, clear_at_share: 0.7,
    detail: "By the mean load, without what waves add to it." } };

test("an alarm is written from its key and values", () => {
  const { title, message, advice } = alarmIn({ ...LOAD, advice: "Keep people and boats away." });
  assert.equal(title, "Høy last på hanefot 7");
  assert.equal(message, "Hanefot 7 bærer 85 % av kapasiteten, 90 % på det verste; alarmen utløses ved 80 % og er over "
    + "ved 70 %. Etter middellasten, uten det bølgene legger til.");
  assert.match(advice, /^Hold folk og båter unna linen\./);
  assert.equal(alarmName("silent.buoy-1"), "Bøye 1 er taus");
});

test("an alarm that the page does not know is shown in the service's words", () => {
  for (const key of ["tilt.active", "load.often", "tilt", "", undefined]) {
    const alarm = { ...LOAD, key };
    assert.equal(alarmIn(alarm), alarm);
  }
  assert.equal(alarmName("tilt.collar"), "tilt.collar");
});

test("concerns and the worst alarm of a cage are written from their keys", () => {
  const concern = { kind: "fit", title: "", message: "", key: "fit", values: { sensors: ["depth-1", "shackle-4"], factor: 2.31 } };
  const { worst_title: title, concerns } = cageIn({ worst_key: "silent.active", worst_title: "Depth-2 is silent",
    worst_values: { source: "depth-2", value_s: 7200 }, reason: "", concerns: [concern] });
  assert.equal(title, "Dybdemåler 2 er taus");
  assert.equal(concerns[0].title, "Tvillingen passer ikke lenger");
  assert.match(concerns[0].message, /^Målingene fra dybdemåler 1, sjakkel 4 .* 2,3 ganger/);
  assert.equal(cageIn({ worst_title: null, reason: "" }).worst_title, null);
});

test("other sentences of the service are known by how they read, each with its values", () => {
  const { reason, bridles } = stateIn({ reason: "The last reading of buoy-1 is 3.5 h old; 3 h is the limit.",
    bridles: [{ interval_reason: null }, { interval_reason: "No sensor has trained level 2: how far the simulation is from the sea is not known." }] });
  assert.equal(reason, "Den siste målingen fra bøye 1 er 3,5 t gammel; grensen er 3 t.");
  assert.deepEqual(bridles.map((one) => one.interval_reason),
    [null, "Ingen sensor har trent nivå 2, så det er ikke kjent hvor mye simuleringen avviker fra sjøen."]);
  assert.equal(sentences("It reads more than the twin and the other sensors let expect. Or bridle-2 has parted: the sensors do not tell which."),
    "Den måler mer enn tvillingen og de andre sensorene tilsier. Eller hanefot 2 har røket: Sensorene viser ikke hvilket.");
  assert.equal(sentences("The service's clock was set back by 2 h, to 2018-01-26 12:00:00 UTC."),
    "Tjenestens klokke ble stilt 2 t tilbake, til 2018-01-26 12:00:00 UTC.");
  assert.equal(sentences("Something quite new."), "Something quite new.");
});
