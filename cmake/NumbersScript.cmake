# Run by galatea_numbers with -P: writes HEADER and SOURCE so that the rows of the table INPUT are members of STRUCT.
file(STRINGS ${INPUT} lines)
set(rows "")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "#.*" "" line "${line}")
  string(STRIP "${line}" line)
  if(line STREQUAL "")
    continue()
  endif()
  if(NOT line MATCHES "^([A-Za-z_][A-Za-z0-9_]*( +[A-Za-z_][A-Za-z0-9_]*)*) +([-+.0-9].*)$")
    message(FATAL_ERROR "${INPUT}: '${line}' is not a name and numbers")
  endif()
  set(name "${CMAKE_MATCH_1}")
  string(REGEX MATCHALL "[^ ]+" numbers "${CMAKE_MATCH_3}")
  list(FILTER numbers EXCLUDE REGEX "[.][.]") # limits, LOW..HIGH
  string(REGEX REPLACE " +" " " name "${name}")
  list(LENGTH numbers count)
  if(numbers MATCHES ";(up_)?to;")
    set(type fsm::Range)
  elseif(numbers MATCHES ";plus;")
    set(type fsm::Linear)
  elseif(count EQUAL 1)
    set(type float)
  elseif(count LESS_EQUAL 4)
    set(type glm::vec${count})
  else()
    set(type "std::array<float, ${count}>")
  endif()
  list(APPEND rows "${name}|${type}")
endforeach()
list(SORT rows) # so that rows whose names begin with the same words follow one another

set(members "")
set(takes "")
set(open "") # the structs that are open, each as its name and a dot
foreach(row IN LISTS rows)
  string(REGEX MATCH "^(.*)[|](.*)$" row "${row}")
  set(name "${CMAKE_MATCH_1}")
  set(type "${CMAKE_MATCH_2}")
  string(REPLACE " " "." member "${name}")
  string(REGEX MATCH "^(.*[.])?([^.]+)$" unused "${member}")
  set(parent "${CMAKE_MATCH_1}")
  set(last "${CMAKE_MATCH_2}")
  string(FIND "${parent}" "${open}" place)
  while(NOT place EQUAL 0)
    string(REGEX MATCH "^(.*[.])?([^.]+)[.]$" unused "${open}")
    set(open "${CMAKE_MATCH_1}")
    string(APPEND members "} ${CMAKE_MATCH_2};\n")
    string(FIND "${parent}" "${open}" place)
  endwhile()
  string(LENGTH "${open}" shared)
  string(SUBSTRING "${parent}" ${shared} -1 more)
  string(REGEX MATCHALL "[^.]+" begun "${more}")
  foreach(word IN LISTS begun) # skin_below begins the struct SkinBelow
    string(REGEX MATCHALL "[^_]+" syllables "${word}")
    string(APPEND members "struct ")
    foreach(syllable IN LISTS syllables)
      string(SUBSTRING "${syllable}" 0 1 first)
      string(SUBSTRING "${syllable}" 1 -1 others)
      string(TOUPPER "${first}" first)
      string(APPEND members "${first}${others}")
    endforeach()
    string(APPEND members " {\n")
  endforeach()
  set(open "${parent}")
  string(APPEND members "${type} ${last}{};\n")
  string(APPEND takes "  numbers.Get(\"${name}\", ${member});\n")
endforeach()
while(NOT open STREQUAL "")
  string(REGEX MATCH "^(.*[.])?([^.]+)[.]$" unused "${open}")
  set(open "${CMAKE_MATCH_1}")
  string(APPEND members "} ${CMAKE_MATCH_2};\n")
endwhile()

get_filename_component(table ${INPUT} NAME)
# Where only a number has changed both stay as they are, and nothing that includes them is compiled anew.
file(CONFIGURE OUTPUT ${HEADER} @ONLY CONTENT "// Written by cmake/NumbersScript.cmake from ${table}, where each number is explained.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include \"fsm/base/number_table.h\"

namespace ${NAMESPACE} {
struct ${STRUCT} {
${STRUCT}() = default;  // all are 0
explicit ${STRUCT}(const fsm::NumberTable& numbers);

${members}};
}
")
file(CONFIGURE OUTPUT ${SOURCE} @ONLY CONTENT "#include \"embedded/${NAME}.h\"

namespace ${NAMESPACE} {
${STRUCT}::${STRUCT}(const fsm::NumberTable& numbers) {
${takes}}
}
")
