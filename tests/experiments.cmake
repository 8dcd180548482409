# The built-in experiments as tests (label: experiment).
set(experiments ${CMAKE_SOURCE_DIR}/comparisons/experiments)

# A case with many Poisson's ratios runs at some of them here: the ends of its range, and what lies between.
# `springproof compare CASE` runs it whole.
set(tested_ratios  # a regular expression of cases, their ratios
    "golec_2019/[a-z]+" -0.5,0.25,0.4,0.499  # those of the README's figure
    "kot_2015/fig_7" -0.9,0.25,0.499
    "kot_2015/fig_12" 0.4
    "kot_2015/fig_13" 0.49
    "large_strain/(compression|tension|torsion)" -0.5,0.25,0.499
    "large_strain/(bending|shear)" 0,0.45
    "cross_check/.*" 0.25  # that of CalculiX' values
    "cost/bending" 0.25
    "motion/(released_bar|struck_bar.*)" 0.3
    "bodies/rabbit" 0.45
    "bodies/l_bracket" 0.45)

# Minutes of all cores, for a look; bodies/rabbit, kot_2014/fig_15 and golec_2019 are the same in fewer cubes, kot_2015/fig_13
# is the hand of hand_pressed, bodies/bar_networks has a smaller network than rabbit_networks.
set(not_tested "bodies/(rabbit_5000|rabbit_networks|hand_pressed)|cost/(rabbit|compression|torsion)|kot_2014/fig_15_fine")

file(GLOB_RECURSE cases CONFIGURE_DEPENDS RELATIVE ${experiments} ${experiments}/*.toml)
list(TRANSFORM cases REPLACE "\\.toml$" "")
list(FILTER cases EXCLUDE REGEX "^(${not_tested}|calibration/.*)$")
foreach(case ${cases})
  set(only "")
  set(rows ${tested_ratios})
  while(rows AND NOT only)
    list(POP_FRONT rows pattern ratios)
    if(case MATCHES "^${pattern}$")
      set(only --poisson-ratio=${ratios})
    endif()
  endwhile()
  add_test(NAME experiment.${case} COMMAND springproof compare ${case} ${only} --jobs 1
                                           --out ${CMAKE_BINARY_DIR}/experiments/${case})
  set_tests_properties(experiment.${case} PROPERTIES LABELS experiment TIMEOUT 1800)
  file(STRINGS ${experiments}/${case}.toml stated REGEX "^\\[\\[expect\\]\\]")
  if(stated)  # and some of them at the ratios tested
    set_tests_properties(experiment.${case} PROPERTIES FAIL_REGULAR_EXPRESSION "No expectations are stated")
  endif()
endforeach()

# One test of all: what counts is the share of values within their uncertainties.
add_test(NAME experiment.calibration COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/calibration.sh $<TARGET_FILE:springproof>
                                             ${CMAKE_BINARY_DIR}/experiments/calibration)
set_tests_properties(experiment.calibration PROPERTIES LABELS experiment TIMEOUT 1800)

add_test(NAME experiment.figures COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/figures.sh ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR}/experiments)
set(drawn ${cases})
list(FILTER drawn INCLUDE REGEX "^golec_2019/[a-z]+$")
list(TRANSFORM drawn PREPEND experiment.)
set_tests_properties(experiment.figures PROPERTIES LABELS experiment SKIP_RETURN_CODE 77 DEPENDS "${drawn}")
