"""Matplotlib figures of records, scores and states."""

from seacage.figures._animation import Motion, write_animation
from seacage.figures._benchmark import Contest, cost_figure, coverage_figure, error_figure
from seacage.figures._comparison import Comparison, density_figure, rows_figure, series_figure
from seacage.figures._drawing import cage_drawing_figure
from seacage.figures._fidelity import fouling_figure, gain_figure, left_figure, sector_figure
from seacage.figures._net import net_figure
from seacage.figures._quality import quality_figure
from seacage.figures._rose import tension_rose_figure
from seacage.figures._shape_error import shape_cases_figure, shape_error_figure
from seacage.figures._shape_views import ShapeView, shape_views_figure
from seacage.figures._states import states_figure
from seacage.figures._style import svg_text, write_figure
from seacage.figures._training_scores import TrainingScores, training_scores_figure
from seacage.figures._volume import MEASURED_VOLUMES, VolumeMark, volume_figure

__all__ = [
    "MEASURED_VOLUMES",
    "Comparison",
    "Contest",
    "Motion",
    "ShapeView",
    "TrainingScores",
    "VolumeMark",
    "cage_drawing_figure",
    "cost_figure",
    "coverage_figure",
    "density_figure",
    "error_figure",
    "fouling_figure",
    "gain_figure",
    "left_figure",
    "net_figure",
    "quality_figure",
    "rows_figure",
    "sector_figure",
    "series_figure",
    "shape_cases_figure",
    "shape_error_figure",
    "shape_views_figure",
    "states_figure",
    "svg_text",
    "tension_rose_figure",
    "training_scores_figure",
    "volume_figure",
    "write_animation",
    "write_figure",
]
