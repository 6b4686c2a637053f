#!/usr/bin/env bash
# The image of launch/stack/Dockerfile, made on a bare Debian by the set-up of the README; a run of its
# containers with compose and as a stack of a Swarm makes the bytes that `dmise run` makes.
#
#   stack.sh CHECKOUT DMISE      of the committed tree (HEAD) of that checkout
#
# Starts a dockerd of its own in namespaces of its own. A proof holds until something that it depends
# on changes; it and the base image are kept in ${XDG_CACHE_HOME:-~/.cache}/dmise. Takes a whole build,
# so it runs only with DMISE_BARE_ROOT=1; else, and where the kernel lets no container run, it exits
# 77 (skipped). DMISE_IMAGE: an image (`docker save`) to test in place of one built here; no proof.
set -euo pipefail

name=stack
checkout=$(readlink -f "$1") dmise=$(readlink -f "$2")
tests=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
data_root=${XDG_CACHE_HOME:-$HOME/.cache}/dmise/docker
file=$checkout/launch/stack/compose.yaml
base=dmise-base:bookworm warm=dmise-warm builder=dmise-builder project=dmise-test
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
source "$tests/setup_proof.sh"
source "$tests/stack/products.sh"
source "$tests/stack/daemon.sh"

clean_up() {
  if [[ -n $outer ]]; then
    docker swarm leave --force >/dev/null 2>&1 || true
    compose down --volumes --timeout 1 >/dev/null 2>&1 || true
    stop_daemon
  fi
  rm -rf --one-file-system "$work"
}

remove_containers() { docker ps -aq | xargs -r docker rm -fv >/dev/null; }
compose() { docker-compose -p "$project" -f "$file" "$@"; }
compose_with_view() { compose -f "$checkout/launch/stack/view.yaml" "$@"; }
container_of() { compose ps -aq "$1" 2>/dev/null; }

# A registry's Debian or, where none can be reached, one made here.
make_base() {
  if timeout 60 docker pull -q debian:bookworm-slim >/dev/null 2>&1; then
    base=debian:bookworm-slim
  else
    "$checkout/launch/stack/base-image.sh" "$base" || die "no base image: see above"
  fi
  say "the base is $base"
}

# The base with what the compiler cache of this machine has kept, so that nothing is compiled twice:
# the set-up, CMake and the linker do all their work. Without a cache, the base.
warm_base() {
  warm=$base
  command -v ccache >/dev/null || return 0
  mkdir "$work/warm"
  cp -r "$(ccache --get-config cache_dir)" "$work/warm/ccache" 2>/dev/null || return 0
  cat >"$work/warm/Dockerfile" <<DOCKERFILE
FROM $base
RUN apt-get -q update && apt-get -q -y install --no-install-recommends ccache && rm -rf /var/lib/apt/lists/*
COPY ccache /var/cache/ccache
ENV CCACHE_DIR=/var/cache/ccache
DOCKERFILE
  warm=dmise-warm
  in_docker -f "$work/warm/Dockerfile" -t "$warm" "$work/warm"
}

in_docker() {  # ARG..: of docker build
  docker build --network host ${http_proxy:+--build-arg http_proxy} ${https_proxy:+--build-arg https_proxy} \
    "$@" >"$work/build.log" 2>&1 || die "docker build failed: $(tail -n 20 "$work/build.log")"
}

build() {  # TARGET NAME: a stage of the Dockerfile
  in_docker -f "$work/tree/launch/stack/Dockerfile" --build-arg BASE="$base" --build-arg BUILDER="$warm" \
    --build-arg PACKAGES="python3-numpy python3-protobuf python3-zmq" \
    ${1:+--target "$1"} -t "$2" "$work/tree"
}

# What bare_root.sh proves, on the way to the image.
check_setup() {
  local began=$SECONDS
  docker run --rm --network none --user 65534 -v "$work/tree:/src:ro" "$base" /src/dmise demo \
    >"$work/refusal.log" 2>&1 && die "the demonstration ran without its packages"
  check_refusal "$work/refusal.log"
  build builder "$builder"
  say "./dmise build on a bare Debian: done after $((SECONDS - began)) s"
  remove_containers
  docker run -d --name demo --network none "$builder" sleep infinity >/dev/null
  docker exec demo ./dmise demo >"$work/demo.log" 2>&1 || die "./dmise demo: $(tail -n 20 "$work/demo.log")"
  docker cp demo:/src/out/demo "$work/demo" >/dev/null
  check_demonstration "$work/demo"
  docker exec demo ./dmise demo >"$work/demo.log" 2>&1
  grep -q 'contains this run, complete' "$work/demo.log" || die "a second ./dmise demo did the work again"
  docker rm -f demo >/dev/null
  say "ok: the demonstration is whole, after $((SECONDS - began)) s"
  write_proof "$(setup_proof)" "$((SECONDS - began))"
}

check_image() {
  local inside
  inside=$(docker run --rm --network none --read-only --entrypoint sh "$DMISE_IMAGE" -c \
    'id -u; for c in cc c++ g++ gcc clang ld as cmake ninja make; do command -v $c; done
     touch /etc/x /opt/dmise/x 2>/dev/null && echo writable; true')
  [[ $inside == 10001 ]] || die "in the image: uid, compilers and what can be written: '$inside'"
  say "ok: user 10001, no compiler, $(($(docker image inspect -f '{{.Size}}' "$DMISE_IMAGE") / 1000000)) MB"
}

make_keys() {
  install -d -m 700 -o 10001 -g 10001 "$DMISE_KEYS"
  docker run --rm --network none --read-only -v "$DMISE_KEYS:/keys" "$DMISE_IMAGE" keygen /keys gateway >/dev/null
  echo "view $view_token" | install -m 400 -o 10001 -g 10001 /dev/stdin "$DMISE_KEYS/view.tokens"
  docker run --rm --network none --read-only -v "$DMISE_KEYS:/keys" -v "$DMISE_SCENARIOS:/scenarios:ro" \
    "$DMISE_IMAGE" keygen /keys --scenario "/scenarios/$DMISE_SCENARIO" --rings >/dev/null
}

# Every container as compose.yaml says, and no secret key where `docker inspect` shows it.
check_containers() {
  local containers secret
  mapfile -t containers < <(docker ps -aq --no-trunc)
  ((${#containers[@]} >= $1)) || die "${#containers[@]} containers, not $1"
  docker inspect "${containers[@]}" >"$work/containers.json"
  [[ $(docker inspect -f '{{.Config.User}} {{.HostConfig.ReadonlyRootfs}} {{.HostConfig.CapDrop}}' \
    "${containers[@]}" | sort -u) == 'dmise true [ALL]' ]] || die "a container has more rights than it needs"
  for secret in $(sed -n 's/^secret //p' "$DMISE_KEYS"/*.key); do
    ! grep -qF -- "$secret" "$work/containers.json" || die "a secret key can be read by docker inspect"
  done
}

# One sensor too many: it stands by.
check_compose() {
  local began=$SECONDS
  compose config -q >/dev/null 2>"$work/config.log" || die "compose config: $(cat "$work/config.log")"
  compose up --no-color --scale sensor=4 --exit-code-from time-master >"$work/up.log" 2>&1 ||
    die "compose up: $(tail -n 30 "$work/up.log")"
  docker cp "$(container_of time-master):/products" "$work/compose" >/dev/null
  same_products "$work/reference" "$work/compose" 17 "compose ($((SECONDS - began)) s)"
  check_containers 9
  compose down --volumes --timeout 1 >/dev/null 2>&1
}

# A scenario whose program, in Python, moves an object: one own node, and one that stands by. Its digest is that of the
# image's Python, so the image runs it alone, too.
check_own_node() {
  local began=$SECONDS
  local -x DMISE_SCENARIO=own.yaml DMISE_KEYS=$work/own-keys DMISE_FLAGS=--allow-programs
  docker run --rm --network none --entrypoint python3 "$DMISE_IMAGE" -c 'import dmise' 2>/dev/null ||
    { say "note: the image has no Python for nodes of one's own"; return; }
  docker run --name own --network none -v "$DMISE_SCENARIOS:/scenarios:ro" "$DMISE_IMAGE" run /scenarios/own.yaml \
    --allow-programs --out /products >"$work/own.log" 2>&1 || die "dmise run: $(tail -n 5 "$work/own.log")"
  docker cp own:/products "$work/own-reference" >/dev/null
  docker rm -fv own >/dev/null
  make_keys
  compose up --no-color --scale sensor=3 --scale own-node=2 --exit-code-from time-master >"$work/up.log" 2>&1 ||
    die "compose up: $(tail -n 30 "$work/up.log")"
  docker cp "$(container_of time-master):/products" "$work/own" >/dev/null
  same_products "$work/own-reference" "$work/own" 17 "compose with a node of one's own ($((SECONDS - began)) s)"
  grep -q 'own-node.*standing by' "$work/up.log" || die "no own node stood by"
  compose down --volumes --timeout 1 >/dev/null 2>&1
}

# Programs in all four roles die, one is stopped, and the container of the one that moves the object is killed: another stands in.
# In the reference all have had their deaths.
check_own_deaths() {
  local began=$SECONDS lived=$work/lived
  local -x DMISE_SCENARIO=roles.yaml DMISE_KEYS=$work/roles-keys DMISE_FLAGS=--allow-programs
  mkdir "$lived"
  printf x | tee "$lived"/{gnc,peaks-ground,laser,mine} >/dev/null
  chmod -R a+rwX "$lived"
  docker run --name roles --network none -v "$DMISE_SCENARIOS:/scenarios:ro" -v "$lived:/tmp" "$DMISE_IMAGE" run \
    /scenarios/roles.yaml --allow-programs --out /products >"$work/roles.log" 2>&1 || die "dmise run: $(tail -n 5 "$work/roles.log")"
  docker cp roles:/products "$work/roles-reference" >/dev/null
  docker rm -fv roles >/dev/null
  make_keys
  begin_run --scale sensor=2 --scale own-node=2
  wait_until 120 "the death of the program of gnc" mover
  docker kill "$(mover)" >/dev/null
  end_run 0
  (($(grep -c 'was restarted' "$work/up.log") >= 4)) || die "not every program was restarted: $(grep restarted "$work/up.log")"
  docker cp "$(container_of time-master):/products" "$work/roles" >/dev/null
  same_products "$work/roles-reference" "$work/roles" 10 "compose whose programs and container died ($((SECONDS - began)) s)"
  compose down --volumes --timeout 1 >/dev/null 2>&1
}

# A run in the background, for compose itself would end all with the first container that ends; its end with this exit code. The logs
# are in up.log then.
begin_run() { compose up --no-color -d "$@" >"$work/up.log" 2>&1 || die "compose up: $(tail -n 30 "$work/up.log")"; }
end_run() {
  wait_until 300 "the end of the run" is_over
  compose logs --no-color >"$work/up.log" 2>&1
  [[ $(of_master ExitCode) == "$1" ]] || die "exit code $(of_master ExitCode) of the run, not $1: $(tail -n 30 "$work/up.log")"
}
is_over() { [[ $(of_master Status) == exited ]]; }
of_master() { docker inspect -f "{{.State.$1}}" "$(container_of time-master)"; }

# The container whose program has moved the object, and has been restarted.
mover() {
  local each
  for each in $(container_of own-node); do
    ! docker logs "$each" 2>&1 | grep -q 'was restarted' || { echo "$each"; return; }
  done
  return 1
}

# What a program says wrongly ends the run with node, tick and reason.
check_own_fault() {
  local -x DMISE_SCENARIO=fault.yaml DMISE_KEYS=$work/fault-keys DMISE_FLAGS=--allow-programs
  sed 's/run: .*/run: [python3, own_actor\/wrong.py], options: {fault: nan, at: 1}}]/' "$DMISE_SCENARIOS/own.yaml" >"$DMISE_SCENARIOS/fault.yaml"
  make_keys
  begin_run --scale sensor=3
  end_run 1
  grep -q 'gnc: tick 1: .*position_m' "$work/up.log" || die "the reason is not told: $(tail -n 20 "$work/up.log")"
  compose down --volumes --timeout 1 >/dev/null 2>&1
  say "ok: NaN of a program ends the run of containers with node, tick and reason"
}

# The head and the page that the gateway's container serves to who has this token.
page_of_view() {
  compose_with_view exec -T gateway bash -c "exec 3<>/dev/tcp/127.0.0.1/7680
    printf 'GET / HTTP/1.0\\r\\nHost: view\\r\\nCookie: dmise_token=%s\\r\\n\\r\\n' '$1' >&3; cat <&3" 2>/dev/null
}
view_is_served() { [[ $(page_of_view "$view_token") == *'DMISE live view'* ]]; }

check_view() {
  compose_with_view config -q >/dev/null 2>"$work/config.log" || die "compose config: $(cat "$work/config.log")"
  compose_with_view up -d gateway >"$work/view.log" 2>&1 || die "the gateway: $(tail -n 5 "$work/view.log")"
  wait_until 120 "the pages of the live view" view_is_served
  [[ $(page_of_view "$view_token") == 'HTTP/1.1 200'* ]] || die "the live view: $(page_of_view "$view_token" | head -n 3)"
  [[ $(page_of_view wrong-wrong-wrong) == 'HTTP/1.1 401'* ]] || die "the live view is shown to who has no token"
  [[ $(page_of_view "$view_token") == *assets/* ]] || say "note: the image has no pages of the live view"
  compose_with_view down --volumes --timeout 1 >/dev/null 2>&1
  say "ok: the gateway's container serves its page, to who has a token"
}

# What the observatory's container answers to a request of Alpaca, with this token.
observatory() { docker-compose -p "$project" -f "$checkout/launch/stack/observatory.yaml" "$@"; }
answer_of_observatory() {
  observatory exec -T observatory bash -c "exec 3<>/dev/tcp/127.0.0.1/11111
    printf 'GET /management/v1/configureddevices HTTP/1.0\\r\\nHost: o\\r\\nAuthorization: Bearer %s\\r\\n\\r\\n' '$1' >&3; cat <&3" 2>/dev/null
}
observatory_answers() { [[ $(answer_of_observatory "$view_token") == *'"DeviceType":"Telescope"'* ]]; }

check_observatory() {
  local -x DMISE_SCENARIO=observatory.yaml DMISE_TOKENS=$work/observatory.tokens
  echo "view $view_token" | install -m 400 -o 10001 -g 10001 /dev/stdin "$DMISE_TOKENS"
  observatory config -q >/dev/null 2>"$work/config.log" || die "compose config: $(cat "$work/config.log")"
  observatory up -d >"$work/observatory.log" 2>&1 || die "the observatory: $(tail -n 5 "$work/observatory.log")"
  wait_until 120 "the observatory's devices" observatory_answers
  [[ $(answer_of_observatory wrong-wrong-wrong) == 'HTTP/1.1 401'* ]] || die "the observatory answers to who has no token"
  observatory stop >/dev/null 2>&1
  [[ $(docker inspect -f '{{.State.ExitCode}}' "$(observatory ps -aq observatory)") == 0 ]] || die "its night did not end well"
  observatory down --volumes --timeout 1 >/dev/null 2>&1
  say "ok: the observatory's container answers by Alpaca, to who has a token, and ends its night"
}

# A scenario that nobody can run: compose gives the launcher's code. It is alone, for where another container fails
# first, compose ends it.
check_failure() {
  local code=0
  DMISE_SCENARIO=missing.yaml compose up --no-color --exit-code-from time-master time-master \
    >"$work/missing.log" 2>&1 || code=$?
  ((code == 2)) || die "exit code $code of a run without scenario, not 2: $(tail -n 9 "$work/missing.log")"
  compose down --volumes --timeout 1 >/dev/null 2>&1
  say "ok: the exit code is that of the run"
}

task() { docker inspect -f "{{.Status.$1}}" "$(docker service ps -q --no-trunc "${project}_time-master")"; }
task_over() { [[ $(task State) =~ ^(complete|failed|rejected)$ ]]; }

check_swarm() {
  local began=$SECONDS
  docker swarm init --advertise-addr 127.0.0.1 >/dev/null
  DMISE_SENSORS=3 docker stack deploy --resolve-image never -c "$file" "$project" >"$work/deploy.log" 2>&1 ||
    die "docker stack deploy: $(tail -n 3 "$work/deploy.log")"
  wait_until 600 "the end of the Swarm's run" task_over
  [[ $(task ContainerStatus.ExitCode) == 0 ]] ||
    die "the Swarm's run: $(task Err) $(docker service logs "${project}_time-master" 2>&1 | tail -n 5)"
  docker cp "$(task ContainerStatus.ContainerID):/products" "$work/swarm" >/dev/null
  same_products "$work/reference" "$work/swarm" 17 "a Swarm ($((SECONDS - began)) s)"
  check_containers 8
  docker stack rm "$project" >/dev/null
  docker swarm leave --force >/dev/null
}

[[ ${DMISE_BARE_ROOT:-0} == 1 ]] || { say "skipped: set DMISE_BARE_ROOT=1 to spend a build on it"; exit 77; }
why=$(kernel_forbids)
[[ -z $why ]] || { say "skipped: no container can run here: $why"; exit 77; }
command -v dockerd docker-compose >/dev/null || die "needs docker.io and docker-compose"
mkdir -p "$proofs"
proof=$proofs/stack-$(digest_of_files 'proto/.*|nodes/.*|broker/.*|time-master/.*|launch/.*|tests/system/stack.*|.dockerignore').proof
if [[ -f $proof && -f $(setup_proof) && -z ${DMISE_IMAGE-} ]]; then
  say "proved before: $(cat "$proof")"
  exit 0
fi
exec 9>"$proofs/docker.lock"
flock 9  # one dockerd a data root
work=$(mktemp -d -t dmise-stack-XXXXXX)
trap clean_up EXIT
view_token=view-of-the-stack-test
export DMISE_SCENARIOS=$work/scenarios DMISE_SCENARIO=scenario.yaml DMISE_KEYS=$work/keys
mkdir "$work/tree" "$DMISE_SCENARIOS"
cp "$checkout/launch/scenarios/observatory.yaml" "$DMISE_SCENARIOS/"
cp -r "$tests"/stack/*.yaml "$tests"/own_{actor,detector,sensor,tracker} "$tests"/own_actor/{walk,mortal}.py "$DMISE_SCENARIOS/"
cp "$checkout/clients/python/examples/detector.py" "$DMISE_SCENARIOS/own_detector/"
cp "$checkout/clients/python/examples/ranging.py" "$DMISE_SCENARIOS/own_sensor/"
with_own_node python3 >"$DMISE_SCENARIOS/own.yaml"
chmod -R a+rX "$DMISE_SCENARIOS"
given=${DMISE_IMAGE-}
export DMISE_IMAGE=dmise-test
if [[ -z $given ]]; then
  committed archive HEAD | tar -x -C "$work/tree"
  start_daemon outside
  make_base
  warm_base
  check_setup
  build '' "$DMISE_IMAGE"
  stop_daemon
fi
"$dmise" run "$DMISE_SCENARIOS/scenario.yaml" --out "$work/reference" >"$work/run.log" 2>&1 ||
  die "dmise run: $(tail -n 1 "$work/run.log")"
start_daemon inside
remove_containers  # a test may have been cut short
[[ -z $given ]] || DMISE_IMAGE=$(docker load -q <"$given" | sed -n 's/^Loaded image: //p')
check_image
make_keys
check_compose
check_own_node
check_own_deaths
check_own_fault
check_view
check_observatory
check_failure
check_swarm
[[ -z $given ]] || exit 0
remove_containers || true  # those of a stack go in their own time
docker image rm -f "$DMISE_IMAGE" "$builder" dmise-warm >/dev/null || true
docker system prune -f --volumes >/dev/null || true
write_proof "$proof" "$SECONDS"
