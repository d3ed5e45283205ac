"""Whole experiments, from campaign to report."""

from seacage.studies._demonstration import Demonstration, prepare_demonstration
from seacage.studies._paper import PaperStudy, paper_study

__all__ = ["Demonstration", "PaperStudy", "paper_study", "prepare_demonstration"]
