#include "comparisons/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "comparisons/results/records_json.h"
#include "problem/system/input_error.h"
#include "problem/system/json.h"
#include "problem/system/shortened.h"

namespace springproof {

namespace fs = std::filesystem;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedPart, poisson_ratio, file, stamp, shard)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedCase, file, text, name, key, parts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Sweep, version, libraries, shards, finer, vtu, cases)

namespace {

constexpr std::string_view plan_heading = "springproof sweep 1 ", meshed_heading = "springproof case 3 ";

fs::path meshed_file(const fs::path& folder, const std::string& key) { return folder / "parts" / (key + ".case.cbor"); }

Sweep read(const fs::path& file) try {
  return nlohmann::json::from_cbor(read_checked(file, plan_heading)).get<Sweep>();
} catch (const std::exception&) {
  throw InputError(fmt::format("{} is damaged (remove it: the next shard writes it anew)", file.string()));
}

struct Titled {
  std::string title, stamp;
};

/// By file: a part of the same name in both plans is the same part.
std::map<std::string, Titled> parts_of(const Sweep& sweep) {
  std::map<std::string, Titled> parts;
  for (const PlannedCase& c : sweep.cases)
    for (const PlannedPart& p : c.parts) parts[p.file] = {title_of(c, p), p.stamp};
  return parts;
}

std::string made_by(const Sweep& s) {
  return fmt::format("springproof {} with {}", s.version, s.libraries.empty() ? "no finite elements" : s.libraries);
}

void require_same(const fs::path& folder, const Sweep& there, const Sweep& own) {
  const std::string name = folder.string();
  if (there.shards != own.shards)
    throw InputError(fmt::format(
        "--shard: is one of {0}, but {1} holds a sweep of {2} shards (allowed: 1/{2} to {2}/{2}, or another "
        "--out)",
        own.shards, name, there.shards));
  const auto refuse = [&](const std::string& what, const char* allowed) {
    throw InputError(fmt::format("--out: {} holds a sweep {} (allowed: {}, or another --out)", name, what, allowed));
  };
  if (made_by(there) != made_by(own))
    refuse(fmt::format("of {}, this is {}", made_by(there), made_by(own)), "the same on every machine");
  const auto parts_there = parts_of(there), parts_here = parts_of(own);
  for (const auto& [file, part] : parts_here)
    if (!parts_there.contains(file)) refuse("without " + part.title, "the same cases in every shard");
  for (const auto& [file, part] : parts_there) {
    const auto here = parts_here.find(file);
    if (here == parts_here.end()) refuse(fmt::format("with {} too", part.title), "the same cases in every shard");
    if (here->second.stamp != part.stamp)
      refuse(
          fmt::format("in which {} is computed from other inputs: the case, its body's files, --finer or --vtu differ",
                      part.title),
          "the same in every shard");
  }
}

/// 0: no number.
int whole_number(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

}  // namespace

fs::path sweep_file(const fs::path& folder) { return folder / "sweep.cbor"; }

Sweep common_plan(const fs::path& folder, const Sweep& own) {
  if (create_checked(sweep_file(folder), plan_heading, cbor(own))) return own;
  Sweep there = read(sweep_file(folder));
  require_same(folder, there, own);
  return there;
}

Sweep read_plan(const fs::path& folder) {
  const fs::path file = sweep_file(folder);
  if (!fs::exists(file))
    throw InputError(fmt::format("{}: no {} here (wanted: the folder that `springproof compare --shard` writes into)",
                                 folder.string(), file.filename().string()));
  Sweep sweep = read(file);
  if (sweep.version != SPRINGPROOF_VERSION)
    throw InputError(
        fmt::format("{}: a sweep of springproof {}, this is {} (take that one, or start the sweep anew in "
                    "another folder)",
                    folder.string(), sweep.version, SPRINGPROOF_VERSION));
  return sweep;
}

const PlannedCase& case_of_key(const Sweep& sweep, const std::string& key) {
  for (const PlannedCase& c : sweep.cases)
    if (c.key == key) return c;
  throw InputError(fmt::format("no case {} in the plan", key));
}

void save_meshed(const fs::path& folder, const std::string& key, const MeshedCase& meshed) {
  write_checked(meshed_file(folder, key), meshed_heading, cbor(meshed));
}

bool load_meshed(const fs::path& folder, const std::string& key, MeshedCase& meshed) try {
  nlohmann::json::from_cbor(read_checked(meshed_file(folder, key), meshed_heading)).get_to(meshed);
  return true;
} catch (const std::exception&) {  // not there, or damaged
  return false;
}

std::string title_of(const PlannedCase& planned, const PlannedPart& part) {
  return fmt::format("{}  nu{}", planned.name, part.poisson_ratio);
}

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard shard{0, 0};
  if (slash != std::string::npos)
    shard = {whole_number(std::string_view(text).substr(0, slash)),
             whole_number(std::string_view(text).substr(slash + 1))};
  if (shard.number < 1 || shard.number > shard.count || shard.count > most_shards)
    throw InputError(shortened(fmt::format(
        "--shard: is {} (allowed: K/N, the K-th of N shares, K from 1 to N, N up to {})", text, most_shards)));
  return shard;
}

std::vector<std::size_t> longest_first(const std::vector<double>& seconds) {
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return seconds[a] > seconds[b]; });
  return order;
}

std::vector<int> shards_of(const std::vector<double>& expected_seconds, int count) {
  std::vector<double> load(static_cast<std::size_t>(count), 0.0);
  std::vector<int> shards(expected_seconds.size());
  for (const std::size_t part : longest_first(expected_seconds)) {
    const auto least = std::ranges::min_element(load);
    *least += expected_seconds[part];
    shards[part] = static_cast<int>(least - load.begin()) + 1;
  }
  return shards;
}

}  // namespace springproof
