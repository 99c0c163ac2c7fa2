# What `cmake --install` puts where, and the Debian packages of CPack. Components:
#   programs   the programs, their manual pages, examples and units
#   dev        the client library: headers, archive, CMake package Galatea (target Galatea::client)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(programs "")
foreach(program agent_manager galatea-log fsm face_fit face_editor ssm ssm_stub srm srm_stub vdm chat gateway vmc mcp task_manager)
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
foreach(agent agent chat film voice voice_film)
  file(READ ${CMAKE_SOURCE_DIR}/examples/agents/${agent}.json text)
  string(REPLACE "build/bin/" "" text "${text}")
  file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/installed/agents/${agent}.json CONTENT "${text}")
endforeach()
install(DIRECTORY ${CMAKE_BINARY_DIR}/installed/agents examples/dialogs examples/macros examples/systemd
  DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea/examples COMPONENT programs)
install(FILES examples/lamp_module.py DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea/examples
  COMPONENT programs)
# The example finds the package beside its folder; pip installs it from there for everything else.
install(DIRECTORY python DESTINATION ${CMAKE_INSTALL_DATADIR}/galatea COMPONENT programs
  PATTERN __pycache__ EXCLUDE)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)

if(TARGET vm_protocol)
  # The same objects as ours, without the warnings and paths we build with.
  add_library(galatea_client STATIC $<TARGET_OBJECTS:vm_protocol>)
  set_target_properties(galatea_client PROPERTIES LINKER_LANGUAGE CXX EXPORT_NAME client)
  target_compile_features(galatea_client INTERFACE cxx_std_23)
  target_include_directories(galatea_client INTERFACE
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/galatea>)
  install(TARGETS galatea_client EXPORT Galatea
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
  install(DIRECTORY vm_protocol/core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/galatea/vm_protocol
    COMPONENT dev FILES_MATCHING PATTERN "*.h")
  set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Galatea)
  install(EXPORT Galatea NAMESPACE Galatea:: DESTINATION ${package_folder} FILE GalateaConfig.cmake
    COMPONENT dev)
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/GalateaConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_BINARY_DIR}/GalateaConfigVersion.cmake DESTINATION ${package_folder}
    COMPONENT dev)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME galatea)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Galatea maintainers <galatea@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Toolkit of talking agents with a face")
set(CPACK_PACKAGE_DESCRIPTION "Independent programs that together listen, think, speak and look at you,
joined by one small text protocol: a hub, a voice, an ear, a face and a VoiceXML interpreter.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME galatea)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION sound)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "ffmpeg, open-jtalk, open-jtalk-mecab-naist-jdic, espeak-ng")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libgalatea-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
include(CPack)
