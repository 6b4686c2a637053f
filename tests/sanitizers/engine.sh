#!/usr/bin/env bash
# Runs the tests of the Python module with AddressSanitizer and UndefinedBehaviorSanitizer: no report may come, from the module or
# what it starts. What the interpreter itself never frees is no report.
#
#   engine.sh TREE [PROGRAM [TEST..]]      TREE: the built tree (build/asan) with target dmise_engine; PROGRAM: as engine_frames, by
#                                          default all; TEST: as Frames.test_wcs_is_astropys
set -euo pipefail

here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
root=$(readlink -f "$here/../..") tree=$(readlink -f "${1:?TREE is missing}")
programs=("$root/tests/clients/"${2:-engine_*}.py)
shift $(($# < 2 ? 1 : 2))
package=$tree/python/dmise reports=$tree/reports-engine
module=$(echo "$package"/_engine.*.so)
[[ -f $module ]] || { echo "$package: has no module; build target dmise_engine" >&2; exit 2; }
runtime=$(clang --print-file-name=libclang_rt.asan-x86_64.so)
[[ -f $runtime ]] || { echo "skipped: clang's runtime of AddressSanitizer is not there"; exit 77; }
rm -rf "$reports"
mkdir -p "$reports"

# The package as it is built, but for the module and what it loads.
for file in "$root"/build/python/dmise/*; do
  case ${file##*/} in
    _engine.*.so | lib | __pycache__) ;;
    *) ln -sfn "$file" "$package/${file##*/}" ;;
  esac
done

# C++ exceptions of the module pass the runtime only if libstdc++ is there before it.
export LD_PRELOAD="$runtime $(clang++ --print-file-name=libstdc++.so.6)" PYTHONMALLOC=malloc DMISE_TEST_PACKAGE=$tree/python
export ASAN_OPTIONS=log_path=$reports/address:detect_leaks=0:detect_stack_use_after_return=1:allocator_may_return_null=1:suppressions=$here/asan.supp
export UBSAN_OPTIONS=log_path=$reports/undefined:print_stacktrace=1
code=0
for program in "${programs[@]}"; do
  [[ $program != */engine_wheel.py && $program != */engine_commands.py ]] || continue  # they test what is released: module and program
  "$root/build/client-venv/bin/python" "$program" "$root/build/release/bin/dmise" "$@" || code=$?
done
for report in "$reports"/*; do
  [[ -e $report ]] || continue
  echo "$report:"
  head -n 40 "$report"
  code=1
done
exit "$code"
