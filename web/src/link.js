// The live connection to one cage: it comes back by itself, and rests while nobody looks.

const QUIET_MS = 15_000;
const LONGEST_PAUSE_S = 15;
const SIGNED_IN = JSON.stringify({ token: null }); // the cookie has come with the question
const REFUSED = { 4401: "unknown", 4403: "scope", 4404: "cage" };

/**
 * Open it.
 *
 * @param {string} cage
 * @param {{topology: Function, frame: Function, lost: Function, refused: Function}} on
 *   topology(message), frame(ArrayBuffer), lost(seconds until the next try), refused(why)
 * @returns {{close: Function, again: Function}} again() tries at once
 */
export function connect(cage, on) {
  let socket, watch, retry;
  let failures = 0;
  let ended = false;

  const listen = () => {
    clearTimeout(watch);
    watch = setTimeout(silent, QUIET_MS);
  };

  function open() {
    clearTimeout(retry);
    const one = new WebSocket(address(cage));
    socket = one;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => one.send(SIGNED_IN);
    socket.onmessage = ({ data }) => {
      if (one !== socket || ended) return;
      failures = 0;
      listen();
      if (typeof data !== "string") on.frame(data);
      else {
        const message = JSON.parse(data);
        if (message.kind === "topology") on.topology(message);
      }
    };
    socket.onclose = ({ code }) => gone(one, code);
    listen();
  }

  function gone(one, code) {
    if (one !== socket || ended) return;
    socket = null;
    clearTimeout(watch);
    if (code in REFUSED) on.refused(REFUSED[code]);
    else if (!document.hidden) pause();
  }

  /** A line that has died may take minutes to close; nobody waits for that. */
  function silent() {
    const dead = socket;
    gone(dead);
    dead?.close();
  }

  function pause() {
    const seconds = Math.min(LONGEST_PAUSE_S, 2 ** failures);
    failures += 1;
    retry = setTimeout(open, 1000 * seconds);
    on.lost(seconds);
  }

  const seen = () => {
    clearTimeout(retry);
    if (document.hidden) socket?.close();
    else if (!socket || socket.readyState >= WebSocket.CLOSING) open();
  };

  document.addEventListener("visibilitychange", seen);
  open();
  return {
    again: open,
    close() {
      ended = true;
      clearTimeout(watch);
      clearTimeout(retry);
      document.removeEventListener("visibilitychange", seen);
      socket?.close();
    },
  };
}

function address(cage) {
  const url = new URL(`api/v1/cages/${encodeURIComponent(cage)}/live`, location.href);
  url.protocol = url.protocol.replace("http", "ws");
  url.hash = "";
  url.search = "";
  return url;
}
