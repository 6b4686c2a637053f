#!/usr/bin/env bash
# No file holds marks of a merge that was left half done, `./dmise --help` names every fuzz target of a file
# format, and the version is the same wherever it stands. Exits 77 where git is missing.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."
git ls-files >/dev/null 2>&1 || { echo "git is not there"; exit 77; }

if git grep -nE '^(<{7}|={7}|>{7})( |$)'; then
  echo "marks of a merge: see above"
  exit 1
fi

help=$(./dmise --help)
targets=$(sed -n '/dmise fuzz/,/dmise sanitize/p' <<<"$help")
missing=0
for target in tests/fuzz/fuzz_*.cpp; do
  name=$(basename "${target#tests/fuzz/fuzz_}" .cpp)
  [[ $name == message ]] || grep -qw -- "$name" <<<"$targets" || { echo "./dmise --help: fuzz: $name is missing"; missing=1; }
done

# One version everywhere.
version=$(sed -n 's/^project(dmise VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
for place in "CITATION.cff:version: $version" "CHANGELOG.md:## $version" "clients/python/pyproject.toml:version = \"$version\"" \
  "clients/python/src/dmise/__init__.py:__version__ = \"$version\"" "clients/dashboard/package.json:\"version\": \"$version\""; do
  grep -qF -- "${place#*:}" "${place%%:*}" || { echo "${place%%:*}: no '${place#*:}'"; missing=1; }
done
exit $missing
