#include "comparisons/report/report.h"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstring>

#include "problem/processes/child.h"

namespace springproof::gltf_test {
namespace {

/// A square and a triangle on its edge.
Picture flag() {
  Picture p;
  p.model = "hybmss_avg";
  p.cells = {2, 2, 2};
  p.rest = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 2, 0};
  p.displacement = {0, 0, 0, 0, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0, 0, -0.25F};
  p.quads = {0, 1, 2, 3, 3, 2, 4, -1};
  return p;
}

template <class Number>
std::vector<Number> numbers(const tinygltf::Model& model, int accessor) {
  const tinygltf::Accessor& a = model.accessors.at(accessor);
  const tinygltf::BufferView& view = model.bufferViews.at(a.bufferView);
  std::vector<Number> out(a.count * tinygltf::GetNumComponentsInType(a.type));
  EXPECT_EQ(out.size() * sizeof(Number), view.byteLength);
  std::memcpy(out.data(), model.buffers[0].data.data() + view.byteOffset, view.byteLength);
  return out;
}

tinygltf::Model written(const Picture& picture) {
  const TemporaryFolder folder;
  write_gltf(folder.path / "run.glb", picture);
  tinygltf::Model model;
  std::string errors, warnings;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &errors, &warnings, (folder.path / "run.glb").string()));
  EXPECT_EQ(errors + warnings, "");
  return model;
}

TEST(Gltf, AnEquilibriumGoesThereAndBack) {
  const tinygltf::Model model = written(flag());
  const tinygltf::Primitive& surface = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(numbers<unsigned>(model, surface.indices), (std::vector<unsigned>{0, 1, 2, 0, 2, 3, 3, 2, 4}));
  EXPECT_EQ(numbers<float>(model, surface.attributes.at("POSITION")), flag().rest);
  ASSERT_EQ(surface.targets.size(), 1u);
  EXPECT_EQ(numbers<float>(model, surface.targets[0].at("POSITION")), flag().displacement);
  const tinygltf::AnimationSampler& sampler = model.animations.at(0).samplers.at(0);
  EXPECT_EQ(numbers<float>(model, sampler.output), (std::vector<float>{0, 1, 0}));
  const tinygltf::Accessor& box = model.accessors.at(surface.attributes.at("POSITION"));
  EXPECT_EQ(box.maxValues, (std::vector<double>{1, 2, 0}));
}

TEST(Gltf, AMotionHasATargetPerFrameAtItsTime) {
  Picture p = flag();
  p.frame_times = {0, 0.25, 0.75};
  p.frames = {std::vector<float>(15, 0), p.displacement, std::vector<float>(15, 1)};
  const tinygltf::Model model = written(p);
  const tinygltf::AnimationSampler& sampler = model.animations.at(0).samplers.at(0);
  EXPECT_EQ(numbers<float>(model, sampler.input), (std::vector<float>{0, 0.25F, 0.75F}));
  EXPECT_EQ(numbers<float>(model, sampler.output), (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(numbers<float>(model, model.meshes.at(0).primitives.at(0).targets.at(2).at("POSITION")), p.frames[2]);
}

TEST(Gltf, TheTrueSurfaceIsTakenWhereThereIsOne) {
  const TemporaryFolder folder;
  CaseResult result;
  result.pictures = {flag(), flag(), flag()};
  result.pictures[1].surface = "smooth";
  result.pictures[1].rest[0] = -1;
  result.pictures[2].model = "emsm";
  write_gltf(result, folder.path);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path))
    files += entry.path().extension() == ".glb";
  EXPECT_EQ(files, 2);
}

TEST(Gltf, WhatCannotBeWrittenIsSaid) { EXPECT_THROW(write_gltf("/nowhere/run.glb", flag()), std::runtime_error); }

}  // namespace
}  // namespace springproof::gltf_test
