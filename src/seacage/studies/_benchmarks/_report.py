"""The benchmarks study as one HTML page that needs nothing beside itself."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from seacage.figures import Contest, cost_figure, coverage_figure, error_figure
from seacage.studies._benchmarks._methods import OURS, Method
from seacage.studies._benchmarks._problems import CAGE_SIZE, Problem
from seacage.studies._benchmarks._scores import Summary
from seacage.studies._benchmarks._verdicts import COVERAGE, Summaries
from seacage.studies._claim import Claim
from seacage.studies._page import Html, claims, facts, page, picture, table, tag
from seacage.studies._text import join_names, number, percent


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BenchmarkReport:
    """What the page is written from.

    Parameters
    ----------
    verdicts
        What was promised.
    problems, methods
        What was run, by whom.
    report, tuning
        Summaries by problem and method, over the seeds that count and over those that the
        settings were chosen on; the second may be empty.
    seeds, tuning_seeds
        Which those are.
    missing
        Why there are no peers, where there are none.
    provenance
        With what it was done, as name and value.
    """

    verdicts: Sequence[Claim]
    problems: Sequence[Problem]
    methods: Sequence[Method]
    report: Summaries
    tuning: Summaries
    seeds: Sequence[int]
    tuning_seeds: Sequence[int]
    missing: str | None
    provenance: Mapping[str, str]

    def html(self) -> str:
        """The whole page."""
        return page(
            "The benchmarks study with seacage",
            self._header(),
            *self._errors(),
            *self._spreads(),
            *self._costs(),
            *self._each(),
            *self._tuning(),
            *self._end(),
        )

    def _header(self) -> Html:
        evaluated = [one for one in self.verdicts if one.holds is not None]
        held = sum(bool(one.holds) for one in evaluated)
        gone = [] if self.missing is None else [tag("p", self.missing, look="lead")]
        return tag(
            "header",
            tag("span", "Computed from formulas", look="badge"),
            tag("h1", "The same few points, other learners"),
            tag(
                "p",
                "Published multifidelity problems and one as large as a cage's, learned by "
                "seacage's NARGP, by simple baselines and by other people's packages. Each method "
                "gets the same training cases and answers the same test points; an own process "
                "fits and times it by the same lines. "
                f"{held} of {len(evaluated)} promises that could be evaluated hold.",
                look="lead",
            ),
            *gone,
            claims((one.verdict, one.claim, one.finding) for one in self.verdicts),
        )

    def _contests(self) -> list[Contest]:
        gone = np.full(len(self.seeds), np.nan)
        contests: list[Contest] = []
        for problem in self.problems:
            found = [self.report.get((problem.name, method.name)) for method in self.methods]
            contests.append(
                Contest(
                    title=problem.title,
                    error=np.array([gone if one is None else one.rmses for one in found]),
                    coverage=np.array([np.nan if one is None else one.coverage for one in found]),
                )
            )
        return contests

    @property
    def _titles(self) -> list[str]:
        return [method.title for method in self.methods]

    @property
    def _ours(self) -> list[int]:
        return [place for place, method in enumerate(self.methods) if method.ours]

    def _errors(self) -> list[Html]:
        head = ("Mean RMSE", *(problem.title for problem in self.problems))
        return [
            tag("h2", "Errors"),
            tag(
                "p",
                "Root mean square error at the test points against the truth without noise, over "
                f"seeds {join_names([str(seed) for seed in self.seeds])}, none of which was looked "
                "at while settings were chosen. A seed draws the training cases of every fidelity, "
                "and the test points.",
            ),
            picture(
                error_figure(self._titles, self._contests(), ours=self._ours),
                caption="Dots: seeds. Diamonds: their mean. Orange: seacage's NARGP; blue: its "
                "baselines; grey: other packages.",
                alternative="Error by problem, method and seed",
                look="wide",
            ),
            table(
                head,
                [
                    (method.title, *(self._cell(problem, method) for problem in self.problems))
                    for method in self.methods
                ],
                caption="Mean RMSE over the seeds, the median small behind it; the least mean of "
                "each problem in green.",
            ),
        ]

    def _cell(self, problem: Problem, method: Method) -> str:
        found = self.report.get((problem.name, method.name))
        if found is None or np.isnan(found.rmse):
            return "–" if found is None else "failed"
        least = min(
            one.rmse
            for (name, _), one in self.report.items()
            if name == problem.name and np.isfinite(one.rmse)
        )
        median = tag("small", f" {number(found.rmse_median)}")
        look = "better" if found.rmse == least else ""
        return tag("span", number(found.rmse), median, look=look)

    def _spreads(self) -> list[Html]:
        low, high = COVERAGE
        return [
            tag("h2", "Spreads"),
            tag(
                "p",
                "A good 95 % interval holds the truth in 95 % of cases. Each package answers as "
                "its own prediction does: Emukit's and scikit-learn's spread includes the noise "
                "that it has learned, that of all others is of what lies behind the noise.",
            ),
            picture(
                coverage_figure(self._titles, self._contests(), ours=self._ours, wanted=COVERAGE),
                caption=f"Mean over seeds. Grey band: {percent(low)} to {percent(high)}; line: "
                "95 %.",
                alternative="Coverage by problem and method",
                look="wide",
            ),
        ]

    def _costs(self) -> list[Html]:
        problem = CAGE_SIZE if CAGE_SIZE in self.problems else self.problems[-1]
        found = [self.report.get((problem.name, method.name)) for method in self.methods]
        costs = {
            title: np.array([np.nan if one is None else getattr(one, name) for one in found])
            for title, name in (
                ("Fit", "fit_s"),
                (f"Answer {problem.tests:,} points", "predict_s"),
                ("Answer one point", "tick_s"),
            )
        }
        return [
            tag("h2", "Cost"),
            tag(
                "p",
                f"On the problem “{problem.title.lower()}”, {problem.recipe} cases: what one core "
                "spends, so that other work on the machine counts little; medians over seeds. All "
                "on one machine, and in one run where the study was told to time it afresh. What "
                "a library compiles or loads at its first call is not counted.",
            ),
            picture(
                cost_figure(self._titles, costs, ours=self._ours),
                caption="The axes are logarithmic; behind each bar, how many times ours it is.",
                alternative="Cost by method",
                look="wide",
            ),
        ]

    def _each(self) -> list[Html]:
        parts = [tag("h2", "Problem by problem")]
        for problem in self.problems:
            rows = [
                _row(method.title, one, self.report[problem.name, OURS])
                for method in self.methods
                if (one := self.report.get((problem.name, method.name))) is not None
            ]
            noise = f", noise of {problem.noise:g} on the highest" if problem.noise else ""
            parts += [
                tag("h3", problem.title),
                table(
                    _HEAD,
                    rows,
                    caption=f"{problem.source}. Cases, low to high fidelity: {problem.recipe}"
                    f"{noise}; {problem.tests:,} test points; inputs: {len(problem.lower)}. "
                    "RMSE, likelihood, CRPS and coverage are means over seeds, times medians and "
                    "shown as multiples of ours.",
                ),
            ]
        return parts

    def _tuning(self) -> list[Html]:
        if not self.tuning:
            return []
        head = ("Mean RMSE", *(problem.title for problem in self.problems))
        rows = [
            (
                method.title,
                *(
                    "–"
                    if (one := self.tuning.get((problem.name, method.name))) is None
                    else number(one.rmse)
                    for problem in self.problems
                ),
            )
            for method in self.methods
        ]
        return [
            tag("h2", "The seeds that settings were chosen on"),
            table(
                head,
                rows,
                caption=f"Seeds {join_names([str(seed) for seed in self.tuning_seeds])}. They "
                "decide no verdict.",
            ),
        ]

    def _end(self) -> list[Html]:
        settings = {f"{one.title} ({one.maker})": one.settings for one in self.methods}
        failed = {
            f"{one.method} on {one.problem}": f"{one.failures} failed: {one.error}"
            for one in self.report.values()
            if one.failures
        }
        lost = [tag("h2", "What failed"), facts(failed)] if failed else []
        return [
            *lost,
            tag("h2", "How each method was set"),
            facts(settings),
            tag("h2", "To repeat it"),
            facts(self.provenance),
            tag(
                "footer",
                "Every verdict on this page is computed from the numbers beside it. All problems "
                "are formulas: who is best on them need not be best at sea.",
            ),
        ]


_HEAD = (
    "Method",
    "RMSE",
    "Median",
    "MNLL",
    "CRPS",
    "Coverage",
    "Fit",
    "All points",
    "One point",
)


def _row(title: str, one: Summary, ours: Summary) -> tuple[str, ...]:
    if one.failures:
        return (title, "failed", *["–"] * (len(_HEAD) - 2))
    times = (
        f"{number(getattr(one, name) / getattr(ours, name))} ×"
        for name in ("fit_s", "predict_s", "tick_s")
    )
    return (
        tag("span", title, look="multi") if one.method == OURS else title,
        number(one.rmse),
        number(one.rmse_median),
        number(one.mnll),
        number(one.crps),
        percent(one.coverage),
        *times,
    )
