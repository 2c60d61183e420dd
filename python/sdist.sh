#!/usr/bin/env bash
# Builds the source archive into a folder, installs it in a clean environment (new home, no caches of pip, another
# folder) and runs an example with it. Needs Python, a stable Rust toolchain and the package registries.
#
# sdist.sh FOLDER
set -euo pipefail
mkdir -p "$1"
folder=$(cd "$1" && pwd)
cd "$(dirname "$0")"
clean=$(mktemp -d)
trap 'rm -rf "$clean"' EXIT

python=${OVERACT_PYTHON:-python3}
"$python" -m venv "$clean/tools"
"$clean/tools/bin/python" -m pip --quiet install "maturin>=1.8,<2"
rm -f "$folder"/overact-*.tar.gz
"$clean/tools/bin/maturin" sdist --out "$folder"

# The toolchain stays; everything else of the home is new.
export RUSTUP_HOME=${RUSTUP_HOME:-$HOME/.rustup} CARGO_HOME=${CARGO_HOME:-$HOME/.cargo}
export HOME=$clean/home PIP_NO_CACHE_DIR=1 CARGO_TARGET_DIR=$clean/target
mkdir -p "$HOME" "$clean/elsewhere"
"$python" -m venv "$clean/venv"
time "$clean/venv/bin/python" -m pip install "$folder"/overact-*.tar.gz
cp examples/pendulum.py "$clean/elsewhere"
cd "$clean/elsewhere"
"$clean/venv/bin/overact" --version
"$clean/venv/bin/python" pendulum.py
