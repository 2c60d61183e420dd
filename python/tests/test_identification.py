"""Virtual experiments and identifications compared with the command line."""

import csv
import json
import xml.dom.minidom

import numpy as np
import pytest

import overact
from conftest import ROBOTS

NAME = "two_motor_axis"


@pytest.fixture(scope="module")
def robot():
    return overact.Robot(ROBOTS / f"{NAME}.toml")


@pytest.fixture(scope="module")
def runs(robot):
    return robot.simulate()


@pytest.fixture(scope="module")
def split(robot, runs):
    """Training and validation runs."""
    held = set(robot.held_out)
    return [one for one in runs if one.name not in held], [one for one in runs if one.name in held]


@pytest.fixture(scope="module")
def result(robot):
    return overact.identify(robot)


def numbers(document):
    """A document without the origin of its runs."""
    kept = ("estimates", "consistent", "base_parameters", "verdicts")
    return {name: document[name] for name in kept}


def without_truth(document):
    if isinstance(document, dict):
        return {k: without_truth(v) for k, v in document.items() if k not in ("true_value", "error_percent")}
    return [without_truth(one) for one in document] if isinstance(document, list) else document


def test_simulated_runs_equal_those_of_the_command_line(robot, runs, command, tmp_path):
    command("simulate", robot.file, "-o", "log.csv")
    assert [one.name for one in runs] == list(robot.runs)
    for run in runs:
        path = tmp_path / (f"log_{run.name}.csv" if len(runs) > 1 else "log.csv")
        with open(path, encoding="utf-8") as file:
            rows = list(csv.reader(file))
        columns = run.to_dict()
        assert rows[0] == list(columns)
        np.testing.assert_array_equal(
            np.array(rows[1:], dtype=float), np.column_stack(list(columns.values()))
        )
    assert repr(runs[0]).startswith(f"<run {runs[0].name}: {len(runs[0])} samples at ")


def test_simulation_options_are_applied(robot, runs):
    name = robot.runs[0]
    calls = []
    (one,) = robot.simulate(name, seed=7, progress=lambda part, what: calls.append((part, what)))
    assert one.name == name and not np.array_equal(one.torques, runs[0].torques)
    assert calls and calls[-1][1] == name and all(0 <= part <= 1 for part, _ in calls)
    parameter = next(iter(robot.true_values))
    (other,) = robot.simulate([name], parameters={parameter: 2 * robot.true_values[parameter]})
    assert not np.array_equal(other.torques, runs[0].torques)
    with pytest.raises(ZeroDivisionError):
        robot.simulate(name, progress=lambda part, what: 1 / 0)


def test_the_json_result_equals_that_of_the_command_line(robot, result, command):
    assert result.to_dict() == command.json("identify", robot.file)
    assert json.loads(result.to_json()) == result.to_dict()


def test_the_text_result_equals_that_of_the_command_line(robot, result, command):
    assert str(result).strip() == command("identify", robot.file).strip()


def test_all_data_types_give_the_same_estimates(robot, split, command, tmp_path):
    own, held = split
    expected = without_truth(numbers(overact.identify(robot, own, validation=held).to_dict()))
    paths = []
    for run in own:
        path = tmp_path / f"{run.name}.csv"
        columns = run.to_dict()
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(columns)
            writer.writerows([repr(float(one)) for one in row] for row in zip(*columns.values()))
        paths.append(path)
    kinds = {
        "paths": paths,
        "arrays": [run.to_dict() for run in own],
        "matrices": [
            {"positions": run.positions, "torques": run.torques, "sampling": run.sampling} for run in own
        ],
        "with times": [{"positions": run.positions, "torques": run.torques, "time": run.time} for run in own],
    }
    for module in ("pandas", "polars", "pyarrow"):
        try:
            frames = __import__(module)
        except ImportError:
            continue
        make = frames.table if module == "pyarrow" else frames.DataFrame
        with_text = [{**run.to_dict(), "note": ["text"] * len(run)} for run in own]
        kinds[module] = [make(columns) for columns in with_text]
    for kind, data in kinds.items():
        # The frequency computed from times differs in its last digits.
        found = overact.identify(robot, data, validation=held)
        assert_same_document(without_truth(numbers(found.to_dict())), expected, kind)
    files = ["--data", *map(str, paths)]
    document = command.json("identify", robot.file, *files)
    own_document = overact.identify(robot, paths).to_dict()
    assert own_document == document


def assert_same_document(found, expected, what):
    if isinstance(expected, dict):
        assert found.keys() == expected.keys(), what
        for key in expected:
            assert_same_document(found[key], expected[key], f"{what}.{key}")
    elif isinstance(expected, list):
        assert len(found) == len(expected), what
        for at, (one, other) in enumerate(zip(found, expected)):
            assert_same_document(one, other, f"{what}[{at}]")
    elif isinstance(expected, float):
        assert found == pytest.approx(expected, rel=1e-5, abs=1e-9), what
    elif not isinstance(expected, str):
        assert found == expected, what


def test_result_objects_have_named_estimates(robot, result):
    assert result.robot == robot.name and len(result.verdicts) == 2
    assert result.verdict.subject == "platform projection" and result.verdict.reasons
    assert result.trusted == (result.verdict.grade == "use")
    base = result.base
    assert list(base) == [one.name for one in robot.base_parameters][: len(base)] or len(base) > 0
    for name, one in base.items():
        assert one.name == name and one.interval_95[0] < one.value < one.interval_95[1]
        assert one.correlated_standard_deviation >= one.standard_deviation > 0
        assert one.true_value is not None
    document = result.to_dict()["estimates"][0]
    assert [one.value for one in base.values()] == [one["value"] for one in document["parameters"]]
    assert result.estimate("base", "actuators").kept_actuators
    with pytest.raises(overact.UnknownNameError, match="no estimate `base, joints") as caught:
        result.estimate("base", "joints")
    assert isinstance(caught.value, KeyError) and "did you mean `base, " in str(caught.value)
    with pytest.raises(overact.UnknownNameError, match="no parameter `zz_platfrom"):
        base["zz_platfrom"]
    with pytest.raises(overact.UnknownNameError, match="no parameter `m_platfrom"):
        result.consistent["m_platfrom"]
    assert base.get("zz_platfrom") is None and "zz_platfrom" not in base
    columns = result.recommended.to_columns()
    assert len(set(map(len, columns.values()))) == 1 and columns["parameter"] == list(result.recommended)
    assert (
        set(result.consistent) == {one.name for one in (*robot.parameters, *robot.payload_parameters)}
        or result.consistent
    )
    text = repr(result)
    assert text.startswith(f"Identification of {robot.name}\nplatform projection: ")
    assert all(name in text for name in result.recommended)


def test_the_report_is_well_formed_html(robot, result, tmp_path):
    page = result.report()
    title = xml.dom.minidom.parseString(page.replace("<!DOCTYPE html>\n", "")).getElementsByTagName("title")
    assert title[0].firstChild.data == f"Identification of {robot.name}"
    shown = result._repr_html_()
    frame = xml.dom.minidom.parseString(shown).documentElement
    assert frame.getAttribute("srcdoc").replace("about:srcdoc#", "#").split() == page.split()
    assert 'href="#' not in frame.getAttribute("srcdoc")
    result.save_report(tmp_path / "report.html")
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == page
    result.save_report(tmp_path / "numbers.csv")
    result.save_report(tmp_path / "numbers.json")
    assert "figures" in json.loads((tmp_path / "numbers.json").read_text(encoding="utf-8"))
    with pytest.raises(ValueError, match="must end with"):
        result.save_report(tmp_path / "report.pdf")


def test_identified_parameters_are_usable_by_the_robot(robot, result, command, tmp_path):
    result.save_parameters(tmp_path / "parameters.toml")
    command("simulate", robot.file, "--parameters", "parameters.toml", "-o", "logs/")
    values = robot.parameter_vector(result.consistent)
    assert values.shape == (len(robot.parameters) + len(robot.payload_parameters),)
    (run,) = robot.simulate(robot.runs[0], parameters=result.consistent)
    assert len(run) > 0


def test_inputs_are_never_overwritten(split, tmp_path):
    path = tmp_path / "robot.toml"
    text = (ROBOTS / f"{NAME}.toml").read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    log = tmp_path / "log.csv"
    run = split[0][0]
    np.savetxt(
        log,
        np.column_stack(list(run.to_dict().values())),
        delimiter=",",
        header=",".join(run.to_dict()),
        comments="",
        fmt="%.17g",
    )
    result = overact.identify(overact.Robot(path), log)
    before = log.read_bytes()
    for name in ("robot.toml", "log.csv"):
        with pytest.raises(ValueError, match="would be overwritten|must end with"):
            result.save_report(tmp_path / name)
    with pytest.raises(ValueError, match="would be overwritten"):
        result.save_parameters(path)
    assert path.read_text(encoding="utf-8") == text and log.read_bytes() == before
    assert sorted(one.name for one in tmp_path.iterdir()) == ["log.csv", "robot.toml"]


@pytest.mark.parametrize(
    "change, error, message",
    [
        (lambda one: one.pop("time"), overact.DataError, "time"),
        (lambda one: one.update(time=one["time"] ** 2), overact.DataError, "uniform"),
        (
            lambda one: one.update({list(one)[1]: np.full(len(one["time"]), np.nan)}),
            overact.DataError,
            "not a finite number",
        ),
        (lambda one: one.update({list(one)[1]: one["time"][:-5]}), overact.DataError, "samples"),
        (
            lambda one: one.update({list(one)[1]: np.array(["x"] * len(one["time"]))}),
            TypeError,
            "not real numbers",
        ),
        (lambda one: one.update({list(one)[1]: np.zeros((2, 2, 2))}), overact.DataError, "3 axes"),
    ],
)
def test_invalid_data_are_rejected(robot, split, change, error, message):
    columns = dict(split[0][0].to_dict())
    change(columns)
    with pytest.raises(error, match=message):
        overact.identify(robot, columns)


def test_invalid_arguments_are_rejected(robot, split, tmp_path):
    run = split[0][0]
    with pytest.raises(TypeError, match="is a int, which is not a run"):
        overact.identify(robot, 7)
    with pytest.raises(overact.DataError, match="can't be read"):
        overact.identify(robot, tmp_path / "none.csv")
    with pytest.raises(overact.DataError, match="neither `sampling`"):
        overact.identify(robot, {"positions": run.positions, "torques": run.torques})
    with pytest.raises(overact.DataError, match="has the shape"):
        overact.identify(robot, {"positions": run.positions, "torques": run.torques[:, :1], "sampling": 1e3})
    with pytest.raises(ValueError, match="no training runs"):
        overact.identify(robot, validation=run)
    with pytest.raises(ValueError, match="seed and held_out"):
        overact.identify(robot, run, seed=3)
    with pytest.raises(overact.DataError, match="no actuator `nonsense`"):
        overact.identify(robot, run, kept=["nonsense"])
    with pytest.raises(ValueError, match='friction="none"'):
        overact.identify(robot, run, friction="none")
    with pytest.raises(ValueError, match='calibrate="some"'):
        overact.identify(robot, run, calibrate="some")


def test_non_numeric_columns_are_rejected_by_name(robot, split):
    polars = pytest.importorskip("polars")
    columns = split[0][0].to_dict()
    first = list(columns)[1]
    table = polars.DataFrame(columns)
    as_text = table.with_columns(polars.col(first).cast(polars.String))
    with pytest.raises(overact.DataError, match=f"column `{first}` .* not numbers"):
        overact.identify(robot, as_text)
    with_hole = table.with_columns(
        polars.when(polars.col("time") > 1.0).then(polars.col(first)).otherwise(None).alias(first)
    )
    with pytest.raises(overact.DataError, match=f"column `{first}` .* no value at sample 0"):
        overact.identify(robot, with_hole)


def test_times_may_be_durations(robot, split):
    polars = pytest.importorskip("polars")
    run = split[0][0]
    columns = run.to_dict()
    steps = np.rint(columns["time"] * 1e9).astype("timedelta64[ns]")
    table = polars.DataFrame({**columns, "time": steps})
    found = overact.identify(robot, table).to_dict()
    expected = overact.identify(robot, run).to_dict()
    assert_same_document(numbers(found)["estimates"], numbers(expected)["estimates"], "durations")
