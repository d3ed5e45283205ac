"""``seacage twin``: the twin that a service answers by."""

import time
from pathlib import Path
from typing import Annotated

import typer

from seacage.service._cli._console import Exit, exit_with, refusal, report
from seacage.service._cli._options import InFile

_PATIENCE_S, _UNKNOWN_S = 60.0, 10.0  # for a service that runs, and for one that may run
_LOOK_S = 0.2


def replace(
    new: Annotated[Path | None, typer.Argument(exists=True, file_okay=False)] = None,
    *,
    data: Annotated[Path | None, typer.Option(file_okay=False)] = None,
    cage: str | None = None,
    previous: Annotated[bool, typer.Option("--previous")] = False,
    why: str = "",
    config: InFile = None,
) -> None:
    """Replace the twin of a cage, between two ticks of a running service or for its next start.

    The new twin is checked against the cage and copied before anything changes; the old one is
    kept. History, alarms and counts of damage stay; what was learned of the old twin's residuals
    (widths of intervals, the fault detector's baseline) begins anew.

    Example:
        seacage twin replace --data var twin-2027 --why "trained with the winter's storms"
        seacage twin replace --data var --previous

    Options:
        new: Folder of the new twin.
        data: The service's data folder. [default: var]
        cage: Which one, where the service has several.
        previous: Put the twin before in force again.
        why: For the journal.
        config: Settings as TOML, with the key that twins are signed with.
    """
    from seacage.service._assembly import twin_shelf
    from seacage.service._auth._audit import Audit
    from seacage.service._settings import read_settings
    from seacage.service._store._database._sqlite import is_served

    if (new is None) != previous:
        raise refusal("twin replace: give the folder of the new twin, or --previous.")
    settings = read_settings(config, data=data)
    shelf = twin_shelf(settings)
    cages = shelf.cages()
    if cage is None and len(cages) > 1:
        raise refusal(f"twin replace: there are {', '.join(cages)}. Name one by --cage.")
    name = cage or next(iter(cages), "")
    shelf.ask(name, new, who="command line", why=why)
    Audit(settings.data / "audit.jsonl").write(f"twin replace {name}", who="command line")
    served = [is_served(one) for one in settings.data.glob("*.sqlite")]
    # A store that lies elsewhere does not show whether a service runs.
    end = time.monotonic() + (_PATIENCE_S if any(served) else _UNKNOWN_S * (not served))
    while (term := shelf.outcome(name)) is None and time.monotonic() < end:
        time.sleep(_LOOK_S)
    if term is None and any(served):
        raise exit_with(
            f"twin replace: the service has not taken the twin within {_PATIENCE_S:.0f} s, and "
            "will as soon as it can. See its log.",
            Exit.FAILED,
        )
    when = f"since {term.since}" if term else "from the next start of the service on"
    report(
        {"cage": name, "since": term and term.since and term.since.isoformat()},
        rows=[("Cage", name), ("In force", when)],
    )
