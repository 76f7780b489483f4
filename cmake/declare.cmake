# flaunay_declare(FILES...) writes what another language knows of the C interface, in the current folder of the build.
find_package(Python3 COMPONENTS Interpreter REQUIRED)
function(flaunay_declare)
  set(SCRIPT ${PROJECT_SOURCE_DIR}/scripts/declare.py)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_BINARY_DIR}/ OUTPUT_VARIABLE OUTPUTS)
  set(HEADERS ${PROJECT_SOURCE_DIR}/src/include/flaunay/flaunay.h ${PROJECT_SOURCE_DIR}/src/include/flaunay/result_arrays.hpp)
  add_custom_command(
    OUTPUT ${OUTPUTS}
    COMMAND Python3::Interpreter ${SCRIPT} ${HEADERS} ${OUTPUTS}
    DEPENDS ${SCRIPT} ${HEADERS})
endfunction()
