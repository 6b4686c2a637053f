#!/usr/bin/env bash
# Runs libFuzzer targets, one on each core, and tells runs and findings; exits 1 on a finding.
#
#   run.sh BIN_DIRECTORY [--seconds N | --runs N] [--json FILE] [TARGET..]
#
# N is for each target (5 seconds unless said); FILE gets a line of figures for each. TARGET is tle, omm, ...; all of them unless said.
# Targets start from tests/fuzz/corpus/TARGET; what they find interesting is kept for the next run in
# BIN_DIRECTORY/../corpus, an input that fails in BIN_DIRECTORY/../findings. One by hand:
#   build/asan/bin/fuzz_tle -runs=1000000 -max_len=2048 FOLDER tests/fuzz/corpus/tle
set -euo pipefail

here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
die() { printf 'fuzz: %s\n' "$*" >&2; exit 2; }

bin=$(readlink -f "${1:?BIN_DIRECTORY is missing}")
shift
limit=-max_total_time=5
json=/dev/null
targets=()
while (($#)); do
  case $1 in
    --seconds | --runs)
      [[ ${2-} =~ ^[1-9][0-9]*$ ]] || die "$1: must be a whole number > 0, got ${2-nothing}"
      if [[ $1 == --runs ]]; then limit=-runs=$2; else limit=-max_total_time=$2; fi
      shift ;;
    --json)
      json=$(realpath -m "${2:?--json: FILE is missing}")
      shift ;;
    -*) die "$1: unknown option" ;;
    *)
      [[ -x $bin/fuzz_$1 ]] || die "$1: no such target"
      targets+=("$1") ;;
  esac
  shift
done
if ((${#targets[@]} == 0)); then
  for program in "$bin"/fuzz_*; do targets+=("${program##*/fuzz_}"); done
fi

# A library in C that is asked for too much gets no memory, as without ASan; our own `new` is a finding.
export ASAN_OPTIONS=allocator_may_return_null=1
export LSAN_OPTIONS=suppressions=$here/../sanitizers/lsan.supp:print_suppressions=0

fuzz_one() {
  local target=$1 code=0 runs found text
  # OpenImageIO's leak is told by its caller, which unwinding by frame pointers does not find beyond libstdc++.
  [[ $target != picture ]] || ASAN_OPTIONS+=:fast_unwind_on_malloc=0
  local kept=$bin/../corpus/$target log=$bin/../fuzz-$target.log corpus
  mkdir -p "$kept" "$bin/../findings"
  corpus=("$kept")
  [[ ! -d $here/corpus/$target ]] || corpus+=("$here/corpus/$target")
  "$bin/fuzz_$target" "$limit" -max_len=2048 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$bin/../findings/$target-" "${corpus[@]}" >"$log" 2>&1 || code=$?
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  found=$((code != 0))  # libFuzzer ends at the first
  printf '{"name": "fuzz", "target": "%s", "value": %d, "findings": %d}\n' "$target" "${runs:-0}" "$found" >>"$json"
  printf -v text '%-17s %9s runs, %d findings' "$target" "${runs:-?}" "$found"
  ((code == 0)) || text+=$'\n'$(grep -m 1 -E 'runtime error|ERROR: |deadly signal' "$log" || true)$'\n'"  log: $log"
  echo "$text"
  return "$found"
}
export -f fuzz_one
export here bin limit json

printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -c 'fuzz_one {}' || exit 1
