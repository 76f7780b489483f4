# flaunay_list_members(OUTPUT) writes, for src/c/members.hpp, the members of each struct of flaunay.h, but for reserved ones:
# FLAUNAY_STRUCT(name, FLAUNAY_MEMBER(member)...), without `flaunay_`.
function(flaunay_list_members OUTPUT)
  set(HEADER ${PROJECT_SOURCE_DIR}/src/include/flaunay/flaunay.h)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${HEADER})
  file(READ ${HEADER} TEXT)
  string(REGEX REPLACE "//[^\n]*" "" TEXT "${TEXT}")
  # Semicolons separate the elements of CMake's lists, and brackets quote them.
  string(REGEX REPLACE "(\\[[0-9]+\\])?;" " END " TEXT "${TEXT}")
  string(REGEX REPLACE "[ \n]+" " " TEXT "${TEXT}")
  set(STRUCTS "")
  string(REGEX MATCHALL "typedef struct flaunay_[a-z_]+ {[^}]*}" BODIES "${TEXT}")
  foreach(BODY IN LISTS BODIES)
    string(REGEX MATCH "flaunay_([a-z_]+) {" NAME "${BODY}")
    set(NAME ${CMAKE_MATCH_1})
    # A function's name stands in parentheses, before its arguments.
    string(REGEX REPLACE "\\(\\*([a-z_]+)\\)\\([^)]*\\)" "\\1" BODY "${BODY}")
    string(REGEX MATCHALL "[a-z0-9_]+ END" MEMBERS "${BODY}")
    list(TRANSFORM MEMBERS REPLACE "(.+) END" "FLAUNAY_MEMBER(\\1)")
    list(REMOVE_ITEM MEMBERS "FLAUNAY_MEMBER(reserved)")
    list(JOIN MEMBERS " " MEMBERS)
    string(APPEND STRUCTS "FLAUNAY_STRUCT(${NAME}, ${MEMBERS})\n")
  endforeach()
  # Written only if it has changed.
  file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${STRUCTS}" @ONLY)
endfunction()
