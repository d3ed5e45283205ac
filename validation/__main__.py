"""`python -m validation`: compute the table; fail if a row that must hold does not."""

import argparse
import os
import sys
from pathlib import Path

from seacage.conventions import SeacageError
from validation._sections import MODULES, chosen, computed, failures
from validation._table import as_csv, as_json, markdown, shown

ROOT = Path(__file__).parents[1]


def main() -> int:
    """Compute and write the table: 0, 1 where a row fails, 2 where a case is wrong."""
    try:
        return _compute(_parser().parse_args())
    except SeacageError as error:
        print(error, file=sys.stderr)
        return 2


def _compute(asked: argparse.Namespace) -> int:
    jobs = chosen(quick=asked.quick, only=asked.only)
    whole = not (asked.quick or asked.only)
    table = computed(jobs, workers=asked.workers, report=_print_progress)
    page = asked.table or (ROOT / "docs" if whole else ROOT / "var") / "validation.md"
    _write(page, markdown(table))
    for path, written in ((asked.json, as_json), (asked.csv, as_csv)):
        if path is not None:
            _write(path, written(table))
    failed = failures(table)
    for row in failed:
        ours = shown(row.ours) if row.ours is not None else "–"
        print(f"does not hold: {row.what}: {ours}, not {shown(row.reference)} {row.unit}")
    return 1 if failed else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="leave out what simulates for long")
    parser.add_argument(
        "--only",
        type=lambda text: text.split(","),
        default=(),
        metavar="NAMES",
        help=f"some sections, separated by commas, of: {', '.join(MODULES)}",
    )
    parser.add_argument("--workers", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("--table", type=Path, metavar="FILE", help="Markdown; docs/validation.md")
    var = ROOT / "var"
    parser.add_argument("--json", type=Path, default=var / "validation.json", metavar="FILE")
    parser.add_argument("--csv", type=Path, default=var / "validation.csv", metavar="FILE")
    return parser


def _print_progress(title: str, done: int, total: int) -> None:
    print(f"{done}/{total} {title}", flush=True)


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, "utf-8")
    print(f"written: {path}")


if __name__ == "__main__":
    sys.exit(main())
