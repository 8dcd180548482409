# The built-in experiments as tests (label: experiment).
set(experiments ${CMAKE_SOURCE_DIR}/comparisons/experiments)

# A case with many Poisson's ratios runs at some of them here: the ends of its range, and what lies between.
# `springproof compare CASE` runs it whole.
set(tested_ratios  # a regular expression of cases, their ratios
    "golec_2019/[a-z]+" -0.5,0.499  # of the README's figure
    "kot_2015/fig_7_surface" -0.9,0.25,0.499
    "kot_2015/fig_12" 0.4
    "kot_2015/fig_13" 0.49
    "large_strain/(compression|tension)" 0.25,0.499
    "large_strain/torsion" 0.499
    "large_strain/(bending|shear)" 0.45
    "large_strain/validity" 0,0.25
    "cross_check/.*" 0.25  # that of CalculiX' values
    "cost/bending" 0.25
    "cost/compression" 0.45,0.499
    "cost/(torsion|rabbit)" 0.499
    "cost/rabbit_measured" 0.45
    "regions/stiff_balls" 0.49
    "motion/(released_bar|struck_bar.*)" 0.3
    "bodies/(rabbit|l_bracket)" 0.45
    "bodies/rabbit_(5000|measured)" -0.5,0.499
    "bodies/rabbit_networks" 0
    "bodies/bar_networks" 0,0.45
    "bodies/glued_to_walls" 0.45,0.499
    "bodies/pressed_between_walls" 0.3,0.499
    "boxes/bending" 0,0.25,0.499
    "boxes/(torsion|large_bending)" 0.25,0.499
    "verification/stress_hollow_sphere" 0.4999
    "verification/stress_plate_with_hole" 0.3)

# Those that repeat at length what others prove in seconds have the label `long`: the papers' figures one by one (`springproof
# reproduce` draws them), larger bodies, longer motions, costs.
set(long
    "kot_2014/fig.*" "kot_2015/fig_(7|8|1[0-9])"
    "golec_2019/(tables/(table2_.*|table3_tension_20|table4_shear_20|table5_torsion_45deg)|figures/fig_5_2MPa)"
    "golec_2019/ten_seconds/(table2_.*|table3_.*|table4_shear_20|table5_torsion_45deg)"
    "bodies/(rabbit_.*|hand_pressed|bar_networks)" "cost/.*" "large_strain/(tension|bending|rabbit_measured)"
    "motion/(released_bar|struck_bar_averaged|falling_rabbit)" "boxes/struck_bar" "regions/(swinging_rod|tumour)"
    "measured/.*" "verification/(manufactured_(linear|quadratic)_straight|macneal_.*_out_of_plane)")

file(GLOB_RECURSE cases CONFIGURE_DEPENDS RELATIVE ${experiments} ${experiments}/*.toml)
list(TRANSFORM cases REPLACE "\\.toml$" "")
list(FILTER cases EXCLUDE REGEX "^calibration/")  # all of them in one test
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
  set(label experiment)
  foreach(pattern ${long})
    if(case MATCHES "^${pattern}$")
      set(label long)
    endif()
  endforeach()
  set_tests_properties(experiment.${case} PROPERTIES LABELS ${label} TIMEOUT 3600)
  file(STRINGS ${experiments}/${case}.toml stated REGEX "^\\[\\[expect\\]\\]")
  if(stated)  # and some of them at the ratios tested
    set_tests_properties(experiment.${case} PROPERTIES FAIL_REGULAR_EXPRESSION "No expectations are stated")
  endif()
endforeach()

# One test of many: what counts is the share of values within their uncertainties.  Blocks and built-in bodies; bodies in files, as
# users have; and, at length, frequencies and motions.
set(calibration ${CMAKE_CURRENT_SOURCE_DIR}/cli/calibration.sh $<TARGET_FILE:springproof> ${CMAKE_BINARY_DIR}/experiments/calibration)
add_test(NAME experiment.calibration COMMAND ${calibration} 200 "compare calibration --jobs 1")
add_test(NAME experiment.calibration_files COMMAND ${calibration}_files 250 "compare calibration/files --jobs 1"
         "frequencies calibration/frequencies/box_on_rollers --poisson-ratio 0.45"
         "frequencies calibration/frequencies/sphere_free --free --modes 20 --poisson-ratio 0.49")
add_test(NAME experiment.calibration_motion COMMAND ${calibration}_motion 100 "compare calibration/motion --jobs 1"
         "frequencies calibration/frequencies/sphere_free --free --modes 20"
         "frequencies calibration/frequencies/block_on_rollers" "frequencies calibration/frequencies/box_on_rollers"
         "frequencies calibration/frequencies/tee_held" "frequencies calibration/frequencies/bracket_held")
set_tests_properties(experiment.calibration experiment.calibration_files PROPERTIES LABELS experiment TIMEOUT 1800 COST 100)  # first
set_tests_properties(experiment.calibration_motion PROPERTIES LABELS long TIMEOUT 3600)

# Many bodies each, half an hour: only by name (ctest -L bodies).
add_test(NAME experiment.ten_bodies COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/bodies/ten_bodies.py
                                            ${CMAKE_BINARY_DIR}/experiments/ten_bodies $<TARGET_FILE:springproof>)
# Twenty of a hundred, one of each kind at least; anew, though the script takes up where it stopped.  Of seventeen the
# reference tells the springs' error, as measured: fewer, and meshes or their limits became worse.
set(hundred ${CMAKE_BINARY_DIR}/experiments/hundred_bodies)
add_test(NAME experiment.hundred_bodies
         COMMAND sh -c "rm -rf '${hundred}' && exec python3 '${CMAKE_CURRENT_SOURCE_DIR}/bodies/hundred_bodies.py' '${hundred}' \"$0\" --count 20 --least 17"
                 $<TARGET_FILE:springproof>)
set_tests_properties(experiment.ten_bodies experiment.hundred_bodies PROPERTIES LABELS bodies TIMEOUT 3600)

if(SPRINGPROOF_PYTHON)  # that has NumPy
  add_test(NAME experiment.one_support
           COMMAND ${SPRINGPROOF_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/bodies/one_support.py
                   ${CMAKE_BINARY_DIR}/experiments/one_support $<TARGET_FILE:springproof> ${CMAKE_SOURCE_DIR}/examples ${CMAKE_C_COMPILER})
  set_tests_properties(experiment.one_support PROPERTIES LABELS bodies TIMEOUT 1800)
endif()

add_test(NAME experiment.figures COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/source/figures.sh ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR}/experiments)
set(drawn ${cases})
list(FILTER drawn INCLUDE REGEX "^golec_2019/[a-z]+$")
list(TRANSFORM drawn PREPEND experiment.)
set_tests_properties(experiment.figures PROPERTIES LABELS experiment SKIP_RETURN_CODE 77 DEPENDS "${drawn}")
