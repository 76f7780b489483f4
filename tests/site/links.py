#!/usr/bin/env python3
"""Checks all pages of the built site: that links and what they load lead to files and headings of the site, and that
nothing is loaded from elsewhere.

    links.py FOLDER
"""

import html.parser
import pathlib
import re
import sys
import urllib.parse

# What a browser loads by itself; a link that a reader follows may lead elsewhere.
LOADS = {("img", "src"), ("script", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("object", "data")}
IMPORT = re.compile(r"""@import\s+["']?([^"';\s]+)|url\(\s*["']?(?!data:|#)([^"')]+)""")


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.names, self.links, self.loads = set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.names.update(given[key] for key in ("id", "name") if given.get(key))
        for key, value in attributes:
            if (tag, key) in LOADS and given.get("rel") not in ("canonical", "next", "prev"):
                self.loads.append(value)
            elif key == "href":
                self.links.append(value)


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = {path: Page(path) for path in root.rglob("*.html")}
    problems = []
    count = 0
    for path, page in pages.items():
        for link in page.links + page.loads:
            count += 1
            address = urllib.parse.urlsplit(link)
            if address.scheme or address.netloc:
                if link in page.loads and address.scheme not in ("data", "javascript"):
                    problems.append(f"{path}: loads {link}")
                continue
            name = urllib.parse.unquote(address.path)
            # 404.html is served for any address, so its links begin at the root.
            target = root / name.lstrip("/") if name.startswith("/") else path.parent / name if name else path
            target = target.resolve()
            if target.is_dir():
                target /= "index.html"
            fragment = urllib.parse.unquote(address.fragment)
            if not target.is_file():
                problems.append(f"{path}: no file {link}")
            elif fragment and target in pages and fragment not in pages[target].names:
                problems.append(f"{path}: nothing is called {link}")
    for path in root.rglob("*.css"):
        for match in IMPORT.finditer(path.read_text(encoding="utf-8")):
            if re.match(r"(https?:)?//", match[1] or match[2]):
                problems.append(f"{path}: loads {match[0]}")
    print(f"{len(pages)} pages, {count} links")
    for problem in problems:
        print(problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
