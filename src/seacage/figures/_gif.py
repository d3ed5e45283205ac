"""Pictures one after the other, as a small GIF."""

from pathlib import Path

import numpy as np
from jaxtyping import UInt8

from seacage.conventions import InputError


class Gif:
    """A GIF of few, chosen colours, so that it stays small and flat areas stay flat.

    ``colours``: as ``#rrggbb``, at most 255; each pixel takes the nearest. ``seconds``: between
    pictures. A GIF counts hundredths; pictures are spread so that the whole keeps time.
    """

    def __init__(self, *, colours: list[str], seconds: float) -> None:
        from PIL import Image

        if seconds < 0.02:
            raise InputError(
                f"Gif: a picture every {seconds:g} s; browsers slow down below 0.02 s. "
                "Draw fewer pictures a second."
            )
        self._palette = Image.new("P", (1, 1))
        self._palette.putpalette(bytes.fromhex("".join(one.removeprefix("#") for one in colours)))
        self._seconds = seconds
        self._pictures: list[Image.Image] = []

    def add(self, pixels: UInt8[np.ndarray, "row column 3"]) -> None:
        """Append one picture."""
        from PIL import Image

        picture = Image.fromarray(pixels)
        self._pictures.append(picture.quantize(palette=self._palette, dither=Image.Dither.NONE))

    def write(self, path: Path) -> None:
        """Write the pictures, looping for ever."""
        first, *others = self._pictures
        ends = np.round(100.0 * self._seconds * np.arange(len(self._pictures) + 1)).astype(int)
        first.save(
            path,
            format="GIF",
            save_all=True,
            append_images=others,
            duration=(10 * np.diff(ends)).tolist(),
            loop=0,
            optimize=True,
        )
