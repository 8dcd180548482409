#include "meshes/gmsh/session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmsh.h>

#include <algorithm>
#include <set>

#ifdef __SANITIZE_ADDRESS__
// gmsh 4.8 leaks a few hundred bytes per extruded mesh, OpenCASCADE (libTK...) in STEP files and B-splines; what we
// leak is still reported.
extern "C" const char* __lsan_default_suppressions() { return "leak:libgmsh\nleak:libTK"; }
#endif

namespace springproof {
namespace {

ElementBlock block_of(int type) {
  ElementBlock block;
  block.type = type;
  int dimension, nodes, corners;
  std::vector<double> coordinates;
  gmsh::model::mesh::getElementProperties(type, block.name, dimension, block.order, nodes, coordinates, corners);
  block.nodes = nodes;
  block.corners = corners;
  return block;
}

}  // namespace

void refuse(const std::filesystem::path& file, const std::string& message) {
  throw InputError(SourceLocation{file.string(), 0, 0}, message);
}

GmshSession::GmshSession(const std::vector<std::pair<std::string, double>>& parameters) {
  std::vector<std::string> words = {"springproof"};
  for (const auto& [name, value] : parameters)
    words.insert(words.end(), {"-setnumber", name, fmt::format("{:.17g}", value)});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  gmsh::initialize(static_cast<int>(arguments.size()), arguments.data(), false);
  gmsh::option::setNumber("General.Terminal", 0);
  // gmsh's parser keeps the rest of a file it left by an exception and hands it to the next one: errors are
  // collected from the log instead.
  gmsh::option::setNumber("General.AbortOnError", 0);
  gmsh::logger::start();
}

GmshSession::~GmshSession() {
  gmsh::logger::stop();
  gmsh::finalize();
}

void GmshSession::stop_on_error(const std::filesystem::path& file) const {
  std::vector<std::string> log;
  gmsh::logger::get(log);
  const auto is_error = [](const std::string& line) { return line.rfind("Error", 0) == 0; };
  const auto error = std::find_if(log.begin(), log.end(), is_error);
  if (error == log.end()) return;
  gmsh::logger::stop();  // a next try begins without it
  gmsh::logger::start();
  refuse(file, "gmsh: " + *error);
}

std::vector<ElementBlock> elements(int dimension, const std::vector<int>& entities,
                                   const std::map<int, std::uint8_t>& materials) {
  std::vector<ElementBlock> blocks;
  for (const int entity : entities) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> element_tags, node_tags;
    gmsh::model::mesh::getElements(types, element_tags, node_tags, dimension, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      auto block = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.type == types[t]; });
      if (block == blocks.end()) block = blocks.insert(block, block_of(types[t]));
      block->node_tags.insert(block->node_tags.end(), node_tags[t].begin(), node_tags[t].end());
      if (materials.empty()) continue;
      const auto material = materials.find(entity);
      block->materials.insert(block->materials.end(), element_tags[t].size(),
                              material == materials.end() ? 0 : material->second);
    }
  }
  return blocks;
}

namespace {

std::string name_of_group(int dimension, int tag) {
  std::string name;
  gmsh::model::getPhysicalName(dimension, tag, name);
  return name.empty() ? std::to_string(tag) : name;
}

std::size_t count_of(const std::vector<ElementBlock>& blocks) {
  std::size_t count = 0;
  for (const ElementBlock& b : blocks) count += b.count();
  return count;
}

/// A physical volume and the entities in it.
struct PhysicalVolume {
  std::string name;  ///< its number if it has none
  int number;
  std::set<int> entities;
};

std::vector<PhysicalVolume> physical_volumes() {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, 3);
  std::vector<PhysicalVolume> all;
  for (const auto& [dimension, tag] : groups) {
    std::vector<int> members;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, members);
    all.push_back({name_of_group(dimension, tag), tag, {members.begin(), members.end()}});
  }
  return all;
}

std::string names_of(const std::vector<PhysicalVolume>& groups) {
  std::vector<std::string> names;
  for (const PhysicalVolume& g : groups) names.push_back(fmt::format("'{}'", g.name));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The material of each entity that is in a region.
std::map<int, std::uint8_t> materials_of(const std::filesystem::path& file, const std::vector<PhysicalVolume>& groups,
                                         const std::vector<std::string>& volumes) {
  std::map<int, std::uint8_t> materials;
  for (std::size_t r = 0; r < volumes.size(); ++r) {
    if (volumes[r].empty()) continue;
    const auto is_named = [&](const PhysicalVolume& g) { return g.name == volumes[r]; };
    auto named = std::find_if(groups.begin(), groups.end(), is_named);
    if (named != groups.end() && std::find_if(named + 1, groups.end(), is_named) != groups.end())
      refuse(file, fmt::format("has several physical volumes '{}', which a [[region]] names (allowed: a name of one; "
                               "or its number, in the order of the file)",
                               volumes[r]));
    if (named == groups.end())
      named = std::find_if(groups.begin(), groups.end(),
                           [&](const PhysicalVolume& g) { return std::to_string(g.number) == volumes[r]; });
    if (named == groups.end())
      refuse(file, fmt::format("has no physical volume '{}', which a [[region]] names (allowed: {})", volumes[r],
                               groups.empty() ? "none, as the file has none" : names_of(groups)));
    for (const int entity : named->entities)
      if (!materials.emplace(entity, static_cast<std::uint8_t>(r + 1)).second)
        refuse(file, fmt::format("the physical volumes of two [[region]]s, one of them '{}', have a part in common "
                                 "(allowed: each part in one)",
                                 volumes[r]));
  }
  return materials;
}

}  // namespace

std::vector<ElementBlock> volume_elements(const std::filesystem::path& file, const std::vector<std::string>& regions,
                                          std::vector<std::string>& notes) {
  const std::vector<PhysicalVolume> groups = physical_volumes();
  const std::map<int, std::uint8_t> materials = materials_of(file, groups, regions);
  std::set<int> all;
  std::size_t largest = 0;  // entities of one group
  for (const PhysicalVolume& g : groups) {
    all.insert(g.entities.begin(), g.entities.end());
    largest = std::max(largest, g.entities.size());
  }
  if (materials.empty() && largest < all.size())
    refuse(file, fmt::format("the physical volumes {} are parts of the body, which may be of several materials "
                             "(allowed: one physical volume that holds all of it, none, or a [[region]] with volume = "
                             "\"{}\" for those that are not of [material])",
                             names_of(groups), groups.back().name));
  const auto blocks = elements(3, {all.begin(), all.end()}, materials), whole = elements(3, entities(3));
  if (blocks.empty()) return whole;
  if (const std::size_t left_out = count_of(whole) - count_of(blocks); left_out > 0)
    notes.push_back(fmt::format("{} of the file's {} cells are in no physical volume and are no part of the body",
                                left_out, count_of(whole)));
  return blocks;
}

std::vector<PhysicalSurface> physical_surfaces() {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, 2);
  std::vector<PhysicalSurface> found;
  for (const auto& [dimension, tag] : groups) {
    PhysicalSurface surface;
    surface.name = name_of_group(dimension, tag);
    std::vector<int> members;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, members);
    surface.facets = elements(dimension, members);
    found.push_back(std::move(surface));
  }
  return found;
}

std::vector<int> entities(int dimension) {
  gmsh::vectorpair pairs;
  gmsh::model::getEntities(pairs, dimension);
  std::vector<int> tags;
  for (const auto& [d, tag] : pairs) tags.push_back(tag);
  return tags;
}

std::map<std::size_t, Vec3> node_positions() {
  std::vector<std::size_t> tags;
  std::vector<double> at, parametric;
  gmsh::model::mesh::getNodes(tags, at, parametric, -1, -1, false, false);
  std::map<std::size_t, Vec3> all;
  for (std::size_t n = 0; n < tags.size(); ++n) all[tags[n]] = Vec3(at[3 * n], at[3 * n + 1], at[3 * n + 2]);
  return all;
}

}  // namespace springproof
