// Who reads: a token is given to the service once, and from then on a cookie that no script can
// read stands for it. Here lies only what a write has to repeat, for a cookie goes by itself.

import { Refusal, request } from "./request.js";

const SIGNED_IN = "seacage-signed-in"; // whether it is worth asking who; it opens nothing
const FORBIDDEN = 403;
const SOONEST_MS = 20_000;
const LATEST_MS = 3600e3;

let session = null;
let linked = null; // the token of the address, until the service has answered to it

/** Sign in with the token of the address, or go on with the cookie of before; rejects with 401. */
export async function begin() {
  linked = fromAddress() ?? linked;
  if (linked === null && !localStorage.getItem(SIGNED_IN)) {
    throw new Refusal(401, "");
  }
  return linked === null ? resume() : signIn(linked);
}

/** Give a token for a cookie; says who is signed in. */
export async function signIn(token) {
  linked = token;
  return kept(request("POST", "session", { body: { token } }));
}

/** Ask who is signed in, whose session then lasts anew. */
export const resume = () => kept(request("GET", "session"));

/** End the session. */
export async function signOut() {
  await request("DELETE", "session", { headers: repeated() });
  forget();
}

/** Think of nobody as signed in. */
export function forget() {
  [session, linked] = [null, null];
  localStorage.removeItem(SIGNED_IN);
}

/** Ask for a path under /api/v1 as who is signed in. Rejects with a Refusal. */
export async function call(method, path, body) {
  if (!session) throw new Refusal(401, "Nobody is signed in.");
  const ask = () => request(method, `api/v1/${path}`, { body, headers: method === "GET" ? {} : repeated() });
  try {
    return await ask();
  } catch (error) {
    // Another tab may have signed in anew: the cookie is its, and what is to be repeated is old.
    if (error.status !== FORBIDDEN || method === "GET" || !(await changed())) throw error;
    return ask();
  }
}

/** How long to wait before the session is to be renewed [ms]. */
export function renewal() {
  const left = Date.parse(session.expires) - Date.now(); // by this machine's clock, which may be off
  return Math.min(LATEST_MS, Math.max(SOONEST_MS, left / 3));
}

async function changed() {
  const before = session.csrf;
  return (await resume()).csrf !== before;
}

async function kept(asked) {
  try {
    session = await asked;
  } catch (error) {
    if (error.status === 401) forget();
    throw error;
  }
  linked = null;
  localStorage.setItem(SIGNED_IN, "yes");
  return session;
}

const repeated = () => ({ "X-CSRF-Token": session?.csrf ?? "" });

/** The token of a link, which is taken out of the address before anybody can copy it. */
function fromAddress() {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  if (token) history.replaceState(null, "", location.pathname + location.search);
  return token;
}
