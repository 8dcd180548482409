// What the table of keys says of each key is what the readers do: its example is read, and a date in its place is
// refused in its words.
#include "problem/case_file/keys.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"

namespace springproof::keys_test {
namespace {

using Values = std::map<std::string, std::string>;

/// Lines that a key needs beside it in its table; "" takes out one that the table has otherwise.
Values beside(const std::string& table, const std::string& key) {
  static const std::map<std::string, Values> of_table = {
      {"body", {{"size_m", "[0.06, 0.01, 0.01]"}, {"cells", "[12, 2, 2]"}}},
      {"patch", {{"box_m", "[[0, 0, 0], [1, 1, 1]]"}}},
      {"material", {{"youngs_modulus_Pa", "1e6"}, {"poisson_ratio", "0.25"}}},
      {"region", {{"volume", "\"tumour\""}, {"youngs_modulus_Pa", "1e6"}, {"poisson_ratio", "0.25"}}},
      {"expect", {{"value", "1"}, {"within", "0.04"}}},
      {"mass", {{"on", "\"x_max\""}}},
      {"load_case", {{"with", "{ mass = [] }"}}},
      {"measured", {{"values", "[{ name = \"sag\", quantity = \"displacement.tip.z\", value = -0.01, u = 3e-4 }]"}}},
      {"measured.values", {{"value", "-0.0108"}, {"u", "3e-4"}}},
      {"input", {{"of", "\"body.size_m[2]\""}, {"u", "3e-4"}}},
      {"external", {{"file", "\"abaqus.csv\""}}}};
  static const Values voxels = {{"cells", ""}, {"voxels", "100"}}, no_young = {{"youngs_modulus_Pa", ""}},
                      no_volume = {{"volume", ""}};
  static const std::map<std::string, Values> of_key = {
      {"body.scale", {{"geo", "\"hand.stl\""}, {"size_m", ""}, {"cells", ""}, {"voxels", "100"}}},
      {"body.voxels", voxels},
      {"body.voxel_edge_m", {{"cells", ""}}},
      {"body.cut", voxels},
      {"body.accuracy", voxels},
      {"body.coarsened", voxels},
      {"material.shear_modulus_Pa", no_young},
      {"material.bulk_modulus_Pa", no_young},
      {"material.lame_lambda_Pa", no_young},
      {"region.box_m", no_volume},
      {"region.near", no_volume},
      {"region.beyond", no_volume},
      {"region.stl", no_volume},
      {"region.scale", {{"volume", ""}, {"stl", "\"tumour.stl\""}}},
      {"region.shear_modulus_Pa", no_young},
      {"region.bulk_modulus_Pa", no_young},
      {"region.lame_lambda_Pa", no_young},
      {"compare.exact", {{"models", "[]"}}},
      {"mass.at_m", {{"on", ""}}},
      {"input.with", {{"of", ""}, {"u", ""}}},
      {"measured.values.arm_m", {{"quantity", "\"mean_displacement.x_max.z\""}}},
      {"measured.histories.arm_m", {{"quantity", "\"mean_displacement.x_max.z\""}}},
      {"reference.integrator", {{"in_time", "true"}}},
      {"expect.within_relative", {{"within", ""}}},
      {"expect.at_least", {{"value", ""}, {"within", ""}}},
      {"external.files", {{"file", ""}}},
      {"dynamics.loss_factor", {{"band_Hz", "[1, 3]"}}},
      {"dynamics.band_Hz", {{"loss_factor", "0.1"}}}};
  Values lines;
  if (const auto of = of_table.find(table); of != of_table.end()) lines = of->second;
  if (const auto of = of_key.find(table + "." + key); of != of_key.end())
    for (const auto& [name, value] : of->second) lines[name] = value;
  return lines;
}

/// The key's table: its required keys, what else the key needs, and the key with a value.
std::string table_with(const KeyTable& table, const Key& key, const std::string& value) {
  Values lines;
  for (const Key& k : table.keys)
    if (!k.otherwise) lines[k.name] = k.example;
  for (const auto& [name, line] : beside(table.name, key.name)) lines[name] = line;
  lines[key.name] = value;
  std::string text;
  for (const auto& [name, line] : lines)
    if (!line.empty()) text += name + " = " + line + "\n";
  return text;
}

/// How a table is headed, with the table that it is part of.
std::string heading_of(const std::string& table) {
  static const std::map<std::string, std::string> parts = {
      {"patch.beyond", "[[patch]]\nname = \"wrist\"\n[patch.beyond]\n"},
      {"patch.facing", "[[patch]]\nname = \"wrist\"\n[patch.facing]\n"},
      {"patch.near", "[[patch]]\nname = \"wrist\"\n[patch.near]\n"},
      {"material.relaxation.branches", "[[material.relaxation.branches]]\n"},
      {"external.files", "[[external]]\nname = \"abaqus\"\n[[external.files]]\n"},
      {"identify.parameters", "[[identify]]\nname = \"modulus\"\n[[identify.parameters]]\n"},
      {"measured.histories", "[[measured]]\nsource = \"here\"\nlicence = \"none\"\n[[measured.histories]]\n"},
      {"measured.values", "[[measured]]\nsource = \"here\"\nlicence = \"none\"\n[[measured.values]]\n"},
      {"load_case", "[[load_case]]\nname = \"52 g\"\n[[load_case]]\n"},
      {"dynamics.plane", "[dynamics]\nduration_s = 10\n[dynamics.plane]\n"}};
  if (const auto part = parts.find(table); part != parts.end()) return part->second;
  if (table.starts_with("load.")) return "[[load]]\n";
  const std::set<std::string> several = {"patch",    "mass",  "probe",    "expect", "published",
                                         "external", "input", "measured", "region", "identify"};
  return several.contains(table) ? "[[" + table + "]]\n" : "[" + table + "]\n";
}

/// What stands before and after a table of measured values, or of what is beside them.
std::pair<std::string, std::string> around_measured(const std::string& table, const std::string& key) {
  const bool identified = table.starts_with("identify");
  if (!table.starts_with("measured") && !identified && table != "load_case" && table != "input") return {};
  const bool fit = key == "fitted" || key == "use" || identified;
  std::string before =
      "[[mass]]\nname = \"weight\"\non = \"x_max\"\nmass_kg = 0.052\n[[probe]]\nname = \"tip\"\nat_m = [0, 0, 0]\n"
      "[compare]\nmeasures = [\"probe\", \"mean_displacement\"]\n";
  if (table != "load_case")
    before += "[[load_case]]\nname = \"52 g\"\n[[load_case]]\nname = \"own weight\"\nwith = { mass = [] }\n";
  if (table == "measured.histories") {
    std::ofstream("creep.csv") << "time_s,value_m,u_m\n1,-0.01,3e-4\n2,-0.011,3e-4\n";
    before += "[material.relaxation]\nbranches = [{ share = 0.1, time_s = 1 }]\n";
  }
  if (fit && table != "input")
    before += "[[input]]\nname = \"E\"\nof = \"material.youngs_modulus_Pa\"\nu = 1\nfitted = true\n";
  if (table.starts_with("measured")) return {before, ""};
  return {before,
          std::string("[[measured]]\nsource = \"here\"\nlicence = \"none\"\nvalues = [{ name = \"sag\", quantity = "
                      "\"displacement.tip.z\", value = 0.01, u = 0.001") +
              (fit ? ", use = \"fit\"" : "") + " }]\n"};
}

/// A case in which the key has a value.
std::string case_with(const KeyTable& table, const Key& key, const std::string& value) {
  const std::string name = table.name, full = name + "." + key.name;
  const bool in_time = full == "reference.in_time" || full == "reference.integrator";
  const bool exact = full == "compare.exact" || name == "load.body_force_of";
  const bool voxels =
      name.starts_with("patch") || full == "compare.parts" || full == "reference.edge_m" || full == "reference.refine";
  std::string text;
  if (name.empty()) text += table_with(table, key, value).append("\n");
  if (name.starts_with("dynamics") || in_time) text += "kinematics = \"hencky\"\n";
  const auto add = [&](const std::string& other, const std::string& lines) {
    if (name != other) text += lines;
  };
  add("body", std::string("[body]\ngeo = \"beam.geo\"\nsize_m = [0.06, 0.01, 0.01]\n") +
                  (voxels ? "voxels = 100\n" : "cells = [12, 2, 2]\n"));
  add("material", "[material]\nyoungs_modulus_Pa = 1e6\npoisson_ratio = 0.25\ndensity_kg_m3 = 1000\n");
  text += "[[load]]\non = \"y_min\"\ndisplacement_m = [0, 0, 0]\n";
  if (name == "line") text += "[[load]]\nforce_N = [0, 0, -1]\nat_m = [0.03, 0.005, 0.005]\n";
  if (exact || name == "region") text += "[reference]\nelements = [\"q2\"]\n";
  if (name == "load.body_force_of" || name == "region") text += "[compare]\nmodels = []\n";
  if (in_time) text += "[[probe]]\nname = \"tip\"\nat_m = [0, 0, 0]\n[dynamics]\nduration_s = 1\n";
  const auto [before, after] = around_measured(name, key.name);
  if (!name.empty()) text += before + heading_of(name) + table_with(table, key, value) + after;
  return text;
}

template <class Check>
void for_each_key(const Check& check) {
  int keys = 0;
  for (const KeyTable& table : key_tables())
    for (const Key& key : table.keys) {
      if (!*key.example) continue;  // heads a table of its own
      SCOPED_TRACE(std::string(table.name) + "." + key.name);
      check(table, key);
      ++keys;
    }
  EXPECT_GT(keys, 100);
}

/// The words behind "allowed: " of a refusal.
std::string allowed_in(const std::string& message) {
  const std::string before = "(allowed: ";
  const auto begin = message.find(before);
  if (begin == std::string::npos) return message;
  return message.substr(begin + before.size(), message.rfind(')') - begin - before.size());
}

/// Whether the readers ask for a name, whose list is that of the case or of another table.
bool is_a_name(const Key& key) {
  const std::string allowed = key.allowed;
  for (const char* begin : {"a name", "the name", "a model", "a patch name", "table or figure"})
    if (allowed.starts_with(begin)) return true;
  return false;
}

TEST(KeysOfCaseFiles, HaveExamplesThatAreRead) {
  for_each_key([](const KeyTable& table, const Key& key) {
    const std::string text = case_with(table, key, key.example);
    EXPECT_NO_THROW(parse_experiment(text, "case.toml")) << test::message_of(text) << "\n" << text;
  });
}

TEST(KeysOfCaseFiles, AreRefusedInTheWordsOfTheirTable) {
  for_each_key([](const KeyTable& table, const Key& key) {
    const std::string message = test::message_of(case_with(table, key, "1979-05-27")), allowed = allowed_in(message);
    EXPECT_NE(message.find(std::string(key.name) + ": is"), std::string::npos) << message;
    EXPECT_TRUE(is_a_name(key) || std::string(key.allowed).starts_with(allowed))
        << message << "\nand in the table: " << key.allowed;
  });
}

TEST(KeysOfCaseFiles, StandOnceInTheirTable) {
  for (const KeyTable& table : key_tables()) {
    std::set<std::string> names;
    for (const Key& key : table.keys) EXPECT_TRUE(names.insert(key.name).second) << table.name << "." << key.name;
  }
}

TEST(KeysOfCaseFiles, AreOfTablesThatThereAre) { EXPECT_THROW(keys_of("bodies"), std::logic_error); }

}  // namespace
}  // namespace springproof::keys_test
