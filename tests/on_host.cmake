# What tests share, and those that need no device: they are also built for other platforms (tests/platforms).
set(TESTS ${PROJECT_SOURCE_DIR}/tests)
set(FLAUNAY_TEST_OBJECTS ""
    CACHE PATH "A build whose objects of tests this build links with its own libraries: they take long to compile")

# What only tests labelled nightly need.
add_custom_target(nightly)

# In `sources`, those of a target, in this folder; or its objects in the other build.
macro(flaunay_test_sources NAME)
  if(FLAUNAY_TEST_OBJECTS)
    file(STRINGS ${FLAUNAY_TEST_OBJECTS}/tests/${NAME}.objects sources)
  else()
    set(sources ${ARGN})
    list(TRANSFORM sources PREPEND ${TESTS}/ REGEX "^[^/]")
    file(GENERATE OUTPUT ${NAME}.objects CONTENT "$<JOIN:$<TARGET_OBJECTS:${NAME}>,\n>\n")
  endif()
endmacro()

# Compiling the tests takes longer than what their own loops take; the library that they test is as users have it. Those
# whose loops do take long keep frame pointers: without, sanitizers would keep a wrong stack, each time another one, of
# every allocation.
set(OPTIMISED -O1 -fno-omit-frame-pointer)

# What several programs of tests share.
function(flaunay_test_library NAME)
  flaunay_test_sources(${NAME} ${ARGN})
  add_library(${NAME} STATIC ${sources})
  set_target_properties(${NAME} PROPERTIES LINKER_LANGUAGE CXX)
  target_compile_options(${NAME} PRIVATE ${OPTIMISED})
endfunction()

# flaunay_test(NAME [WHOLE] [UNITY] [OPTIMISED] [NATIVE] [NIGHTLY] SOURCES ... LIBRARIES ... [LABELS ...]
#              [COST seconds] [ENVIRONMENT setting] [ON_DEVICE filter] [WHEN_SANITIZED filter]): a GoogleTest program whose
# tests CTest runs one by one; or with WHOLE, for those that share a device and its kernels, in one process. UNITY: its
# files share a namespace, and are compiled together. OPTIMISED: its own loops take longer than optimising them. NIGHTLY:
# scripts/attack.sh builds and runs it. WHEN_SANITIZED: what of it runs in a sanitized build, which is slow.
# NATIVE: on the host, whose kernels are those of devices; in a sanitized build only its Small suites, which reach the
# same code with the same kinds of input. ON_DEVICE: what of a NATIVE program is about devices, as NAME.device. COST: about
# how long it takes; the longest begin first.
function(flaunay_test NAME)
  cmake_parse_arguments(ARG "WHOLE;UNITY;OPTIMISED;NATIVE;NIGHTLY" "COST;ON_DEVICE;ENVIRONMENT;WHEN_SANITIZED" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  if(NOT FLAUNAY_SANITIZE)
    set(ARG_WHEN_SANITIZED "")
  elseif(ARG_NATIVE)
    set(ARG_WHEN_SANITIZED "Small*")
  endif()
  flaunay_test_sources(${NAME} ${ARG_SOURCES})
  add_executable(${NAME} ${sources})
  set_target_properties(${NAME} PROPERTIES LINKER_LANGUAGE CXX)
  # The library first, so that the linker takes from it what both have of headers: optimised, and sanitized.
  if(flaunay_core IN_LIST ARG_LIBRARIES AND NOT CMAKE_CROSSCOMPILING)
    target_link_options(${NAME} PRIVATE LINKER:--whole-archive $<TARGET_FILE:flaunay_core> LINKER:--no-whole-archive)
  endif()
  target_include_directories(${NAME} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${NAME} PRIVATE ${ARG_LIBRARIES} flaunay_options GTest::gtest_main $<TARGET_NAME_IF_EXISTS:OpenCL::OpenCL>
                                        $<$<BOOL:${CMAKE_CROSSCOMPILING}>:fmt::fmt>)
  target_compile_definitions(${NAME} PRIVATE FLAUNAY_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  if(WIN32)
    # For M_PI.
    target_compile_definitions(${NAME} PRIVATE _USE_MATH_DEFINES)
  endif()
  # Members that tests leave out are zero.
  set(optimisation -O0)
  if(ARG_OPTIMISED)
    set(optimisation ${OPTIMISED})
  endif()
  target_compile_options(${NAME} PRIVATE ${optimisation} -Wno-missing-field-initializers)
  if(NOT ARG_UNITY)
    set_target_properties(${NAME} PROPERTIES UNITY_BUILD OFF)
  endif()
  if(ARG_NIGHTLY)
    list(APPEND ARG_LABELS nightly)
    set_target_properties(${NAME} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_dependencies(nightly ${NAME})
  endif()
  # An emulator takes long to begin.
  if(ARG_WHOLE OR CMAKE_CROSSCOMPILING)
    set(FILTER "*-*ChoosesDevices*")
    if(ARG_WHEN_SANITIZED)
      set(FILTER ${ARG_WHEN_SANITIZED})
    endif()
    add_test(NAME ${NAME} COMMAND ${NAME} --gtest_brief=1 --gtest_filter=${FILTER})
    set_tests_properties(${NAME} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 1800)
    if(ARG_COST)
      set_tests_properties(${NAME} PROPERTIES COST ${ARG_COST})
    endif()
    if(ARG_NATIVE)
      set_tests_properties(${NAME} PROPERTIES ENVIRONMENT FLAUNAY_TEST_DEVICE=host)
    endif()
    if(ARG_ON_DEVICE AND NOT FLAUNAY_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
      add_test(NAME ${NAME}.device COMMAND ${NAME} --gtest_brief=1 --gtest_filter=${ARG_ON_DEVICE})
      set_tests_properties(${NAME}.device PROPERTIES LABELS devices TIMEOUT 1800 COST 60)
    endif()
  else()
    gtest_discover_tests(${NAME} DISCOVERY_TIMEOUT 60 TEST_FILTER "${ARG_WHEN_SANITIZED}"
                         PROPERTIES LABELS "${ARG_LABELS}" ENVIRONMENT "${ARG_ENVIRONMENT}")
  endif()
endfunction()

# What tests compare with; GMP stays here, out of the library.
flaunay_test_library(flaunay_test_support support/reference.cpp)
target_include_directories(flaunay_test_support PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(flaunay_test_support PUBLIC flaunay_options gmpxx gmp)
# The definition of constrained triangulations.
flaunay_test_library(flaunay_constrained_check constrained/check.cpp)
target_include_directories(flaunay_constrained_check PUBLIC ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(flaunay_constrained_check PUBLIC flaunay_verify flaunay_test_support GTest::gtest)

# The points that the fuzzer of the triangulation makes, and how it shrinks those that fail.
flaunay_test_library(flaunay_fuzz fuzz/degenerate.cpp fuzz/minimise.cpp)
target_include_directories(flaunay_fuzz PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(flaunay_fuzz PUBLIC flaunay_io PRIVATE fmt::fmt)

# Without a device.
flaunay_test(
  test_fuzz
  SOURCES fuzz/minimise_test.cpp
  LIBRARIES flaunay_fuzz flaunay_core flaunay_host_modes flaunay_verify flaunay_test_support
  LABELS asan)
flaunay_test(
  test_host_modes UNITY
  WHEN_SANITIZED -RecursiveHull.Fixtures:Recursive.VariantsAgreeOnManyPoints:RecursiveCounts.*:VerifyChunksAccepts.AllDistributions
  SOURCES dwyer/dwyer_test.cpp
          geometry/areas_test.cpp
          geometry/mesh_test.cpp
          geometry/planar_test.cpp
          geometry/sort_test.cpp
          partition/regions_test.cpp
          recursive/recursive_test.cpp
          statistics/counting_test.cpp
          verify/chunks_test.cpp
          verify/verify_test.cpp
  LIBRARIES flaunay_core flaunay_host_modes flaunay_io flaunay_verify flaunay_test_support
  LABELS asan)
# It has kernels' text with types of its own.
set_source_files_properties(${TESTS}/statistics/counting_test.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
# The predicates in fixed point, as several devices would compute them.
set(FIXED_POINT_READINGS ${TESTS}/support/fixed_point_direct.cpp ${TESTS}/support/fixed_point_contracted.cpp)
set_source_files_properties(${FIXED_POINT_READINGS} PROPERTIES COMPILE_OPTIONS -frounding-math)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set_source_files_properties(${TESTS}/support/fixed_point_contracted.cpp PROPERTIES COMPILE_OPTIONS
                                                                            "-frounding-math;-mfma;-ffp-contract=fast;-O2")
endif()
# A library, so that its objects are sanitized.
add_library(flaunay_fixed_point_readings STATIC EXCLUDE_FROM_ALL ${FIXED_POINT_READINGS})
set_target_properties(flaunay_fixed_point_readings PROPERTIES UNITY_BUILD OFF)
target_include_directories(flaunay_fixed_point_readings PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(flaunay_fixed_point_readings PUBLIC flaunay_core flaunay_test_support)
target_compile_options(flaunay_fixed_point_readings PRIVATE $<$<CONFIG:Release>:-O1>)
flaunay_test(
  test_fixed_point WHOLE OPTIMISED
  WHEN_SANITIZED Small*-SmallFixedPoint.Circles:SmallFixedCertify.IsNeverWrong
  COST 10
  SOURCES geometry/fixed_certify_test.cpp geometry/fixed_point_test.cpp support/double_certificates.cpp
  LIBRARIES flaunay_fixed_point_readings flaunay_core flaunay_host_modes flaunay_io flaunay_test_support
  LABELS asan)
flaunay_test(
  test_constrained UNITY
  WHEN_SANITIZED -NastySegments.*:CrossingPairs.AllKindsOfSegments:Constrained.*OfOtherTriangulations:Constrained.OneSegmentThroughEverything:Split.Large*:Split.ManySegments
  SOURCES constrained/constrained_test.cpp constrained/pairs_test.cpp constrained/refinement_bounds_test.cpp
          constrained/split_test.cpp constrained/verify_test.cpp
  LIBRARIES flaunay_core flaunay_host_modes flaunay_io flaunay_constrained_check
  LABELS asan)
flaunay_test(
  test_io UNITY
  SOURCES io/io_test.cpp io/generate_test.cpp io/map_test.cpp io/stream_test.cpp
  LIBRARIES flaunay_io flaunay_core fmt::fmt nlohmann_json::nlohmann_json
  LABELS asan)
if(FLAUNAY_GDAL)
  flaunay_test(
    test_geotiff
    SOURCES io/geotiff_test.cpp
    LIBRARIES flaunay_io fmt::fmt GDAL::GDAL)
endif()
# These compare with a device: Wine finds those of this system, QEMU none. What is kept for one has the files of POSIX.
if(WIN32 OR NOT CMAKE_CROSSCOMPILING)
  set(NATIVE_TESTS call/native_test.cpp host/threads_test.cpp)
  if(NOT WIN32)
    list(APPEND NATIVE_TESTS host/program_cache_test.cpp)
  endif()
  flaunay_test(
    test_native WHOLE UNITY
    WHEN_SANITIZED -SmallNative.*AsOnADevice
    SOURCES ${NATIVE_TESTS}
    LIBRARIES flaunay_core flaunay_host flaunay_io
    LABELS asan)
endif()

# Its first test calls all functions that flaunay.h declares.
file(READ ${PROJECT_SOURCE_DIR}/src/include/flaunay/flaunay.h HEADER)
string(REGEX REPLACE "//[^\n]*|\n" " " HEADER "${HEADER}")
string(REPLACE ";" "\n" HEADER "${HEADER}")
string(REGEX MATCHALL "FLAUNAY_API [^\n]*" DECLARATIONS "${HEADER}")
list(TRANSFORM DECLARATIONS REPLACE ".* \\*?(flaunay_[a-z_]+)\\((.*)\\)" "FUNCTION(\\1, \"\\2\")")
list(JOIN DECLARATIONS "\n" DECLARATIONS)
file(CONFIGURE OUTPUT functions/flaunay_functions.inc CONTENT "${DECLARATIONS}\n" @ONLY)
flaunay_test(
  test_arguments
  SOURCES call/arguments_test.cpp
  LIBRARIES flaunay::flaunay
  LABELS asan)
target_include_directories(test_arguments PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/functions)
