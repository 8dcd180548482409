#include "comparisons/sweep/sweep.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "problem/files/checked_file.h"
#include "problem/system/json.h"

namespace springproof {

namespace fs = std::filesystem;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedPart, poisson_ratio, file, stamp, shard)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlannedCase, file, text, name, key, parts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Sweep, version, libraries, shards, finer, vtu, cases)

namespace {

constexpr std::string_view plan_heading = "springproof sweep 1 ", meshed_heading = "springproof case 2 ";

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
    throw InputError(
        fmt::format("--shard: is one of {}, but {} holds a sweep of {} shards (allowed: 1/{} to {}/{}, or "
                    "another --out)",
                    own.shards, name, there.shards, there.shards, there.shards, there.shards));
  if (made_by(there) != made_by(own))
    throw InputError(
        fmt::format("--out: {} holds a sweep of {}, this is {} (allowed: the same on every machine, or "
                    "another --out)",
                    name, made_by(there), made_by(own)));
  const auto parts_there = parts_of(there), parts_here = parts_of(own);
  for (const auto& [file, part] : parts_here)
    if (!parts_there.contains(file))
      throw InputError(
          fmt::format("--out: {} holds a sweep without {} (allowed: the same cases in every shard, or "
                      "another --out)",
                      name, part.title));
  for (const auto& [file, part] : parts_there) {
    const auto here = parts_here.find(file);
    if (here == parts_here.end())
      throw InputError(
          fmt::format("--out: {} holds a sweep with {} too (allowed: the same cases in every shard, or "
                      "another --out)",
                      name, part.title));
    if (here->second.stamp != part.stamp)
      throw InputError(
          fmt::format("--out: {} holds a sweep in which {} is computed from other inputs: the case, its "
                      "body's files, --finer or --vtu differ (allowed: the same in every shard, or another "
                      "--out)",
                      name, part.title));
  }
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

void save_meshed(const fs::path& folder, const std::string& key, const CaseResult& meshed) {
  write_checked(meshed_file(folder, key), meshed_heading,
                cbor({{"size", meshed.size},
                      {"cells", meshed.cells},
                      {"notes", meshed.notes},
                      {"own_poisson_ratios", meshed.own_poisson_ratios},
                      {"laws", meshed.laws},
                      {"made_of", meshed.made_of},
                      {"regions", meshed.regions},
                      {"section", meshed.section_svg}}));
}

bool load_meshed(const fs::path& folder, const std::string& key, CaseResult& result) try {
  const nlohmann::json meshed = nlohmann::json::from_cbor(read_checked(meshed_file(folder, key), meshed_heading));
  meshed.at("size").get_to(result.size);
  meshed.at("cells").get_to(result.cells);
  meshed.at("notes").get_to(result.notes);
  meshed.at("own_poisson_ratios").get_to(result.own_poisson_ratios);
  meshed.at("laws").get_to(result.laws);
  meshed.at("made_of").get_to(result.made_of);
  meshed.at("regions").get_to(result.regions);
  meshed.at("section").get_to(result.section_svg);
  return true;
} catch (const std::exception&) {  // not there, or damaged
  return false;
}

std::string title_of(const PlannedCase& planned, const PlannedPart& part) {
  return fmt::format("{}  nu{}", planned.name, part.poisson_ratio);
}

}  // namespace springproof
