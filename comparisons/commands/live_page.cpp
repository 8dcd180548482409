#include "comparisons/commands/live_page.h"

#include <fmt/format.h>

#include "problem/processes/child.h"
#include "problem/system/input_error.h"

namespace springproof {

std::filesystem::path live_page() {
  const std::filesystem::path page = data_folder("live", SPRINGPROOF_LIVE_DIR) / "live.html";
  if (!std::filesystem::exists(page))
    throw InputError(
        fmt::format("--live: the live page is not built, {} is not there (in the sources: "
                    "comparisons/live/build.sh, which needs Debian's packages emscripten and node-acorn)",
                    page.string()));
  return page;
}

}  // namespace springproof
