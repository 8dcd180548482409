#include "problem/patch_rule.h"

#include <fmt/format.h>

#include <algorithm>

#include "problem/case_file/experiment_parts.h"

namespace springproof {

PatchRule::Box read_box(const TomlValue& value) {
  const auto corners = as_list_of(2, value, "two corners, [[x, y, z], [x, y, z]]");
  const PatchRule::Box box{as_vector(corners[0]), as_vector(corners[1])};
  for (int axis = 0; axis < 3; ++axis)
    if (!(box.low[axis] < box.high[axis]))
      refuse(corners[1],
             fmt::format("has {} for {}, where the first corner has {}", box.high[axis], "xyz"[axis], box.low[axis]),
             "the lower corner, then the higher one");
  return box;
}

PatchRule::Beyond read_beyond(const TomlValue& value) {
  const TomlTable table(value, keys_of("patch.beyond"));
  return {as_vector(table.at("point_m")), as_direction(table.at("normal"))};
}

PatchRule::Near read_near(const TomlValue& value) {
  const TomlTable table(value, keys_of("patch.near"));
  return {as_vector(table.at("point_m")), as_number(table.at("radius_m"), positive_number)};
}

namespace {

BodySide read_side(const TomlValue& value) {
  const auto names = names_of(BodySide{});
  return static_cast<BodySide>(as_choice_number(value, {names.begin(), names.end()}));
}

PatchRule::Facing read_facing(const TomlValue& value) {
  const TomlTable table(value, keys_of("patch.facing"));
  return {as_direction(table.at("direction")),
          as_number(table.at("within_deg"), {"an angle > 0 and <= 180", 0, 180, false, true})};
}

PatchRule read_rule(const TomlValue& value) {
  const TomlTable table(value, keys_of("patch"));
  PatchRule rule;
  rule.where = location_of(value);
  rule.name = as_text(table.at("name"));
  if (const auto side = table.find("side")) rule.side = read_side(*side);
  if (const auto box = table.find("box_m")) rule.box = read_box(*box);
  if (const auto beyond = table.find("beyond")) rule.beyond = read_beyond(*beyond);
  if (const auto facing = table.find("facing")) rule.facing = read_facing(*facing);
  if (const auto near = table.find("near")) rule.near = read_near(*near);
  if (!rule.side && !rule.box && !rule.beyond && !rule.facing && !rule.near)
    refuse(value, fmt::format("'{}' does not say where it lies", rule.name),
           "one or more of side, box_m, beyond, facing, near");
  if (rule.side && (rule.beyond || rule.facing))
    refuse(*table.find("side"), "stands beside beyond or facing", "side with box_m or near, or none of the three");
  return rule;
}

}  // namespace

PatchRule parse_patch_rule(const std::string& name, const std::string& text, const std::string& source) {
  require_bounded(text, source);
  toml::table table;
  try {
    table = toml::parse(text.find('=') == std::string::npos ? fmt::format("side = \"{}\"", text) : text, source);
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}: '{}' is no rule of a patch: {} (allowed: left, right, front, back, bottom, top, or "
                    "keys of [[patch]] such as 'beyond = {{ point_m = [0, 0, 0.01], normal = [0, 0, -1] }}')",
                    source, text, error.description()));
  }
  table.insert("name", name);
  return read_rule({&table, "patch", source});
}

std::vector<PatchRule> read_patch_rules(const TomlTable& document) {
  std::vector<PatchRule> rules;
  for (const TomlValue& value : document.tables("patch")) {
    read_own_name(TomlTable(value, keys_of("patch")).at("name"), rules, " patch");
    rules.push_back(read_rule(value));
  }
  return rules;
}

}  // namespace springproof
