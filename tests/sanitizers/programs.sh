#!/usr/bin/env bash
# Names the unit tests of a kind, one a line.
#
#   programs.sh address|thread UNIT_TESTS      UNIT_TESTS: unit-tests.txt of a built tree, which names them all
#
# Under AddressSanitizer those but for what `left-out.txt` names, which says why; under ThreadSanitizer those of `thread.txt`.
set -euo pipefail

here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
kind=${1:?address or thread} unit_tests=${2:?UNIT_TESTS is missing}
names() { sed -e 's/#.*//' -e 's/[[:space:]]*$//' -e '/^$/d' "$here/$1"; }

case $kind in
  address) grep -vxFf <(names left-out.txt | grep -vF .) "$unit_tests" ;;
  thread) names thread.txt ;;
  *) echo "sanitizers: $kind: must be address or thread" >&2; exit 2 ;;
esac
