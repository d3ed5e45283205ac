"""Whole experiments, from campaign to report."""

from seacage.studies._benchmarks import BenchmarkStudy, benchmark_study
from seacage.studies._demonstration import Demonstration, prepare_demonstration
from seacage.studies._fidelity import FidelityStudy, fidelity_study
from seacage.studies._held_out import score_record
from seacage.studies._paper import (
    LevelOneScore,
    PaperClaim,
    PaperStudy,
    ShapeScore,
    WayScore,
    paper_study,
)
from seacage.studies._quality import quality_page
from seacage.studies._sensor_scores import Errors, SensorScore
from seacage.studies._shape_error import (
    Judged,
    judged_paths,
    judged_points,
    learned_discrepancy,
)

__all__ = [
    "BenchmarkStudy",
    "Demonstration",
    "Errors",
    "FidelityStudy",
    "Judged",
    "LevelOneScore",
    "PaperClaim",
    "PaperStudy",
    "SensorScore",
    "ShapeScore",
    "WayScore",
    "benchmark_study",
    "fidelity_study",
    "judged_paths",
    "judged_points",
    "learned_discrepancy",
    "paper_study",
    "prepare_demonstration",
    "quality_page",
    "score_record",
]
