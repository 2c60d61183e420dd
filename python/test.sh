#!/usr/bin/env bash
# Builds the wheel, installs it into a separate virtual environment and runs its tests there. Without
# Python, maturin or NumPy the tests are skipped.
#
# OVERACT_WHEEL_PROFILE=release builds the wheel for users; OVERACT_TESTS=full tests all robots and more states;
# OVERACT_COMPILED_VALUES is the program of the compiled robots
# (`cargo build -p overact-compiled --example values`), with which values are also compared.
set -euo pipefail
cd "$(dirname "$0")"
skip() { echo "the Python package is not tested: $*"; exit 0; }

python=${OVERACT_PYTHON:-python3}
command -v "$python" >/dev/null || skip "there is no $python"
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' || skip "it needs Python 3.10 or newer"
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/../target}
venv=$CARGO_TARGET_DIR/python
if ! [ -x "$venv/bin/python" ]; then
  "$python" -m venv "$venv" >/dev/null 2>&1 || { rm -rf "$venv"; skip "no virtual environment can be made"; }
fi
pip() { "$venv/bin/python" -m pip --disable-pip-version-check --quiet "$@"; }
pip install "maturin>=1.8,<2" "numpy>=1.23" "pytest>=7" || skip "maturin, NumPy or pytest can't be had"
# Tests that need a missing one are skipped with a message.
pip install sympy pandas polars pyarrow || echo "without all of SymPy, pandas, Polars and PyArrow"
wheels=$CARGO_TARGET_DIR/wheels
rm -rf "$wheels"
PATH=$venv/bin:$PATH maturin build --quiet --locked --profile "${OVERACT_WHEEL_PROFILE:-dev}" \
  --interpreter "$venv/bin/python" --out "$wheels"
pip install --force-reinstall --no-deps "$wheels"/overact-*.whl
# From another folder, so that the wheel is imported.
root=$PWD
cd "$CARGO_TARGET_DIR"
exec "$venv/bin/python" -m pytest -q -p no:cacheprovider "$root/tests" "$@"
