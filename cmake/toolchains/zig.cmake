# Another system, by the compiler of PyPI's package ziglang, which brings the C library, in the oldest version that is to
# do, and the standard library of C++:
#   cmake --toolchain cmake/toolchains/zig.cmake -DFLAUNAY_ZIG=PROGRAM -DFLAUNAY_ZIG_TARGET=x86_64-linux-gnu.2.28
# Targets are PROCESSOR-SYSTEM-ABI, as the program lists them.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FLAUNAY_ZIG FLAUNAY_ZIG_TARGET)
string(REPLACE "-" ";" ZIG_TARGET_PARTS ${FLAUNAY_ZIG_TARGET})
list(GET ZIG_TARGET_PARTS 0 CMAKE_SYSTEM_PROCESSOR)
list(GET ZIG_TARGET_PARTS 1 ZIG_SYSTEM)
set(CMAKE_SYSTEM_NAME Linux)
if(ZIG_SYSTEM STREQUAL "windows")
  set(CMAKE_SYSTEM_NAME Windows)
elseif(ZIG_SYSTEM MATCHES "^macos")
  set(CMAKE_SYSTEM_NAME Darwin)
  # No tool here changes the paths in a library when it is installed.
  set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
endif()
set(CMAKE_C_COMPILER ${FLAUNAY_ZIG} cc)
set(CMAKE_CXX_COMPILER ${FLAUNAY_ZIG} c++)
foreach(LANGUAGE C CXX)
  set(CMAKE_${LANGUAGE}_COMPILER_TARGET ${FLAUNAY_ZIG_TARGET})
  set(CMAKE_${LANGUAGE}_ARCHIVE_CREATE "${FLAUNAY_ZIG} ar qc <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_${LANGUAGE}_ARCHIVE_APPEND "${FLAUNAY_ZIG} ar q <TARGET> <LINK_FLAGS> <OBJECTS>")
  set(CMAKE_${LANGUAGE}_ARCHIVE_FINISH "${FLAUNAY_ZIG} ranlib <TARGET>")
endforeach()
