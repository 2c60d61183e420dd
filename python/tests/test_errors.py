"""Errors are exceptions with their location."""

import pathlib
import pickle

import pytest

import overact


def test_all_description_errors_are_located(dualv):
    text = dualv.text.replace('l_ab = "0.28 m"', 'l_ab = "0.28 kg"').replace(
        'motion = "planar"', 'motion = "plannar"'
    )
    with pytest.raises(overact.DescriptionError) as caught:
        overact.Robot.from_string(text, "mine.toml")
    error = caught.value
    assert isinstance(error, ValueError) and isinstance(error, overact.OveractError)
    lines = text.splitlines()
    assert len(error.problems) >= 2
    assert error.file == "mine.toml" and error.line == error.problems[0].line
    # A wrong constant is reported where it is used, a wrong word where it is written.
    for problem in error.problems[:2]:
        assert any(word in lines[problem.line - 1] for word in ('d = "l_ab"', "plannar"))
        assert problem.column >= 1
    assert any(one.help and "planar" in one.help for one in error.problems)
    assert "mine.toml:" in str(error) and "^" in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert again.problems == error.problems and str(again) == str(error)


def test_invalid_toml_is_located():
    with pytest.raises(overact.DescriptionError) as caught:
        overact.Robot.from_string("name = ")
    assert (caught.value.file, caught.value.line) == ("robot.toml", 1)


def test_missing_files_raise_data_errors(tmp_path):
    with pytest.raises(overact.DataError, match="can't be read") as caught:
        overact.Robot(tmp_path / "none.toml")
    assert caught.value.file == str(tmp_path / "none.toml")
    assert "overact new" in caught.value.help


def test_binary_files_raise_data_errors(tmp_path):
    path = pathlib.Path(tmp_path, "broken.toml")
    path.write_bytes(b'name = "\xff\xfe"')
    with pytest.raises(overact.DataError, match="can't be read"):
        overact.Robot(path)


def test_invalid_experiments_are_rejected(emps):
    with pytest.raises(overact.OveractError, match="no run `nonsense`"):
        emps.simulate("nonsense")
    with pytest.raises(ValueError, match="no parameters m_9"):
        emps.simulate(parameters={"m_9": 1.0})
    text = emps.text[: emps.text.index("[experiment")]
    without = overact.Robot.from_string(text)
    with pytest.raises(overact.DataError, match="no virtual experiment"):
        without.simulate()
