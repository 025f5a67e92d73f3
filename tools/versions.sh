#!/usr/bin/env bash
# Run all tests with the lowest or the newest versions of what pyproject.toml names, in an environment of their own:
# tools/versions.sh lowest, tools/versions.sh newest. What was taken is written to .venv-lowest/versions.txt.
set -euo pipefail
cd "$(dirname "$0")/.."
which=${1:?lowest or newest}
case $which in
    # Old versions warn of what their newer neighbours will drop; what this package must change, the newest tell.
    lowest) resolution=lowest-direct warnings=(-W ignore::DeprecationWarning -W ignore::PendingDeprecationWarning) ;;
    newest) resolution=highest warnings=() ;;
    *) echo "tools/versions.sh: lowest or newest, not $which" >&2; exit 2 ;;
esac
venv=.venv-$which
"${PYTHON:-python3}" -m venv --clear "$venv"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check 'uv>=0.4'
uv() { "$venv/bin/uv" "$@" --quiet --python "$venv/bin/python"; }
uv pip compile --resolution "$resolution" --prerelease disallow --extra dev pyproject.toml --output-file "$venv/versions.txt"
uv pip install --requirements "$venv/versions.txt"
uv pip install --no-deps --editable .
OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 "$venv/bin/python" -m pytest -q -n "${JOBS:-2}" --dist loadgroup "${warnings[@]}"
