# What `cmake --install` puts where, and the Debian packages of CPack. Components:
#   programs   the programs and their helpers, manual pages, documents, examples, units, galatea-agent (run_agent.sh)
#   dev        libraries for clients and modules: headers, archives, CMake package Galatea (targets
#              Galatea::client and Galatea::module)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(programs "")
# ssm finds ssm_espeak, and with --voices align, beside itself.
foreach(program agent_manager galatea-log fsm face_fit face_editor face_space face_track face_watch film_dub hypermask ssm ssm_espeak ssm_stub srm srm_stub align
                vdm chat gateway mcp vmc task_manager srgs_match)
  if(TARGET ${program})
    list(APPEND programs ${program})
  endif()
endforeach()
if(programs)
  install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
endif()
file(GLOB pages CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/docs/man/*.1 ${CMAKE_SOURCE_DIR}/docs/man/*.7)
foreach(page IN LISTS pages)
  string(REGEX REPLACE ".*\\." "" section ${page})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} COMPONENT programs)
endforeach()
# The examples start programs of the build; installed ones are found by their names.
foreach(agent agent chat film hypermask mirror voice voice_film)
  file(READ ${CMAKE_SOURCE_DIR}/examples/agents/${agent}.json text)
  string(REPLACE "build/bin/" "" text "${text}")
  file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/installed/agents/${agent}.json CONTENT "${text}")
endforeach()
install(DIRECTORY ${CMAKE_BINARY_DIR}/installed/agents examples/dialogs examples/macros examples/systemd examples/web_site
  DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea/examples COMPONENT programs)
install(FILES examples/lamp_module.py examples/typed_chat.py DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea/examples
  COMPONENT programs)
install(PROGRAMS scripts/run_agent.sh DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME galatea-agent COMPONENT programs)
install(PROGRAMS scripts/face_networks.sh DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea/scripts COMPONENT programs)
install(FILES scripts/text_languages.txt DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea/scripts COMPONENT programs)
install(PROGRAMS scripts/subtitles.py scripts/web_dialog.py DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea/scripts COMPONENT programs)
# The example finds the package beside its folder; pip installs it from there for everything else.
install(DIRECTORY python DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea COMPONENT programs
  PATTERN __pycache__ EXCLUDE)
install(FILES LICENSE README.md CONTRIBUTING.md CHANGELOG.md SECURITY.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs PATTERN man EXCLUDE)

if(TARGET vm_protocol)
  # The same objects as ours, without the warnings and paths we build with.
  function(galatea_install_library target objects name)
    add_library(${target} STATIC $<TARGET_OBJECTS:${objects}>)
    set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX EXPORT_NAME ${name})
    add_dependencies(programs ${target})
    install(TARGETS ${target} EXPORT Galatea ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
  endfunction()
  galatea_install_library(galatea_client vm_protocol client)
  target_compile_features(galatea_client INTERFACE cxx_std_23)
  target_include_directories(galatea_client INTERFACE
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/galatea>)
  find_package(OpenSSL REQUIRED)
  galatea_install_library(galatea_module vm_runtime module)
  target_link_libraries(galatea_module PUBLIC galatea_client PRIVATE OpenSSL::SSL Threads::Threads)
  install(DIRECTORY vm_protocol/core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/galatea/vm_protocol
    COMPONENT dev FILES_MATCHING PATTERN "*.h")
  install(FILES vm_protocol/runtime/module_main.h
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/galatea/vm_protocol/runtime COMPONENT dev)
  set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Galatea)
  install(EXPORT Galatea NAMESPACE Galatea:: DESTINATION ${package_folder} FILE GalateaTargets.cmake
    COMPONENT dev)
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/GalateaConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES cmake/GalateaConfig.cmake ${CMAKE_BINARY_DIR}/GalateaConfigVersion.cmake
    DESTINATION ${package_folder} COMPONENT dev)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_NAME galatea)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Galatea maintainers <galatea@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Toolkit of talking agents with a face")
set(CPACK_PACKAGE_DESCRIPTION "Independent programs that together listen, think, speak and look at you,
joined by one small text protocol: a hub, a voice, an ear, a face, a module that answers and a VoiceXML interpreter.
`galatea-agent --web` talks with you in a browser.")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME galatea)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION sound)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS python3) # for galatea-agent
if(TARGET fsm_render AND OSMESA_FOUND) # fsm_render loads it itself, so it is not among the shared libraries found
  string(APPEND CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS ", libosmesa6")
endif()
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS
  "ffmpeg, pocketsphinx-en-us, mecab-naist-jdic, open-jtalk, open-jtalk-mecab-naist-jdic, fonts-dejavu-core, fonts-vlgothic")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "npm")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libgalatea-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "libboost1.81-dev, libssl-dev")
include(CPack)
