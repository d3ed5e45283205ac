"""Whether shapes have the symmetry that their net has."""

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.surrogates._features import check_turnable
from seacage.surrogates._prediction import check_shapes
from seacage.surrogates._shape._symmetry import Symmetry

# Cases that the trial model learns from, and cases that it is asked about, at most
TEACH, JUDGE = 400, 100
COMPRESSION = 0.01  # of the trial model [m]
FEW = 20  # least number of cases that can show an asymmetry


def check_symmetry(
    symmetry: Symmetry,
    x: Float[np.ndarray, "n feature"],
    node_position: Float[np.ndarray, "n node 3"],
    *,
    tolerance: float = 0.05,
    seed: int = 0,
) -> float:
    """Refuse a symmetry that the shapes do not have.

    A trial model that knows of no symmetry learns four fifths of the cases. The others it is
    asked about twice: as they are, and by their images, whose shapes are moved back. Only an
    asymmetry of the cage, its mooring or the sea can make the images miss by more. The cases
    must cover the images: currents and waves from all round.

    Raises InputError: the asymmetry is above the tolerance, or the cases are too few, or too hard
    for the trial model, to tell.

    Parameters
    ----------
    symmetry
        Of the net.
    x
        From ``metocean_features``.
    node_position
        The shape of each case [m].
    tolerance
        Largest asymmetry: distance of a node from its image, root mean square over nodes, beyond
        what the trial model misses anyway, in the median case [m].
    seed
        Of the choice of cases.

    Returns the asymmetry [m].
    """
    x, node_position = check_shapes(x, node_position, what="check_symmetry")
    check_turnable(x, what="check_symmetry")
    nodes = symmetry.source.shape[1]
    if node_position.shape[1] != nodes:
        raise InputError(
            f"check_symmetry: the shapes have {node_position.shape[1]} nodes, the symmetry is of "
            f"{nodes}. Make it of the same net."
        )
    if len(x) < FEW:
        raise InputError(
            f"check_symmetry: {len(x)} cases are too few; give at least {FEW}, or learn without "
            "a symmetry."
        )
    rows = np.random.default_rng(seed).permutation(len(x))
    held_out, training = np.split(rows[: TEACH + JUDGE], [min(JUDGE, len(x) // 5)])
    missed = _errors_by_image(
        symmetry, x, node_position, training=training, held_out=held_out, seed=seed
    )
    direct, by_image = np.median(missed[0]), np.median(np.sqrt(np.mean(missed[1:] ** 2, axis=0)))
    asymmetry = float(np.sqrt(max(by_image**2 - direct**2, 0.0)))
    if asymmetry > tolerance:
        raise InputError(
            f"check_symmetry: by their images the shapes are missed by {by_image:.3g} m, directly "
            f"by {direct:.3g} m, so they are {asymmetry:.3g} m from symmetric, above the tolerance "
            f"of {tolerance:g} m. The cage, its mooring or the campaign's directions are not "
            "symmetric so: learn without a symmetry, or with a lesser one."
        )
    if direct > 4.0 * tolerance:
        raise InputError(
            f"check_symmetry: {len(training)} training cases give an error of {direct:.3g} m, too "
            f"large to see an asymmetry of {tolerance:g} m. Give more cases, a larger "
            "tolerance, or no symmetry."
        )
    return asymmetry


def _errors_by_image(
    symmetry: Symmetry,
    x: Float[np.ndarray, "n feature"],
    node_position: Float[np.ndarray, "n node 3"],
    *,
    training: np.ndarray,
    held_out: np.ndarray,
    seed: int,
) -> Float[np.ndarray, "image held_out"]:
    """Root mean square distance over the nodes of each held-out case, by each image [m]."""
    # which asks this check before it folds by a symmetry
    from seacage.surrogates._shape._shape_gp import EVERY, ShapeGP

    trial = ShapeGP(tolerance=COMPRESSION, restarts=0)
    model = trial.fit(x[training], node_position[training], seed=seed)
    missed = np.empty((len(symmetry), len(held_out)))
    for image in range(len(symmetry)):
        answer = model.mean_of_nodes(symmetry.turned(x[held_out], image), EVERY)
        moved_back = symmetry.moved(answer, symmetry.back(image))
        distance = np.sum((moved_back - node_position[held_out]) ** 2, axis=2)
        missed[image] = np.sqrt(distance.mean(axis=1))
    return missed
