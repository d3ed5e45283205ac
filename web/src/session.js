// Who reads: a token is given to the service once, and from then on a cookie that no script can
// read stands for it. Here lies only what a write has to repeat, for a cookie goes by itself.

import { Refusal, request } from "./request.js";
import { text } from "./texts/index.js";

const SIGNED_IN = "seacage-signed-in"; // whether it is worth asking who; it opens nothing
const [UNKNOWN, FORBIDDEN] = [401, 403];
const SOONEST_MS = 20_000;
const LATEST_MS = 3600e3;

let session = null;
let linked = null; // the token of the address, until the service has answered to it

/** Sign in with the token of the address, or go on with the cookie of before. */
export async function begin() {
  linked = fromAddress() ?? linked;
  if (linked !== null) return signIn(linked);
  if (!localStorage.getItem(SIGNED_IN)) throw new Refusal(UNKNOWN, "");
  return resume();
}

/** Give a token for a cookie; says who is signed in. */
export async function signIn(token) {
  linked = token;
  return kept(request("POST", "session", { body: { token } }), text("session.token"));
}

/** Ask who is signed in, whose session then lasts anew. */
export const resume = () => kept(request("GET", "session"), text("session.ended"));

/** End the session. */
export async function signOut() {
  await requestSignedIn("DELETE", "session");
  forget();
}

/** Think of nobody as signed in. */
export function forget() {
  [session, linked] = [null, null];
  localStorage.removeItem(SIGNED_IN);
}

/** Ask for a path under /api/v1 as who is signed in. Rejects with a Refusal. */
export const call = (method, path, body) => requestSignedIn(method, `api/v1/${path}`, body);

async function requestSignedIn(method, address, body) {
  if (!session) throw new Refusal(UNKNOWN, text("session.nobody"));
  const ask = () => request(method, address, { body, headers: method === "GET" ? {} : repeated() });
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

async function kept(answer, why) {
  try {
    session = await answer;
  } catch (error) {
    if (error.status !== UNKNOWN) throw error;
    hideToken();
    forget();
    throw new Refusal(UNKNOWN, why);
  }
  hideToken();
  linked = null;
  localStorage.setItem(SIGNED_IN, "yes");
  return session;
}

const repeated = () => ({ "X-CSRF-Token": session.csrf });

/** The token of a link. */
const fromAddress = () => new URLSearchParams(location.hash.slice(1)).get("token");

/** Take it out of the address once it is answered; sooner, and who reloads then would lose it. */
function hideToken() {
  if (fromAddress()) history.replaceState(null, "", location.pathname + location.search);
}
