# SPDX-License-Identifier: Apache-2.0
# assemble.cmake: makes a manual page from its source and the sections that pages share.
#
#     cmake -D IN=man/bake-normals.1.in -D OUT=bake-normals.1 -P man/assemble.cmake
#
# A line "@include NAME@" becomes the text of shared/NAME.mdoc. A line "@set KEY TEXT@" gives the text of @KEY@ in the
# page and in everything that it includes. The first line for a key wins, so a shared file ends with its default.
file(READ "${IN}" page)
while(page MATCHES "(^|\n)@include ([a-z-]+)@\n")
  set(name "${CMAKE_MATCH_2}")
  file(READ "${CMAKE_CURRENT_LIST_DIR}/shared/${name}.mdoc" part)
  string(REPLACE "@include ${name}@\n" "${part}" page "${page}")
endwhile()
while(page MATCHES "(^|\n)@set ([a-z-]+) ([^@\n]*)@\n")
  set(key "${CMAKE_MATCH_2}")
  set(text "${CMAKE_MATCH_3}")
  string(REPLACE "@set ${key} ${text}@\n" "" page "${page}")
  string(REPLACE "@${key}@" "${text}" page "${page}")
endwhile()
if(page MATCHES "@[a-z][^@\n]*@")
  message(FATAL_ERROR "${IN}: nothing defines ${CMAKE_MATCH_0}")
endif()
file(WRITE "${OUT}" "${page}")
