#!/usr/bin/env bash
# Builds the dashboard: build.sh OUT. Its packages are in build/dashboard (./dmise dashboard fetches them); without them
# nothing is built.
set -euo pipefail
source=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
work=$source/../../build/dashboard
[[ -d $work/node_modules/vite ]] || exit 0
command -v node >/dev/null || PATH=$source/../../build/node-venv/bin:$PATH
mkdir -p "$1"
out=$(readlink -f "$1")
cp -r "$source"/{index.html,package.json,tsconfig.json,vite.config.js} "$work"
rm -rf "$work/src"
cp -r "$source/src" "$work/src"
cd "$work"
node node_modules/typescript/bin/tsc --noEmit
DMISE_DASHBOARD_OUT=$out node node_modules/vite/bin/vite.js build --logLevel warn
