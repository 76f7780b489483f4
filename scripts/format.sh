#!/usr/bin/env bash
# Formats the C++ and OpenCL files of the repository in place, by .clang-format and kernels/.clang-format, and adds words
# of enumerators that lists in documents lack.
#   scripts/format.sh           does it
#   scripts/format.sh --check   changes nothing; lists the files that are not as they should be, and fails if there are any
# Needs clang-format 14, the version of Debian 12. Other versions format slightly differently, so they are not used.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

check=false
case "${1-}" in
  '') ;;
  --check) check=true ;;
  *)
    echo "usage: scripts/format.sh [--check]" >&2
    exit 2
    ;;
esac

words=(python3 scripts/declare.py --words)
if $check; then words+=(--check); fi
"${words[@]}"

format=
for candidate in clang-format-14 clang-format; do
  if command -v "$candidate" >/dev/null && [[ $("$candidate" --version) == *'version 14.'* ]]; then
    format=$candidate
    break
  fi
done
if [[ -z $format ]]; then
  echo 'format: clang-format 14 is missing: apt-get install clang-format-14' >&2
  # Tests must not fail because of another version.
  if $check; then exit 0; else exit 1; fi
fi

# All files that git tracks, and new ones that it does not ignore. In an exported source tree, all files.
folders=(bench examples host javascript kernels python src tests)
if git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
  mapfile -t all < <(git ls-files --cached --others --exclude-standard -- "${folders[@]}" | sort -u)
else
  mapfile -t all < <(find "${folders[@]}" -type f | sort)
fi
files=()
for file in "${all[@]}"; do
  if [[ -f $file && $file =~ \.(c|cl|cpp|h|hpp)$ ]]; then files+=("$file"); fi
done

# clang-format recognises .cl as OpenCL C, and uses the style in the nearest folder above each file.
if ! $check; then
  "$format" -i "${files[@]}"
  exit
fi
unformatted="$("$format" --dry-run "${files[@]}" 2>&1 | sed -nE 's/^([^ :]+):[0-9]+:[0-9]+: warning: .*/\1/p' | sort -u)"
if [[ -n $unformatted ]]; then
  echo 'format: these files are not formatted; scripts/format.sh does it:' >&2
  echo "$unformatted" >&2
  exit 1
fi
