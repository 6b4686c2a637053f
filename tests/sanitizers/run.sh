#!/usr/bin/env bash
# Runs unit tests that were built with sanitizers, one program after another on each core. Exits 1 when
# a test fails or a sanitizer has something to report, in a program or in one that it started.
#
#   run.sh address|thread BIN_DIRECTORY [PROGRAM..]
#
# Which programs there are of each kind says programs.sh; of a program that runs under AddressSanitizer `left-out.txt` names the tests
# that do not, and says why.
set -euo pipefail

here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
kind=${1:?address or thread} bin=$(readlink -f "${2:?BIN_DIRECTORY is missing}")
shift 2
export reports=$bin/../reports
rm -rf "$reports"
mkdir -p "$reports"

export left_out=''
launcher=()
case $kind in
  address)
    named=$(sed -e 's/#.*//' -e 's/[[:space:]]*$//' -e '/^$/d' "$here/left-out.txt")
    left_out=$(grep -F . <<<"$named" | paste -sd :)
    export ASAN_OPTIONS=log_path=$reports/address:detect_stack_use_after_return=1
    export LSAN_OPTIONS=suppressions=$here/lsan.supp:print_suppressions=0
    export UBSAN_OPTIONS=log_path=$reports/undefined:print_stacktrace=1
    ;;
  thread)
    export TSAN_OPTIONS=log_path=$reports/thread:suppressions=$here/tsan.supp:atexit_sleep_ms=0
    # ThreadSanitizer wants its addresses where a kernel that scatters them widely may put others.
    ! setarch -R true 2>/dev/null || launcher=(setarch -R)
    ;;
  *) echo "sanitizers: $kind: must be address or thread" >&2; exit 2 ;;
esac

(($#)) || set -- $("$here/programs.sh" "$kind" "$bin/../unit-tests.txt")

run_one() {
  local name=${1##*/} log=$reports/${1##*/}.log began=$SECONDS code=0
  # What OpenImageIO leaks is told by who called, beyond frames of libstdc++ that a fast unwinder does not pass.
  [[ $name != test_pictures ]] || ASAN_OPTIONS=${ASAN_OPTIONS-}:fast_unwind_on_malloc=0
  (ulimit -t 900 && exec timeout 3600 "$1" --gtest_brief=1 --gtest_output="xml:$log.xml" --gtest_filter="-$left_out") >"$log" 2>&1 || code=$?
  printf '%-28s %4d s  %s\n' "$name" $((SECONDS - began)) \
    "$( ((code == 0)) && sed -n 's/^\[==========\] //p' "$log" | tail -n 1 || echo "FAILED with code $code")"
  ((code == 0)) || tail -n 40 "$log"
  return "$code"
}
export -f run_one

code=0
ls -S "${@/#/$bin/}" |  # the largest first, for they run longest
  "${launcher[@]}" xargs -P "$(nproc)" -I{} bash -c 'run_one {}' || code=1
for report in "$reports"/{address,undefined,thread}.*; do
  [[ -e $report ]] || continue
  echo "$report:"
  head -n 40 "$report"
  code=1
done
exit "$code"
