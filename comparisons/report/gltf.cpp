#include "comparisons/report/report.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <sstream>

#include "problem/files/files.h"

namespace springproof {
namespace {

constexpr double seconds_to_deform = 1;

/// A model under construction: its one buffer grows by an array at a time.
class Builder {
 public:
  Builder() { model_.buffers.emplace_back(); }

  /// @return the number of the accessor
  template <class Number>
  int add(const std::vector<Number>& numbers, int type, int target = 0) {
    const int component =
        std::is_same_v<Number, float> ? TINYGLTF_COMPONENT_TYPE_FLOAT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    std::vector<unsigned char>& bytes = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = numbers.size() * sizeof(Number);
    view.target = target;
    const auto* data = reinterpret_cast<const unsigned char*>(numbers.data());
    bytes.insert(bytes.end(), data, data + view.byteLength);
    model_.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
    accessor.componentType = component;
    accessor.type = type;
    const std::size_t width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
    accessor.count = numbers.size() / width;
    accessor.minValues.assign(width, HUGE_VAL);
    accessor.maxValues.assign(width, -HUGE_VAL);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      accessor.minValues[i % width] = std::min(accessor.minValues[i % width], double(numbers[i]));
      accessor.maxValues[i % width] = std::max(accessor.maxValues[i % width], double(numbers[i]));
    }
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  tinygltf::Model& model() { return model_; }

 private:
  tinygltf::Model model_;
};

std::vector<unsigned> triangles_of(const Picture& picture) {
  std::vector<unsigned> out;
  for (std::size_t q = 0; q + 3 < picture.quads.size(); q += 4) {
    const int* n = &picture.quads[q];
    for (const int corner : {0, 1, 2}) out.push_back(static_cast<unsigned>(n[corner]));
    if (n[3] >= 0)
      for (const int corner : {0, 2, 3}) out.push_back(static_cast<unsigned>(n[corner]));
  }
  return out;
}

/// Times [s] and, one after the other, the weights of all targets at each.
struct Course {
  std::vector<float> times, weights;
};

Course course_of(const Picture& picture, std::size_t targets) {
  if (picture.frames.empty()) return {{0, seconds_to_deform, 2 * seconds_to_deform}, {0, 1, 0}};
  Course course{{picture.frame_times.begin(), picture.frame_times.end()}, std::vector<float>(targets * targets, 0)};
  for (std::size_t t = 0; t < targets; ++t) course.weights[t * targets + t] = 1;
  return course;
}

void animate(Builder& builder, const Course& course) {
  tinygltf::AnimationSampler sampler;
  sampler.input = builder.add(course.times, TINYGLTF_TYPE_SCALAR);
  sampler.output = builder.add(course.weights, TINYGLTF_TYPE_SCALAR);
  sampler.interpolation = "LINEAR";
  tinygltf::AnimationChannel channel;
  channel.sampler = 0;
  channel.target_node = 0;
  channel.target_path = "weights";
  tinygltf::Animation animation;
  animation.samplers.push_back(sampler);
  animation.channels.push_back(channel);
  builder.model().animations.push_back(animation);
}

}  // namespace

void write_gltf(const std::filesystem::path& file, const Picture& picture) {
  Builder builder;
  tinygltf::Primitive surface;
  surface.mode = TINYGLTF_MODE_TRIANGLES;
  surface.material = 0;
  surface.indices = builder.add(triangles_of(picture), TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  surface.attributes["POSITION"] = builder.add(picture.rest, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
  const std::vector<std::vector<float>> one = {picture.displacement};
  const auto& targets = picture.frames.empty() ? one : picture.frames;
  for (const std::vector<float>& u : targets)
    surface.targets.push_back({{"POSITION", builder.add(u, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER)}});

  tinygltf::Model& model = builder.model();
  model.asset.version = "2.0";
  model.asset.generator = "springproof";
  model.materials.emplace_back();
  model.materials[0].pbrMetallicRoughness.baseColorFactor = {0.36, 0.55, 0.75, 1};
  model.materials[0].pbrMetallicRoughness.metallicFactor = 0;
  model.materials[0].doubleSided = true;
  model.meshes.emplace_back();
  model.meshes[0].name = picture.model;
  model.meshes[0].primitives.push_back(surface);
  model.meshes[0].weights.assign(targets.size(), 0);
  model.nodes.emplace_back();
  model.nodes[0].mesh = 0;
  model.nodes[0].rotation = {-std::numbers::sqrt2 / 2, 0, 0, std::numbers::sqrt2 / 2};
  model.scenes.emplace_back();
  model.scenes[0].nodes = {0};
  model.defaultScene = 0;
  animate(builder, course_of(picture, targets.size()));
  std::ostringstream out;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true);
  write_file(file, out.str());
}

void write_gltf(const CaseResult& result, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::set<std::string> smooth;
  for (const Picture& picture : result.pictures)
    if (picture.surface == "smooth") smooth.insert(file_stem(picture));
  for (const Picture& picture : result.pictures)
    if (picture.surface == "smooth" || !smooth.contains(file_stem(picture)))
      write_gltf(folder / (file_stem(picture) + ".glb"), picture);
}

}  // namespace springproof
