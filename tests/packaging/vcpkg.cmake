# SPDX-License-Identifier: Apache-2.0
# cmake -D STAGE=DIR -D CURRENT_PACKAGES_DIR=DIR -D CALLS=FILE -D PORT_DIR=DIR -P vcpkg.cmake: runs the portfile of the
# port in PORT_DIR with stand-ins for the functions of vcpkg. The stand-in for the build copies the installation STAGE.
# Writes each call of a function as a line of FILE.
cmake_minimum_required(VERSION 3.25)
get_filename_component(PORT ${PORT_DIR} NAME)
file(WRITE ${CALLS} "")
foreach(name vcpkg_cmake_configure vcpkg_fixup_pkgconfig)
  cmake_language(EVAL CODE "function(${name})\n file(APPEND ${CALLS} \"${name};\${ARGN}\\n\")\nendfunction()")
endforeach()

function(vcpkg_find_acquire_program variable)
  set(${variable} /the/${variable} PARENT_SCOPE)
endfunction()

function(vcpkg_cmake_install)
  foreach(folder ${CURRENT_PACKAGES_DIR} ${CURRENT_PACKAGES_DIR}/debug)
    file(COPY ${STAGE}/lib ${STAGE}/include DESTINATION ${folder})
    file(COPY ${STAGE}/share/doc DESTINATION ${folder}/share)
  endforeach()
endfunction()

function(vcpkg_cmake_config_fixup)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "PACKAGE_NAME;CONFIG_PATH" "")
  file(RENAME ${CURRENT_PACKAGES_DIR}/${arg_CONFIG_PATH} ${CURRENT_PACKAGES_DIR}/share/${arg_PACKAGE_NAME})
  file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/${arg_CONFIG_PATH})
endfunction()

function(vcpkg_install_copyright)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "FILE_LIST")
  file(COPY_FILE ${arg_FILE_LIST} ${CURRENT_PACKAGES_DIR}/share/${PORT}/copyright)
endfunction()

include(${PORT_DIR}/portfile.cmake)
