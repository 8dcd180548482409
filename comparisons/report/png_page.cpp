#include "comparisons/report/png_page.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "problem/files/encoding.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

/// Every text between `open` and `close`.
std::vector<std::string> all_between(const std::string& text, const std::string& open, const std::string& close) {
  std::vector<std::string> found;
  for (std::size_t at = 0; (at = text.find(open, at)) != std::string::npos;) {
    at += open.size();
    const std::size_t end = text.find(close, at);
    if (end == std::string::npos) break;
    found.push_back(text.substr(at, end - at));
    at = end;
  }
  return found;
}

/// file:// address of a path.
std::string url_of(const fs::path& path) {
  std::string out = "file://";
  for (const unsigned char c : fs::absolute(path).string())
    out +=
        std::isalnum(c) || std::strchr("/-_.~", c) ? std::string(1, static_cast<char>(c)) : fmt::format("%{:02X}", c);
  return out;
}

}  // namespace

PngPage png_page(const std::string& dom) {
  const std::vector<std::string> done = all_between(dom, "<p class=\"png-done\">", "</p>");
  if (done.empty()) throw std::runtime_error("the browser did not come to the end of the page");
  PngPage page;
  for (const std::string& item : all_between(dom, "<pre class=\"png\" data-name=\"", "</pre>")) {
    const std::size_t quote = item.find('"'), text = item.find('>');
    page.files.push_back({item.substr(0, quote), from_base64(item.substr(text + 1))});
    if (page.files.back().name.find('/') != std::string::npos || !page.files.back().bytes.starts_with("\x89PNG"))
      throw std::runtime_error("the browser gave something that is no PNG");
  }
  page.failed = all_between(dom, "<p class=\"png-failed\">", "</p>");
  return page;
}

fs::path find_chromium() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (const fs::path file = program_on_path(name); !file.empty()) return file;
  return {};
}

std::string dump_dom(const fs::path& chromium, const fs::path& page, const std::string& fragment, double time_limit) {
  const TemporaryFolder folder;
  const fs::path output = folder.path / "dom.html";
  const ChildEnd end =
      run_child({chromium,
                 {"--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                  "--disable-gpu-compositing", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
                  "--disable-background-networking", "--disable-component-update", "--disable-sync",
                  "--user-data-dir=" + (folder.path / "profile").string(), "--dump-dom", url_of(page) + fragment},
                 {},
                 output,
                 "/dev/null",
                 time_limit,
                 true});
  if (end.kind == ChildEnd::out_of_time)
    throw std::runtime_error(fmt::format("not finished after {:g} s; allow more with --time-limit", time_limit));
  if (!end.ok()) throw std::runtime_error(fmt::format("{} {}", chromium.string(), words_for(end)));
  return text_of_file(output);
}

}  // namespace springproof
