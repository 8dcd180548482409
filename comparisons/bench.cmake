# The program springproof-bench, which `springproof bench` starts.  It links PETSc, where there is one, for a baseline: hence a program of
# its own, so that springproof does not wait for those libraries.
add_library(bench STATIC bench/rows.cpp bench/timer.cpp bench/interrupt.cpp bench/in_child.cpp bench/machine.cpp
                                 bench/bodies.cpp bench/motion.cpp bench/lammps.cpp bench/dynamics.cpp bench/gamg.cpp bench/relaxation.cpp
                                 bench/statics.cpp bench/fem.cpp bench/experiments.cpp bench/table.cpp bench/page.cpp)
target_link_libraries(bench PUBLIC report msm fem_reference meshes PRIVATE fmt::fmt-header-only nlohmann_json::nlohmann_json Threads::Threads springproof_warnings)

add_executable(springproof-bench bench/main.cpp)
target_link_libraries(springproof-bench PRIVATE bench CLI11::CLI11 fmt::fmt-header-only nlohmann_json::nlohmann_json springproof_warnings)
add_dependencies(springproof-bench springproof-mesh)
target_compile_definitions(springproof-bench PRIVATE SPRINGPROOF_VERSION="${PROJECT_VERSION}")

# Its loops once per instruction set, as the kernels of msm/ are and with their options.
foreach(instruction_set portable avx2 avx512)
  if(TARGET msm_${instruction_set})
    get_target_property(options msm_${instruction_set} COMPILE_OPTIONS)
    if(NOT options)
      set(options)
    endif()
    add_library(bench_${instruction_set} OBJECT bench/kernels/bench_kernels.cpp)
    target_include_directories(bench_${instruction_set} PRIVATE ${CMAKE_BINARY_DIR}/arrows/msm ${CMAKE_BINARY_DIR}/arrows/comparisons)
    target_compile_definitions(bench_${instruction_set} PRIVATE SPRINGPROOF_KERNEL_NAMESPACE=${instruction_set})
    target_compile_options(bench_${instruction_set} PRIVATE ${options})
    target_link_libraries(bench_${instruction_set} PRIVATE springproof_warnings)
    target_sources(bench PRIVATE $<TARGET_OBJECTS:bench_${instruction_set}>)
  endif()
endforeach()
if(TARGET msm_avx2)
  target_compile_definitions(bench PUBLIC SPRINGPROOF_X86_BENCH_KERNELS)
endif()

find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(PETSC QUIET IMPORTED_TARGET PETSc)
  pkg_check_modules(MPI_C QUIET IMPORTED_TARGET mpi-c)
endif()
if(PETSC_FOUND AND MPI_C_FOUND)
  target_compile_definitions(bench PRIVATE SPRINGPROOF_PETSC)
  target_link_libraries(bench PRIVATE PkgConfig::PETSC PkgConfig::MPI_C)
endif()
