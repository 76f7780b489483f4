#!/usr/bin/env python3
"""Writes the bill of materials of a release, in CycloneDX's JSON: what is in its files, besides flaunay, in the versions
that this system's headers, the compiler and the built site name.

    sbom.py VERSION COMMIT ZIGLANG FILES...    ZIGLANG: the folder of PyPI's package; FILES: those of the release
"""

import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import uuid

version, commit, ziglang = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
files = sorted(pathlib.Path(name) for name in sys.argv[4:])
source = pathlib.Path(__file__).resolve().parent.parent


def found(path, pattern):
    return re.search(pattern, (source / path).read_text(encoding="utf-8", errors="replace")).group(1)


def number(header, macro):
    return int(re.search(rf"#\s*define {macro} (\d+)", pathlib.Path(header).read_text()).group(1))


def debian_version(package):
    return subprocess.check_output(["dpkg-query", "-W", "-f", "${Version}", package], text=True)


def component(name, version, license, description, purl=None):
    return {
        "type": "library",
        "bom-ref": f"{name}@{version}",
        "name": name,
        "version": version,
        "description": description,
        "licenses": [{"expression": license}],
        **({"purl": purl} if purl else {}),
    }


fmt = number("/usr/include/fmt/core.h", "FMT_VERSION")
fmt = f"{fmt // 10000}.{fmt // 100 % 100}.{fmt % 100}"
boost = number("/usr/include/boost/version.hpp", "BOOST_VERSION")
boost = f"{boost // 100000}.{boost // 100 % 1000}.{boost % 100}"
libcxx = number(ziglang / "lib/libcxx/include/__config", "_LIBCPP_VERSION")
libcxx = f"{libcxx // 10000}.{libcxx // 100 % 100}.{libcxx % 100}"
mingw = ziglang / "lib/libc/include/any-windows-any/_mingw_mac.h"
mingw = ".".join(str(number(mingw, f"__MINGW64_VERSION_{part}")) for part in ("MAJOR", "MINOR", "BUGFIX"))
zig = subprocess.check_output([ziglang / "zig", "version"], text=True).strip()
everywhere = "in every library"
site = "on pages of the site"
vendored = "site/vendor/README.md"
wheels = "in wheels"
llvm = "Apache-2.0 WITH LLVM-exception"
components = [
    component("fmt", fmt, "MIT", everywhere, f"pkg:github/fmtlib/fmt@{fmt}"),
    component("boost", boost, "BSL-1.0", f"headers of Compute, Multiprecision and Uuid, {everywhere}"),
    component("opencl-headers", debian_version("opencl-headers"), "Apache-2.0", "in every library but that for JavaScript"),
    component("CLI11", debian_version("libcli11-dev"), "BSD-3-Clause", "in the command"),
    component("nlohmann_json", debian_version("nlohmann-json3-dev"), "MIT", "in the command"),
    component("fast_float", debian_version("libfast-float-dev"), "Apache-2.0 OR MIT", "in the command of wheels"),
    component("libc++", libcxx, llvm, wheels),
    component("libc++abi", libcxx, llvm, wheels),
    component("libunwind", libcxx, llvm, wheels),
    component("mingw-w64", mingw, "ZPL-2.1", "in the wheel for Windows"),
    component("delaunator", found(vendored, r"\[delaunator\]\S* ([\d.]+)"), "ISC", site),
    component("robust-predicates", found(vendored, r"\[robust-predicates\]\S* ([\d.]+)"), "Unlicense", site),
    component("mkdocs-material", found("site/requirements.txt", r"mkdocs-material==([\d.]+)"), "MIT", site),
    component("jquery", found("build/site/cpp/jquery.js", r"jQuery v([\d.]+)"), "MIT", site),
    component("zig compiler-rt", zig, "MIT", wheels, f"pkg:pypi/ziglang@{zig}"),
]
root = f"flaunay@{version}"
release = {
    "type": "library",
    "bom-ref": root,
    "name": "flaunay",
    "version": version,
    "licenses": [{"expression": "MIT"}],
    "properties": [{"name": "commit", "value": commit}],
    "components": [
        {
            "type": "file",
            "bom-ref": file.name,
            "name": file.name,
            "hashes": [{"alg": "SHA-256", "content": hashlib.sha256(file.read_bytes()).hexdigest()}],
        }
        for file in files
    ],
}
time = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
bom = {
    "bomFormat": "CycloneDX",
    "specVersion": "1.5",
    "serialNumber": uuid.uuid5(uuid.NAMESPACE_OID, f"flaunay {version} {commit}").urn,
    "version": 1,
    "metadata": {"timestamp": time.strftime("%Y-%m-%dT%H:%M:%SZ"), "component": release},
    "components": components,
    "dependencies": [{"ref": root, "dependsOn": [part["bom-ref"] for part in components]}],
}
json.dump(bom, sys.stdout, indent=2)
print()
