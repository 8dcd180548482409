#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <string>

#include "comparisons/commands/commands.h"
#include "comparisons/judge/differences.h"
#include "comparisons/report/png_page.h"
#include "comparisons/sweep/status.h"
#include "problem/case_file/experiment.h"
#include "problem/files/files.h"
#include "problem/system/number_checks.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

/// Percent-encodes text for a URL fragment.
std::string escaped(const std::string& text) {
  std::string out;
  for (const unsigned char c : text)
    out += std::isalnum(c) ? std::string(1, static_cast<char>(c)) : fmt::format("%{:02X}", c);
  return out;
}

/// `springproof pictures FOLDER`.
class PicturesCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0: every picture was written; 1: one was not.
  /// @throws InputError if there is no report in the folder, or no Chromium.
  int run() const;

 private:
  std::filesystem::path folder_ = "springproof-report";
  std::string only_;
  double time_limit_ = 600;
};

void PicturesCommand::add_options(CLI::App& command) {
  command.add_option("FOLDER", folder_, "what `springproof compare` wrote")->capture_default_str();
  command.add_option("--only", only_,
                     "only pictures with this in their name: shapes, error, convergence, split, line, nu0.4, ...");
  command.add_option("--time-limit", time_limit_, "for the pictures of one case [s]")
      ->check(positive())
      ->capture_default_str();
  command.footer(
      "Writes FOLDER/png/CASE-FIGURE-nu....png: every chart, and every 3D view in every colouring, at every Poisson's "
      "ratio.\n"
      "Needs Chromium (apt-get install chromium), no display.  It draws in software, which is slow: on two busy cores "
      "a hundred charts\n"
      "come to about two minutes, a hundred rows of twelve bodies to ten or fifteen.  --only makes it shorter, "
      "--time-limit longer.\n"
      "Exit status: 0 all are written, 1 some could not be drawn, 2 the input is unusable or Chromium is not here.");
}

int PicturesCommand::run() const {
  if (!fs::exists(folder_ / "report.html"))
    throw InputError(
        fmt::format("{}: no report.html here; give the folder that `springproof compare` wrote", folder_.string()));
  const std::vector<std::string> cases = read_results(folder_).cases;
  const fs::path chromium = find_chromium();
  if (chromium.empty())
    throw InputError(
        "the pictures need Chromium (Debian's package: sudo apt-get install chromium); the report's own PNG buttons do "
        "not");
  const fs::path out = folder_ / "png";
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw InputError(fmt::format("{}: {}", out.string(), error.message()));
  std::size_t written = 0, failed = 0;
  {
    Status status;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const std::string title = fmt::format("[{}/{}] {}", i + 1, cases.size(), cases[i]);
      const Status::Working working(status, title);
      progress::phase("drawing");
      try {
        const auto begin = std::chrono::steady_clock::now();
        const std::string fragment = fmt::format("#png={}{}", i, only_.empty() ? "" : "&only=" + escaped(only_));
        const PngPage page = png_page(dump_dom(chromium, folder_ / "report.html", fragment, time_limit_));
        for (const PngFile& file : page.files) write_file(out / file.name, file.bytes);
        for (const std::string& line : page.failed) status.print("not drawn: " + line);
        written += page.files.size();
        failed += page.failed.size();
        status.print(fmt::format("{:<54} {} pictures, {:.1f} s", title, page.files.size(),
                                 std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()));
      } catch (const std::runtime_error& e) {
        ++failed;
        status.print(fmt::format("{:<54} no pictures: {}", title, e.what()));
      }
    }
  }
  to_stdout("{} pictures in {}\n", written, out.string());
  if (written == 0 && failed == 0) to_stderr("no picture has '{}' in its name\n", only_);
  return failed == 0 && written > 0 ? 0 : 1;
}

}  // namespace

RunCommand pictures_command(CLI::App& parser) { return made<PicturesCommand>(parser); }

}  // namespace springproof
