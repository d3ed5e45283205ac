"""Whole experiments, from campaign to report."""

from seacage.studies._demonstration import Demonstration, prepare_demonstration
from seacage.studies._fidelity import FidelityStudy, fidelity_study
from seacage.studies._held_out import score_record
from seacage.studies._level_one import LevelOneScore, ShapeScore
from seacage.studies._paper import PaperStudy, paper_study
from seacage.studies._quality import quality_page
from seacage.studies._sensor_scores import Errors, SensorScore

__all__ = [
    "Demonstration",
    "Errors",
    "FidelityStudy",
    "LevelOneScore",
    "PaperStudy",
    "SensorScore",
    "ShapeScore",
    "fidelity_study",
    "paper_study",
    "prepare_demonstration",
    "quality_page",
    "score_record",
]
