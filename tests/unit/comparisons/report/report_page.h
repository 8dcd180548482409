// Reports of made-up cases, as files and as Chromium shows them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "comparisons/report/report.h"
#include "comparisons/results/records.h"

namespace springproof {

/// results.json of some cases.
inline nlohmann::json document(const std::vector<CaseResult>& cases) {
  nlohmann::json out = {{"program", {{"name", "springproof"}, {"version", "0.1.0"}, {"libraries", "none"}}},
                        {"generated", "2026-01-01T00:00:00Z"},
                        {"host", {{"cores", 2}}},
                        {"cases", nlohmann::json::array()}};
  for (const auto& c : cases) out["cases"].push_back(to_json(c));
  return out;
}

inline nlohmann::json pictures(const std::vector<CaseResult>& cases) {
  nlohmann::json out = nlohmann::json::array();
  for (const auto& c : cases) out.push_back(pictures_to_json(c));
  return out;
}

inline std::string slurp(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

class Report : public testing::Test {
 protected:
  std::string write(const std::vector<CaseResult>& cases) {
    write_report(file, headline(cases), document(cases), pictures(cases));
    return slurp(file);
  }
  void TearDown() override { std::filesystem::remove(file); }

  /// "springproof_TextCannotLeaveItsPlace.html"; slashes of a test with a parameter become dots.
  static std::string file_name() {
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '.');
    return "springproof_" + name + ".html";
  }
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / file_name();
};

/// Skipped where there is no Chromium.
class ReportInBrowser : public Report {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium > /dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed (apt-get install chromium)";
  }
  void TearDown() override {
    std::filesystem::remove_all(profile);
    Report::TearDown();
  }

  /// The page as the browser holds it after the scripts have run, and its console.
  std::string open(const std::vector<CaseResult>& cases, const std::string& fragment = "") {
    write(cases);
    return visit(file, fragment);
  }

  /// The same with a script that runs after the page's own.
  std::string open_with(const std::vector<CaseResult>& cases, const nlohmann::json& pictures, const std::string& script,
                        const std::string& fragment = "", const std::string& options = whole_page) {
    write_report(file, headline(cases), document(cases), pictures);
    add_script(script);
    return visit(file, fragment, options);
  }

  void add_script(const std::string& script) {
    std::string page = slurp(file);
    page.insert(page.rfind("</body>"), "<script>" + script + "</script>");
    std::ofstream(file, std::ios::binary) << page;
  }

  std::string visit(const std::filesystem::path& page, const std::string& fragment = "",
                    const std::string& options = whole_page) {
    const std::string command =
        "timeout 300 chromium --headless --no-sandbox --use-gl=angle --use-angle=swiftshader --disable-gpu-compositing "
        "--enable-unsafe-swiftshader --disable-quic --no-first-run --disable-background-networking "
        "--disable-component-update --disable-sync --enable-logging=stderr " +
        options + " --user-data-dir='" + profile.string() + "' --dump-dom 'file://" + page.string() + fragment +
        "' 2>&1 | grep -v 'GL Driver Message'";  // on the speed of reading pixels back
    std::string out;
    if (FILE* pipe = popen(command.c_str(), "r")) {
      char buffer[4096];
      while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, n);
      pclose(pipe);
    }
    return out;
  }

  static constexpr const char *whole_page = "--window-size=1400,7500", *one_screen = "--window-size=1400,900";
  const std::filesystem::path profile = file.string() + ".profile";
};

inline void expect_no_complaint(const std::string& dom) {
  ASSERT_NE(dom.find("</html>"), std::string::npos) << dom.substr(0, 2000);
  EXPECT_EQ(dom.find("could not be drawn: "), dom.find("could not be drawn: ${")) << "a section was not drawn";
  EXPECT_EQ(dom.find(":CONSOLE"), std::string::npos) << dom.substr(dom.find(":CONSOLE"), 300);
}

/// What a script said.
inline std::string said(const std::string& dom) {
  return dom.substr(std::min(dom.find("<p class=\"said\">"), dom.size()));
}

/// For scripts: the browser holds the page to be loading until endLoading() is called, and shows its document then;
/// colours of a canvas of the page, of any kind, as numbers; what a test wants to say.
inline const std::string tools = R"js(
  const loading = document.body.appendChild(Object.assign(document.createElement('iframe'), {hidden: true}));
  loading.contentDocument.open();
  const endLoading = () => loading.contentDocument.close();
  addEventListener('error', endLoading);
  /// Frames come when the machine has time for them: looks ten times a second, for a minute at most.
  const until = (holds, then, left = 600) => holds() || left === 0 ? then() : setTimeout(until, 100, holds, then, left - 1);
  const pixelsOf = canvas => {
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const ctx = copy.getContext('2d');
    ctx.drawImage(canvas, 0, 0);
    return new Uint32Array(ctx.getImageData(0, 0, copy.width, copy.height).data.buffer);
  };
  const coloursOf = canvas => canvas.width * canvas.height === 0 ? 0 : new Set(pixelsOf(canvas)).size;
  const drawn = canvas => coloursOf(canvas) > 20;
  const say = text => document.body.append(Object.assign(document.createElement('p'), {className: 'said', textContent: text}));
)js";

}  // namespace springproof
