#!/usr/bin/env bash
# Build source distribution and wheel, check them, install the wheel into an empty environment and use it there.
set -euo pipefail
cd "$(dirname "$0")/.."
here=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# The source may lie here too: what is tested is what was installed.
unset PYTHONPATH

"${PYTHON:-python3}" -m venv "$work/tools"
"$work/tools/bin/python" -m pip install --quiet --disable-pip-version-check 'build>=1.0' 'twine>=5.0'
rm -rf dist
# The wheel is built from the source distribution, so that both are complete.
"$work/tools/bin/python" -m build --outdir dist . >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
"$work/tools/bin/python" -m twine check --strict dist/*

"${PYTHON:-python3}" -m venv "$work/empty"
"$work/empty/bin/python" -m pip install --quiet --disable-pip-version-check dist/*.whl
cd "$work"
"$work/empty/bin/python" - <<'PYTHON'
import pathlib
import sys

import movingfrf as mf

assert pathlib.Path(mf.__file__).is_relative_to(sys.prefix), mf.__file__
for name in mf.__all__:
    getattr(mf, name)
print(f"movingfrf {mf.__version__}: {len(mf.__all__)} public names load")
PYTHON
"$work/empty/bin/movingfrf" new truck.toml
"$work/empty/bin/movingfrf" check truck.toml >/dev/null
"$work/empty/bin/movingfrf" run truck.toml --output truck >/dev/null
"$work/empty/bin/movingfrf" new loads.toml --loads
"$work/empty/bin/movingfrf" run loads.toml --output loads >/dev/null
"$work/empty/bin/movingfrf" paper --only 7 --quick --output paper >/dev/null
ls -l truck/report.html truck/result.nc truck/summary.json loads/report.html paper/report.html | awk '{print $5, $9}'
cd "$here"
ls -l dist | awk 'NR > 1 {print $5, $9}'
