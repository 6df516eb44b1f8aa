# Installs the build tree to a scratch prefix, builds a stranger's project against it and runs it.
set(scratch ${BUILD_DIR}/consumer)
file(REMOVE_RECURSE ${scratch})
foreach(command
    "${CMAKE_COMMAND};--install;${BUILD_DIR};--prefix;${scratch}/prefix"
    "${CMAKE_COMMAND};-S;${SOURCE_DIR};-B;${scratch}/build;-DCMAKE_PREFIX_PATH=${scratch}/prefix"
    "${CMAKE_COMMAND};--build;${scratch}/build"
    "${scratch}/prefix/bin/dowel;library;${scratch}/elements"
    "${scratch}/prefix/bin/dowel;catalog;build;${scratch}/elements/H40-12/plate-6x6.step;${scratch}/elements/H40-12/riser-80x80x40.step;-o;${scratch}/catalog.db"
    "${scratch}/build/reader;${scratch}/elements/H40-12/riser-80x80x40.step")
  execute_process(COMMAND ${command} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(COMMAND ${scratch}/build/consumer ${scratch}/catalog.db
  OUTPUT_VARIABLE verdicts COMMAND_ERROR_IS_FATAL ANY)
if(NOT verdicts STREQUAL "clear\ncontact\ninterference\n")
  message(FATAL_ERROR "expected clear, contact, interference; found: ${verdicts}")
endif()
