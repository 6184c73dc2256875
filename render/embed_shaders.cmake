# Writes OUTPUT, a C++ source with the shaders as raw strings (shaderText of shader_text.h).
#   cmake -DSHADERS="a.glsl;b.glsl" -DOUTPUT=... -P embed_shaders.cmake
file(WRITE ${OUTPUT}.new
     "#include \"render/shader_text.h\"\n\n#include <cstdio>\n#include <cstdlib>\n\nnamespace ltcfit {\n\n"
     "std::string_view shaderText(std::string_view name) {\n")
foreach(path ${SHADERS})
  get_filename_component(name ${path} NAME)
  file(READ ${path} text)
  string(FIND "${text}" ")ltcfit-shader\"" inside)
  if(NOT inside EQUAL -1)
    message(FATAL_ERROR "${path}: holds the end of the string that it is put into")
  endif()
  file(APPEND ${OUTPUT}.new "  if (name == \"${name}\") return R\"ltcfit-shader(${text})ltcfit-shader\";\n")
endforeach()
file(APPEND ${OUTPUT}.new
     "  std::fprintf(stderr, \"shaderText: no %.*s\\n\", static_cast<int>(name.size()), name.data());\n"
     "  std::abort();\n}\n\n}  // namespace ltcfit\n")
file(COPY_FILE ${OUTPUT}.new ${OUTPUT} ONLY_IF_DIFFERENT)
file(REMOVE ${OUTPUT}.new)
