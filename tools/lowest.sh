#!/usr/bin/env bash
# Run all tests with the lowest versions of what pyproject.toml names, in .venv-lowest.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=${JOBS:-2}
"${PYTHON:-python3}" -m venv --clear .venv-lowest
.venv-lowest/bin/python -m pip install --quiet --disable-pip-version-check 'uv>=0.4'
.venv-lowest/bin/uv pip install --quiet --python .venv-lowest/bin/python --resolution lowest-direct --editable '.[dev]'
OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 .venv-lowest/bin/python -m pytest -q -n "$jobs" --dist loadgroup
