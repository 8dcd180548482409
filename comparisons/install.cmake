# cmake --install: the programs beside each other, what they read (data_folder in problem/system/child.h finds it from where they lie),
# the man page and the completion for bash.
foreach(program springproof springproof-mesh springproof-fem springproof-bench springproof-lattice)
  if(TARGET ${program})
    set_target_properties(${program} PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)   # deal.II's and PETSc's libraries
    set(where_built)
    if(program MATCHES "bench|lattice")   # quickstart.sh does not build these
      set(where_built OPTIONAL)
    endif()
    install(TARGETS ${program} DESTINATION bin ${where_built})
  endif()
endforeach()
install(DIRECTORY ${CMAKE_SOURCE_DIR}/comparisons/experiments ${CMAKE_SOURCE_DIR}/meshes/geo DESTINATION share/springproof)

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
