"""Gaussian process regression with one kernel for all outputs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self, get_args

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import InputError
from seacage.surrogates._arrays import Arrays, Settings, array, setting, setting_list
from seacage.surrogates._gp._ensemble import FEW, Ensemble, draw_members, widening
from seacage.surrogates._gp._hyperparameters import Evidence, most_probable
from seacage.surrogates._gp._kernels import (
    AbstractKernel,
    KernelName,
    StationaryKernel,
    restore_kernel,
)
from seacage.surrogates._gp._noise import (
    CORRELATED,
    NoiseByInput,
    NoiseName,
    noise_named,
    restore_noise,
)
from seacage.surrogates._gp._posterior import Posterior, Process
from seacage.surrogates._prediction import Moments, Prediction, check_inputs, check_outputs
from seacage.surrogates._scaling import Scaling

RowFeature = Float[np.ndarray, "row feature"]
RowOutput = Float[np.ndarray, "row output"]
MANY_OUTPUTS = 16  # more outputs than this are condensed before the kernel is fitted to them
CONDENSED = 1e-6  # share of the outputs' variance that condensing may leave out
NEGLIGIBLE = 0.02  # weight of a process in an average
SHARED_POINTS = 5.0  # weight of the shared variance against each output's own roughness, in points

Times = Float[np.ndarray, " time"] | None
Answer = tuple[Float[np.ndarray, "_ _"], Float[np.ndarray, "_ _"]]
"""Mean of each output, and variance, before the output's centre and amplitude."""


@dataclass(frozen=True, slots=True)
class Clock:
    """Times of cases whose noise is correlated, in mean steps from one case to the next."""

    begin: float = 0.0  # of the first case [s]
    step: float = 0.0  # the whole time over the number of cases [s]; 0 where cases have no times

    @classmethod
    def of(cls, time: Times, noise: NoiseName) -> Self:
        """Raises InputError: times with a noise of another kind, all alike, or not finite."""
        if time is None:
            return cls()
        if noise != "white" or not np.ptp(time) > 0.0 or not np.isfinite(time).all():
            raise InputError(
                f"fit: times are given, with noise {noise!r}, from {np.min(time):g} to "
                f"{np.max(time):g} s. Noise that is correlated in time takes noise='white' and "
                "cases of several times, all finite."
            )
        return cls(float(np.min(time)), float(np.ptp(time)) / len(time))

    def standardise(self, time: Times, rows: int, *, what: str) -> Float[np.ndarray, " row"]:
        """Zeros where cases have no times. Raises InputError: some are missing, or not finite."""
        if not self.step:
            return np.zeros(rows)
        if time is None or np.shape(time) != (rows,) or not np.isfinite(time).all():
            raise InputError(
                f"{what}: the noise is correlated in time, so each of the {rows} cases needs its "
                "time [s], a finite number."
            )
        return (time - self.begin) / self.step


@dataclass(frozen=True, slots=True, kw_only=True)
class GaussianProcess:
    """Gaussian process regression, not yet fitted.

    All outputs share one kernel and one factorisation; each keeps its own mean and amplitude.

    Source: Rasmussen & Williams (2006), chapters 2 and 5.
    """

    # ``"squared-exponential"`` for very smooth answers, ``"matern-5/2"`` for those with kinks,
    # ``"matern-3/2"`` for rough ones
    kernel: KernelName = "squared-exponential"
    # ``"white"``: Gaussian, the same share of every output's variance. ``"per-output"``: its own
    # share for each. ``"by-input"``: changing smoothly with the inputs, the same share for all.
    # ``"student-t"``: with outliers, four degrees of freedom; what is wrong in one output of a case
    # counts less in all
    noise: NoiseName = "white"
    # ``"auto"``: where observations are few, the answer is that of 16 draws of the hyperparameters
    # from their posterior, as one choice would make intervals too narrow. ``"always"`` and
    # ``"never"`` decide it
    ensemble: Ensemble = "auto"
    # Starts of the hyperparameter search beside the one at the prior's mean, for more than 40
    # cases; fewer get four times as many
    restarts: int = 3

    def __post_init__(self) -> None:
        check_options(
            kernel=self.kernel, noise=self.noise, ensemble=self.ensemble, restarts=self.restarts
        )

    def fit(
        self,
        x: Float[np.ndarray, "n feature"],  # one row per case
        y: Float[np.ndarray, "n *output"],  # (n,) or (n, outputs)
        *,
        seed: int = 0,  # of the subset of points and of the random starts
        # Of the cases [s], where their noise is correlated in time: white, and a part whose
        # correlation falls exponentially
        time: Times = None,
    ) -> "FittedGaussianProcess":
        """Learn from inputs and outputs."""
        x = check_inputs(x, what="GaussianProcess.fit")
        shape = "(rows,)" if np.ndim(y) == 1 else "(rows, outputs)"
        y = check_outputs(y, what="GaussianProcess.fit", rows=len(x), shape=shape)
        fitted = fit_process(
            StationaryKernel(self.kernel),
            x,
            y.reshape(len(y), -1),
            noise=self.noise,
            ensemble=self.ensemble,
            restarts=self.restarts,
            seed=seed,
            time=time,
        )
        return replace(fitted, single=y.ndim == 1)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedGaussianProcess:
    """Gaussian process conditioned on its training cases."""

    MODEL: ClassVar[str] = "gaussian-process"

    # Of the outputs less their centre, at standardised inputs; more than one for an ensemble of
    # hyperparameters, the most probable ones first
    members: tuple[Posterior, ...]
    share: Float[np.ndarray, " member"]  # probability of each member
    inputs: Scaling  # centre and spread of each feature
    # Of each output: its mean, and the standard deviation that the kernel's is a share of
    centre: Float[np.ndarray, " output"]
    amplitude: Float[np.ndarray, " output"]
    single: bool  # whether the answer is (row,) rather than (row, output)
    # What each output is expected to rise by with each standardised feature; the members are of
    # what is left
    line: Float[np.ndarray, "feature output"]
    # Of each member: the standard deviation that its kernel's is a share of, over the amplitude
    factor: Float[np.ndarray, " member"]
    clock: Clock = Clock()  # of the cases' times, where their noise is correlated

    @property
    def posterior(self) -> Posterior:
        """The member with the most probable hyperparameters."""
        return self.members[0]

    @property
    def noise(self) -> Float[np.ndarray, " output"]:
        """Variance of each output's noise, in its unit squared.

        Where it changes with the inputs, its mean over the training cases.
        """
        return self._noise(self.posterior.x).mean(axis=0)

    def noise_at(self, x: RowFeature) -> Float[np.ndarray, "row *output"]:
        """Variance of the noise of a new observation at each row, in its unit squared."""
        return self._reshape(self._noise(self._standardise(x, what="noise_at")))

    def predict(self, x: RowFeature, *, noisy: bool = False) -> Prediction:
        """Answer at each row of features.

        ``x``: one row per case, the features of the training.
        ``noisy``: of a new observation rather than of what lies behind it: adds the noise.
        """
        x = self._standardise(x, what="predict")
        mean, variance = self._mix(x, [member.predict(x) for member in self.members])
        if noisy:
            variance = variance + self._noise(x)
        return self._answer(mean, variance)

    def mean(self, x: RowFeature) -> Float[np.ndarray, "row *output"]:
        """The mean of ``predict`` alone, at a fraction of its cost."""
        x = self._standardise(x, what="mean")
        means = [member.mean(x) for member in self.members]
        return self._reshape(self._average(means) + self._trend(x))

    def jacobian(self, x: RowFeature) -> Float[np.ndarray, "row *output feature"]:
        """Change of the mean per change of each feature, at each row."""
        x = self._standardise(x, what="jacobian")
        slope = self._average([member.mean_slope(x) for member in self.members]) + self.line.T
        return self._reshape(slope / self.inputs.unit)

    def moments(self, x: RowFeature) -> Moments:
        """Mean and variance of the one output with their gradients, for what builds on it."""
        if not self.single:
            raise InputError(
                f"moments: this model has {len(self.centre)} outputs. Ask one, e.g. "
                "`fitted.output(0)`."
            )
        x = self._standardise(x, what="moments")
        parts = [member.moments(x) for member in self.members]
        mean, variance = self._mix(x, [(one.mean[:, None], one.variance[:, None]) for one in parts])
        of_members = mean - self._trend(x)
        mean_slope = self._average([one.mean_slope for one in parts])
        # Of the law of total variance: of each member's, and of their means about the mean.
        variance_slopes = [
            (factor * self.amplitude[0]) ** 2 * one.variance_slope
            + 2.0 * (one.mean[:, None] - of_members) * (one.mean_slope - mean_slope)
            for one, factor in zip(parts, self.factor, strict=True)
        ]
        return Moments(
            mean=mean[:, 0],
            variance=variance[:, 0],
            mean_slope=(mean_slope + self.line[:, 0]) / self.inputs.unit,
            variance_slope=self._average(variance_slopes) / self.inputs.unit,
        )

    def updated(
        self,
        x: Float[np.ndarray, "new feature"],
        y: Float[np.ndarray, "new *output"],
        *,
        time: Times = None,
    ) -> Self:
        """Conditioned on more cases, with the hyperparameters learned before.

        It answers as if conditioned on all cases at once, at O(n^2) per new case; with noise
        per output, at O(n^3). Scales, amplitudes and shares stay those of the training.

        ``x``: one row per new case.
        ``y``: (new,) or (new, outputs), as in the training.
        ``time``: of the new cases [s], where the training had times.
        """
        x = self._standardise(x, what="updated")
        shape = "(rows,)" if self.single else "(rows, outputs)"
        y = check_outputs(y, what="updated", rows=len(x), shape=shape, least=1).reshape(len(x), -1)
        if y.shape[1] != len(self.centre):
            raise InputError(
                f"updated: {y.shape[1]} outputs, but {len(self.centre)} were learned. "
                "Give the outputs of the training, in the same order."
            )
        y, when = y - self._trend(x), self.clock.standardise(time, len(x), what="updated")
        members = [
            member.updated(x, y, amplitude=factor * self.amplitude, time=when)
            for member, factor in zip(self.members, self.factor, strict=True)
        ]
        return replace(self, members=tuple(members))

    def kept(self, cases: Bool[np.ndarray, " n"]) -> Self:
        """Conditioned on some of its cases alone, with the hyperparameters of all."""
        return self._conditioned(self.posterior.x, cases)

    def cases(self) -> Float[np.ndarray, "n feature"]:
        """Inputs that it is conditioned on, in their own units."""
        return self.posterior.x * self.inputs.unit + self.inputs.centre

    def moved(self, x: Float[np.ndarray, "n feature"]) -> Self:
        """Conditioned on the same outputs at other inputs, one row for each case."""
        return self._conditioned(self.inputs.standardise(x), np.ones(len(x), dtype=bool))

    def _conditioned(self, x: RowFeature, cases: Bool[np.ndarray, " row"]) -> Self:
        """Conditioned on some of its cases at these standardised inputs."""
        members = [
            member.condition(
                x[cases],
                (member.observations() + (member.x - x) @ self.line)[cases],
                noise_factor=member.noise_factor[cases],
                time=member.time[cases],
            )
            for member in self.members
        ]
        return replace(self, members=tuple(members))

    def leave_one_out(self) -> Prediction:
        """Answer at each training case from all the others, as a new observation.

        In closed form; the hyperparameters stay those learned from all cases.

        Source: Rasmussen & Williams (2006), eqs. (5.10)-(5.12).
        """
        return self._from_residuals([member.leave_one_out() for member in self.members])

    def leave_groups_out(self, group: Float[np.ndarray, " n"]) -> Prediction:
        """``leave_one_out`` with all training cases of a group left out together.

        ``group``: a number for each training case.
        """
        return self._from_residuals([member.leave_groups_out(group) for member in self.members])

    def _from_residuals(self, left_out: Sequence[tuple[np.ndarray, np.ndarray]]) -> Prediction:
        """From each member's residuals and their variances."""
        answers = [
            (member.observations() - residual, variance)
            for member, (residual, variance) in zip(self.members, left_out, strict=True)
        ]
        return self._answer(*self._mix(self.posterior.x, answers))

    def output(self, index: int) -> "FittedGaussianProcess":
        """One output as a model that answers (row,); it shares the factor."""
        outputs = len(self.centre)
        if not 0 <= index < outputs:
            raise InputError(f"output {index} does not exist; this model has {outputs}, from 0.")
        return replace(
            self,
            members=tuple(member.output(index) for member in self.members),
            centre=self.centre[[index]],
            amplitude=self.amplitude[[index]],
            single=True,
            line=self.line[:, [index]],
        )

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs, as plain values and float64 arrays."""
        first, kernels = self.posterior, [member.kernel.name for member in self.members]
        several = len(set(kernels)) > 1
        most = max(len(member.log_parameters) for member in self.members)
        settings: Settings = {
            "model": self.MODEL,
            # Versions that know of one kernel refuse the name of several.
            "kernel": ",".join(kernels) if several else kernels[0],
            "noise": first.noise.name,
            "single": self.single,
            "about_line": bool(self.line.any()),
        }
        arrays = {
            "share": self.share,
            # Kernels with fewer than the most are filled up.
            "log_parameters": np.stack(
                [np.resize(member.log_parameters, most) for member in self.members]
            ),
            "log_noise": np.stack([member.log_noise for member in self.members]),
            "weights": np.stack([member.weights for member in self.members]),
            "inputs": first.x,
            "doubt": first.noise_factor,
            "input_centre": self.inputs.centre,
            "input_spread": self.inputs.spread,
            "output_centre": self.centre,
            "output_amplitude": self.amplitude,
        }
        if self.line.any():
            arrays["line"] = self.line
        if several:
            arrays["factor"] = self.factor
        if first.noise.name == CORRELATED:
            arrays |= {"time": first.time, "clock": np.array([self.clock.begin, self.clock.step])}
        if isinstance(first.noise, NoiseByInput):
            arrays["anchor"] = first.noise.anchor
        return settings, arrays

    @classmethod
    def from_arrays(
        cls,
        settings: Mapping[str, object],
        arrays: Mapping[str, np.ndarray],
        *,
        later: bool = False,  # factorise when a variance is first asked for
    ) -> Self:
        """The model that ``to_arrays`` described; ``ModelError`` where it is damaged."""
        kernels = [restore_kernel(name) for name in setting(settings, "kernel", str).split(",")]
        single = setting(settings, "single", bool)
        x = array(arrays, "inputs", None, None)
        rows, width = x.shape
        share = array(arrays, "share", len(kernels) if len(kernels) > 1 else None)
        weights = array(arrays, "weights", len(share), rows, 1 if single else None)
        outputs = weights.shape[2]
        noise = restore_noise(
            setting(settings, "noise", str),
            lambda: array(arrays, "anchor", None, width),
            outputs=outputs,
        )
        # Members of one kernel have no factors, and models saved before there was an average.
        several = len(kernels) > 1
        factor = array(arrays, "factor", len(share)) if several else np.ones(len(share))
        kernels = kernels if several else kernels * len(share)
        sizes = [kernel.size(width) for kernel in kernels]
        parameters = array(arrays, "log_parameters", len(share), max(sizes, default=None))
        log_noise = array(arrays, "log_noise", len(share), len(noise.prior().mean))
        noise_factor = array(arrays, "doubt", rows)
        clock, time = Clock(), np.zeros(rows)
        if noise.name == CORRELATED:
            clock, time = Clock(*array(arrays, "clock", 2)), array(arrays, "time", rows)
        members = [
            Process(
                kernel=kernel, log_parameters=own[:size], noise=noise, log_noise=own_noise
            ).restore(x, weight, noise_factor=noise_factor, time=time, later=later)
            for kernel, size, own, own_noise, weight in zip(
                kernels, sizes, parameters, log_noise, weights, strict=True
            )
        ]
        inputs = Scaling(
            centre=array(arrays, "input_centre", width), spread=array(arrays, "input_spread", width)
        )
        return cls(
            members=tuple(members),
            share=share,
            inputs=inputs,
            centre=array(arrays, "output_centre", outputs),
            amplitude=array(arrays, "output_amplitude", outputs),
            single=single,
            # Models saved before there was a line are without one.
            line=array(arrays, "line", width, outputs)
            if settings.get("about_line", False)
            else np.zeros((width, outputs)),
            factor=factor,
            clock=clock,
        )

    def _standardise(self, x: RowFeature, *, what: str) -> RowFeature:
        return self.inputs.standardise(check_inputs(x, what=what, width=len(self.inputs.centre)))

    def _noise(self, x: RowFeature) -> RowOutput:
        shares = self._average(self._rescale([member.noise_at(x) for member in self.members]))
        return shares * self.amplitude**2

    def _average(self, parts: Sequence[Float[np.ndarray, "row *rest"]]) -> np.ndarray:
        """Of the members, by their share."""
        return parts[0] if len(parts) == 1 else np.tensordot(self.share, np.stack(parts), axes=1)

    def _rescale(self, variances: Sequence[RowOutput]) -> list[RowOutput]:
        """Of the members, as shares of the amplitude's square."""
        return [factor**2 * one for factor, one in zip(self.factor, variances, strict=True)]

    def _mix(self, x: RowFeature, answers: Sequence[Answer]) -> tuple[RowOutput, RowOutput]:
        """Mean and variance of the outputs, by the law of total variance over the members."""
        means = [mean for mean, _ in answers]
        mean = self._average(means)
        variances = self._rescale([variance for _, variance in answers])
        variance = self._average(variances) * self.amplitude**2
        if len(answers) > 1:
            variance = variance + self._average([(one - mean) ** 2 for one in means])
        return mean + self._trend(x), variance

    def _trend(self, x: RowFeature) -> RowOutput:
        """What the members are about, at standardised inputs."""
        return self.centre + x @ self.line

    def _answer(self, mean: RowOutput, variance: RowOutput) -> Prediction:
        return Prediction(mean=self._reshape(mean), std=self._reshape(np.sqrt(variance)))

    def _reshape(
        self, values: Float[np.ndarray, "row output *rest"]
    ) -> Float[np.ndarray, "row *answer"]:
        return values[:, 0] if self.single else values


def processes_to_arrays(
    processes: Sequence[FittedGaussianProcess],
) -> tuple[list[Settings], Arrays]:
    """Settings of the processes that a model holds, and all their arrays, named by their place."""
    saved = [process.to_arrays() for process in processes]
    return [settings for settings, _ in saved], {
        f"{place}.{name}": values
        for place, (_, arrays) in enumerate(saved)
        for name, values in arrays.items()
    }


def processes_from_arrays(
    settings: Mapping[str, object],
    name: str,
    arrays: Mapping[str, np.ndarray],
    *,
    later: bool = False,
) -> tuple[FittedGaussianProcess, ...]:
    """The processes whose settings are listed under a name."""
    return tuple(
        FittedGaussianProcess.from_arrays(
            part,
            {key[len(start) :]: one for key, one in arrays.items() if key.startswith(start)},
            later=later,
        )
        for place, part in enumerate(setting_list(settings, name, dict))
        for start in [f"{place}."]
    )


def fit_process(
    kernel: AbstractKernel,  # that all outputs share
    # Inputs and outputs in their own units
    x: Float[np.ndarray, "n feature"],
    y: Float[np.ndarray, "n output"],
    *,
    # Outputs of the likelihood that is maximised, of unit variance all in all; None for ``y`` in
    # its spreads, so that all outputs are of the same importance
    likelihood_outputs: Float[np.ndarray, "n some"] | None = None,
    # As for ``GaussianProcess``
    noise: NoiseName = "white",
    ensemble: Ensemble = "never",
    # What each output is expected to rise by per unit of each feature; None for nothing
    slope: Float[np.ndarray, " feature"] | None = None,
    # Of the search, as ``most_probable`` takes them
    restarts: int,
    seed: int,
    most: int | None = None,
    time: Times = None,  # as for ``GaussianProcess.fit``
) -> FittedGaussianProcess:
    """Fit the hyperparameters, then condition on the outputs."""
    inputs, outputs = Scaling.of(x), Scaling.of(y)
    standardised = inputs.standardise(x)
    slope = np.zeros(x.shape[1]) if slope is None else slope
    line = np.tile((slope * inputs.unit)[:, None], y.shape[1])
    rest = y - outputs.centre - standardised @ line
    likely = likelihood_outputs
    if likely is None:
        # In spreads of the outputs themselves, whatever the slope leaves of them, as the priors are
        left = y - x @ slope[:, None]
        likely = (left - left.mean(axis=0)) / outputs.unit
        # With noise of its own to learn none can stand for others
        if noise != "per-output" and y.shape[1] > MANY_OUTPUTS:
            likely = condense(likely)
    clock = Clock.of(time, noise)
    when = clock.standardise(time, len(x), what="fit")
    name = noise if time is None else CORRELATED
    scatter = noise_named(name, standardised, outputs=likely.shape[1])
    evidence = Evidence.of(kernel, scatter, standardised, likely, when)
    mode = most_probable(evidence, restarts=restarts, seed=seed, most=most)
    hyperparameters, wider = mode.log_parameters[None], 1.0
    few = evidence.independent(mode.log_parameters) <= FEW
    if ensemble == "always" or (ensemble == "auto" and few):
        hyperparameters, wider = draw_members(mode, seed=seed), widening(len(y))
    # noise factors are of all points, or there are none
    noise_factor = evidence.noise_factor if most else mode.evidence.noise_factor
    members = [
        evidence.process(log_parameters).condition(
            standardised, rest, noise_factor=noise_factor, time=when
        )
        for log_parameters in hyperparameters
    ]
    share = np.full(len(members), 1.0 / len(members))
    # Each output's own variance, held to the shared one by a few points' worth of belief:
    # the mean of the conjugate posterior, a scaled inverse chi-squared, so that the answer's
    # variance is that of the Student's t which it leaves.
    own = [np.einsum("no,no->o", rest, member.weights) for member in members]
    variance = (SHARED_POINTS * outputs.spread**2 + share @ np.stack(own)) / (
        SHARED_POINTS + len(y) - 2.0
    )
    return FittedGaussianProcess(
        members=tuple(members),
        share=share,
        inputs=inputs,
        centre=outputs.centre,
        amplitude=wider * np.sqrt(variance),
        single=y.shape[1] == 1,
        line=line,
        factor=np.ones(len(members)),
        clock=clock,
    )


def average(
    processes: Sequence[FittedGaussianProcess], weight: Float[np.ndarray, " process"]
) -> FittedGaussianProcess:
    """One process whose members are those of several, each process with its weight.

    ``processes``: of one output and the same cases, scales and line, with kernels of their own.
    ``weight``: their sum is 1; those below ``NEGLIGIBLE`` are left out.
    """
    order = [one for one in np.argsort(-weight) if weight[one] >= NEGLIGIBLE]
    first, total = processes[order[0]], weight[order].sum()
    amplitude = first.amplitude[0] or 1.0
    return replace(
        first,
        members=tuple(member for one in order for member in processes[one].members),
        share=np.concatenate([weight[one] / total * processes[one].share for one in order]),
        factor=np.concatenate(
            [processes[one].amplitude / amplitude * processes[one].factor for one in order]
        ),
    )


def condense(y: Float[np.ndarray, "n output"]) -> Float[np.ndarray, "n some"]:
    """Fewer outputs with the same likelihood of a kernel.

    The likelihood summed over outputs knows them only by their products between cases, Y Y',
    which the principal scores keep; an output counts as much as it varies.
    """
    left, size, _ = np.linalg.svd(y - y.mean(axis=0), full_matrices=False)
    left_out = 1.0 - np.cumsum(size**2) / max(float(np.sum(size**2)), np.finfo(float).tiny)
    kept = 1 + int(np.argmax(left_out < CONDENSED))
    scores = left[:, :kept] * size[:kept]
    return scores / (np.sqrt(np.mean(scores**2)) or 1.0)


def check_options(*, restarts: int, **options: str) -> None:
    """Refuse options of ``GaussianProcess`` that do not exist: kernel, noise or ensemble."""
    names = {"kernel": KernelName, "noise": NoiseName, "ensemble": Ensemble}
    for name, value in options.items():
        if value not in (known := get_args(names[name])):
            raise InputError(f"{name} = {value!r} is not known. Choose one of {', '.join(known)}.")
    if restarts < 0:
        raise InputError(f"restarts = {restarts} is negative. Give the number of extra starts.")
