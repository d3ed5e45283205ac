"""Numbers of the lines of a mooring, as files and stores name them."""

from seacage.records._netcdf_file import CELL_METHODS, Variable

LINES = {
    "capacity": ("N", "breaking load over material factor"),
    "mean": ("N", "mean tension"),
    "std": ("N", "standard deviation of the tension"),
    "minimum": ("N", "least tension"),
    "maximum": ("N", "largest tension"),
    "mpm_3h": ("N", "most probable largest tension of three hours"),
    "mpm_3h_std": ("N", "standard deviation of line_mpm_3h"),
    "expected_3h": ("N", "expected largest tension of three hours"),
    "expected_3h_std": ("N", "standard deviation of line_expected_3h"),
    "slack_share": ("1", "share of the time below 1 % of the pretension"),
    "snaps": ("1", "times that the slack line was pulled beyond its mean"),
    "uplift_mean": ("N", "mean pull up on the line's anchor"),
    "uplift_maximum": ("N", "largest pull up on the line's anchor"),
    "damage_equivalent": ("N", "range of cycles at 1 Hz that wear the line as much"),
    "damage_per_year": ("year-1", "share of the T-N life that a year of such a sea uses up"),
    "tn_slope": ("1", "slope m of the T-N curve, of line_damage_equivalent"),
}
"""Unit and meaning of each, by the names of ``HistoryRecord.lines``; in files after ``line_``."""

CONSTANT = ("capacity", "tn_slope")  # those that do not depend on the sea


def line_variable(name: str, *dims: str, dtype: str = "float64") -> Variable:
    """One of ``LINES`` along some dimensions and the lines."""
    unit, meaning = LINES[name]
    methods = CELL_METHODS.get(name, "")
    return Variable((*dims, "mooring_line"), unit, meaning, cell_methods=methods, dtype=dtype)
