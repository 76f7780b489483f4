"""The recipe for Conan 2, which builds the source tree that it lies in: conan create packaging/conan"""

import re
from pathlib import Path

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy


class Flaunay(ConanFile):
    name = "flaunay"
    license = "MIT"
    description = "Exact Delaunay triangulations, meshes and maps, on any CPU at once and on any OpenCL GPU"
    topics = ("geometry", "delaunay", "triangulation", "voronoi", "opencl")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    default_options = {"shared": False, "boost/*:header_only": True, "fmt/*:header_only": True}

    def set_version(self):
        text = (Path(self.recipe_folder).parents[1] / "CMakeLists.txt").read_text()
        self.version = re.search(r"VERSION ([0-9.]+)\n", text).group(1)

    def export_sources(self):
        source = Path(self.recipe_folder).parents[1]
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "docs/Doxyfile.in", "host/*", "kernels/*", "src/*"):
            copy(self, pattern, source, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        # Compiled in; users of flaunay need none of them.
        for library in ("boost/[>=1.74]", "fmt/[>=9]", "opencl-headers/[>=2022.09.30]"):
            self.requires(library, visible=False, libs=False, headers=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("COMMAND", "BENCH", "TESTS"):
            toolchain.cache_variables[f"FLAUNAY_{part}"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build(target="flaunay")

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, str(Path(self.package_folder) / "licenses"))

    def package_info(self):
        # flaunay's own files for CMake are used.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append("lib/cmake/flaunay")
        self.cpp_info.set_property("pkg_config_name", "flaunay")
        self.cpp_info.libs = ["flaunay"]
        if not self.options.shared:
            self.cpp_info.defines = ["FLAUNAY_STATIC"]
            if self.settings.os in ("Linux", "FreeBSD"):
                self.cpp_info.system_libs = ["m", "dl", "pthread"]
