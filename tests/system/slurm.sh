#!/usr/bin/env bash
# A run as a Slurm job on two hosts makes the bytes that `dmise run` makes, and its exit code is that of
# the run; a job array makes a data set; a cancelled job leaves nothing behind.
#
#   slurm.sh DMISE
#
# Starts munged, slurmctld and two slurmd of its own, all in namespaces (processes, network, mounts)
# that end with it. Exits 77 (skipped) without root or Slurm; DMISE_BARE_ROOT=1 demands them.
set -euo pipefail

name=slurm
tests=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
source "$tests/stack/products.sh"
jobs=$(readlink -f "$tests/../../launch/stack/slurm")
scenario=$tests/stack/scenario.yaml
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
PYTHONPATH=$(readlink -f "$tests/../../build/python")  # for the own node
export PYTHONPATH

skip() {
  [[ ${DMISE_BARE_ROOT:-0} != 1 || $1 == kernel* ]] || die "$1"
  say "skipped: $1"
  exit 77
}

if [[ ${1-} != --inside ]]; then
  DMISE=$(readlink -f "$1")
  export DMISE
  ((EUID == 0)) || skip "needs root"
  command -v slurmctld slurmd munged srun >/dev/null || skip "needs slurm-wlm and munge"
  spaces=(unshare --mount --net --uts --pid --fork --kill-child --mount-proc)
  "${spaces[@]}" true 2>/dev/null || skip "kernel: no namespaces may be made"
  work=$(mktemp -d -t dmise-slurm-XXXXXX)
  trap 'rm -rf "$work"' EXIT
  "${spaces[@]}" "$0" --inside "$work"
  exit
fi

work=$2
export SLURM_CONF=$work/slurm.conf

start_cluster() {
  mkdir -p "$work"/{munge,state,spool/first,spool/second,log,jobs}
  chmod 755 "$work"
  chmod 700 "$work/munge"
  dd if=/dev/urandom of="$work/munge/key" bs=128 count=1 status=none
  chmod 400 "$work/munge/key"
  cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=control(10.77.0.1)
SlurmUser=root
SlurmdUser=root
AuthInfo=socket=$work/munge.socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool/%n
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd-%n.pid
SlurmctldLogFile=$work/log/slurmctld
SlurmdLogFile=$work/log/slurmd-%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SwitchType=switch/none
ReturnToService=2
SlurmdTimeout=300
KillWait=5
NodeName=first NodeHostname=control NodeAddr=10.77.0.1 Port=6821 CPUs=8
NodeName=second NodeHostname=control NodeAddr=10.77.0.2 Port=6822 CPUs=8
PartitionName=all Nodes=first,second Default=YES State=UP
CONF
  hostname control
  ip link set lo up
  ip link add hosts type bridge  # two addresses that are not loopback
  ip address add 10.77.0.1/24 dev hosts
  ip address add 10.77.0.2/24 dev hosts
  ip link set hosts up
  printf '127.0.0.1 localhost\n10.77.0.1 control first\n10.77.0.2 second\n' >"$work/hosts"
  mount --bind "$work/hosts" /etc/hosts
  munged --force --key-file="$work/munge/key" --socket="$work/munge.socket" \
    --pid-file="$work/munge/pid" --seed-file="$work/munge/seed" --log-file="$work/munge/log"
  slurmctld -D >"$work/log/ctld" 2>&1 &
  slurmd -D -N first >"$work/log/first" 2>&1 &
  slurmd -D -N second >"$work/log/second" 2>&1 &
  wait_until 120 "two idle nodes of Slurm" two_idle_nodes
}

two_idle_nodes() { [[ $(sinfo --noheader --Node --format %t) == idle$'\n'idle ]]; }
no_node() { [[ -z $(pgrep -f "$(dirname "$DMISE")/dmise-") ]]; }
no_keys() { [[ -z $(find "$work" -maxdepth 1 -name '*.keys-*') ]]; }
log_of() { cat "$work"/jobs/* | tail -n 30; }

# submit SCRIPT SCENARIO OUT OPTION.. [-- FLAG..]: waits for the job's end; its exit code.
submit() {
  local script=$1 of=$2 out=$3 options=()
  shift 3
  for (( ; $# > 0; )); do
    [[ $1 != -- ]] || { shift && break; }
    options+=("$1") && shift
  done
  (cd "$work/jobs" && sbatch --wait --parsable "${options[@]}" "$jobs/$script" "$of" "$out" "$@") >"$work/job"
}

check_run() {
  submit run.sbatch "$scenario" "$work/run" --nodes 2 --ntasks 9 || die "the job failed: $(log_of)"
  same_products "$work/reference" "$work/run" 17 "a job of two hosts"
  no_keys || die "the keys of a job are left behind"
}

check_failure() {
  local code=0
  sed 's/seed: 1/seed: 7/' "$scenario" >"$work/other.yaml"
  submit run.sbatch "$work/other.yaml" "$work/run" --nodes 2 --ntasks 9 || code=$?
  ((code == 2)) || die "exit code $code of a job into another run's directory, not 2: $(log_of)"
  wait_until 60 "the end of all nodes" no_node
  say "ok: the exit code of the job is that of the run"
}

# Its first task after the six of every run is the node of one's own.
check_own_node() {
  OWN_NODES=1 submit run.sbatch "$work/own.yaml" "$work/own" --nodes 2 --ntasks 10 -- --allow-programs ||
    die "the job with a node of one's own failed: $(log_of)"
  same_products "$work/own-reference" "$work/own" 17 "a job with a node of one's own"
}

check_data_set() {
  submit dataset.sbatch "$scenario" "$work/set" --array 1-2 || die "the array failed: $(log_of)"
  same_products "$work/reference" "$work/set/seed-1" 17 "a task of an array"
  same_products "$work/reference-2" "$work/set/seed-2" 17 "another"
  ! cmp -s "$work"/set/seed-{1,2}/alpha/frame-000001.fits || die "two seeds gave the same frame"
}

check_cancel() {
  local job
  sed 's/duration_s: 15/duration_s: 36000/' "$scenario" >"$work/long.yaml"
  job=$(cd "$work/jobs" &&
    sbatch --parsable --nodes 2 --ntasks 9 "$jobs/run.sbatch" "$work/long.yaml" "$work/cancelled")
  wait_until 240 "a first frame of a long job" test -e "$work/cancelled/alpha/frame-000001.fits"
  scancel "$job"
  wait_until 60 "the end of a cancelled job" no_node
  wait_until 60 "idle nodes" two_idle_nodes
  wait_until 60 "the end of its keys" no_keys
  say "ok: a cancelled job leaves no process and no key"
}

"$DMISE" run "$scenario" --out "$work/reference" >"$work/reference.log" 2>&1 ||
  die "dmise run: $(tail -n 1 "$work/reference.log")"
"$DMISE" run "$scenario" --seed 2 --out "$work/reference-2" >"$work/reference.log" 2>&1
cp "$tests"/stack/small.yaml "$tests"/own_actor/{walk,mortal}.py "$work/"
with_own_node /usr/bin/python3 >"$work/own.yaml"
"$DMISE" run "$work/own.yaml" --allow-programs --out "$work/own-reference" >"$work/reference.log" 2>&1 ||
  die "dmise run with a node of one's own: $(tail -n 1 "$work/reference.log")"
start_cluster
check_run
check_own_node
check_failure
check_data_set
check_cancel
