// The service: its token, its calls and its live connection.

const KEY = "seacage-token";
const QUIET_MS = 10_000;
const REFUSED = new Set([4401, 4403]);

/** Take the token from the address, where it is not sent anywhere, or from before. */
export function token() {
  const given = new URLSearchParams(location.hash.slice(1)).get("token");
  if (given) {
    sessionStorage.setItem(KEY, given);
    history.replaceState(null, "", location.pathname + location.search);
  }
  return sessionStorage.getItem(KEY);
}

export const keepToken = (given) => sessionStorage.setItem(KEY, given);
export const dropToken = () => sessionStorage.removeItem(KEY);

/** A call was refused; `status` says how. */
export class Refusal extends Error {
  constructor(status, sentence) {
    super(sentence);
    this.status = status;
  }
}

/** Ask for a path under /api/v1. */
export async function ask(path) {
  const headers = { Authorization: `Bearer ${token()}` };
  const answer = await fetch(`api/v1/${path}`, { headers });
  if (answer.ok) return answer.json();
  const { detail } = await answer.json().catch(() => ({ detail: answer.statusText }));
  throw new Refusal(answer.status, String(detail));
}

/**
 * Keep a live connection to a cage: it comes back by itself, and rests while nobody looks.
 *
 * `on` has topology(message), state(message), lost(seconds until the next try), refused(code).
 */
export function connect(cage, on) {
  let socket, watch, retry;
  let failures = 0;

  const listen = () => {
    clearTimeout(watch);
    watch = setTimeout(() => socket.close(), QUIET_MS);
  };

  function open() {
    const address = new URL(`api/v1/cages/${encodeURIComponent(cage)}/live`, location.href);
    address.protocol = address.protocol.replace("http", "ws");
    address.hash = "";
    socket = new WebSocket(address);
    socket.onopen = () => socket.send(JSON.stringify({ token: token() }));
    socket.onmessage = ({ data }) => {
      const message = JSON.parse(data);
      failures = 0;
      listen();
      on[message.kind](message);
    };
    socket.onclose = ({ code }) => {
      clearTimeout(watch);
      if (REFUSED.has(code)) on.refused(code);
      else if (!document.hidden) again();
    };
    listen();
  }

  function again() {
    const seconds = Math.min(15, 2 ** failures);
    failures += 1;
    on.lost(seconds);
    clearTimeout(retry);
    retry = setTimeout(open, 1000 * seconds);
  }

  document.addEventListener("visibilitychange", () => {
    clearTimeout(retry);
    if (document.hidden) socket.close();
    else if (socket.readyState >= WebSocket.CLOSING) open();
  });
  open();
}
