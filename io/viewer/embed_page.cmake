# cmake -D INPUT=page.html -D OUTPUT=page_template.cpp -P embed_page.cmake
# Writes a C++ source whose `page_template()` is the content of INPUT: a raw string literal, which
# compiles in no time where an array of numbers takes seconds.

file(READ ${INPUT} page)
string(FIND "${page}" ")page\"" delimiter)
if(NOT delimiter EQUAL -1)
  message(FATAL_ERROR "${INPUT} holds the delimiter of the raw string literal")
endif()
file(WRITE ${OUTPUT}
  "#include \"page_template.h\"\n\n"
  "std::string_view dowel::page_template() {\n  return R\"page(${page})page\";\n}\n")
