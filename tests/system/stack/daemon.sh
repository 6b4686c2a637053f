# Sourced by stack.sh: a dockerd of one's own, in namespaces that end with it, so that no process, mount,
# network, firewall rule or port outlives it. Uses `work`, `data_root`, `say`; sets DOCKER_HOST.

outer=''  # process that holds the namespaces

# Why no container can run here; empty when one can.
kernel_forbids() {
  local spaces=(unshare --mount --net --pid --fork --kill-child --mount-proc)
  ((EUID == 0)) || { echo "needs root"; return; }
  "${spaces[@]}" true 2>/dev/null || { echo "the kernel allows no namespaces"; return; }
  [[ -e /sys/fs/cgroup/cgroup.controllers || -d /sys/fs/cgroup/devices ]] ||
    { echo "there are no control groups"; return; }
  "${spaces[@]}" sh -c 'ip link add name br0 type bridge && ip link add name ve0 type veth peer name ve1 &&
    ip link add name vx0 type vxlan id 1 dstport 4789' 2>/dev/null ||
    echo "the kernel has no bridge, veth or vxlan"
}

# start_daemon inside|outside: without any network but its own, or in that of this machine (for builds).
start_daemon() {
  local where=$1 driver
  for driver in overlay2 vfs; do
    ! try_daemon "$where" "$driver" || return 0
    stop_daemon
  done
  say "skipped: no container can run here: $(tail -n 1 "$work/dockerd.log")"
  exit 77
}

try_daemon() {
  local spaces=(--mount --pid --fork --kill-child --mount-proc) i
  local options=(--host "unix://$work/docker.sock" --data-root "$data_root" --exec-root "$work/exec"
    --pidfile "$work/dockerd.pid" --storage-driver "$2")
  if [[ $1 == inside ]]; then
    spaces+=(--net)
  else
    options+=(--bridge none --iptables=false --ip-forward=false)
  fi
  rm -f "$work/docker.sock" "$work/dockerd.pid"
  mkdir -p "$data_root" /run/docker
  unshare "${spaces[@]}" -- sh -c '
    ip link set lo up
    mount -t tmpfs tmpfs /run/docker
    exec dockerd "$@"' sh "${options[@]}" >"$work/dockerd.log" 2>&1 &
  outer=$!
  export DOCKER_HOST=unix://$work/docker.sock
  for ((i = 0; i < 600; ++i)); do
    ! docker info >/dev/null 2>&1 || return 0
    kill -0 "$outer" 2>/dev/null || return 1
    sleep 0.1
  done
  return 1
}

stop_daemon() {
  local i inner
  [[ -n $outer ]] || return 0
  inner=$(pgrep -P "$outer" || true)  # unshare itself passes no signal on
  [[ -z $inner ]] || kill "$inner" 2>/dev/null || true
  for ((i = 0; i < 300; ++i)); do
    kill -0 "$outer" 2>/dev/null || break
    sleep 0.1
  done
  kill -9 "$outer" 2>/dev/null || true
  wait "$outer" 2>/dev/null || true
  outer=''
}
