"""The study of the paper's experiment: its claims against this project's own numbers."""

from seacage.studies._paper._claims import PaperClaim
from seacage.studies._paper._level_one import LevelOneScore
from seacage.studies._paper._shape_scores import ShapeScore
from seacage.studies._paper._study import PaperStudy, paper_study
from seacage.studies._paper._trainings import WayScore

__all__ = ["LevelOneScore", "PaperClaim", "PaperStudy", "ShapeScore", "WayScore", "paper_study"]
