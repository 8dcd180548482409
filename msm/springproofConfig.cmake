# find_package(springproof): the target springproof::msm, the mass-spring library.
include(CMakeFindDependencyMacro)
foreach(package Eigen3 fmt nlohmann_json Threads tomlplusplus ZLIB)
  find_dependency(${package})
endforeach()
include(${CMAKE_CURRENT_LIST_DIR}/springproofTargets.cmake)
