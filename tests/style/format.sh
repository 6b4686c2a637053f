#!/usr/bin/env bash
# Every C++ file is as clang-format leaves it. Exits 77 where git or clang-format is missing.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."
command -v clang-format >/dev/null && git ls-files >/dev/null 2>&1 || {
  echo "clang-format or git is not there"
  exit 77
}
wrong=$(git ls-files -z '*.cpp' '*.h' | xargs -0 clang-format --dry-run 2>&1 | grep 'clang-formatted' || true)
[[ -z $wrong ]] || {
  cut -d: -f1 <<<"$wrong" | sort | uniq -c | awk '{print $2 ": " $1 " places; clang-format -i " $2}'
  exit 1
}
echo "ok: $(git ls-files '*.cpp' '*.h' | wc -l) files"
