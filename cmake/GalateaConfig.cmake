# find_package(Galatea): Galatea::client, which needs only the standard library; with COMPONENTS module also
# Galatea::module, which needs OpenSSL, threads and the headers of Boost.
include(CMakeFindDependencyMacro)
if("module" IN_LIST Galatea_FIND_COMPONENTS)
  find_dependency(Threads)
  find_dependency(OpenSSL)
  find_dependency(Boost 1.81)
endif()
include("${CMAKE_CURRENT_LIST_DIR}/GalateaTargets.cmake")
