// Single keys, wherever the reader does not write.

// Sliders take arrows and pages alone, so letters go on to do what they do elsewhere.
const WRITES = "input:not([type=range], [type=checkbox]), textarea, select";
const PRESSES = "button, a, summary, [role=tab], [type=checkbox]";

/** Call what belongs to a key; `keys` maps what the keyboard says to functions. */
export function listenForKeys(keys) {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    if (document.querySelector("dialog[open]")) return;
    const { target } = event;
    // A field of a dialog that has just closed has the keys until the page is drawn again.
    if (target.closest?.(WRITES)?.checkVisibility()) return;
    // A space on a button presses the button.
    if (event.key === " " && target.closest?.(PRESSES)) return;
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}
