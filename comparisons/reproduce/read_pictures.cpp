#include "comparisons/reproduce/read_pictures.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "problem/files/encoding.h"
#include "problem/files/files.h"
#include "problem/system/input_error.h"
#include "problem/system/json.h"

namespace springproof {
namespace {

using nlohmann::json;

/// Unsigned little-endian numbers.
template <class T>
std::vector<T> little_endian(const json& base64_text) {
  const std::string bytes = from_base64(base64_text.get_ref<const std::string&>());
  std::vector<T> out(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t b = 0; b < sizeof(T); ++b)
      out[i] |= static_cast<T>(static_cast<T>(static_cast<unsigned char>(bytes[sizeof(T) * i + b])) << (8 * b));
  return out;
}

std::vector<float> floats_of(const json& base64_text) {
  std::vector<float> out;
  for (const std::uint32_t bits : little_endian<std::uint32_t>(base64_text)) out.push_back(std::bit_cast<float>(bits));
  return out;
}

std::vector<float> scaled_shorts(const json& j) {
  constexpr std::int16_t not_finite = -32768;
  const double scale = j.at("scale");
  std::vector<float> out;
  for (const std::uint16_t bits : little_endian<std::uint16_t>(j.at("base64"))) {
    const auto steps = static_cast<std::int16_t>(bits);
    out.push_back(steps == not_finite ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(scale * steps));
  }
  return out;
}

/// @throws std::out_of_range if a facet names a node that is not there.
std::vector<int> facets_of(const json& quads, std::size_t nodes) {
  std::vector<int> out;
  const auto add = [&](auto number) {
    if (number >= nodes) throw std::out_of_range(fmt::format("a facet names node {} of {}", number, nodes));
    out.push_back(static_cast<int>(number));
  };
  if (quads.at("type") == "uint16")
    for (const std::uint16_t n : little_endian<std::uint16_t>(quads.at("base64"))) add(n);
  else
    for (const std::uint32_t n : little_endian<std::uint32_t>(quads.at("base64"))) add(n);
  return out;
}

Picture picture_of(const json& j, const json& meshes) {
  Picture p;
  const json& mesh = meshes.at(j.at("mesh").get<std::size_t>());
  p.model = j.at("model");
  p.poisson_ratio = j.at("poisson_ratio");
  p.cells = j.at("cells").get<Cells>();
  p.surface = j.at("surface");
  p.rest = floats_of(mesh.at("rest"));
  p.displacement = scaled_shorts(j.at("displacement"));
  p.quads = facets_of(mesh.at("quads"), p.rest.size() / 3);
  if (p.displacement.size() != p.rest.size()) throw std::out_of_range("displacements of other nodes");
  return p;
}

}  // namespace

std::map<std::string, std::vector<Picture>> read_pictures(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "report.html";
  const std::string page = text_of_file(file);
  if (page.empty()) return {};
  const std::string opening = "id=\"pictures-data\">";
  const std::size_t at = page.find(opening), end = page.find("</script>", at);
  try {
    if (end == std::string::npos) throw std::out_of_range("there are no pictures in it");
    const std::size_t from = at + opening.size();
    std::map<std::string, std::vector<Picture>> all;
    for (const json& result :
         json::parse(page.begin() + static_cast<long>(from), page.begin() + static_cast<long>(end))) {
      const std::string group = result.at("folder"), name = result.at("case");
      for (const json& j : result.at("pictures"))
        all[group.empty() ? name : group + '/' + name].push_back(picture_of(j, result.at("meshes")));
    }
    return all;
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: not the report of `springproof compare`: {}", file.string(), e.what()));
  }
}

}  // namespace springproof
