#include "meshes/mesher_exchange.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meshes/mesh_json.h"

namespace springproof {
namespace {

using nlohmann::json;

json vec(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Vec3 to_vec(const json& j) {
  return Vec3(j.at(0), j.at(1), j.at(2));
}

std::string cbor(const json& j) {
  std::string bytes;
  json::to_cbor(j, bytes);
  return bytes;
}

}  // namespace

json to_json(const MeshRequest& r) {
  return {{"file", r.file.string()},
          {"size", vec(r.size)},
          {"cells", r.cells},
          {"tetrahedra", r.kind.tetrahedra},
          {"second_order", r.kind.second_order},
          {"edge", r.edge},
          {"about", r.tetrahedra},
          {"coarser", r.coarser},
          {"scale", r.scale}};
}

MeshRequest mesh_request_from_json(const json& j) {
  MeshRequest r;
  r.file = std::string(j.at("file"));
  r.size = to_vec(j.at("size"));
  r.cells = j.at("cells");
  r.kind = {j.at("tetrahedra"), j.at("second_order")};
  r.edge = j.at("edge");
  r.tetrahedra = j.at("about");
  r.coarser = j.at("coarser").get<std::vector<double>>();
  r.scale = j.at("scale");
  return r;
}

std::string to_cbor(const MeshedBody& body) {
  json coarser = json::array();
  for (const Mesh& mesh : body.coarser) coarser.push_back(to_json(mesh));
  return cbor({{"mesh", to_json(body.mesh)}, {"notes", body.notes}, {"edge", body.edge}, {"coarser", coarser}});
}

std::string refusal_to_cbor(const std::string& message) {
  return cbor({{"refused", message}});
}

MeshedBody answer_from_cbor(const std::string& bytes) {
  json j;
  try {
    j = json::from_cbor(bytes);
  } catch (const json::exception& e) {
    throw std::runtime_error(std::string("springproof-mesh gave no answer: ") + e.what());
  }
  if (j.contains("refused")) throw InputError(j.at("refused").get<std::string>());
  MeshedBody body{mesh_from_json(j.at("mesh")), j.at("notes"), j.at("edge"), {}};
  for (const json& mesh : j.at("coarser")) body.coarser.push_back(mesh_from_json(mesh));
  return body;
}

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace springproof
