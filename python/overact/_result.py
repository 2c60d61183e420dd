"""Results of an identification."""

from __future__ import annotations

import html
import json
import os
import tempfile
from dataclasses import dataclass
from typing import Any, Iterator, Mapping, Sequence

from ._errors import Named, unknown


@dataclass(frozen=True)
class ParameterEstimate:
    """The estimate of a parameter.

    Attributes:
        name: Name of the parameter.
        value: Estimate, in `unit`.
        unit: SI unit.
        standard_deviation: For white residuals.
        correlated_standard_deviation: For residuals that are correlated over time and between rows; use
            this one.
        interval_95: Lower and upper end of the 95 % interval.
        true_value: True value, if known.
    """

    name: str
    value: float
    unit: str
    standard_deviation: float
    correlated_standard_deviation: float
    interval_95: tuple[float, float]
    true_value: float | None = None

    @classmethod
    def _of(cls, one: Mapping[str, Any]) -> ParameterEstimate:
        return cls(
            name=one["name"],
            value=one["value"],
            unit=one["unit"],
            standard_deviation=one["standard_deviation"],
            correlated_standard_deviation=one["correlated_standard_deviation"],
            interval_95=tuple(one["interval_95"]),
            true_value=one.get("true_value"),
        )

    def __repr__(self) -> str:
        low, high = self.interval_95
        return f"<{self.name} = {self.value:.6g} {self.unit}, 95 %: {low:.6g} … {high:.6g}>"


class Estimate(Mapping):
    """Estimates of parameters, by name.

    Attributes:
        model: "platform" (platform projection, case 1), "actuators" (actuator projection, case 2) or
            "joints".
        stage: "base", "recommended" or "essential".
        estimator: "least-squares", "ordinary-least-squares" or "instrumental-variables".
        kept_actuators: Names of the actuators of the actuator projection; none for the platform.
        relative_error_percent: Relative residual of the torques.
        condition_number: Condition number of the observation matrix.
    """

    def __init__(self, document: Mapping[str, Any]) -> None:
        self.model: str = document["model"]
        self.stage: str = document["stage"]
        self.estimator: str = document["estimator"]
        self.kept_actuators: tuple[str, ...] = tuple(document["kept_actuators"])
        self.relative_error_percent: float = document["relative_error_percent"]
        self.condition_number: float = document["condition_number"]
        estimates = map(ParameterEstimate._of, document["parameters"])
        self._parameters = {one.name: one for one in estimates}

    def __getitem__(self, name: str) -> ParameterEstimate:
        try:
            return self._parameters[name]
        except KeyError:
            raise unknown("parameter", name, self._parameters) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._parameters)

    def __len__(self) -> int:
        return len(self._parameters)

    def to_columns(self) -> dict[str, list]:
        """A table of the estimates: ``pandas.DataFrame(estimate.to_columns())``."""
        all = list(self._parameters.values())
        return {
            "parameter": [one.name for one in all],
            "value": [one.value for one in all],
            "unit": [one.unit for one in all],
            "standard_deviation": [one.correlated_standard_deviation for one in all],
            "lower_95": [one.interval_95[0] for one in all],
            "upper_95": [one.interval_95[1] for one in all],
            "true_value": [one.true_value for one in all],
        }

    def __repr__(self) -> str:
        title = (
            f"{self.model}, {self.stage}, {self.estimator}: {len(self)} parameters, "
            f"relative residual {self.relative_error_percent:.4g} %"
        )
        widest = max((len(name) for name in self), default=0)
        rows = [
            f"  {one.name:<{widest}} {one.value:>12.6g} ± {_half(one):<8.2g} {one.unit}"
            for one in self._parameters.values()
        ]
        return "\n".join([title, *rows])


def _half(one: ParameterEstimate) -> float:
    """Half width of the 95 % interval."""
    return (one.interval_95[1] - one.interval_95[0]) / 2


@dataclass(frozen=True)
class Verdict:
    """Verdict on the estimates of a model.

    Attributes:
        subject: "platform projection", "actuator projection" or "joint model".
        grade: "use", "use-listed" or "do-not-use".
        trusted: Whether they may be used without restriction.
        listed: Parameters that may be used, if not all may.
        reasons: Reasons, in sentences.
    """

    subject: str
    grade: str
    trusted: bool
    listed: Sequence[str]
    reasons: Sequence[str]

    def __repr__(self) -> str:
        reasons = "".join(f"\n  {one}" for one in self.reasons)
        return f"{self.subject}: {self.grade}{reasons}"


class Identification:
    """Result of an identification; a notebook shows its report."""

    def __init__(self, handle: Any, inputs: Sequence[str]) -> None:
        self._handle = handle
        self._inputs = tuple(inputs)
        self._document = json.loads(handle.json())
        self._estimates = tuple(map(Estimate, self._document["estimates"]))

    @property
    def robot(self) -> str:
        """Name of the robot."""
        return self._document["robot"]

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """Verdict on each model."""
        fields = Verdict.__dataclass_fields__
        all = self._document["verdicts"]
        return tuple(Verdict(**{name: one[name] for name in fields}) for one in all)

    @property
    def verdict(self) -> Verdict:
        """Verdict on the first model, which contains all actuators."""
        return self.verdicts[0]

    @property
    def trusted(self) -> bool:
        """Whether the verdict on the first model is to use it."""
        return self._handle.trusted()

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings on the result."""
        return tuple(self._document["warnings"])

    @property
    def estimates(self) -> tuple[Estimate, ...]:
        """All estimates: for each model base, recommended and essential parameters, then those by other
        estimators."""
        return self._estimates

    def estimate(
        self, stage: str = "recommended", model: str | None = None, estimator: str = "least-squares"
    ) -> Estimate:
        """The estimate of a stage ("base", "recommended", "essential") and a model ("platform",
        "actuators" or "joints"; the first one if not given).

        Raises:
            UnknownNameError: There is none.
        """
        for one in self._estimates:
            if (one.stage, one.estimator) == (stage, estimator) and model in (None, one.model):
                return one
        all = [f"{one.stage}, {one.model}, {one.estimator}" for one in self._estimates]
        raise unknown("estimate", f"{stage}, {model or 'any model'}, {estimator}", all)

    @property
    def base(self) -> Estimate:
        """The base parameters of the first model."""
        return self.estimate("base")

    @property
    def recommended(self) -> Estimate:
        """The recommended parameters of the first model, the fewest that the data do not refute."""
        return self.estimate("recommended")

    @property
    def essential(self) -> Estimate:
        """The essential parameters of the first model, by the rule of Briot, Krut, Gautier 2015."""
        return self.estimate("essential")

    @property
    def consistent(self) -> dict[str, float]:
        """Physically consistent standard parameters by name (SI units), empty if there are none.

        They are inputs of `Robot.parameter_vector`, `Robot.simulate` and controllers.
        """
        all = self._document["consistent"]
        return Named({one["name"]: one["value"] for one in all[0]["parameters"]} if all else {})

    def to_dict(self) -> dict[str, Any]:
        """The document of ``overact identify --json``."""
        return json.loads(self._handle.json())

    def to_json(self) -> str:
        """`to_dict` as a JSON string."""
        return self._handle.json()

    def summary(self) -> str:
        """Output of ``overact identify --all``."""
        return self._handle.summary()

    def tables(self) -> str:
        """All tables, as in ``overact identify --tables``."""
        return self._handle.tables()

    def report(self) -> str:
        """The report: one self-contained HTML page."""
        return self._handle.html()

    def calibrated_description(self) -> str | None:
        """The description with calibrated offsets and lengths; None without calibration."""
        return self._handle.calibrated_description()

    def save_report(self, path: str | os.PathLike[str]) -> None:
        """Writes the report: a page (``.html``), all numbers and figures (``.json``), or a flat table
        (``.csv``)."""
        kinds = {
            ".html": self._handle.html,
            ".htm": self._handle.html,
            ".json": self._handle.json_with_figures,
            ".csv": self._handle.csv,
        }
        end = os.path.splitext(os.fspath(path))[1].lower()
        if end not in kinds:
            raise ValueError(f"the name of a report must end with .html, .json or .csv, unlike {os.fspath(path)!r}")
        self._save(path, kinds[end]())

    def save_parameters(self, path: str | os.PathLike[str]) -> None:
        """Writes the physically consistent standard parameters as TOML, which ``overact simulate``,
        ``evaluate`` and ``generate`` read."""
        text = self._handle.parameters_toml()
        if text is None:
            raise ValueError("no physically consistent parameters: the search did not converge")
        self._save(path, text)

    def _save(self, path: str | os.PathLike[str], text: str) -> None:
        """Writes a file completely or not at all, and never over an input."""
        for read in self._inputs:
            if os.path.exists(read) and os.path.exists(path) and os.path.samefile(read, path):
                raise ValueError(f"{os.fspath(path)!r} has been read, and would be overwritten")
        folder = os.path.dirname(os.path.abspath(path))
        with tempfile.NamedTemporaryFile("w", dir=folder, delete=False, encoding="utf-8") as file:
            try:
                file.write(text)
                file.close()
                os.chmod(file.name, 0o644)
                os.replace(file.name, path)
            except BaseException:
                os.unlink(file.name)
                raise

    def __repr__(self) -> str:
        verdicts = "\n".join(map(repr, self.verdicts))
        try:
            estimate = f"\n{self.recommended!r}"
        except KeyError:
            estimate = f"\n{self._estimates[0]!r}" if self._estimates else ""
        return f"Identification of {self.robot}\n{verdicts}{estimate}"

    def __str__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        """The report in a separate frame, to isolate its style."""
        # In a frame without an address, links to anchors would lead to the notebook.
        page = html.escape(self.report().replace('href="#', 'href="about:srcdoc#'), quote=True)
        return (
            f'<iframe title="Identification of {html.escape(self.robot, quote=True)}" srcdoc="{page}" '
            'sandbox="allow-downloads" style="width: 100%; height: 40em; box-sizing: border-box; border: 1px solid gray; color-scheme: light"></iframe>'
        )
