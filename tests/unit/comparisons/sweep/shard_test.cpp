// Shares of a comparison, and what keeps those that compute them from each other.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "comparisons/sweep/folder_lock.h"
#include "comparisons/sweep/sweep.h"
#include "problem/processes/child.h"

namespace springproof::shard_test {
namespace {

TEST(Shard, IsReadAsAShareOfAll) {
  EXPECT_EQ(parse_shard("3/16").number, 3);
  EXPECT_EQ(parse_shard("3/16").count, 16);
  EXPECT_EQ(parse_shard("1/1").count, 1);
  for (const char* text :
       {"", "3", "/", "0/4", "5/4", "a/b", "1/4x", "1 /4", "+1/4", "1/4/5", "1/10001", "1/-1", "1/4294967297"})
    EXPECT_THROW(parse_shard(text), InputError) << text;
}

TEST(Shard, EqualPartsGoRound) {
  EXPECT_EQ(shards_of({1, 1, 1, 1, 1}, 2), (std::vector<int>{1, 2, 1, 2, 1}));
  EXPECT_EQ(shards_of({1, 1}, 4), (std::vector<int>{1, 2}));
  EXPECT_TRUE(shards_of({}, 3).empty());
}

TEST(Shard, LongPartsAreSharedOutFirst) {
  EXPECT_EQ(longest_first({1, 8, 2, 8}), (std::vector<std::size_t>{1, 3, 2, 0}));
  EXPECT_EQ(shards_of({1, 8, 2, 3, 2}, 2), (std::vector<int>{2, 1, 2, 2, 2}));
}

// No shard has more than the shortest that is possible, and one part.
TEST(Shard, NoneHasMuchMoreToDoThanTheOthers) {
  std::vector<double> seconds;
  for (int i = 0; i < 97; ++i) seconds.push_back(1 + i * 37 % 101);
  for (const int count : {2, 5, 16}) {
    std::vector<double> load(static_cast<std::size_t>(count), 0);
    const std::vector<int> shards = shards_of(seconds, count);
    for (std::size_t i = 0; i < seconds.size(); ++i) load[static_cast<std::size_t>(shards[i] - 1)] += seconds[i];
    const auto [least, most] = std::minmax_element(load.begin(), load.end());
    EXPECT_LE(*most - *least, 101) << count;
  }
}

TEST(ByteLock, IsOfOneByteAndEndsWithIt) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "plan";
  std::ofstream(file) << "x";
  {
    const ByteLock first(file, 1, "taken");
    const ByteLock second(file, 2, "taken");
    EXPECT_THROW(ByteLock(file, 1, "taken"), InputError);
    EXPECT_THROW(ByteLock(file, ByteLock::all, "taken"), InputError);
    EXPECT_TRUE(is_locked(file, 1));
    EXPECT_FALSE(is_locked(file, 3));
  }
  EXPECT_FALSE(is_locked(file, 1));
  const ByteLock all(file, ByteLock::all, "taken");
  EXPECT_THROW(ByteLock(file, 7, "taken"), InputError);
  EXPECT_NO_THROW(ByteLock(folder.path / "missing", 1, "taken"));
}

TEST(FolderLock, IsSharedByShards) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder.path / "out";
  std::filesystem::create_directory(out);
  const FolderLock first(out, FolderLock::beside_shards);
  EXPECT_NO_THROW(FolderLock(out, FolderLock::beside_shards));
  EXPECT_THROW(FolderLock(out, FolderLock::alone), InputError);
}

Sweep sweep_of(int shards) {
  return {"0", "deal.II 1", shards,
          1,   false,       {{"/a.toml", "what = 'K\xf6rper'", "a", "a", {{0.3, "a-nu0.3.cbor", "stamp", 2}}}}};
}

TEST(Sweep, FirstPlanHolds) {
  const TemporaryFolder folder;
  EXPECT_EQ(common_plan(folder.path, sweep_of(2)).cases[0].parts[0].shard, 2);
  Sweep other = sweep_of(2);
  other.cases[0].parts[0].shard = 1;
  const Sweep held = common_plan(folder.path, other);
  EXPECT_EQ(held.cases[0].parts[0].shard, 2) << "two plans for one folder";
  EXPECT_EQ(held.cases[0].text, sweep_of(2).cases[0].text);
  EXPECT_EQ(title_of(held.cases[0], held.cases[0].parts[0]), "a  nu0.3");
  EXPECT_THROW(common_plan(folder.path, sweep_of(3)), InputError);
  other.cases[0].parts[0].stamp = "another";
  EXPECT_THROW(common_plan(folder.path, other), InputError);
  other = sweep_of(2);
  other.libraries = "deal.II 2";
  EXPECT_THROW(common_plan(folder.path, other), InputError);
  other = sweep_of(2);
  other.cases.clear();
  EXPECT_THROW(common_plan(folder.path, other), InputError);
}

TEST(Sweep, KeepsWhatMeshingToldOfACase) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path / "parts");
  CaseResult meshed, back;
  meshed.size = {1, 2, 3};
  meshed.cells = {{4, 4, 4}, {8, 8, 8}};
  meshed.notes = {"a note"};
  meshed.own_poisson_ratios = {{"msm_18", 0.25}};
  meshed.laws = {{"hybmss_avg", "hencky"}};
  meshed.made_of = {{"hybmss_avg", "a term per cell"}};
  EXPECT_FALSE(load_meshed(folder.path, "a", back));
  save_meshed(folder.path, "a", meshed);
  EXPECT_TRUE(load_meshed(folder.path, "a", back));
  EXPECT_EQ(back.size, meshed.size);
  EXPECT_EQ(back.cells, meshed.cells);
  EXPECT_EQ(back.notes, meshed.notes);
  EXPECT_EQ(back.own_poisson_ratios, meshed.own_poisson_ratios);
  EXPECT_EQ(back.laws, meshed.laws);
  EXPECT_EQ(back.made_of, meshed.made_of);
}

TEST(Sweep, PlanThatIsNotWholeIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_plan(folder.path), InputError);
  std::ofstream(sweep_file(folder.path)) << "springproof sweep 1 ";
  EXPECT_THROW(read_plan(folder.path), InputError);
  EXPECT_THROW(common_plan(folder.path, sweep_of(2)), InputError);
}

}  // namespace
}  // namespace springproof::shard_test
