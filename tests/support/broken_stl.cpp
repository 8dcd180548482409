#include "support/broken_stl.h"

#include <fstream>
#include <iterator>
#include <random>

namespace springproof::test {

namespace fs = std::filesystem;

Surface loose(const Surface& surface) {
  Surface s;
  for (const auto& [a, b, c] : surface.triangles) {
    const int n = static_cast<int>(s.points.size());
    for (const int p : {a, b, c}) s.points.push_back(surface.points[p]);
    s.triangles.push_back({n, n + 1, n + 2});
  }
  return s;
}

Surface pyramid_sphere() { return sphere(1, 3); }

Surface with_a_flipped_facet() {
  Surface s = pyramid_sphere();
  std::swap(s.triangles[100][1], s.triangles[100][2]);
  return s;
}

/// Corners off by up to 3e-5 of the diagonal.
Surface unwelded() {
  Surface s = loose(pyramid_sphere());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1e-5, 1e-5);
  for (Vec3& p : s.points)
    for (int c = 0; c < 3; ++c) p[c] += 3.46 * share(random);
  return s;
}

/// A point beside an edge is drawn into it: a facet with its corners on a line; and one with two corners at one point.
Surface with_facets_without_area() {
  Surface s = box({1, 1, 1}, 2);
  const auto [a, b, c] = s.triangles[0];
  const int middle = static_cast<int>(s.points.size());
  s.points.push_back((s.points[a] + s.points[b]) / 2);
  s.triangles[0] = {a, middle, c};
  s.triangles.push_back({middle, b, c});
  s.triangles.push_back({a, b, middle});  // no area; the facet beyond ab is not cut
  s.triangles.push_back({a, a, b});
  return s;
}

namespace {

Surface with_hole() {
  Surface s = pyramid_sphere();
  s.triangles.erase(s.triangles.begin() + 100);
  return s;
}
Surface with_a_facet_twice() {
  Surface s = pyramid_sphere();
  s.triangles.push_back(s.triangles[100]);
  return s;
}
/// One point pulled through the other side.
Surface self_intersecting() {
  Surface s = pyramid_sphere();
  s.points[s.triangles[100][0]] *= -1.5;
  return s;
}

void write_text(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

void write_edited_ascii(const fs::path& file, const std::function<void(std::string&)>& edit) {
  write_stl_ascii(file, pyramid_sphere());
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  edit(text);
  write_text(file, text);
}

std::function<void(const fs::path&)> ascii(Surface (*make)()) {
  return [make](const fs::path& file) { write_stl_ascii(file, make()); };
}

}  // namespace

const std::vector<BrokenFile>& broken_files() {
  static const std::vector<BrokenFile> files = {
      {"hole", ascii(with_hole), "the surface is open: 3 open edges round 1 hole; the first, of 3 edges, is at", false},
      {"flipped_facet", ascii(with_a_flipped_facet), "1 facet turned that faced the other way than its neighbours",
       true},
      {"duplicate_facet", ascii(with_a_facet_twice), "1 facet removed that was there twice", true},
      {"unwelded", ascii(unwelded), "open edges were closed by welding points up to 0.00034", true},
      {"self_intersecting", ascii(self_intersecting), "of facets cut each other, the first at", false},
      {"two_shells",
       [](const fs::path& file) {
         write_stl_binary(file, both(pyramid_sphere(), moved(pyramid_sphere(), 0.5, {3, 0, 0})));
       },
       "2 shells that do not touch (allowed: one body): the largest has 1280 of 2560 facets", false},
      {"without_area", ascii(with_facets_without_area), "1 facet without area removed (the first at", true},
      {"nan",
       [](const fs::path& file) {
         write_edited_ascii(file, [](std::string& t) { t.replace(t.rfind("vertex ") + 7, 3, "nan "); });
       },
       ":8959:14: facet 1280: coordinate 'nan", false},
      {"truncated",
       [](const fs::path& file) { write_edited_ascii(file, [](std::string& t) { t.resize(t.size() / 2); }); },
       "cut off within facet 64", false},
      {"empty", [](const fs::path& file) { write_text(file, ""); }, ": is empty", false},
      {"wrong_header",
       [](const fs::path& file) {
         write_stl_binary(file, pyramid_sphere());
         std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(80).write("\1\1\0\0", 4);
       },
       "says 257 facets, but the file's size is that of 1280 facets", false},
      {"no_stl", [](const fs::path& file) { write_text(file, "v 0 0 0\nv 1 0 0\nf 1 2 3\n"); },
       "is no STL file: its first word is 'v'", false},
  };
  return files;
}

}  // namespace springproof::test
