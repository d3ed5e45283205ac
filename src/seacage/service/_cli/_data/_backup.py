"""``seacage backup`` and ``seacage restore``: a service in one file, and back."""

from pathlib import Path
from typing import Annotated

import typer

from seacage.service._cli._console import report
from seacage.service._cli._options import DataFolder, InFile, InFolder


def backup(
    file: Annotated[Path, typer.Argument(dir_okay=False)],
    *,
    config: InFile = None,
    data: Annotated[Path | None, typer.Option(file_okay=False)] = None,
    twin: InFolder = None,
    store: str | None = None,
) -> None:
    """Write a service to one file: data folder, samples, archive, twins and settings.

    The service may be running. Give the options that `seacage serve` is given. Not in the file:
    samples in PostgreSQL, certificates, keys, and the tables that loggers write. The file opens
    what its tokens and passwords open: keep it as safe as them.

    Example:
        seacage backup /mnt/backup/ace.tar --data var --twin twin

    Options:
        file: To write; an earlier one is replaced once the new one is whole.
        config: Settings as TOML.
        data: The service's data folder. [default: var]
        twin: The trained twin that is served.
        store: postgresql://user@host/name, or a file of SQLite. [default: in --data]
    """
    from seacage.service._backup import back_up
    from seacage.service._settings import read_settings

    settings = read_settings(
        config,
        data=data,
        store={"url": store} if store else None,
        cages=[{"twin": twin}] if twin else None,
    )
    manifest = back_up(settings, file, config=config)
    size = f"{len(manifest.files)} files, {file.stat().st_size / 1e6:.1f} MB"
    samples = "in it" if manifest.database is None else _by_hand("pg_dump", manifest.database)
    rows = [("Backup", f"{file}, {size}"), ("Samples", samples)]
    report({"file": file, "files": len(manifest.files), "made": manifest.made}, rows=rows)


def restore(
    file: Annotated[Path, typer.Argument(exists=True, dir_okay=False)],
    *,
    data: DataFolder,
    replace: Annotated[bool, typer.Option("--replace")] = False,
    other_physics: Annotated[bool, typer.Option("--other-physics")] = False,
) -> None:
    """Make a backup a data folder again, once every checksum holds.

    A restored file of settings names the restored places; what else differs on this machine,
    such as certificates and tables of loggers, is yours to change before the service starts.

    Example:
        seacage restore /mnt/backup/ace.tar --data var
        seacage serve --data var --twin var/served/twin

    Options:
        file: That `seacage backup` wrote.
        data: Folder to restore, absent or empty.
        replace: Move a folder that is there aside first.
        other_physics: Restore twins of another simulator; they must be trained anew.
    """
    from seacage.service._backup import SETTINGS
    from seacage.service._restore import restore as from_backup

    manifest, aside = from_backup(file, data, replace=replace, other_physics=other_physics)
    options = [f"--data {data}"]
    if SETTINGS in manifest.files:
        options.insert(0, f"--config {data / SETTINGS}")
    else:
        options += [f"--twin {data / new}" for new in manifest.twins]
    rows = [("Restored", f"{data}, {len(manifest.files)} files as of {manifest.made}")]
    if aside is not None:
        rows.append(("Before", f"{aside}; delete it when it is no longer needed"))
    if manifest.database is not None:
        rows.append(("Samples", _by_hand("pg_restore", manifest.database)))
    rows.append(("Serve", f"seacage serve {' '.join(options)}"))
    report({"data": data, "files": len(manifest.files), "before": aside}, rows=rows)


def _by_hand(command: str, database: str) -> str:
    return f"in {database}: {command} takes them, see docs/service.md"
