#!/usr/bin/env bash
# The programs in the documentation, built and run:
#
#   snippets.sh cpp | c | python | sh | js PAGE.md...
#
# A program is a fenced block of that language that begins with #include, #define or import; each block of sh is one. If
# the next fenced block is one of text, what the program prints must be that. Programs run in a folder of their own. In
# the environment: SOURCE of flaunay, LIBRARY (the shared one), WORK (a folder to work in), and CXX, CC, PYTHON,
# COMMAND (flaunay's), or PACKAGE (the folder of the JavaScript package).
set -euo pipefail

language=$1
shift
case $language in
  cpp) ending=cpp ;;
  c) ending=c ;;
  python) ending=py ;;
  sh) ending=sh ;;
  js) ending=mjs ;;
  *)
    echo "snippets.sh: unknown language $language" >&2
    exit 1
    ;;
esac
folder="$WORK/$language"
rm -rf "$folder"
mkdir -p "$folder/files"
folder="$(realpath "$folder")"
python="$(command -v "${PYTHON:-python3}")"
[[ $python == /* ]] || python="$PWD/$python"
if [[ $language == js ]]; then
  mkdir "$folder/node_modules"
  ln -s "$(realpath "$PACKAGE")" "$folder/node_modules/flaunay"
fi
[[ $language != sh ]] || export PATH="${COMMAND%/*}:$PATH"

# extract PAGE: its programs to $folder/PAGE-K.$ending, and what they print to $folder/PAGE-K.expected.
extract() {
  awk -v language="$language" -v stem="$folder/$(basename "$1" .md)" -v ending="$ending" '
    !inside && /^```/ { inside = 1; kind = substr($0, 4); first = 1; file = ""
      if (kind == "text" && program != "") file = program ".expected"
      program = ""
      if (file != "") printf "" >file
      next }
    inside && /^```$/ { inside = 0; if (file != "") close(file); next }
    inside && first { first = 0
      if (kind == language && (kind == "sh" || /^(#include|#define|import) /)) { program = stem "-" ++count; file = program "." ending } }
    inside && file != "" { print >file }' "$1"
}

# run PROGRAM: called where set -e means nothing.
run() {
  local stem=${1%.*} compile
  case $language in
    cpp | c)
      compile=("${CXX:-c++}" -std=c++17)
      [[ $language == cpp ]] || compile=("${CC:-cc}" -std=c11)
      "${compile[@]}" -Wall -Wextra -Werror -I "$SOURCE/src/include" "$1" -o "$stem" "$LIBRARY" \
        "-Wl,-rpath,${LIBRARY%/*}" -lOpenCL -pthread && (cd "$folder/files" && "$stem") >"$stem.printed" || return
      ;;
    python) [[ -e $stem.printed ]] || return ;;
    js) (cd "$folder/files" && node "$1") >"$stem.printed" || return ;;
    sh) (cd "$folder/files" && bash -euo pipefail "$1") >"$stem.printed" || return ;;
  esac
  [[ ! -e $stem.expected ]] || diff -u "$stem.expected" "$stem.printed"
}

for page in "$@"; do
  extract "$page"
done
programs=("$folder"/*."$ending")
if [[ ! -e ${programs[0]} ]]; then
  echo "snippets.sh: no programs in $*" >&2
  exit 1
fi
if [[ $language == python ]]; then
  "$python" "$(dirname "${BASH_SOURCE[0]}")/programs.py" "$folder/files" "${programs[@]}"
fi
failed=0
for program in "${programs[@]}"; do
  if ! run "$program"; then
    echo "snippets.sh: $program failed" >&2
    failed=1
  fi
done
echo "${#programs[@]} programs"
exit "$failed"
