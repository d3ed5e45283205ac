"""Training of level 1 of lines' loads in waves, folded by the cage's symmetry."""

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
from jaxtyping import Bool, Float

from seacage.cage import Cage, mooring_lines
from seacage.conventions import InputError, compass
from seacage.dynamics import Mooring, line_places, settle
from seacage.ocean import SeaState
from seacage.records import CampaignRecord
from seacage.surrogates import FittedMotionGP, LoadCases, LoadGP, Symmetry
from seacage.twin._lines._line_loads import LineLoads, load_features, period_span, sea_domain
from seacage.twin._lines._site_waves import SiteWaves
from seacage.twin._metocean import Metocean

LEAST_CASES = 20  # with waves, that converged
# Of every line, by the names of a campaign's
STATISTICS = ("mean", "std", "mpm_3h", "expected_3h", "maximum", "damage_equivalent")

# Lower waves move no line by more than rounding, and would weigh as much as any [m]
LEAST_HS = 0.05

# Of Tp / (5 sqrt(Hs)), largest over least: below, a campaign cannot tell height from period
LEAST_SPAN = 1.5

# Largest difference of a line's tension from its image's, over the largest of all lines [-]
ASYMMETRY = 0.01

# Speed [m/s] and angle from the cage's axis [deg] of the current that a symmetry is tried in
TRIAL = 0.4, 25.0


def train_line_loads(
    cage: Cage, campaign: CampaignRecord, *, restarts: int, seed: int
) -> LineLoads | None:
    """Train level 1 of lines' loads; None where the campaign has none to learn from.

    It has where it was simulated in time, in waves whose period varies beside their height. No
    symmetry is known of the lines of another simulator.
    """
    wavy = in_waves(campaign)
    if not set(STATISTICS) <= campaign.lines.keys() or wavy.sum() < LEAST_CASES:
        return None
    water = Metocean.of(campaign.seas).rows(wavy)
    if period_span(water) < LEAST_SPAN:
        return None
    symmetry = None if campaign.simulator else line_symmetry(cage, campaign.line_names)
    x = load_features(water)
    surrogate = LoadGP(symmetry=symmetry, restarts=restarts).fit(
        x, load_cases(campaign, wavy), duration=campaign.duration, seed=seed
    )
    return LineLoads(
        motion=_node_motion(cage, campaign, wavy, x, symmetry, seed),
        names=campaign.line_names,
        kinds=campaign.line_kinds,
        surrogate=surrogate,
        domain=sea_domain(water),
        waves=SiteWaves.of(water, "the waves of the training campaign"),
    )


def _node_motion(
    cage: Cage,
    campaign: CampaignRecord,
    wavy: Bool[np.ndarray, " case"],
    x: Float[np.ndarray, "n feature"],
    symmetry: Symmetry | None,
    seed: int,
) -> FittedMotionGP | None:
    """Surrogate of the nodes' motion, from cases with waves; None where none was kept."""
    if campaign.node_position_std is None:
        return None
    std = np.asarray(campaign.node_position_std[wavy], dtype=np.float64)
    try:
        turns = None if symmetry is None else symmetry.at(cage.design_position)
    except InputError:  # lines that coincide with their images do not make a mesh do so
        turns = None
    return FittedMotionGP.fit(x, std, symmetry=turns, restarts=0, seed=seed)


def in_waves(campaign: CampaignRecord) -> Bool[np.ndarray, " case"]:
    """Cases whose loads in waves can be learned from."""
    return campaign.converged & np.array([sea.hs >= LEAST_HS for sea in campaign.seas])


def load_cases(campaign: CampaignRecord, some: np.ndarray) -> LoadCases:
    """Loads of some cases of a campaign."""
    names = (one.name for one in fields(LoadCases))
    columns = (np.asarray(campaign.lines[name], dtype=np.float64) for name in STATISTICS)
    return LoadCases(**dict(zip(names, columns, strict=True))).rows(some)


def representative_lines(cage: Cage, *, mooring: Mooring = "catenary") -> tuple[str, ...]:
    """One line of each kind that a cage's symmetry tells apart, which stands for its images.

    Of an uneven cage every line stands for itself. Buoy lines are left out: a buoy whose line has
    parted drifts off, and its corner hangs from the lines that are left.
    """
    lines = mooring_lines(cage, anchored=mooring == "catenary")
    symmetry = line_symmetry(cage, lines.names)
    own = np.arange(len(lines.names))
    first = own if symmetry is None else symmetry.source.min(axis=0)
    return tuple(
        name
        for name, kind, place, at in zip(lines.names, lines.kinds, first, own, strict=True)
        if place == at and kind != "buoy line"
    )


def line_symmetry(cage: Cage, names: Sequence[str]) -> Symmetry | None:
    """The largest symmetry that some of a cage's lines have, in the drawing and in their loads.

    Bridles alone are those of a cage on corner springs. A campaign that has lines of another
    mooring has no symmetry that is known here.

    Every fold that divides the number of its bridles is tried, with mirrors through a frame
    corner or a side's middle and without; what coincides is asked of the equilibria in one
    current and its images.
    """
    mooring: Mooring = "springs" if tuple(names) == cage.bridle_names else "catenary"
    known = mooring_lines(cage, anchored=mooring == "catenary").names
    if not set(names) <= set(known):
        return None
    rows = [known.index(name) for name in names]
    places, corners = line_places(cage, mooring=mooring)[rows], cage.corner_position[:, :2]
    middle = (corners[0] + corners[1]) / 2.0
    mirrors = [float(np.rad2deg(np.arctan2(*one[::-1]))) for one in (corners[0], middle)]
    for fold in range(cage.bridle_count, 0, -1):
        for mirror in (*mirrors, None):
            if cage.bridle_count % fold or (fold == 1 and mirror is None):
                continue
            try:
                symmetry = Symmetry.of(places, fold=fold, mirror=mirror)
            except InputError:
                continue
            if _loads_fall_on_images(cage, mooring, symmetry, rows):
                return symmetry
    return None


def _loads_fall_on_images(
    cage: Cage, mooring: Mooring, symmetry: Symmetry, rows: list[int]
) -> bool:
    speed, angle = TRIAL
    along = np.deg2rad(90.0 - cage.heading + angle)
    velocity = speed * symmetry.turn @ np.array([np.cos(along), np.sin(along)])
    seas = [SeaState(current_speed=speed, current_to=to) for to in compass(velocity).tolist()]
    tension = settle(cage, seas, mooring=mooring).line_tension[:, rows]
    images = tension[0][symmetry.source]
    return bool(np.abs(tension - images).max() <= ASYMMETRY * tension.max())
