#!/usr/bin/env bash
# The Python package is typed: mypy finds nothing. types.sh PYTHON PACKAGE
set -euo pipefail
"$1" -c 'import mypy' 2>/dev/null || { echo "skipped: mypy is not installed (./dmise setup --tests)"; exit 77; }
exec "$1" -m mypy --ignore-missing-imports --explicit-package-bases --cache-dir=/dev/null "$2"
