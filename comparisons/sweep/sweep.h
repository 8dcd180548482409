// The plan of a comparison whose parts several machines compute into one folder, each a share of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/results/records.h"
#include "problem/files/new_file.h"

namespace springproof {

/// One case at one Poisson's ratio.
struct PlannedPart {
  double poisson_ratio = 0;
  std::string file;   ///< in the folder's parts/
  std::string stamp;  ///< identifies its inputs, save_part()
  int shard = 0;      ///< that computes it
};

struct PlannedCase {
  std::string file, text;
  std::string name;  ///< "golec_2019/bending"
  std::string key;   ///< the same as the name of files
  std::vector<PlannedPart> parts;
};

struct Sweep {
  std::string version, libraries;  ///< of the program, of the reference
  int shards = 1;
  int finer = 1;  ///< SuiteOptions::finer
  bool vtu = false;
  std::vector<PlannedCase> cases;
};

/// The file of the plan.  Shard k holds a lock of its byte k, a report one of byte 0.
std::filesystem::path sweep_file(const std::filesystem::path& folder);

/// The plan that all shards in the folder follow: that of the first of them, which may be this one.
/// @throws InputError if it differs from `own` in anything but which shard computes what.
Sweep common_plan(const std::filesystem::path& folder, const Sweep& own);

/// @throws InputError if the folder holds no plan, or one by another version of the program.
Sweep read_plan(const std::filesystem::path& folder);

/// @throws InputError if there is none.
const PlannedCase& case_of_key(const Sweep& sweep, const std::string& key);

/// Keeps in the folder what was known of a case when it was meshed: with the plan and the parts enough for a report.
void save_meshed(const std::filesystem::path& folder, const std::string& key, const MeshedCase& meshed);

/// @return whether it is there, and whole.
bool load_meshed(const std::filesystem::path& folder, const std::string& key, MeshedCase& meshed);

/// `stamp` identifies the inputs of the part; a part is only loaded with the same stamp.
void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part);

/// Nothing if there is no such file or its stamp differs.
/// @throws DamagedFile
std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp);

/// "golec_2019/bending  nu0.3"
std::string title_of(const PlannedCase& planned, const PlannedPart& part);

/// One of `count` shares, numbered from 1.
struct Shard {
  int number = 1, count = 1;
};

inline constexpr int most_shards = 10000;

/// Reads "3/16".
/// @throws InputError
Shard parse_shard(const std::string& text);

/// The number of the shard of each part: the longest parts first, each to the shard with the least to do.  Parts that
/// take equally long go round.
std::vector<int> shards_of(const std::vector<double>& expected_seconds, int count);

/// The parts in the order in which they are to be started: none of the long ones is left for the end.
std::vector<std::size_t> longest_first(const std::vector<double>& expected_seconds);

}  // namespace springproof
