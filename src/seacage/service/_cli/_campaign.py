"""``seacage campaign``: many simulations."""

import math
import shlex
from dataclasses import asdict, fields, replace
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from seacage.service._cli import _options
from seacage.service._cli._console import (
    Exit,
    exit_with,
    guard,
    progress_bar,
    report,
    wants_json,
)
from seacage.service._cli._plans import PlanOptions

if TYPE_CHECKING:
    from seacage.cage import Cage, Structure
    from seacage.campaigns import CampaignStatus, Simulator

Store = Annotated[Path, typer.Argument(help="The campaign's folder, a Zarr store.")]
_FAILURES_SHOWN = 20


def run(
    store: Store,
    *,
    plan: PlanOptions,
    cage: _options.CageName = "ace",
    method: Literal["simulate", "settle"] = "simulate",
    law: _options.Law = "kristiansen-faltinsen",
    mooring: _options.Mooring = "catenary",
    ramp: float = 60.0,
    spin_up: _options.SpinUp = 300.0,
    time_step: float = 0.002,
    second_moment: bool = True,
    draw_mooring: bool = False,
    without: _options.Without = None,
    parted_lines: bool = False,
    workers: _options.Workers = None,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS")] = None,
    share: Annotated[str | None, typer.Option(metavar="I/N")] = None,
) -> None:
    """Simulate a cage in many sea states.

    Finished cases are on disk at once: stopped at any moment, the same command goes on where
    it was, and the numbers do not depend on --workers, --cluster or --share.

    Example:
        seacage campaign run ace.zarr --plan paper --cases 400 --seed 1

    Options:
        method: simulate: in time; settle: equilibria, waves by their mean loads.
        ramp: Over which the waves rise, s.
        time_step: s
        second_moment: Keep the second moment of all node coordinates.
        draw_mooring: Draw each case a mooring from the uncertainty that the cage file states.
        parted_lines: One campaign without each line that the cage's symmetry tells apart, in a
            folder of STORE by the line's name, for `seacage train --parted STORE`.
        cluster: Of a Dask scheduler you trust: tcp://host:8786.
        share: Only the I-th of N shares, from 0; others run the rest.
    """
    from seacage.campaigns import Simulator, campaign_status, run_share

    chosen, subject = plan.read(), _options.read_cage_or_structure(cage)
    _options.warn_of(mooring)
    by = Simulator(
        method=method,
        law=law,
        mooring=mooring,
        ramp=ramp,
        spin_up=spin_up,
        time_step=time_step,
        second_moment=second_moment,
        draw_mooring=draw_mooring,
        parted=tuple(without or ()),
    )
    stores = _stores_without(store, subject, by) if parted_lines else {store: by}
    with progress_bar() as progress:
        for each, simulator in stores.items():
            run_share(
                subject,
                chosen,
                each,
                by=simulator,
                share=_options.read_share(share),
                workers=workers,
                cluster=cluster,
                progress=progress,
            )
    reached = {each: campaign_status(each) for each in stores}
    if parted_lines:
        _report_stores(reached)
    else:
        _report_status(store, reached[store])
    if all(one.finished and not one.answers for one in reached.values()):
        raise exit_with("campaign run: no case converged. Check the cage's file.", Exit.FAILED)


def status(store: Store) -> None:
    """Say how far a campaign is, what failed in it and why, and how quick it is.

    While it runs, or after it was stopped.

    Example:
        seacage campaign status ace.zarr
    """
    from seacage.campaigns import campaign_status

    _report_status(store, campaign_status(store))


def finish(store: Store) -> None:
    """Sum up a campaign whose cases have all been run, in shares perhaps.

    Whoever runs the last share does it; only if that was stopped just there it is left to do.

    Example:
        seacage campaign finish ace.zarr
    """
    from seacage.campaigns import campaign_status
    from seacage.records import finish_campaign

    finish_campaign(store)
    reached = campaign_status(store)
    if not reached.finished:
        raise exit_with(
            f"campaign finish: {reached.total - reached.done} of {reached.total} cases have not "
            "been run. Run them first.",
            Exit.REFUSED,
        )
    _report_status(store, reached)


def export(store: Store, out: Annotated[Path, typer.Argument(dir_okay=False)]) -> None:
    """Write a campaign as one CF-NetCDF file.

    Example:
        seacage campaign export ace.zarr ace.nc

    Options:
        out: The CF-NetCDF file to write.
    """
    from seacage.records import export_campaign

    export_campaign(store, out)
    report({"written": str(out)}, rows=[("Written", str(out))])


def import_(
    folder: Annotated[Path, typer.Argument(exists=True, file_okay=False, metavar="DIR")],
    out: Annotated[Path, typer.Argument(metavar="OUT")],
    *,
    cage: _options.CageName,
    simulator: str,
    duration: float | None = None,
) -> None:
    """Read the results of another simulator as a campaign, to train a twin from.

    The twin takes their net, where it is rings of equally many nodes around one at the bottom, and
    the tensions of the lines that the cage's file names. docs/simulators.md has every column.

    Example:
        seacage campaign import results mine.zarr --cage mine.toml --simulator "OrcaFlex 11.4"

    Options:
        folder: Of nodes.csv, edges.csv, cases.csv and positions.nc.
        out: The campaign's folder to write, a Zarr store.
        simulator: Its name and version.
        duration: That standard deviations and maxima are over, without spin-up, s.
    """
    from seacage.cage import Cage
    from seacage.records import read_results, write_campaign

    described = _options.read_cage(cage)
    found = read_results(folder, described, simulator=simulator, duration=duration)
    title = f"Results of {simulator} for cage {described.name!r}"
    write_campaign(found, out, title=title, plan=folder.name, method="import")
    simulated = Cage.from_toml(found.cage_toml)
    _options.warn(simulated.warnings)
    own, rings = simulated.mesh == described.mesh, f"{simulated.rings} rings of {simulated.spokes}"
    report(
        {"written": str(out), "cases": len(found), "lines": list(found.line_names)}
        | {"nodes": simulated.node_count, "mesh_of_cage": own, "statistics": list(found.lines)},
        rows=[
            ("Written", f"{out}: {len(found)} cases of {simulator}"),
            ("Net", f"{rings} nodes, {'as' if own else 'not'} in {cage}"),
            ("Lines", f"{len(found.line_names)}: {', '.join(found.lines)}"),
        ],
    )


def slurm(
    words: Annotated[list[str], typer.Argument(metavar="STORE [OPTIONS]")],
    *,
    tasks: Annotated[int, typer.Option(min=1)],
) -> None:
    """Print a SLURM job array that runs a campaign in shares.

    Beside --tasks it takes what `seacage campaign run` takes, and checks it now.

    Example:
        seacage campaign slurm --tasks 50 ace.zarr --plan paper > job.sh

    Options:
        words: As of `campaign run`.
        tasks: Of the job array: one share each.
    """
    from seacage.campaigns import Simulator

    given = _parse_options(words)
    if given["share"] or given["cluster"]:
        raise exit_with(
            "campaign slurm: it makes the shares. Leave --share and --cluster out.", Exit.USAGE
        )
    chosen = PlanOptions(**{one.name: given[one.name] for one in fields(PlanOptions)}).read()
    _options.read_cage_or_structure(given["cage"])
    blocks = -(-len(chosen) // Simulator(method=given["method"], law=given["law"]).block)
    alone = [] if given["workers"] else ["--workers", "1"]
    template = files("seacage.service._cli").joinpath("slurm.sh").read_text("utf-8")
    script = template.format(
        cases=len(chosen),
        tasks=min(tasks, blocks),
        last=min(tasks, blocks) - 1,
        workers=given["workers"] or 1,
        store=shlex.quote(str(given["store"])),
        command=shlex.join(["seacage", "campaign", "run", *words, *alone]),
    )
    if wants_json():
        report({"script": script})
    else:
        typer.echo(script, nl=False)


def _parse_options(words: list[str]) -> dict[str, Any]:
    """The options that `campaign run` would get of the words meant for it."""
    alone = typer.Typer(add_completion=False)
    alone.command()(guard(run))
    command: Any = typer.main.get_command(alone)
    with command.make_context("seacage campaign run", [*words]) as context:
        return {name: None if one == () else one for name, one in context.params.items()}


def _stores_without(
    store: Path, cage: "Cage | Structure", by: "Simulator"
) -> "dict[Path, Simulator]":
    """A store, and what fills it, for each line that is unlike the others."""
    from seacage.cage import Cage
    from seacage.conventions import InputError
    from seacage.twin import representative_lines

    if by.parted or not isinstance(cage, Cage):
        raise InputError(
            "campaign run: --parted-lines takes the lines of a whole cage one by one. Give it "
            f"{'without --without' if by.parted else 'a cage that is no structure'}."
        )
    lines = representative_lines(cage, mooring=by.mooring)
    return {store / line: replace(by, parted=(line,)) for line in lines}


def _report_stores(reached: "dict[Path, CampaignStatus]") -> None:
    stores, rows = list[dict[str, Any]](), list[tuple[str, str]]()
    for store, one in reached.items():
        stores.append(
            {"store": str(store), "parted": store.name, "answers": one.answers}
            | {"done": one.done, "total": one.total, "finished": one.finished}
        )
        rows.append((store.name, f"{one.done} of {one.total} done, {one.answers} to learn from"))
    report({"stores": stores}, rows=rows)


def _report_status(store: Path, reached: "CampaignStatus") -> None:
    from seacage.conventions import Result

    about, ends = asdict(reached), [result.name.lower() for result in Result]
    failures = [{"case": case, "reason": reason} for case, reason in reached.failures.items()]
    summed = reached.finished or reached.done < reached.total
    unsummed = ", not summed: say `seacage campaign finish`"
    report(
        {"store": store, "origin": "computed", **about, "done": reached.done}
        | {"failures": failures, "core_seconds": round(reached.core_seconds, 2)}
        | {"simulated_s_per_core_second": round(reached.pace, 1)},
        rows=[
            ("Campaign", f"{store}: plan {reached.plan}, {reached.method}, {reached.law}"),
            ("Done", f"{reached.done} of {reached.total}{'' if summed else unsummed}"),
            *((name.replace("_", " "), str(about[name])) for name in ends),
            *_pace(reached),
            *_failure_rows(reached),
        ],
    )


def _pace(reached: "CampaignStatus") -> list[tuple[str, str]]:
    if math.isnan(reached.core_seconds):
        return []
    each = "" if math.isnan(reached.pace) else f", {reached.pace:.0f} simulated seconds in each"
    return [("Cost", f"{reached.core_seconds:.0f} core-seconds{each}")]


def _failure_rows(reached: "CampaignStatus") -> list[tuple[str, str]]:
    rows = [(f"case {case}", reason) for case, reason in reached.failures.items()]
    more = len(rows) - _FAILURES_SHOWN
    return [*rows[:_FAILURES_SHOWN], *([("…", f"and {more} more: say --json")] if more > 0 else [])]
