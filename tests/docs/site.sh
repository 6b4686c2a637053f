#!/usr/bin/env bash
# site.sh CHECKOUT: the site of the documents is built: no link leads nowhere, and its search finds the tutorial. Without MkDocs
# (build/docs-venv, of ./dmise setup --tests) it exits 77 (skipped).
set -euo pipefail

root=$1
python=$root/build/docs-venv/bin/python
"$python" -c 'import mkdocs' 2>/dev/null || { echo "skipped: build/docs-venv has no MkDocs"; exit 77; }
"$python" "$root/docs/site/make.py"
grep -q '"location":"tutorial.html#' "$root/build/site/search/search_index.json" || { echo "search does not know the tutorial"; exit 1; }
