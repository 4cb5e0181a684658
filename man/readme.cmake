# SPDX-License-Identifier: Apache-2.0
# cmake -D DOCUMENTS=DIR -P man/readme.cmake: takes out of DIR/README.md what points to files that DIR does not have.
# A picture goes, a link becomes its text: an installation has a part of what a clone has.

cmake_minimum_required(VERSION 3.25)
file(READ "${DOCUMENTS}/README.md" before)
# From the end to the beginning, because a regular expression of CMake takes as much as it can.
set(after "")
while("${before}" MATCHES "^(.*)\\[([^]]*)\\]\\(([^)]*)\\)(.*)$")
  set(before "${CMAKE_MATCH_1}")
  set(text "${CMAKE_MATCH_2}")
  set(target "${CMAKE_MATCH_3}")
  set(after "${CMAKE_MATCH_4}${after}")
  if(target MATCHES "^https?:" OR EXISTS "${DOCUMENTS}/${target}")
    string(PREPEND after "[${text}](${target})")
  elseif(before MATCHES "^(.*)!$")
    set(before "${CMAKE_MATCH_1}")
  else()
    string(PREPEND after "${text}")
  endif()
endwhile()
file(WRITE "${DOCUMENTS}/README.md" "${before}${after}")
