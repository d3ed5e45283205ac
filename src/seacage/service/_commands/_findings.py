"""What a command that looks for faults has found, and how it says so."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from seacage.service._console import Exit, stopped, tell


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What was looked at, how it is, and what to do where it is wrong."""

    what: str
    state: Literal["ok", "absent", "wrong"]
    said: str


def tell_findings(command: str, findings: Sequence[Finding], *, code: Exit, as_json: bool) -> None:
    """Print what was found, and end with a code where something is wrong.

    Parameters
    ----------
    command
        Whose findings they are.
    findings
        All of them, in the order in which they are read.
    code
        To end with where one is wrong.
    as_json
        Whether ``--json`` was given.
    """
    wrong = [one for one in findings if one.state == "wrong"]
    tell(
        {"ok": not wrong}
        | {"findings": [{"what": f.what, "state": f.state, "said": f.said} for f in findings]},
        as_json=as_json,
        rows=[(f"{one.state:<6}  {one.what}", one.said) for one in findings],
    )
    if wrong:
        raise stopped(f"{command}: {len(wrong)} of {len(findings)} are wrong.", code)
