"""The study of the two fidelities: how they differ, and what is left without a difference."""

from seacage.studies._fidelity._study import FidelityStudy, fidelity_study

__all__ = ["FidelityStudy", "fidelity_study"]
