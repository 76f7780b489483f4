# flaunay_add_launchers(TARGET DIRECTORY OUTPUT FILES...) adds a target that generates a C++ header with launchers for
# each kernel file of the directory: OUTPUT/flattened/cut.cl.hpp for flattened/cut.cl. If another kernel file includes
# the file, that one is its program.
function(flaunay_add_launchers TARGET DIRECTORY OUTPUT)
  foreach(FILE IN LISTS ARGN)
    file(STRINGS ${DIRECTORY}/${FILE} INCLUDES REGEX "^#include \".*\\.cl\"")
    foreach(INCLUDE IN LISTS INCLUDES)
      string(REGEX REPLACE "^#include \"(.*)\"$" "\\1" INCLUDED "${INCLUDE}")
      string(REGEX REPLACE "\\.cl$" "" PROGRAM_OF_${INCLUDED} ${FILE})
    endforeach()
  endforeach()
  set(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/launchers.cmake)
  set(LAUNCHERS "")
  foreach(FILE IN LISTS ARGN)
    if(DEFINED PROGRAM_OF_${FILE})
      set(PROGRAM ${PROGRAM_OF_${FILE}})
    else()
      string(REGEX REPLACE "\\.cl$" "" PROGRAM ${FILE})
    endif()
    add_custom_command(
      OUTPUT ${OUTPUT}/${FILE}.hpp
      COMMAND ${CMAKE_COMMAND} -DDIRECTORY=${DIRECTORY} -DFILE=${FILE} -DPROGRAM=${PROGRAM}
              -DOUTPUT=${OUTPUT}/${FILE}.hpp -P ${SCRIPT}
      DEPENDS ${DIRECTORY}/${FILE} ${SCRIPT}
      VERBATIM)
    list(APPEND LAUNCHERS ${OUTPUT}/${FILE}.hpp)
  endforeach()
  add_custom_target(${TARGET} DEPENDS ${LAUNCHERS})
endfunction()
