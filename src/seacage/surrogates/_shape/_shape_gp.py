"""The whole shape of the net from one shared kernel."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import InputError, ModelError
from seacage.surrogates import _gp
from seacage.surrogates._arrays import Arrays, Settings, array, setting
from seacage.surrogates._features import check_turnable
from seacage.surrogates._prediction import Prediction, check_inputs, check_shapes
from seacage.surrogates._shape._pca import Modes, modes_within
from seacage.surrogates._shape._symmetry import Symmetry

NFeature = Float[np.ndarray, "n feature"]
NNode3 = Float[np.ndarray, "n node 3"]
Row4Node = Float[np.ndarray, "row 4 node"]
RowFeature = Float[np.ndarray, "row feature"]
RowMode = Float[np.ndarray, "row mode"]
RowNode3 = Float[np.ndarray, "row node 3"]
# Share of the cases that an interval of so many standard deviations is to cover
LEVEL, DEVIATIONS = 0.95, 1.959964
# Cases that the trial model of ``check_symmetry`` learns from, and that it is checked on, at most
TRAINING, HELD_OUT = 400, 100
COMPRESSION = 0.01  # of the trial model [m]
FEW = 20  # least number of cases that can show an asymmetry
Nodes = slice | Int[np.ndarray, " node"]  # some nodes: a slice, or their numbers
EVERY = slice(None)


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapeGP:
    """One Gaussian process for all node coordinates, not yet fitted.

    All coordinates share one kernel and one factorisation, so principal components are no
    model here but compression: as many are kept as the tolerance asks for.
    """

    # Matern-5/2 by default: lines going slack and ropes stiffening put kinks in the shape
    kernel: _gp.KernelName = "matern-5/2"
    # Largest root mean square distance that compression may move any node by, over the training
    # cases [m]
    tolerance: float = 1e-3
    restarts: int = 3  # random starts of the hyperparameter search beside the deterministic one
    # Of the cage: every case is learned by its image in one sector of the current's directions, and
    # answered from there. Needs ``metocean_features``
    symmetry: Symmetry | None = None
    asymmetry: float = 0.05  # largest that ``check_symmetry`` may find in the training [m]

    def __post_init__(self) -> None:
        _gp.check_options(kernel=self.kernel, restarts=self.restarts)
        for name in ("tolerance", "asymmetry"):
            if not getattr(self, name) > 0.0:
                raise InputError(
                    f"ShapeGP: {name} = {getattr(self, name):g} m is not above 0. "
                    "Give the distance that a node may be off by, e.g. 0.001 m."
                )

    def fit(self, x: NFeature, node_position: NNode3, *, seed: int = 0) -> "FittedShapeGP":
        """Learn from features and shapes.

        ``x``: one row per case, e.g. from ``metocean_features``.
        ``node_position``: the shape of each case [m].
        ``seed``: of the subset of points and of the random starts.
        """
        x, shape = check_shapes(x, node_position, what="ShapeGP.fit")
        if self.symmetry is not None:
            check_symmetry(self.symmetry, x, shape, tolerance=self.asymmetry, seed=seed)
            x, shape = _fold_cases(self.symmetry, x, shape)
        centre = shape.mean(axis=0)
        displacement = (shape - centre).reshape(len(x), -1)
        modes = modes_within(displacement, self.tolerance)
        scores = modes.encode(displacement)
        process = _gp.fit_process(
            _gp.StationaryKernel(self.kernel),
            x,
            scores,
            likelihood_outputs=_gp.condense(scores),
            restarts=self.restarts,
            seed=seed,
        )
        fitted = FittedShapeGP(
            basis=modes,
            scores=process,
            centre=centre,
            left_out=np.zeros_like(centre),
            scale=np.ones_like(centre),
            features=x.shape[1],
            symmetry=self.symmetry,
        )
        missed = shape - fitted.render(scores)
        fitted = replace(fitted, left_out=np.sqrt(np.mean(missed**2, axis=0)))
        return replace(fitted, scale=_interval_scale(fitted, x, shape))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedShapeGP:
    """The whole shape: compressed modes, and one process for all their scores.

    With a symmetry all of this is of the sector in which it was learned.
    """

    MODEL: ClassVar[str] = "shape-gp"

    basis: Modes  # the modes kept, of displacements from the mean shape
    scores: _gp.FittedGaussianProcess  # one process with an output per mode
    centre: Float[np.ndarray, "node 3"]  # the mean shape [m]
    # Root mean square over the training cases of what the modes leave out [m]
    left_out: Float[np.ndarray, "node 3"]
    # What the standard deviation of each coordinate is multiplied by: with it 95 % of the training
    # cases lie inside 1.96 of them, each predicted from all others
    scale: Float[np.ndarray, "node 3"]
    features: int  # how many the sea state has
    symmetry: Symmetry | None  # as in ``ShapeGP``
    # Of the modes' coordinates at each node, which variances are sums of: x x, y y, z z, x y
    products: Float[np.ndarray, "mode product node"] = field(init=False, repr=False)
    # These sums where every score is as uncertain as before the training [m2]
    prior_moments: Float[np.ndarray, "product node"] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        # Formed once: it would cost more than all the rest of a prediction.
        x, y, z = np.moveaxis(self.basis.direction.reshape(self.modes, -1, 3), 2, 0)
        products = np.stack([x * x, y * y, z * z, x * y], axis=1)
        object.__setattr__(self, "products", products)
        prior = np.tensordot(self.scores.amplitude**2, products, axes=1)
        object.__setattr__(self, "prior_moments", prior)

    @property
    def modes(self) -> int:
        """How many the compression keeps."""
        return len(self.basis.direction)

    @property
    def compression_error_m(self) -> float:
        """Largest root mean square distance that compression moves a node by [m]."""
        return float(np.sqrt(np.max(np.sum(self.left_out**2, axis=1))))

    def predict(self, x: RowFeature, *, noisy: bool = False) -> Prediction:
        """Shape at each row of features [m].

        ``x``: one row per case, the features of the training.
        ``noisy``: of a new observation: adds the noise. What compression leaves out is in the
        standard deviation either way.
        """
        return self.predict_nodes(x, EVERY, noisy=noisy)

    def predict_nodes(self, x: RowFeature, nodes: Nodes, *, noisy: bool = False) -> Prediction:
        """These nodes alone at each row of features [m].

        ``x``, ``noisy``: as for ``predict``.
        ``nodes``: which, from 0.
        """
        x = self._check(x, what="predict")
        if self.symmetry is None:
            mean, variance = self._in_sector(x, nodes, noisy=noisy)
            return Prediction(mean=mean, std=np.sqrt(np.swapaxes(variance[:, :3], 1, 2)))
        mean, std = np.zeros((2, len(x), len(self.centre[nodes]), 3))
        for image, shares in enumerate(self.symmetry.shares(x).T):
            rows = np.flatnonzero(shares)
            if len(rows):
                own = self._by_image(self.symmetry, image, x[rows], nodes, noisy=noisy)
                mean[rows] += shares[rows, None, None] * own.mean
                std[rows] += shares[rows, None, None] * own.std
        return Prediction(mean=mean, std=std)

    def mean_of_nodes(self, x: RowFeature, nodes: Nodes) -> RowNode3:
        """The mean of ``predict_nodes`` alone [m], at a fraction of its cost without symmetry."""
        if self.symmetry is not None:
            return self.predict_nodes(x, nodes).mean
        x = self._check(x, what="mean_of_nodes")
        return self.render(self.scores.mean(x).reshape(len(x), self.modes), nodes)

    def coordinate(self, node: int, axis: int) -> "FittedCoordinate":
        """One coordinate of one node, answered without the rest of the shape.

        ``node``: from 0.
        ``axis``: 0 east, 1 north, 2 up.
        """
        nodes = len(self.centre)
        if not (0 <= node < nodes and 0 <= axis < 3):
            raise InputError(
                f"coordinate: node {node}, axis {axis} does not exist; this shape has {nodes} "
                "nodes, from 0, and the axes 0, 1 and 2."
            )
        return FittedCoordinate(shape=self, node=node, axis=axis)

    def render(self, score: RowMode, nodes: Nodes = EVERY) -> RowNode3:
        """Shapes of scores [m], at home in the sector of the symmetry, if there is one."""
        direction = self.basis.direction.reshape(self.modes, -1, 3)[:, nodes]
        centre = self.basis.centre.reshape(-1, 3)[nodes]
        return self.centre[nodes] + (centre + np.tensordot(score, direction, axes=1))

    def variance(self, score_std: RowMode, nodes: Nodes) -> Row4Node:
        """Of x, y and z of each node, and the covariance of x with y, at home [m2]."""
        power, prior = score_std**2, self.scores.amplitude**2
        share = power.sum(axis=1) / max(float(prior.sum()), np.finfo(float).tiny)
        # With one kernel and white noise all scores know the same share of what they varied by.
        alike = share[:, None] * prior
        if (np.abs(power - alike) <= 1e-9 * alike).all():
            moments = share[:, None, None] * self.prior_moments[:, nodes]
        else:
            moments = np.tensordot(power, self.products[..., nodes], axes=1)
        scale = self.scale[nodes].T
        moments[:, :3] += self.left_out[nodes].T ** 2
        return moments * np.vstack([scale**2, scale[0] * scale[1]])

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs, as plain values and float64 arrays."""
        scores, arrays = _gp.processes_to_arrays([self.scores])
        settings: Settings = {
            "model": self.MODEL,
            "frame": "earth",
            "features": self.features,
            "symmetric": self.symmetry is not None,
            "scores": scores,
        }
        own = {"mean_shape": self.centre, "left_out": self.left_out, "scale": self.scale}
        symmetry = {} if self.symmetry is None else self.symmetry.to_arrays()
        return settings, self.basis.to_arrays() | own | symmetry | arrays

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The model that ``to_arrays`` described; ``ModelError`` where it is damaged."""
        processes = _gp.processes_from_arrays(settings, "scores", arrays)
        if len(processes) != 1:
            raise ModelError(f"The saved ShapeGP holds {len(processes)} processes; expected 1.")
        scores = processes[0]
        if (frame := setting(settings, "frame", str)) != "earth":
            raise ModelError(
                f"The saved ShapeGP has frame {frame!r}, which this version does not know. "
                "Train the model again."
            )
        centre = array(arrays, "mean_shape", None, 3)
        nodes = len(centre)
        basis = Modes.from_arrays(arrays, modes=len(scores.centre))
        if len(basis.centre) != 3 * nodes:
            raise ModelError(
                f"The saved ShapeGP has modes of {len(basis.centre)} coordinates, but {nodes} "
                "nodes. Train the model again."
            )
        symmetric = setting(settings, "symmetric", bool)
        return cls(
            basis=basis,
            scores=scores,
            centre=centre,
            left_out=array(arrays, "left_out", nodes, 3),
            scale=array(arrays, "scale", nodes, 3),
            features=setting(settings, "features", int),
            symmetry=Symmetry.from_arrays(arrays, nodes=nodes) if symmetric else None,
        )

    def _by_image(
        self, symmetry: Symmetry, image: int, x: RowFeature, nodes: Nodes, *, noisy: bool
    ) -> Prediction:
        """Answer to an image of each sea state, moved back."""
        undo = symmetry.back(image)
        source, turn = symmetry.source[undo][nodes], symmetry.turn[undo]
        home = symmetry.turned(x, image)
        if nodes is EVERY:
            # Answering in order and then sorting the nodes spares a copy of all modes.
            mean, moments = self._in_sector(home, EVERY, noisy=noisy)
            mean, moments = mean[:, source], moments[..., source]
        else:
            mean, moments = self._in_sector(home, source, noisy=noisy)
        mean[..., :2] = symmetry.centre + (mean[..., :2] - symmetry.centre) @ turn.T
        return Prediction(mean=mean, std=np.sqrt(_turn_variance(moments, turn)))

    def _check(self, x: RowFeature, *, what: str) -> Float[np.ndarray, "_ _"]:
        x = check_inputs(x, what=what, width=self.features)
        if self.symmetry is not None:
            check_turnable(x, what=what)
        return x

    def _in_sector(self, x: RowFeature, nodes: Nodes, *, noisy: bool) -> tuple[RowNode3, Row4Node]:
        score = self.scores.predict(x, noisy=noisy)
        rows = (len(x), self.modes)
        mean = self.render(score.mean.reshape(rows), nodes)
        return mean, self.variance(score.std.reshape(rows), nodes)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedCoordinate:
    """One coordinate of one node; it shares the shape's factor and is not saved by itself."""

    shape: FittedShapeGP  # what it is a coordinate of
    node: int
    axis: int

    def predict(self, x: RowFeature, *, noisy: bool = False) -> Prediction:
        """The coordinate at each row of features, as the whole shape would answer [m]."""
        x = check_inputs(x, what="predict", width=self.shape.features)
        answer = self.shape.predict_nodes(x, np.array([self.node]), noisy=noisy)
        return Prediction(mean=answer.mean[:, 0, self.axis], std=answer.std[:, 0, self.axis])


def check_symmetry(
    symmetry: Symmetry,
    x: NFeature,
    node_position: NNode3,
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
    held_out, training = np.split(rows[: TRAINING + HELD_OUT], [min(HELD_OUT, len(x) // 5)])
    trial = ShapeGP(tolerance=COMPRESSION, restarts=0)
    model = trial.fit(x[training], node_position[training], seed=seed)
    missed = _errors_by_image(symmetry, model, x[held_out], node_position[held_out])
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
    symmetry: Symmetry, model: FittedShapeGP, x: NFeature, node_position: NNode3
) -> Float[np.ndarray, "image n"]:
    """Root mean square distance over the nodes of each case, by each image [m]."""
    missed = []
    for image in range(len(symmetry)):
        answer = model.mean_of_nodes(symmetry.turned(x, image), EVERY)
        distance = symmetry.moved(answer, symmetry.back(image)) - node_position
        missed.append(np.sqrt(np.sum(distance**2, axis=2).mean(axis=1)))
    return np.stack(missed)


def _fold_cases(symmetry: Symmetry, x: NFeature, node_position: NNode3) -> tuple[NFeature, NNode3]:
    """Each case as its image in the sector."""
    home_x, home_position = np.empty_like(x), np.empty_like(node_position)
    image_of = symmetry.home(x)
    for image in range(len(symmetry)):
        rows = image_of == image
        home_x[rows] = symmetry.turned(x[rows], image)
        home_position[rows] = symmetry.moved(node_position[rows], image)
    return home_x, home_position


def _turn_variance(moments: Row4Node, turn: Float[np.ndarray, "2 2"]) -> RowNode3:
    """Variances of x, y and z after a turn."""
    x, y, z, both = np.moveaxis(moments, 1, 0)
    horizontal = [a * a * x + 2.0 * a * b * both + b * b * y for a, b in turn]
    # Rounding can leave a hair less than nothing.
    return np.maximum(np.stack([*horizontal, z], axis=2), 0.0)


def _interval_scale(
    fitted: FittedShapeGP, x: NFeature, shape: NNode3
) -> Float[np.ndarray, "node 3"]:
    """The scale that makes intervals of each coordinate cover what they should.

    Each case is predicted from all others, as a new observation. The quantile is that of
    split-conformal prediction: one rank higher than the share asks for.
    """
    left_out = fitted.scores.leave_one_out()
    rows = (len(x), fitted.modes)
    missed = np.abs(shape - fitted.render(left_out.mean.reshape(rows)))
    moments = fitted.variance(left_out.std.reshape(rows), EVERY)
    std = np.sqrt(np.swapaxes(moments[:, :3], 1, 2))
    ratio = np.divide(missed, std, out=np.full_like(missed, DEVIATIONS), where=std > 0.0)
    rank = min(int(np.ceil(LEVEL * (len(x) + 1))), len(x)) - 1
    return np.partition(ratio, rank, axis=0)[rank] / DEVIATIONS
