# SPDX-License-Identifier: Apache-2.0
# cpack runs this before it makes the packages. It brings the files of each package into the form that Debian's policy
# demands: documents in a folder with the name of the package, manual pages and changelogs compressed.

if(NOT CPACK_TEX_SKIPS_RPATH)
  message(FATAL_ERROR "This build is not for Debian packages: its programs have a search path for libraries. "
                      "Run: cmake --preset debian && cmake --build --preset debian && (cd build/debian && cpack)")
endif()
file(READ ${CPACK_TEX_SOURCE_DIR}/changelog changelog)
string(REGEX MATCH "libtex \\(([^)]*)\\)" unused "${changelog}")
if(NOT CMAKE_MATCH_1 STREQUAL "${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
  message(FATAL_ERROR "The first entry of libtex/debian/changelog is about version ${CMAKE_MATCH_1}. "
                      "Add one about ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}.")
endif()

# Without the time (-n), so that equal sources make equal files.
function(compress)
  foreach(file IN LISTS ARGN)
    execute_process(COMMAND gzip -9n ${file} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endfunction()

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(share ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/share)
  set(documents ${share}/doc/${package})
  if(EXISTS ${share}/doc/libtex)
    file(RENAME ${share}/doc/libtex ${documents})
    file(REMOVE ${documents}/LICENSE)  # copyright says where Debian keeps this licence
  endif()
  if(EXISTS ${documents}/CHANGELOG.md)
    file(RENAME ${documents}/CHANGELOG.md ${documents}/changelog)
    compress(${documents}/changelog)
  endif()
  file(COPY ${CPACK_TEX_SOURCE_DIR}/copyright DESTINATION ${documents})
  file(WRITE ${documents}/changelog.Debian "${changelog}")
  compress(${documents}/changelog.Debian)
  file(CHMOD ${documents}/changelog.Debian.gz ${documents}/copyright
       PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  set(overrides "# Debian's archive does not have this package, so no bug asks for it.\n"
                "${package}: initial-upload-closes-no-bugs\n")
  if(component STREQUAL "runtime")
    list(APPEND overrides "# cpack writes scripts that call ldconfig. The trigger, which Debian wants, is there, too.\n"
         "${package}: maintscript-calls-ldconfig\n")
  endif()
  file(WRITE ${share}/lintian/overrides/${package} ${overrides})
  file(CHMOD ${share}/lintian/overrides/${package} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  file(GLOB pages ${share}/man/man*/*)
  compress(${pages})
  if(EXISTS ${share}/zsh)  # Debian's zsh does not look into site-functions
    file(RENAME ${share}/zsh/site-functions ${share}/zsh/vendor-completions)
  endif()
endforeach()
