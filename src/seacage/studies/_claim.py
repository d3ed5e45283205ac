"""A claim of a study, evaluated on the study's own numbers."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A sentence that the numbers support or contradict."""

    claim: str
    holds: bool | None  # whether the numbers support it; None where a run that it needs is missing
    finding: str

    @property
    def verdict(self) -> str:
        """In a word."""
        return {True: "holds", False: "missed", None: "not evaluated"}[self.holds]
