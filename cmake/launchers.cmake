# cmake -DDIRECTORY=kernels -DFILE=flattened/cut.cl -DPROGRAM=flattened/cut -DOUTPUT=launchers/flattened/cut.cl.hpp
#       [-DNATIVE_OUTPUT=native/flattened/cut.cpp [-DCOUNTING_OUTPUT=native/counting/flattened/cut.cpp]]
#       -P launchers.cmake
#
# Writes a C++ header with a struct per kernel of the file: a member per argument, of the argument's type and name. Runtime
# (host/runtime.hpp) launches these structs, so that a wrong, missing or unknown argument does not compile. PROGRAM is the
# file that is built: the file itself, or the one that includes it.
#
# It understands the forms that our kernel files use: signatures `kernel void name(arguments)` without macros other than
# COUNTERS (operations/counters.h), which Runtime sets, ARG_REDUCE_ARGUMENTS (operations/segmented_arg_reduce.h) and the
# lists of arguments of headers named arguments.h, which become structs.
#
# With NATIVE_OUTPUT it also writes a C++ file that compiles the kernels for the host (host/native/opencl.hpp), and with
# COUNTING_OUTPUT another one, of those that count (operations/counters.h).
cmake_policy(VERSION 3.25)

# The launch sets the number of elements and the size of a chunk; Runtime::arg_reduce sets the reduction's others.
set(LEADING_PerElement n)
set(LEADING_PerChunk n chunk)
set(ARG_REDUCE_MEMBERS "global const int* segment, global int* result, ")

set(CPP_int cl_int)
set(CPP_uint cl_uint)
set(CPP_int64 cl_long)
set(CPP_uint64 cl_ulong)
set(CPP_uchar cl_uchar)
set(CPP_float cl_float)
set(CPP_double cl_double)
set(CPP_int2 cl_int2)
set(CPP_int4 cl_int4)
set(CPP_uint2 cl_uint2)
set(CPP_uint8 cl_uint8)
set(CPP_double2 cl_double2)
# Of arithmetic/numbers.h; in fixed point they are 64-bit integers, of as many bytes.
set(CPP_coordinate cl_double)
set(CPP_coordinate2 cl_double2)
set(CPP_filter_bound cl_float)
set(CPP_double_bits cl_ulong)
set(CPP_float_bits cl_uint)
# The vector types of kernels.
set(CPP_keyed cl_ulong)

# Sets ${RESULT} to the C++ type of a kernel's type. Types that are not listed are structs of the headers named records.h
# that the file includes.
function(cpp_type TYPE RESULT)
  if(DEFINED CPP_${TYPE})
    set(${RESULT} ${CPP_${TYPE}} PARENT_SCOPE)
  else()
    set(${RESULT} kernel::${TYPE} PARENT_SCOPE)
  endif()
endfunction()

# Sets TYPES and NAMES to those of the members for arguments, whose text is separated by commas.
function(read_arguments NAME ARGUMENTS)
  string(REGEX REPLACE "[ \n]+" " " ARGUMENTS "${ARGUMENTS}")
  string(REGEX REPLACE " ?COUNTERS" "" ARGUMENTS "${ARGUMENTS}")
  string(REGEX REPLACE " (restrict|volatile)" "" ARGUMENTS "${ARGUMENTS}")
  string(REPLACE "," ";" ARGUMENTS "${ARGUMENTS}")
  set(TYPES "")
  set(NAMES "")
  foreach(ARGUMENT IN LISTS ARGUMENTS)
    string(STRIP "${ARGUMENT}" ARGUMENT)
    if(ARGUMENT MATCHES "^global const ([a-z_0-9]+)\\* ?([a-z_0-9]+)$")
      cpp_type(${CMAKE_MATCH_1} TYPE)
      list(APPEND TYPES "host::In<${TYPE}>")
    elseif(ARGUMENT MATCHES "^global ([a-z_0-9]+)\\* ?([a-z_0-9]+)$")
      cpp_type(${CMAKE_MATCH_1} TYPE)
      list(APPEND TYPES "host::Out<${TYPE}>")
    elseif(ARGUMENT MATCHES "^list ([A-Z_]+) ?([a-z_]*)$")
      set(PREFIX "${CMAKE_MATCH_2}")
      string(TOLOWER ${CMAKE_MATCH_1} TYPE)
      list(APPEND TYPES "kernels::${TYPE}")
      if(PREFIX STREQUAL "")
        set(PREFIX ${TYPE})
      endif()
      string(REGEX REPLACE "_$" "" PREFIX ${PREFIX})
      list(APPEND NAMES ${PREFIX})
      continue()
    elseif(ARGUMENT MATCHES "^([a-z_0-9]+) ([a-z_0-9]+)$")
      cpp_type(${CMAKE_MATCH_1} TYPE)
      list(APPEND TYPES "host::Value<${TYPE}>")
    else()
      message(FATAL_ERROR "${DIRECTORY}/${FILE}: kernel ${NAME} has an argument that cannot be read: '${ARGUMENT}'")
    endif()
    list(APPEND NAMES ${CMAKE_MATCH_2})
  endforeach()
  set(TYPES "${TYPES}" PARENT_SCOPE)
  set(NAMES "${NAMES}" PARENT_SCOPE)
endfunction()

# Appends a struct for a list of arguments to LISTS, unless another launcher header has it.
function(append_list LIST ARGUMENTS)
  read_arguments(${LIST} "${ARGUMENTS}")
  string(TOLOWER ${LIST} STRUCT)
  set(MEMBERS "")
  set(VISITS "")
  foreach(TYPE MEMBER IN ZIP_LISTS TYPES NAMES)
    string(APPEND MEMBERS "  ${TYPE} ${MEMBER};\n")
    string(APPEND VISITS "    visit(${MEMBER});\n")
  endforeach()
  string(CONCAT STRUCT
    "\n#ifndef FLAUNAY_LIST_${LIST}\n#define FLAUNAY_LIST_${LIST}\n"
    "struct ${STRUCT} {\n${MEMBERS}\n"
    "  template <typename Visit>\n"
    "  void for_each_argument(const Visit& visit) const {\n${VISITS}  }\n};\n#endif\n")
  set(LISTS "${LISTS}${STRUCT}" PARENT_SCOPE)
endfunction()

# Appends the launcher of a kernel to CODE. ARGUMENTS: the text of the arguments, separated by commas.
function(append_launcher NAME ARGUMENTS)
  set(COUNTS FALSE)
  if(ARGUMENTS MATCHES "COUNTERS")
    set(COUNTS TRUE)
  endif()
  if(ARGUMENTS MATCHES "^ARG_REDUCE_ARGUMENTS,(.*)")
    set(FORM ArgReduce)
    read_arguments(${NAME} "${ARG_REDUCE_MEMBERS}${CMAKE_MATCH_1}")
  else()
    set(FORM Plain)
    read_arguments(${NAME} "${ARGUMENTS}")
    foreach(CANDIDATE PerElement PerChunk)
      list(LENGTH LEADING_${CANDIDATE} COUNT)
      list(SUBLIST NAMES 0 ${COUNT} FIRST)
      if(FIRST STREQUAL "${LEADING_${CANDIDATE}}")
        set(FORM ${CANDIDATE})
      endif()
    endforeach()
    foreach(LEADING IN LISTS LEADING_${FORM})
      list(POP_FRONT TYPES)
      list(POP_FRONT NAMES)
    endforeach()
  endif()
  set(MEMBERS "")
  set(VISITS "")
  foreach(TYPE MEMBER IN ZIP_LISTS TYPES NAMES)
    string(APPEND MEMBERS "  ${TYPE} ${MEMBER};\n")
    if(TYPE MATCHES "^kernels::")
      string(APPEND VISITS "    ${MEMBER}.for_each_argument(visit);\n")
    elseif(NOT FORM STREQUAL "ArgReduce" OR NOT MEMBER MATCHES "^(segment|result)$")
      string(APPEND VISITS "    visit(${MEMBER});\n")
    endif()
  endforeach()
  set(NATIVE_DECLARATION "")
  set(NATIVE_FUNCTIONS "")
  if(NATIVE_OUTPUT)
    set(NATIVE_FUNCTIONS ", native::${NAME}")
    set(NATIVE_SIGNATURE "void ${NAME}(host::WorkItems items, void* const* arguments)")
    set(NATIVE_DECLARATION "namespace native {\n${NATIVE_SIGNATURE};\n}\n")
    set(FUNCTION "${NATIVE_SIGNATURE} {\n  kernel::run_work_items<kernel::${NAME}>(items, arguments);\n}\n")
    set(NATIVE_CODE "${NATIVE_CODE}${FUNCTION}" PARENT_SCOPE)
    if(COUNTS AND COUNTING_OUTPUT)
      string(APPEND NATIVE_FUNCTIONS ", counting::${NAME}")
      string(APPEND NATIVE_DECLARATION "namespace counting {\n${NATIVE_SIGNATURE};\n}\n")
      set(COUNTING_CODE "${COUNTING_CODE}${FUNCTION}" PARENT_SCOPE)
    endif()
  endif()
  string(CONCAT LAUNCHER
    "\n${NATIVE_DECLARATION}/// See kernel ${NAME} in kernels/${FILE}.\n"
    "struct ${NAME} {\n"
    "  static constexpr host::KernelName kernel_name{\"${PROGRAM}\", \"${NAME}\"${NATIVE_FUNCTIONS}};\n"
    "  static constexpr host::Form form = host::Form::${FORM};\n"
    "${MEMBERS}\n"
    "  template <typename Visit>\n"
    "  void for_each_argument([[maybe_unused]] const Visit& visit) const {\n${VISITS}  }\n"
    "};\n")
  set(CODE "${CODE}${LAUNCHER}" PARENT_SCOPE)
endfunction()

file(READ ${DIRECTORY}/${FILE} TEXT)
string(REGEX REPLACE "//[^\n]*" "" TEXT "${TEXT}")
# Semicolons separate the elements of CMake's lists, so they are replaced.
string(REPLACE ";" " " TEXT "${TEXT}")
string(REGEX REPLACE "[][]" " " TEXT "${TEXT}")
set(LISTS "")
file(STRINGS ${DIRECTORY}/${FILE} INCLUDES REGEX "^#include \".*/arguments.h\"")
foreach(INCLUDE IN LISTS INCLUDES)
  string(REGEX REPLACE "^#include \"(.*)\"$" "\\1" INCLUDE "${INCLUDE}")
  file(READ ${DIRECTORY}/${INCLUDE} MACROS)
  string(REGEX REPLACE "[\\]\n" " " MACROS "${MACROS}")
  string(REPLACE "PREFIX##" "" MACROS "${MACROS}")
  string(REGEX MATCHALL "#define [A-Z_]+\\(PREFIX\\)[^\n]*" MACROS "${MACROS}")
  foreach(MACRO IN LISTS MACROS)
    string(REGEX MATCH "#define ([A-Z_]+)\\(PREFIX\\)(.*)" MACRO "${MACRO}")
    set(LIST ${CMAKE_MATCH_1})
    set(ARGUMENTS "${CMAKE_MATCH_2}")
    if(TEXT MATCHES "[^A-Z_]${LIST}\\(")
      append_list(${LIST} "${ARGUMENTS}")
      string(REGEX REPLACE "([^A-Z_])${LIST}\\(([a-z_]*)\\)" "\\1list ${LIST} \\2" TEXT "${TEXT}")
    endif()
  endforeach()
endforeach()
string(REGEX MATCHALL "kernel void [a-z_0-9]+\\([^)]*\\)" SIGNATURES "${TEXT}")
set(CODE "")
set(NATIVE_CODE "")
set(COUNTING_CODE "")
foreach(SIGNATURE IN LISTS SIGNATURES)
  if(SIGNATURE MATCHES "kernel void ([a-z_0-9]+)\\(([^)]*)\\)")
    append_launcher(${CMAKE_MATCH_1} "${CMAKE_MATCH_2}")
  endif()
endforeach()

file(STRINGS ${DIRECTORY}/${FILE} RECORDS REGEX "^#include \".*/records.h\"")
list(JOIN RECORDS "\n" RECORDS)
string(APPEND RECORDS "\n")
string(CONCAT HEADER
  "// Made from kernels/${FILE} when the library was built; see cmake/launchers.cmake.\n"
  "#pragma once\n\n"
  "#include \"host/launch/kernel_arguments.hpp\"\n${RECORDS}\n"
  "namespace flaunay::kernels {\n${LISTS}${CODE}\n}  // namespace flaunay::kernels\n")
# Written only if it has changed, so that files that include it are compiled again only if a signature changed.
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${HEADER}" @ONLY)

if(NATIVE_OUTPUT)
  # The shared headers come first, as they have namespaces of their own, and before them what the file defines for them.
  string(FIND "${TEXT}" "\n#include" LENGTH)
  set(HEAD "")
  if(LENGTH GREATER 0)
    string(SUBSTRING "${TEXT}" 0 ${LENGTH} HEAD)
  endif()
  string(REGEX REPLACE "\n+" "\n" HEAD "${HEAD}\n")
  set(HEADERS "")
  set(FILES ${FILE})
  while(FILES)
    list(POP_FRONT FILES CURRENT)
    file(STRINGS ${DIRECTORY}/${CURRENT} INCLUDES REGEX "^#include \"")
    foreach(INCLUDE IN LISTS INCLUDES)
      string(REGEX REPLACE "^#include \"(.*)\"$" "\\1" INCLUDED "${INCLUDE}")
      if(INCLUDED MATCHES "\\.cl$")
        list(APPEND FILES ${INCLUDED})
      elseif(NOT INCLUDED IN_LIST HEADERS)
        list(APPEND HEADERS ${INCLUDED})
      endif()
    endforeach()
  endwhile()
  list(TRANSFORM HEADERS REPLACE "(.+)" "#include \"\\1\"\n")
  string(CONCAT HEADERS ${HEADERS} "")
  set(MADE_FROM "// Made from kernels/${FILE} when the library was built; see cmake/launchers.cmake.\n")
  string(CONCAT NATIVE
    "#include \"host/native/opencl.hpp\"\n"
    "${HEAD}${HEADERS}\n"
    "namespace flaunay::kernel {\n"
    "#include \"host/native/words.h\"\n#include \"${FILE}\"\n#include \"host/native/end_of_words.h\"\n"
    "}\n\n"
    "namespace flaunay::kernels::")
  file(CONFIGURE OUTPUT ${NATIVE_OUTPUT} CONTENT "${MADE_FROM}${NATIVE}native {\n${NATIVE_CODE}}\n" @ONLY)
  if(COUNTING_OUTPUT)
    string(CONCAT COUNTING "${MADE_FROM}#define FLAUNAY_COUNT\n${NATIVE}counting {\n${COUNTING_CODE}}\n")
    file(CONFIGURE OUTPUT ${COUNTING_OUTPUT} CONTENT "${COUNTING}" @ONLY)
  endif()
endif()
