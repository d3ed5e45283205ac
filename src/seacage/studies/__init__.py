"""Whole experiments, from campaign to report."""

from seacage.studies._bench._study import BenchStudy, bench_study
from seacage.studies._benchmarks._study import BenchmarkStudy, benchmark_study
from seacage.studies._demonstration import Demonstration, prepare_demonstration
from seacage.studies._fidelity._study import FidelityStudy, fidelity_study
from seacage.studies._held_out import score_record
from seacage.studies._paper._claims import PaperClaim
from seacage.studies._paper._sensor_baselines import BaselineScore, score_surrogate
from seacage.studies._paper._shape_scores import ShapeScore
from seacage.studies._paper._study import LevelOneScore, PaperStudy, paper_study
from seacage.studies._paper._trainings import WayScore
from seacage.studies._quality import quality_page
from seacage.studies._sensor_scores import Errors, SensorScore
from seacage.studies._shape_discrepancy import (
    Reliability,
    learned_discrepancy,
    score_paths,
    score_points,
)

__all__ = [
    "BaselineScore",
    "BenchStudy",
    "BenchmarkStudy",
    "Demonstration",
    "Errors",
    "FidelityStudy",
    "LevelOneScore",
    "PaperClaim",
    "PaperStudy",
    "Reliability",
    "SensorScore",
    "ShapeScore",
    "WayScore",
    "bench_study",
    "benchmark_study",
    "fidelity_study",
    "learned_discrepancy",
    "paper_study",
    "prepare_demonstration",
    "quality_page",
    "score_paths",
    "score_points",
    "score_record",
    "score_surrogate",
]
