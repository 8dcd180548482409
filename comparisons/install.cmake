# cmake --install: the programs beside each other, what they read (data_folder in problem/processes/child.h finds it from where they lie),
# the man page and the completion for bash.
foreach(program springproof springproof-mesh springproof-fem springproof-bench springproof-mpi)
  if(TARGET ${program})
    set_target_properties(${program} PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)   # deal.II's and PETSc's libraries
    set(where_built)
    if(program MATCHES "bench|mpi")   # quickstart.sh does not build these
      set(where_built OPTIONAL)
    endif()
    install(TARGETS ${program} DESTINATION bin ${where_built})
  endif()
endforeach()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/comparisons/experiments ${CMAKE_SOURCE_DIR}/meshes/geo
        DESTINATION share/springproof PATTERN *.cpp EXCLUDE)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/comparisons/advise DESTINATION share/springproof
        FILES_MATCHING PATTERN "*.csv" PATTERN "*.toml" PATTERN "*.txt")

set(described ${CMAKE_CURRENT_BINARY_DIR}/described)
file(MAKE_DIRECTORY ${described})
foreach(form man bash)
  install(CODE "execute_process(COMMAND \"$<TARGET_FILE:springproof>\" describe ${form}
                                OUTPUT_FILE \"${described}/${form}\" COMMAND_ERROR_IS_FATAL ANY)")
endforeach()
install(FILES ${described}/man DESTINATION share/man/man1 RENAME springproof.1)
install(FILES ${described}/bash DESTINATION share/bash-completion/completions RENAME springproof)

# msm/ as a library: find_package(springproof), then springproof::msm.
install(TARGETS problem meshes msm EXPORT springproof DESTINATION lib/springproof)
foreach(module problem meshes msm)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${module} DESTINATION include/springproof
          FILES_MATCHING PATTERN "*.h" PATTERN gmsh EXCLUDE PATTERN geo EXCLUDE PATTERN parallel EXCLUDE)
endforeach()
install(EXPORT springproof NAMESPACE springproof:: FILE springproofTargets.cmake DESTINATION lib/cmake/springproof)
install(FILES ${CMAKE_SOURCE_DIR}/msm/springproofConfig.cmake DESTINATION lib/cmake/springproof)
# The same for builds without CMake: pkg-config --cflags --libs springproof.
configure_file(${CMAKE_SOURCE_DIR}/msm/springproof.pc.in ${CMAKE_CURRENT_BINARY_DIR}/springproof.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/springproof.pc DESTINATION lib/pkgconfig)

# cpack: one Debian package of programs and library; dpkg-shlibdeps finds the libraries that it depends on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "springproof")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "mass-spring models of elastic solids, compared with finite elements")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libeigen3-dev, libfmt-dev, nlohmann-json3-dev, libtomlplusplus-dev, zlib1g-dev")  # to link springproof::msm
include(CPack)
