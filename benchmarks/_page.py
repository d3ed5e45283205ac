"""The live page in headless Chromium, and when its table of loads showed which sample."""

import math
import shutil
from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from datetime import datetime

from seacage.cage import Cage
from seacage.records import Sample

Key = tuple[str, datetime]
"""A sample's stream and time."""

Seen = list[tuple[float, list[str]]]
"""By the machine's clock [s], what the column of measured loads said from then on."""

_AROUND = 3  # samples whose digits must differ for one to be told from another

# A mutation is noted in the page itself: then it is in the DOM, and on the screen with the
# next picture.
_NOTE = """
window.seen = [];
let last = "";
new MutationObserver(() => {
  const cells = [...document.querySelectorAll(".loads tbody .measured")].map((c) => c.textContent);
  const now = cells.join();
  if (now === last) return;
  last = now;
  window.seen.push([Date.now() / 1000, cells]);
}).observe(document, { subtree: true, childList: true, characterData: true });
"""


@contextmanager
def opened_page(address: str) -> Generator[Seen]:
    """Open the page, drawn flat; what its table said is in the list when the block ends."""
    from playwright.sync_api import sync_playwright

    seen: Seen = []
    flags = ["--no-sandbox", "--disable-gpu", "--disable-3d-apis"]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=flags)
        try:
            page = browser.new_page()
            page.add_init_script(_NOTE)
            page.goto(address)
            page.locator(".loads tbody tr").first.wait_for()
            yield seen
            seen += [(at, cells) for at, cells in page.evaluate("window.seen")]
        finally:
            browser.close()


def shown_at(
    seen: Seen, cage: Cage, samples: Sequence[Sample], since: Mapping[Key, float]
) -> dict[Key, float]:
    """When the table first showed a shackle's sample, or one of the two after it [s].

    Whether it did is read from the digits, so only samples count whose digits, and those of the
    two after them, differ from those of the three before. One that was never shown counts as
    infinitely late.
    """
    found: dict[Key, float] = {}
    for shackle in cage.shackles:
        own = [one for one in samples if one.stream == shackle.name]
        words = [f"{one.values['tension_kn']:.1f}" for one in own]
        rows = [(at, cells[shackle.bridle]) for at, cells in seen if len(cells) > shackle.bridle]
        for k in range(_AROUND, len(own) - _AROUND):
            wanted = set(words[k : k + _AROUND])
            if wanted.isdisjoint(words[k - _AROUND : k]):
                key = (shackle.name, own[k].t)
                hits = (at for at, word in rows if at >= since[key] and word in wanted)
                found[key] = next(hits, math.inf)
    return found
