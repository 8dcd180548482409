# Target `report`: results as JSON and CSV, and the offline page that shows them.
#
# The page carries its own style, script and libraries; they are embedded as text at build time.
find_file(SPRINGPROOF_CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js NO_DEFAULT_PATH
          DOC "Chart.js 3.9, as one file")
find_file(SPRINGPROOF_THREE_JS three.min.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH
          DOC "three.js r111, as one file")
find_file(SPRINGPROOF_ORBIT_CONTROLS_JS OrbitControls.js
          PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH
          DOC "OrbitControls of three.js r111, as a plain script")

function(springproof_require_js variable what package)
  if(NOT ${variable})
    message(FATAL_ERROR "The report needs ${what}, which is not there.\n"
                        "Install Debian's package:  sudo apt-get install ${package}\n"
                        "or say where the file is:  cmake -D${variable}=/path/to/the/file.js ...")
  endif()
endfunction()
springproof_require_js(SPRINGPROOF_CHART_JS "Chart.js 3.9 (chart.min.js)" libjs-chart.js)
springproof_require_js(SPRINGPROOF_THREE_JS "three.js r111 (three.min.js)" libjs-three)
springproof_require_js(SPRINGPROOF_ORBIT_CONTROLS_JS "OrbitControls of three.js r111 (OrbitControls.js)" libjs-three)

set(report_dir ${CMAKE_CURRENT_LIST_DIR})
set(report_generated ${CMAKE_CURRENT_BINARY_DIR}/report_assets.cpp)
# name=file; a name that comes again goes on where it stopped.
set(report_assets
    template_html=${report_dir}/report/page/template.html
    style_css=${report_dir}/report/page/style.css
    report_js=${report_dir}/report/page/data.js
    report_js=${report_dir}/report/page/figure.js
    report_js=${report_dir}/report/page/charts.js
    report_js=${report_dir}/report/page/first.js
    report_js=${report_dir}/report/page/line.js
    report_js=${report_dir}/report/page/motion.js
    report_js=${report_dir}/report/page/cracks.js
    report_js=${report_dir}/report/page/stability.js
    report_js=${report_dir}/report/page/cost.js
    report_js=${report_dir}/report/page/splits.js
    report_js=${report_dir}/report/page/measured.js
    report_js=${report_dir}/report/page/colours.js
    report_js=${report_dir}/report/page/pictures.js
    report_js=${report_dir}/report/page/viewer.js
    report_js=${report_dir}/report/page/shapes.js
    report_js=${report_dir}/report/page/problem_picture.js
    report_js=${report_dir}/report/page/regions.js
    report_js=${report_dir}/report/page/pages.js
    report_js=${report_dir}/report/page/verification.js
    report_js=${report_dir}/report/page/fem_column.js
    report_js=${report_dir}/report/page/report.js
    chart_js=${SPRINGPROOF_CHART_JS}
    three_js=${SPRINGPROOF_THREE_JS}
    orbit_controls_js=${SPRINGPROOF_ORBIT_CONTROLS_JS})
list(TRANSFORM report_assets REPLACE "^[a-z_]+=" "" OUTPUT_VARIABLE report_asset_files)
add_custom_command(
  OUTPUT ${report_generated}
  COMMAND ${CMAKE_COMMAND} "-DASSETS=${report_assets}" -DOUTPUT=${report_generated} -P ${report_dir}/report/embed.cmake
  DEPENDS ${report_asset_files} ${report_dir}/report/embed.cmake
  COMMENT "Embedding the report's page and its libraries"
  VERBATIM)

set_source_files_properties(${report_generated} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # an edited script compiles no source again
springproof_sources(report_sources results report)
add_library(report STATIC ${report_sources} ${report_generated})
springproof_uses_headers(report headers_with_json)
set(report_view ${CMAKE_BINARY_DIR}/arrows/comparisons)
file(MAKE_DIRECTORY ${report_view})
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/comparisons ${report_view}/comparisons SYMBOLIC)
target_include_directories(report PUBLIC ${report_view})
find_package(TinyGLTF REQUIRED)
target_link_libraries(report PUBLIC problem meshes nlohmann_json::nlohmann_json
                             PRIVATE springproof_warnings fmt::fmt TinyGLTF::TinyGLTF)
