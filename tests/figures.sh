#!/usr/bin/env bash
# figures.sh PYTHON: pictures in docs/ that are drawn from what its pages print are those in the repository.
set -euo pipefail
docs="$(cd "$(dirname "${BASH_SOURCE[0]}")/../docs" && pwd)"
drawn="$(mktemp)"
trap 'rm -f "$drawn"' EXIT
"$1" "$docs/figures/data_layout.py" "$docs/data-layout.md" "$drawn"
if ! cmp "$docs/data-layout.svg" "$drawn"; then
  echo 'figures.sh: run docs/figures/data_layout.py docs/data-layout.md docs/data-layout.svg' >&2
  exit 1
fi
