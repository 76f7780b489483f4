#!/usr/bin/env bash
# Builds the site and tests it: its links, and its first page in headless Chromium. Needs chromium and node 20 or later
# beside what scripts/site.sh needs. Writes screenshots to build/site/screenshots, and what was measured, with its
# commit, to bench/results/site.json; with --no-record only to the former.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/site.sh --build
work=build/site
"$work/venv/bin/python" tests/site/links.py "$work/html"
node site/pictures.mjs build/javascript/package

# Port 0 is any free one, which the server prints; not that of an earlier run.
rm -f "$work/server.log"
touch "$work/server.log"
"$work/venv/bin/python" -u -m http.server --bind 127.0.0.1 --directory "$work/html" 0 >"$work/server.log" 2>/dev/null &
server=$!
trap 'kill "$server"' EXIT
until port="$(sed -n 's/.* port \([0-9]*\).*/\1/p' "$work/server.log")" && [[ -n $port ]]; do sleep 0.1; done

node --experimental-websocket --no-warnings tests/site/live.mjs "http://127.0.0.1:$port" "$work/screenshots"
if [[ ${1-} != --no-record ]]; then
  "$work/venv/bin/python" - "$work/screenshots/live.json" bench/results/site.json <<'END'
import datetime, json, os, subprocess, sys

with open(sys.argv[1], encoding="utf-8") as file:
    measured = json.load(file)
commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
browser = subprocess.run(["chromium", "--version"], capture_output=True, text=True, check=True).stdout.strip()
record = {
    "command": "scripts/site-test.sh",
    "date": datetime.date.today().isoformat(),
    "commit": commit,
    "browser": f"{browser}, headless, without a GPU",
    "cores": os.cpu_count(),
    "load": round(os.getloadavg()[0], 1),
    **measured,
}
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump(record, file, indent=2)
    file.write("\n")
END
fi
