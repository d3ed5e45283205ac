"""``seacage campaign``: many simulations."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from seacage.service._commands._settle import CageName, Law, read_cage
from seacage.service._console import Exit, Json, guarded, progress_bar, stopped, tell

if TYPE_CHECKING:
    from seacage.campaigns import CampaignStatus, Plan

group = typer.Typer(help="Many simulations: run them, see how far they are, export them.")

Store = Annotated[Path, typer.Argument(help="The campaign's folder, a Zarr store.")]


@group.command()
@guarded
def run(
    store: Store,
    *,
    cases: Annotated[int, typer.Option(min=1, help="Sea states to draw.")] = 1000,
    plan: Annotated[
        Literal["current", "paper", "default"],
        typer.Option(help="current: no waves; paper: its ranges; default: also longer periods."),
    ] = "current",
    plan_file: Annotated[
        Path | None,
        typer.Option(
            exists=True, dir_okay=False, help="A plan that was written; instead of --plan."
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the draw.")] = 0,
    cage: CageName = "ace",
    law: Law = "kristiansen-faltinsen",
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes. [default: one per core]")
    ] = None,
    as_json: Json = False,
) -> None:
    """Settle a cage in many sea states.

    Finished cases are on disk at once: stopped at any moment, the same command goes on where
    it was, and the numbers do not depend on --workers.

    Example:
        seacage campaign run ace.zarr --cases 400 --seed 1
    """
    from seacage.campaigns import campaign_status, run_campaign

    with progress_bar() as progress:
        run_campaign(
            read_cage(cage),
            _plan(plan, plan_file, seed, cases),
            store,
            workers=workers,
            law=law,
            progress=progress,
        )
    reached = campaign_status(store)
    _tell(store, reached, as_json=as_json)
    if not reached.converged:
        raise stopped("campaign run: no case converged. Check the cage's file.", Exit.FAILED)


@group.command()
@guarded
def status(store: Store, *, as_json: Json = False) -> None:
    """Say how far a campaign is, while it runs or after it was stopped.

    Example:
        seacage campaign status ace.zarr
    """
    from seacage.campaigns import campaign_status

    _tell(store, campaign_status(store), as_json=as_json)


@group.command()
@guarded
def export(
    store: Store,
    out: Annotated[Path, typer.Argument(dir_okay=False, help="The CF-NetCDF file to write.")],
    *,
    as_json: Json = False,
) -> None:
    """Write a campaign as one CF-NetCDF file.

    Example:
        seacage campaign export ace.zarr ace.nc
    """
    from seacage.records import export_campaign

    export_campaign(store, out)
    tell({"written": str(out)}, as_json=as_json, rows=[("Written", str(out))])


def _plan(name: str, file: Path | None, seed: int, cases: int) -> "Plan":
    from seacage.campaigns import Plan

    if file is not None:
        return Plan.read(file)
    if name == "current":
        return Plan.sample(seed, cases, hs=(0.0, 0.0), name="current")
    return Plan.named(name, seed, cases)


def _tell(store: Path, reached: "CampaignStatus", *, as_json: bool) -> None:
    done = reached.converged + reached.not_converged + reached.diverged
    counts = {
        "converged": reached.converged,
        "not_converged": reached.not_converged,
        "diverged": reached.diverged,
    }
    tell(
        {"store": str(store), "plan": reached.plan, "law": reached.law, "origin": "computed"}
        | {"total": reached.total, "done": done, **counts},
        as_json=as_json,
        rows=[
            ("Campaign", f"{store}: plan {reached.plan}, {reached.law}"),
            ("Done", f"{done} of {reached.total}"),
            *((name.replace("_", " "), str(count)) for name, count in counts.items()),
        ],
    )
