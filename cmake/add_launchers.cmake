# flaunay_add_launchers(TARGET DIRECTORY OUTPUT FILES files... [NATIVE files... NATIVE_OUTPUT folder]) adds a target that
# generates a C++ header with launchers for each kernel file of the directory: OUTPUT/flattened/cut.cl.hpp for
# flattened/cut.cl. If another kernel file includes the file, that one is its program. For those of NATIVE, it also
# generates C++ files that compile the kernels for the host, such as NATIVE_OUTPUT/blocks/mesh.cpp, and such as
# NATIVE_OUTPUT/counting/blocks/mesh.cpp if there are kernels that count. Kernels of one name in
# two files are an error: their launchers would be structs of one name, which the linker mixes up without a word. So are
# lists of arguments of one name in two headers named arguments.h.
function(flaunay_add_launchers TARGET DIRECTORY OUTPUT)
  cmake_parse_arguments(PARSE_ARGV 3 GIVEN "" "NATIVE_OUTPUT" "FILES;NATIVE")
  foreach(FILE IN LISTS GIVEN_FILES)
    file(STRINGS ${DIRECTORY}/${FILE} INCLUDES REGEX "^#include \".*\\.cl\"")
    foreach(INCLUDE IN LISTS INCLUDES)
      string(REGEX REPLACE "^#include \"(.*)\"$" "\\1" INCLUDED "${INCLUDE}")
      string(REGEX REPLACE "\\.cl$" "" PROGRAM_OF_${INCLUDED} ${FILE})
      list(APPEND INCLUDED_BY_${FILE} ${DIRECTORY}/${INCLUDED})
    endforeach()
  endforeach()
  foreach(FILE IN LISTS GIVEN_FILES)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${DIRECTORY}/${FILE})
    file(STRINGS ${DIRECTORY}/${FILE} KERNELS REGEX "kernel void [a-z_0-9]+\\(")
    foreach(KERNEL IN LISTS KERNELS)
      string(REGEX REPLACE ".*kernel void ([a-z_0-9]+)\\(.*" "\\1" KERNEL "${KERNEL}")
      get_property(OTHER GLOBAL PROPERTY FLAUNAY_FILE_OF_${KERNEL})
      if(OTHER)
        message(FATAL_ERROR "${DIRECTORY}: ${FILE} and ${OTHER} both have a kernel ${KERNEL}")
      endif()
      set_property(GLOBAL PROPERTY FLAUNAY_FILE_OF_${KERNEL} ${FILE})
    endforeach()
  endforeach()
  set(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/launchers.cmake)
  file(GLOB LISTS CONFIGURE_DEPENDS ${DIRECTORY}/*/arguments.h)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${LISTS})
  foreach(HEADER IN ITEMS ${LISTS})
    file(READ ${HEADER} TEXT)
    string(REGEX MATCHALL "#define [A-Z_]+\\(" NAMES "${TEXT}")
    foreach(NAME IN LISTS NAMES)
      if(DEFINED HEADER_OF_${NAME})
        message(FATAL_ERROR "${HEADER} and ${HEADER_OF_${NAME}} both have a list of arguments: ${NAME}PREFIX)")
      endif()
      set(HEADER_OF_${NAME} ${HEADER})
    endforeach()
  endforeach()
  set(LAUNCHERS "")
  set(NATIVE_SOURCES "")
  foreach(FILE IN LISTS GIVEN_FILES)
    if(DEFINED PROGRAM_OF_${FILE})
      set(PROGRAM ${PROGRAM_OF_${FILE}})
    else()
      string(REGEX REPLACE "\\.cl$" "" PROGRAM ${FILE})
    endif()
    set(NATIVE_ARGUMENT "")
    set(NATIVE_FILE "")
    if(FILE IN_LIST GIVEN_NATIVE)
      string(REGEX REPLACE "\\.cl$" ".cpp" NATIVE_FILE ${GIVEN_NATIVE_OUTPUT}/${FILE})
      set(NATIVE_ARGUMENT -DNATIVE_OUTPUT=${NATIVE_FILE})
      file(READ ${DIRECTORY}/${FILE} TEXT)
      # No function that library.js calls counts.
      if(TEXT MATCHES "COUNTERS" AND (FLAUNAY_COMMAND OR NOT EMSCRIPTEN))
        string(REGEX REPLACE "\\.cl$" ".cpp" COUNTING_FILE ${GIVEN_NATIVE_OUTPUT}/counting/${FILE})
        list(APPEND NATIVE_ARGUMENT -DCOUNTING_OUTPUT=${COUNTING_FILE})
        list(APPEND NATIVE_FILE ${COUNTING_FILE})
      endif()
      list(APPEND NATIVE_SOURCES ${NATIVE_FILE})
    endif()
    add_custom_command(
      OUTPUT ${OUTPUT}/${FILE}.hpp ${NATIVE_FILE}
      COMMAND ${CMAKE_COMMAND} -DDIRECTORY=${DIRECTORY} -DFILE=${FILE} -DPROGRAM=${PROGRAM}
              -DOUTPUT=${OUTPUT}/${FILE}.hpp ${NATIVE_ARGUMENT} -P ${SCRIPT}
      DEPENDS ${DIRECTORY}/${FILE} ${INCLUDED_BY_${FILE}} ${LISTS} ${SCRIPT}
      VERBATIM)
    list(APPEND LAUNCHERS ${OUTPUT}/${FILE}.hpp)
  endforeach()
  add_custom_target(${TARGET} DEPENDS ${LAUNCHERS})
  set_property(TARGET ${TARGET} PROPERTY FLAUNAY_NATIVE_SOURCES ${NATIVE_SOURCES})
endfunction()

# flaunay_use_launchers(LIBRARY TARGET) lets a library call the kernels of flaunay_add_launchers, and compiles those for
# the host into it. To be called in the same folder.
function(flaunay_use_launchers LIBRARY TARGET)
  add_dependencies(${LIBRARY} ${TARGET})
  target_include_directories(${LIBRARY} PUBLIC ${CMAKE_CURRENT_BINARY_DIR})
  get_property(SOURCES TARGET ${TARGET} PROPERTY FLAUNAY_NATIVE_SOURCES)
  target_sources(${LIBRARY} PRIVATE ${SOURCES})
  # Each has static functions of its own, whose names may be the same. Not every kernel with a list of arguments uses
  # all of them.
  set_source_files_properties(${SOURCES} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set(OPTIONS -Wno-unused-parameter)
  if(EMSCRIPTEN)
    # The rest of a module is compiled for its size.
    list(APPEND OPTIONS -O3)
  elseif(FLAUNAY_SANITIZE)
    list(APPEND OPTIONS -O1 -fsanitize=null,alignment)
  endif()
  set_property(SOURCE ${SOURCES} PROPERTY COMPILE_OPTIONS ${OPTIONS})
  if(FLAUNAY_SANITIZE)
    # The same kernels once more, on little input.
    list(FILTER SOURCES INCLUDE REGEX "/counting/")
    set_property(SOURCE ${SOURCES} APPEND PROPERTY COMPILE_OPTIONS -O0)
  endif()
endfunction()
