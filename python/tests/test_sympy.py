"""Functions as SymPy expressions."""

import builtins

import numpy as np
import pytest

from conftest import ROBOTS

import overact


@pytest.mark.parametrize("name", ["idm_red_platform", "inverse_jacobian", "mass_matrix_base"])
def test_expressions_evaluate_to_the_values_of_the_function(dualv, name):
    pytest.importorskip("sympy")
    symbolic = dualv.to_sympy(name)
    function = dualv.function(name)
    assert symbolic.matrix.shape == function.shape
    random = np.random.default_rng(3)
    inputs = {one: random.uniform(-0.05, 0.05, length) for one, length in function.inputs.items()}
    called = symbolic.lambdify()
    found = called(*[inputs[one] for one in symbolic.inputs])
    expected = function(**inputs)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_expressions_can_be_inlined_and_simplified():
    sympy = pytest.importorskip("sympy")
    robot = overact.Robot(ROBOTS / "emps.toml")
    symbolic = robot.to_sympy("idm_red_platform")
    assert repr(symbolic).startswith("<idm_red_platform: 1 x ")
    inlined = symbolic.inlined()
    known = {one for inputs in symbolic.inputs.values() for one in inputs}
    assert inlined.free_symbols <= known
    # Mass of the carriage times its acceleration.
    acceleration = symbolic.inputs["joint_accelerations"][0]
    column = [one.name for one in robot.parameters].index("m_1")
    assert sympy.simplify(inlined[0, column] - acceleration) == 0


def test_missing_sympy_raises_an_installation_hint(dualv, monkeypatch):
    usual = builtins.__import__

    def without(name, *rest):
        if name == "sympy":
            raise ImportError("No module named 'sympy'")
        return usual(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match="pip install"):
        dualv.to_sympy("joints")


def test_unknown_functions_are_rejected_with_a_suggestion(dualv):
    pytest.importorskip("sympy")
    with pytest.raises(AttributeError, match="did you mean `joints`"):
        dualv.to_sympy("joint")
