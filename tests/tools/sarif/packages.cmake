# The schema of SARIF and what validates by it, fetched by `npm ci` once for each build folder: tests
# use no network.
find_program(NPM npm REQUIRED)
find_program(NODE NAMES node nodejs REQUIRED)
set(sarif_build_dir ${CMAKE_CURRENT_BINARY_DIR}/sarif)
set(sarif_inputs package.json package-lock.json .npmrc check_sarif.mjs)
list(TRANSFORM sarif_inputs PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
add_custom_command(
  OUTPUT ${sarif_build_dir}/packages.stamp
  COMMAND ${CMAKE_COMMAND} -E make_directory ${sarif_build_dir}
  COMMAND ${CMAKE_COMMAND} -E copy ${sarif_inputs} ${sarif_build_dir}
  COMMAND ${NPM} ci --prefer-offline --no-progress --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch ${sarif_build_dir}/packages.stamp
  DEPENDS ${sarif_inputs}
  WORKING_DIRECTORY ${sarif_build_dir}
  COMMENT "Fetching the packages of the SARIF test"
  VERBATIM)
add_custom_target(dowel_sarif_packages DEPENDS ${sarif_build_dir}/packages.stamp)
add_dependencies(dowel_tools_tests dowel_sarif_packages)
target_compile_definitions(dowel_tools_tests PRIVATE
  DOWEL_NODE="${NODE}" DOWEL_SARIF_CHECK_SCRIPT="${sarif_build_dir}/check_sarif.mjs")
