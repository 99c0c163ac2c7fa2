# galatea_embed(TARGET NAME FILE): makes the bytes of FILE part of TARGET. The code then says
#   #include "embedded/NAME.h"     and gets     std::string_view embedded::NAME();
# The file is read when building, so editing it rebuilds only the generated source. A generated
# array is used rather than #embed or an assembler include because both of our compilers take it.
set(GALATEA_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/EmbedScript.cmake)

function(galatea_embed target name file)
  get_filename_component(input ${file} ABSOLUTE)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/embed_${target})
  set(header ${folder}/embedded/${name}.h)
  set(source ${folder}/embedded/${name}.cc)
  add_custom_command(
    OUTPUT ${header} ${source}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${input} -DNAME=${name} -DHEADER=${header} -DSOURCE=${source}
            -P ${GALATEA_EMBED_SCRIPT}
    DEPENDS ${input} ${GALATEA_EMBED_SCRIPT}
    COMMENT "Embedding ${name}"
    VERBATIM)
  target_sources(${target} PRIVATE ${source} ${header})
  target_include_directories(${target} PRIVATE ${folder})
endfunction()

# galatea_numbers(TARGET NAME NAMESPACE STRUCT FILE): makes the rows of FILE, a fsm::NumberTable, members of
# STRUCT, so that a compiler checks their names. The code then says
#   #include "embedded/NAME.h"     and gets     NAMESPACE::STRUCT(const fsm::NumberTable&)
# where the row "lamp key direction 0.4 0.5 0.8" is lamp.key.direction, a glm::vec3, and the type of lamp is
# STRUCT::Lamp. One number is a float, two to four are a vector of glm, more are a std::array<float, N>; "12 to 24" and
# "0.4 up_to 0.9" are a fsm::Range, "1.8 plus 2.9" is a fsm::Linear. Who links to TARGET may include it too.
set(GALATEA_NUMBERS_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/NumbersScript.cmake)

function(galatea_numbers target name namespace struct file)
  get_filename_component(input ${file} ABSOLUTE)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/numbers_${target})
  set(header ${folder}/embedded/${name}.h)
  set(source ${folder}/embedded/${name}.cc)
  add_custom_command(
    OUTPUT ${header} ${source}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${input} -DNAME=${name} -DNAMESPACE=${namespace} -DSTRUCT=${struct}
            -DHEADER=${header} -DSOURCE=${source} -P ${GALATEA_NUMBERS_SCRIPT}
    DEPENDS ${input} ${GALATEA_NUMBERS_SCRIPT}
    COMMENT "Naming the numbers of ${name}"
    VERBATIM)
  target_sources(${target} PRIVATE ${source} ${header})
  target_include_directories(${target} PUBLIC ${folder})
endfunction()
