# SPDX-License-Identifier: Apache-2.0
# Stand-ins for libraries that OpenImageIO links and tex-reader never calls: those of cameras, movies and HEIF; and
# log4cplus, which OpenVDB links, and which starts threads while it is loaded. (If these get no memory, it waits
# for ever.) With all that these libraries link in turn, they are 200 of 260, and most of the time that the reader takes
# to start. A stand-in has the name of the library and the functions that are imported from it; each of them ends the
# process. (LibRaw has none, because OpenImageIO asks it for its version.)

# Sets `path` to the file of library lib<name>.so that `importer` links, and `soname` to its name; empty if it does not
# link it.
function(find_linked importer name soname path)
  find_program(TEX_LDD ldd)
  execute_process(COMMAND ${TEX_LDD} ${importer} OUTPUT_VARIABLE libraries ERROR_QUIET)
  if(NOT libraries MATCHES "(lib${name}[.]so[^ ]*) => (/[^ ]+)")
    set(CMAKE_MATCH_1)
    set(CMAKE_MATCH_2)
  endif()
  set(${soname} "${CMAKE_MATCH_1}" PARENT_SCOPE)
  set(${path} "${CMAKE_MATCH_2}" PARENT_SCOPE)
endfunction()

# Makes a target for each named library that exists here and from which `importer`, the path of a library, imports
# functions alone (and types, whose addresses are enough). Adds their names to `targets`.
function(add_stand_ins importer targets)
  set(result ${${targets}})
  execute_process(COMMAND ${CMAKE_NM} -D --undefined-only --with-symbol-versions ${importer}
                  OUTPUT_VARIABLE imports ERROR_QUIET)
  string(REGEX MATCHALL "[^ \n]+" imports "${imports}")
  foreach(name ${ARGN})
    find_linked(${importer} ${name} soname path)
    if(NOT path)
      continue()
    endif()
    execute_process(COMMAND ${CMAKE_NM} -D --defined-only ${path} OUTPUT_VARIABLE exports ERROR_QUIET)
    set(functions)
    set(versions)
    set(has_data OFF)
    foreach(import IN LISTS imports)
      string(REGEX MATCH "^([^@]+)@*(.*)$" unused ${import})
      set(symbol ${CMAKE_MATCH_1})
      set(version ${CMAKE_MATCH_2})
      if(NOT exports MATCHES " ([A-Za-z]) ${symbol}(@[^\n]*)?\n")
        continue()
      endif()
      if(NOT "${CMAKE_MATCH_1} ${symbol}" MATCHES "^([TW] |V _ZTI)")
        set(has_data ON)
      endif()
      string(APPEND functions "extern \"C\" [[gnu::visibility(\"default\")]] void ${symbol}() { __builtin_trap(); }\n")
      list(APPEND versions ${version})
    endforeach()
    if(has_data OR NOT functions)
      continue()
    endif()
    set(source ${PROJECT_BINARY_DIR}/stand-in-sources/${name}.cpp)
    set(map ${PROJECT_BINARY_DIR}/stand-in-sources/${name}.map)
    file(CONFIGURE OUTPUT ${source} CONTENT "${functions}")
    list(REMOVE_DUPLICATES versions)
    set(map_text)
    foreach(version IN LISTS versions)
      string(APPEND map_text "${version} { *; };\n")
    endforeach()
    file(CONFIGURE OUTPUT ${map} CONTENT "${map_text}")
    add_library(stand-in-${name} MODULE ${source})
    set_target_properties(stand-in-${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} UNITY_BUILD OFF
                          LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/stand-ins)
    # They must be loaded by name, so they have one; and packages want to know which C library they are for.
    target_link_options(stand-in-${name} PRIVATE -Wl,-soname,${soname} -Wl,--no-as-needed)
    if(versions)
      target_link_options(stand-in-${name} PRIVATE -Wl,--version-script,${map})
    endif()
    list(APPEND result stand-in-${name})
  endforeach()
  set(${targets} ${result} PARENT_SCOPE)
endfunction()
