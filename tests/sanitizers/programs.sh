#!/usr/bin/env bash
# Names the unit tests of a kind, one a line.
#
#   programs.sh address|thread UNIT_TESTS [K/N]      UNIT_TESTS: unit-tests.txt of a built tree, which names them all
#
# Under AddressSanitizer those but for what `left-out.txt` names, which says why. With K/N they are those of `bytes.txt` and, of the rest,
# every N-th beginning with the K-th: N parts together have all. Under ThreadSanitizer those of `thread.txt`.
set -euo pipefail

here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
kind=${1:?address or thread} unit_tests=${2:?UNIT_TESTS is missing} part=${3:-1/1}
[[ $part =~ ^([1-9][0-9]*)/([1-9][0-9]*)$ ]] && ((BASH_REMATCH[1] <= BASH_REMATCH[2])) ||
  { echo "sanitizers: part: must be K/N with K from 1 to N, got $part" >&2; exit 2; }
names() { sed -e 's/#.*//' -e 's/[[:space:]]*$//' -e '/^$/d' "$here/$1"; }

case $kind in
  address)
    names bytes.txt
    grep -vxFf <(names bytes.txt; names left-out.txt | grep -vF .) "$unit_tests" |
      awk -v k="${BASH_REMATCH[1]}" -v n="${BASH_REMATCH[2]}" 'NR % n == k % n' ;;
  thread) names thread.txt ;;
  *) echo "sanitizers: $kind: must be address or thread" >&2; exit 2 ;;
esac
