#include "meshes/gmsh/session.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>

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

std::vector<ElementBlock> elements(int dimension, const std::vector<int>& entities) {
  std::vector<ElementBlock> blocks;
  for (const int entity : entities) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> element_tags, node_tags;
    gmsh::model::mesh::getElements(types, element_tags, node_tags, dimension, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      auto block = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.type == types[t]; });
      if (block == blocks.end()) block = blocks.insert(block, block_of(types[t]));
      block->node_tags.insert(block->node_tags.end(), node_tags[t].begin(), node_tags[t].end());
    }
  }
  return blocks;
}

std::vector<ElementBlock> volume_elements() {
  gmsh::vectorpair groups, all;
  gmsh::model::getPhysicalGroups(groups, 3);
  std::vector<int> entities;
  for (const auto& [dimension, tag] : groups) {
    std::vector<int> members;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, members);
    for (const int e : members)
      if (std::find(entities.begin(), entities.end(), e) == entities.end()) entities.push_back(e);
  }
  auto blocks = elements(3, entities);
  if (!blocks.empty()) return blocks;
  gmsh::model::getEntities(all, 3);
  entities.clear();
  for (const auto& [dimension, tag] : all) entities.push_back(tag);
  return elements(3, entities);
}

std::vector<PhysicalSurface> physical_surfaces() {
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups, 2);
  std::vector<PhysicalSurface> found;
  for (const auto& [dimension, tag] : groups) {
    PhysicalSurface surface;
    gmsh::model::getPhysicalName(dimension, tag, surface.name);
    if (surface.name.empty()) surface.name = std::to_string(tag);
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, entities);
    surface.facets = elements(dimension, entities);
    found.push_back(std::move(surface));
  }
  return found;
}

}  // namespace springproof
