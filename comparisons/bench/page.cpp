#include "comparisons/bench/page.h"

#include <nlohmann/json.hpp>

#include "comparisons/report/assets.h"
#include "comparisons/report/page.h"
#include "comparisons/results/records.h"
#include "problem/system/files.h"

namespace springproof::bench {

void write_page(const std::filesystem::path& file, const nlohmann::json& document) {
  using namespace report_assets;
  write_file(file, filled(bench_html, {{"style_css", std::string(style_css)},
                                       {"results", script_json(document)},
                                       {"chart_js", std::string(chart_js)},
                                       {"bench_js", std::string(bench_js)}}));
}

}  // namespace springproof::bench
