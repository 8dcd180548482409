// Pictures as JSON: what the report's 3D view reads.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "comparisons/results/records.h"
#include "problem/files/encoding.h"

namespace springproof {
namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little);  // as the report reads them

template <class Number>
std::string base64_of(const std::vector<Number>& numbers) {
  return base64(numbers.data(), numbers.size() * sizeof(Number));
}

/// Multiples of `scale` as Integers, the smallest of which is no number: 16 bits for places, exact to 1/65000 of the
/// largest value; 8 bits for colours.
template <class Integer>
Json multiples_json(const std::vector<float>& values) {
  using Limits = std::numeric_limits<Integer>;
  double largest = 0;
  for (float value : values)
    if (std::isfinite(value)) largest = std::max<double>(largest, std::abs(value));
  const double scale = largest > 0 ? largest / Limits::max() : 1;
  std::vector<Integer> steps;
  for (float value : values)
    steps.push_back(static_cast<Integer>(std::isfinite(value) ? std::lround(value / scale) : Limits::min()));
  return {{"scale", scale}, {"base64", base64_of(steps)}};
}

/// Triangles (fourth number -1) repeat their last corner.
Json quads_json(const std::vector<int>& quads, std::size_t nodes) {
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const int node = i % 4 == 3 && quads[i] < 0 ? quads[i - 1] : quads[i];
    if (node < 0 || static_cast<std::size_t>(node) >= nodes)
      throw std::invalid_argument(fmt::format("picture: facet names node {} of {}", node, nodes));
    corners.push_back(static_cast<std::uint32_t>(node));
  }
  if (nodes > 65536) return {{"type", "uint32"}, {"base64", base64_of(corners)}};
  return {{"type", "uint16"}, {"base64", base64_of(std::vector<std::uint16_t>(corners.begin(), corners.end()))}};
}

/// Of the patches that a load acts on, the surface nodes.
Json patches_json(const Picture& p, const std::vector<Load>& loads) {
  Json out = Json::object();
  for (const Load& load : loads)
    if (const std::string* on = patch_of(load); on && p.patches.count(*on)) out[*on] = p.patches.at(*on);
  return out;
}

Json json_of(const LoadMark& m) {
  const auto list = [](const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); };
  return {{"kind", m.kind}, {"on", m.on}, {"vector", list(m.vector)}, {"at", list(m.at)}};
}

void check_sizes(const Picture& p) {
  const auto nodes = p.rest.size() / 3;
  if (p.rest.size() % 3 != 0 || p.displacement.size() != p.rest.size() || p.quads.size() % 4 != 0 ||
      (!p.difference.empty() && p.difference.size() != nodes) ||
      (!p.volume_change.empty() && p.volume_change.size() != nodes) ||
      (!p.von_mises.empty() && p.von_mises.size() != nodes))
    throw std::invalid_argument(fmt::format(
        "picture of {}: {} rest, {} displacement, {} difference, {} volume changes, {} facet numbers", p.model,
        p.rest.size(), p.displacement.size(), p.difference.size(), p.volume_change.size(), p.quads.size()));
}

}  // namespace

Json pictures_to_json(const CaseResult& result) {
  Json meshes = Json::array(), pictures = Json::array();
  std::vector<const Picture*> owners;  // one per entry of meshes
  for (const Picture& p : result.pictures) {
    check_sizes(p);
    std::size_t mesh = 0;
    while (mesh < owners.size() && (owners[mesh]->rest != p.rest || owners[mesh]->quads != p.quads)) ++mesh;
    if (mesh == owners.size()) {
      owners.push_back(&p);
      meshes.push_back({{"rest", base64_of(p.rest)},
                        {"quads", quads_json(p.quads, p.rest.size() / 3)},
                        {"patches", patches_json(p, result.experiment.loads)}});
    }
    pictures.push_back({{"model", p.model},
                        {"poisson_ratio", p.poisson_ratio},
                        {"cells", p.cells},
                        {"surface", p.surface},
                        {"mesh", mesh},
                        {"displacement", multiples_json<std::int16_t>(p.displacement)},
                        {"difference", multiples_json<std::int8_t>(p.difference)},
                        {"volume_change", multiples_json<std::int8_t>(p.volume_change)}});
    if (!p.von_mises.empty()) pictures.back()["von_mises"] = multiples_json<std::int8_t>(p.von_mises);
    if (p.frames.empty()) continue;
    std::vector<float> frames;  // one after the other, with one scale
    for (const std::vector<float>& frame : p.frames) frames.insert(frames.end(), frame.begin(), frame.end());
    pictures.back()["frames"] = {{"time", p.frame_times}, {"displacement", multiples_json<std::int16_t>(frames)}};
  }
  Json cracks = Json::array();
  for (const CrackRecord& c : result.cracks)
    cracks.push_back({{"model", c.model}, {"poisson_ratio", c.poisson_ratio}, {"cells", c.cells}, {"svg", c.svg}});
  Json marks = Json::array();
  for (const Load& load : result.experiment.loads)
    if (const LoadMark m = mark(load); !m.kind.empty()) marks.push_back(json_of(m));
  return {{"case", result.experiment.name},
          {"folder", result.experiment.folder},
          {"marks", marks},
          {"meshes", meshes},
          {"pictures", pictures},
          {"cracks", cracks},
          {"section", result.section_svg}};
}

}  // namespace springproof
