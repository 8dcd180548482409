#include "comparisons/reference/run_keeper.h"

#include <string_view>

#include "problem/files/new_file.h"
#include "problem/processes/child.h"
#include "problem/system/json.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

// File format: this heading (problem/files/new_file.h), then the stamp and the run.
constexpr std::string_view run_heading = "springproof run 2 ", run_ending = ".run";

/// Of a program that was killed while it wrote, too.
bool is_ours(const std::string& name) {
  return name.ends_with(run_ending) ||
         (name.ends_with(".part") && name.find(std::string(run_ending) + ".") != name.npos);
}

}  // namespace

RunKeeper::RunKeeper(fs::path folder, std::string stamp, Listener listener, Sayer sayer)
    : folder_(std::move(folder)), stamp_(std::move(stamp)), listener_(std::move(listener)), sayer_(std::move(sayer)) {}

std::optional<nlohmann::json> RunKeeper::find(const std::string& name) const try {
  const fs::path file = folder_ / (name + std::string(run_ending));
  if (!keeps() || !fs::exists(file)) return {};
  nlohmann::json document = nlohmann::json::from_cbor(read_checked(file, run_heading));
  if (document.at("stamp") != stamp_) return {};
  return std::optional(std::move(document.at("run")));
} catch (const DamagedFile& e) {
  to_stderr("note: {}; this run is made anew\n", e.what());
  return {};
}

/// A run that an interrupt has ended early is none.
void RunKeeper::keep(const std::string& name, const nlohmann::json& content) const {
  if (children_interrupted()) return;
  fs::create_directories(folder_);
  write_checked(folder_ / (name + std::string(run_ending)), run_heading, cbor({{"stamp", stamp_}, {"run", content}}));
}

void RunKeeper::tell(const std::string& name, const RunCost& expected, std::optional<double> took) const {
  if (listener_ && told_.insert(name).second) listener_(expected, took);
}

void RunKeeper::forget() const {
  if (!keeps()) return;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder_, ignored), end; entry != end; entry.increment(ignored))
    if (is_ours(entry->path().filename().string())) fs::remove(entry->path(), ignored);
  fs::remove(folder_, ignored);  // if it is empty
}

}  // namespace springproof
