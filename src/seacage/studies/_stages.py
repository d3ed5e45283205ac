"""Work in stages: each is made once for its settings, and a stop in between loses nothing."""

import hashlib
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal, TypeVar

from seacage.cage import Cage
from seacage.campaigns import Plan, run_campaign
from seacage.conventions import Progress, RecordError, no_progress
from seacage.dynamics import PHYSICS
from seacage.records import CampaignRecord, read_campaign

MANIFEST = "stage.json"
# Rooms whose code makes a campaign
SIMULATION = ("conventions", "ocean", "cage", "dynamics", "campaigns")

Item = TypeVar("Item")


@dataclass(frozen=True, slots=True, kw_only=True)
class Stages:
    """A folder of finished stages, ``<stage>-<key>``, and of those begun, ``.<stage>-<key>``.

    The key is a hash of the stage's settings and of the code that makes it. A finished stage
    is never written to again, so that whoever finds it can trust it.
    """

    folder: Path
    workers: int | None = None  # processes for simulations; None for one per core
    progress: Progress = no_progress  # called as (stage, done, total)

    def ensure(
        self,
        stage: str,
        settings: Mapping[str, object],  # all that the result depends on, as JSON takes it
        # Fills the folder it is given. After a stop it gets that folder again with what it had put
        # there, and may go on from it.
        make: Callable[[Path], None],
        *,
        rooms: tuple[str, ...],  # the rooms of seacage whose code makes the stage
    ) -> Path:
        """The folder of a stage, made now unless it is there."""
        manifest = {
            "stage": stage,
            "seacage": version("seacage"),
            "physics": PHYSICS,
            "code_sha256": code_sha256(rooms),
            "settings": dict(settings),
        }
        text = json.dumps(manifest, indent=2, sort_keys=True) + "\n"
        key = hashlib.sha256(text.encode()).hexdigest()[:10]
        finished = self.folder / f"{stage}-{key}"
        if finished.exists():
            _check(finished, text)
            return finished
        begun = self.folder / f".{stage}-{key}"
        begun.mkdir(parents=True, exist_ok=True)
        make(begun)
        (begun / MANIFEST).write_text(text, encoding="utf-8")
        return begun.rename(finished)

    def ensure_campaign(
        self,
        stage: str,
        cage: Cage,
        plan: Plan,
        *,
        method: Literal["simulate", "settle"] = "settle",
        second_moment: bool = False,
        **others: Any,
    ) -> CampaignRecord:
        """A cage in the seas of a plan, kept on disk case by case.

        ``stage``: its name, which the progress is called with. All others: as for ``run_campaign``.
        """
        by = {"method": method, "second_moment": second_moment, **others}

        def make(begun: Path) -> None:
            run_campaign(
                cage,
                plan,
                begun / "campaign.zarr",
                workers=self.workers,
                progress=lambda _, done, total: self.progress(stage, done, total),
                **by,
            )

        settings = {"cage": cage.to_toml(), "plan_sha256": plan.sha256, **by}
        return read_campaign(self.ensure(stage, settings, make, rooms=SIMULATION) / "campaign.zarr")


def count(items: Sequence[Item], stage: str, progress: Progress) -> Iterator[Item]:
    """Items one after another; progress is called before each, and at the end."""
    for done, item in enumerate(items):
        progress(stage, done, len(items))
        yield item
    progress(stage, len(items), len(items))


@cache  # what this process runs is what it has loaded, whatever is edited meanwhile
def code_sha256(rooms: tuple[str, ...]) -> str:
    """Hash of the source files of some rooms: one version may have seen many changes."""
    digest = hashlib.sha256()
    for room in rooms:
        root = Path(str(resources.files("seacage") / room))
        for path in sorted(root.rglob("*")):
            if path.suffix in {".py", ".c", ".h", ".toml"}:
                digest.update(path.relative_to(root).as_posix().encode() + b"\0")
                digest.update(path.read_bytes() + b"\0")
    return digest.hexdigest()


def _check(finished: Path, text: str) -> None:
    manifest = finished / MANIFEST
    if not manifest.is_file() or manifest.read_text("utf-8") != text:
        raise RecordError(
            f"{finished} is not the stage that its name says; something changed in it. "
            "Delete this folder; it will be made again."
        )
