# Installs the library in an empty folder, then builds and runs the example against it as an outside project
# would.
#   cmake -D BUILD=<build folder> -D SOURCE=<source folder> -D WORK=<scratch folder>
#         -D GENERATOR=<generator of the build folder> -P install_test.cmake
function(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component physics)
file(COPY ${SOURCE}/physics/example DESTINATION ${WORK})
step(${CMAKE_COMMAND} -G ${GENERATOR} -S ${WORK}/example -B ${WORK}/build -D CMAKE_PREFIX_PATH=${WORK}/prefix)
step(${CMAKE_COMMAND} --build ${WORK}/build)
step(${WORK}/build/example)
if(NOT output MATCHES "a boundary at 150 mm: 29[0-9][0-9][0-9]\\.")
  message(FATAL_ERROR "the example printed: ${output}")
endif()
