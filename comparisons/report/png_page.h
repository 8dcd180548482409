// Extracts PNG files from report.html with headless Chromium.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace springproof {

struct PngFile {
  std::string name;  ///< "golec_2019-torsion-shapes-displacement-nu0.4.png"
  std::string bytes;
};

struct PngPage {
  std::vector<PngFile> files;
  std::vector<std::string> failed;  ///< a sentence each
};

/// The pictures in the page that the report becomes with the fragment "#png=N" (report/figure.js).
/// @throws std::runtime_error if the page was not completed.
PngPage png_page(const std::string& dom);

/// Chromium on the search path (chromium, chromium-browser, google-chrome); empty: none.
std::filesystem::path find_chromium();

/// The DOM of the page after Chromium has run its scripts, for at most `time_limit` seconds.
/// @throws std::runtime_error if it cannot be started, fails or takes longer.
std::string dump_dom(const std::filesystem::path& chromium, const std::filesystem::path& page,
                     const std::string& fragment, double time_limit);

}  // namespace springproof
