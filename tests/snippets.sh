#!/usr/bin/env bash
# The programs in the documentation, built and run:
#
#   snippets.sh cpp | c | python PAGE.md...
#
# A program is a fenced block of that language that begins with #include, #define or import. If the next fenced block is
# one of text, what the program prints must be that. In the environment: SOURCE of flaunay, LIBRARY (the shared one), WORK (a
# folder to work in), and CXX, CC or PYTHON.
set -euo pipefail

language=$1
shift
case $language in
  cpp) ending=cpp ;;
  c) ending=c ;;
  python) ending=py ;;
  *)
    echo "snippets.sh: unknown language $language" >&2
    exit 1
    ;;
esac
folder="$WORK/$language"
rm -rf "$folder"
mkdir -p "$folder"

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
      if (kind == language && /^(#include|#define|import) /) { program = stem "-" ++count; file = program "." ending } }
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
        "-Wl,-rpath,${LIBRARY%/*}" -lOpenCL -pthread && "$stem" >"$stem.printed" || return
      ;;
    python) "${PYTHON:-python3}" "$1" >"$stem.printed" || return ;;
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
failed=0
for program in "${programs[@]}"; do
  if ! run "$program"; then
    echo "snippets.sh: $program failed" >&2
    failed=1
  fi
done
echo "${#programs[@]} programs"
exit "$failed"
