"""Makes the site of all documents, wherever they are in the source tree, without a second copy of any text.

Pages outside of docs/ get the names in PAGES. A link of any page to another file of the source tree leads to a copy of
that file below source/; the text of a link to a folder stays without the link.
"""

import pathlib
import posixpath
import re

from mkdocs.structure.files import File

SOURCE = pathlib.Path(__file__).resolve().parent.parent
PAGES = {
    "README.md": "guide.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "SECURITY.md": "security.md",
    "bench/results/paper.md": "results/paper.md",
    "javascript/README.md": "javascript-package.md",
    "tests/data/README.md": "data.md",
    "site/index.md": "index.md",
    "site/reference.md": "reference/index.md",
    "site/reference-python.md": "reference/python.md",
}
# Folders that the site has as they are; those in build/ are there once site.sh has made them.
FOLDERS = {
    "site/live": "live",
    "site/pictures": "pictures",
    "site/vendor": "vendor",
    "build/site/module": "module",
    "build/site/cpp": "reference/cpp",
}
LINK = re.compile(r"(?<=\]\()(?!\w+:|#)([^)\s#]+)((?:#[^)\s]*)?)(?=\))")
BLOCK = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)


def place(path):
    """The name that a file of the source tree has in the site, None for a folder."""
    if path in PAGES:
        return PAGES[path]
    if path.startswith("docs/"):
        return path.removeprefix("docs/")
    for folder, name in FOLDERS.items():
        if path.startswith(folder + "/"):
            return name + path.removeprefix(folder)
    return "source/" + path if (SOURCE / path).is_file() else None


def origin(uri):
    """The file of the source tree that a page is made of."""
    return next((path for path, name in PAGES.items() if name == uri), "docs/" + uri)


def targets(text, path):
    """The files of the source tree to which a page's text links."""
    for link, _ in LINK.findall(BLOCK.sub("", text)):
        yield posixpath.normpath(posixpath.join(posixpath.dirname(path), link))


def on_files(files, config):
    for path, name in PAGES.items():
        files.append(File.generated(config, name, abs_src_path=str(SOURCE / path)))
    for folder, name in FOLDERS.items():
        for file in sorted((SOURCE / folder).rglob("*")):
            if file.is_file() and file.suffix != ".md":
                uri = f"{name}/{file.relative_to(SOURCE / folder).as_posix()}"
                files.append(File.generated(config, uri, abs_src_path=str(file)))
    for page in list(files.documentation_pages()):
        path = origin(page.src_uri)
        for target in targets((SOURCE / path).read_text(encoding="utf-8"), path):
            name = place(target)
            if name and name.startswith("source/") and not files.get_file_from_path(name):
                content = (SOURCE / target).read_bytes()
                files.append(File.generated(config, name, content=content))
    return files


def on_page_markdown(markdown, page, **_):
    path = origin(page.file.src_uri)
    folder = posixpath.dirname(page.file.src_uri)

    def mapped(match):
        target = posixpath.normpath(posixpath.join(posixpath.dirname(path), match[1]))
        name = place(target)
        return posixpath.relpath(name, folder or ".") + match[2] if name else match[0]

    parts = re.split(r"(^```.*?^```$)", markdown, flags=re.MULTILINE | re.DOTALL)
    for k in range(0, len(parts), 2):
        text = re.sub(
            r"\[([^\]]*)\]\((?!\w+:|#)([^)\s#]+)\)",
            lambda m: m[1] if (SOURCE / posixpath.dirname(path) / m[2]).is_dir() else m[0],
            parts[k],
        )
        parts[k] = LINK.sub(mapped, text)
    return "".join(parts)
