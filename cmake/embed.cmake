# cmake -DOUTPUT=embedded.cpp -DDIRECTORY=kernels "-DFILES=a.cl;blocks/b.h" -P embed.cmake
set(CODE "#include \"kernels/embedded.hpp\"\n\nnamespace flaunay {\nnamespace {\n")
set(TABLE "")
set(INDEX 0)
foreach(FILE IN LISTS FILES)
  # Without comments, which are a quarter, but on the same lines, which errors name.
  file(READ ${DIRECTORY}/${FILE} TEXT)
  string(REGEX REPLACE "[ \t]*//[^\n]*" "" TEXT "${TEXT}")
  string(HEX "${TEXT}" HEX)
  string(LENGTH "${HEX}" LENGTH)
  math(EXPR SIZE "${LENGTH} / 2")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," BYTES "${HEX}")
  string(APPEND CODE "const unsigned char file_${INDEX}[] = {${BYTES}0};\n")
  string(APPEND TABLE "      {\"${FILE}\", reinterpret_cast<const char*>(file_${INDEX}), ${SIZE}},\n")
  math(EXPR INDEX "${INDEX} + 1")
endforeach()
string(APPEND CODE "}  // namespace\n\nconst std::vector<EmbeddedFile>& embedded_kernels() {\n"
                   "  static const std::vector<EmbeddedFile> files = {\n${TABLE}  };\n  return files;\n}\n\n"
                   "}  // namespace flaunay\n")
file(WRITE ${OUTPUT} "${CODE}")
