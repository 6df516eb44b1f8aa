# Builds the template of the 3D page (one HTML file, see README.md) and compiles it into dowel_io.
# `npm ci` fetches exactly what package-lock.json names, once for each build folder.

find_program(NPM npm)
find_program(NODE NAMES node nodejs)
if(NOT NPM OR NOT NODE)
  message(FATAL_ERROR "The 3D page is built with npm, which was not found: install the packages "
                      "nodejs and npm (Debian: apt-get install nodejs npm).")
endif()

set(viewer_dir ${CMAKE_CURRENT_LIST_DIR})
set(viewer_build_dir ${CMAKE_CURRENT_BINARY_DIR}/viewer)
set(viewer_manifests package.json package-lock.json .npmrc)
set(viewer_inputs build.mjs)
foreach(name page.html style.css main.js scene_file.js stage.js drawing.js sidebar.js)
  list(APPEND viewer_inputs src/${name})
endforeach()
list(TRANSFORM viewer_manifests PREPEND ${viewer_dir}/ OUTPUT_VARIABLE viewer_manifest_files)
list(TRANSFORM viewer_inputs PREPEND ${viewer_dir}/ OUTPUT_VARIABLE viewer_input_files)

# The sources are copied beside the packages, so that the source tree stays as it is.
add_custom_command(
  OUTPUT ${viewer_build_dir}/packages.stamp
  COMMAND ${CMAKE_COMMAND} -E make_directory ${viewer_build_dir}
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer_manifest_files} ${viewer_build_dir}
  COMMAND ${NPM} ci --prefer-offline --no-progress --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch ${viewer_build_dir}/packages.stamp
  DEPENDS ${viewer_manifest_files}
  WORKING_DIRECTORY ${viewer_build_dir}
  COMMENT "Fetching the packages of the 3D page"
  VERBATIM)
add_custom_command(
  OUTPUT ${viewer_build_dir}/page.html
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer_dir}/build.mjs ${viewer_build_dir}
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${viewer_dir}/src ${viewer_build_dir}/src
  COMMAND ${NODE} build.mjs page.html
  DEPENDS ${viewer_build_dir}/packages.stamp ${viewer_input_files}
  WORKING_DIRECTORY ${viewer_build_dir}
  COMMENT "Building the 3D page"
  VERBATIM)
add_custom_command(
  OUTPUT ${viewer_build_dir}/page_template.cpp
  COMMAND ${CMAKE_COMMAND} -D INPUT=${viewer_build_dir}/page.html
          -D OUTPUT=${viewer_build_dir}/page_template.cpp -P ${viewer_dir}/embed_page.cmake
  DEPENDS ${viewer_build_dir}/page.html ${viewer_dir}/embed_page.cmake
  VERBATIM)

target_sources(dowel_io PRIVATE ${viewer_build_dir}/page_template.cpp)
set_source_files_properties(${viewer_build_dir}/page_template.cpp PROPERTIES
  INCLUDE_DIRECTORIES ${CMAKE_CURRENT_SOURCE_DIR}/src
  COMPILE_OPTIONS -Wno-overlength-strings)  # the whole page is one literal
