// Assets of the HTML pages, embedded at build time (report.cmake).
#pragma once

#include <string_view>

namespace springproof::report_assets {

extern const std::string_view template_html;  ///< with placeholders @name@ for the rest
extern const std::string_view style_css;
extern const std::string_view report_js;
extern const std::string_view chart_js;           ///< Chart.js 3.9, MIT licence
extern const std::string_view three_js;           ///< three.js r111, MIT licence
extern const std::string_view orbit_controls_js;  ///< of three.js r111, MIT licence

}  // namespace springproof::report_assets
