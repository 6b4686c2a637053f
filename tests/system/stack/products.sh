# Sourced by the tests of runs on many hosts. Uses `name` (of the test), `tests` (their directory).

say() { printf '%s: %s\n' "$name" "$*"; }
die() { say "$*" >&2; exit 1; }

# with_own_node PYTHON: the scenario with an object that a program moves.
with_own_node() {
  sed 's/{catalogue: demo}/&, {name: probe, motion: {node: gnc}}/' "$tests/stack/scenario.yaml"
  echo "nodes: [{name: gnc, run: [$1, walk.py]}]"
}

# wait_until SECONDS WHAT COMMAND..: until the command succeeds; gives up after so long.
wait_until() {
  local patience=$1 what=$2 began=$SECONDS
  shift 2
  until "$@" >/dev/null 2>&1; do
    ((SECONDS - began <= patience)) || die "waited $patience s in vain for $what"
    sleep 0.2
  done
}

# same_products REFERENCE OUT AT_LEAST WHERE: every product byte for byte, none more, none less.
same_products() {
  local of=(-name '*.fits' -o -name '*.jsonl' ! -name cost.jsonl -o -name '*.csv') file count=0
  diff <(cd "$1" && find . "${of[@]}" | sort) <(cd "$2" && find . "${of[@]}" | sort) >&2 ||
    die "other products than those of dmise run"
  while read -r file; do
    cmp "$1/$file" "$2/$file" || die "$file differs"
    count=$((count + 1))
  done < <(cd "$1" && find . "${of[@]}")
  ((count >= $3)) || die "only $count products"
  say "ok: $count products of $4 are those of one process"
}
