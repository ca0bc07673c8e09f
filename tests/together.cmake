# cmake -P together.cmake OUTPUT FILE...: writes a source file that compiles these test files together, which takes
# half the time of compiling them one by one. Each of them is in a namespace of its own, because test files define helpers
# with equal names; what they include comes first, outside of these namespaces.
math(EXPR last "${CMAKE_ARGC} - 1")
set(includes "")
set(body "")
foreach(i RANGE 4 ${last})
  set(file "${CMAKE_ARGV${i}}")
  file(STRINGS "${file}" lines REGEX "^#include ")
  list(APPEND includes ${lines})
  string(APPEND body "namespace file_${i} {\n#include \"${file}\"\n}\n")
endforeach()
list(REMOVE_DUPLICATES includes)
list(JOIN includes "\n" includes)
file(WRITE "${CMAKE_ARGV3}" "${includes}\n${body}")
