#include "comparisons/results/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "meshes/volume.h"

namespace springproof {
namespace {

constexpr std::array<const char*, 8> colours = {"#c9ced6", "#d55e00", "#0072b2", "#009e73",
                                                "#cc79a7", "#e69f00", "#56b4e9", "#f0e442"};  // Okabe and Ito
constexpr double picture_width = 600, margin = 10;                                            // units of the drawing

using Point = Eigen::Vector2d;

/// What a plane cuts out of a cell.
struct Piece {
  std::vector<Point> corners;  ///< in order
  int material;
};

struct SectionPlane {
  int axis;
  double at;

  Point flat(const Vec3& x) const { return {x[axis == 0 ? 1 : 0], x[axis == 2 ? 1 : 2]}; }
};

/// Where the edges between the corners of a convex cell cross the plane, in order around their middle.
template <class Cell>
std::vector<Point> crossing(const SectionPlane& plane, const NodalVectors& nodes, const Cell& cell) {
  std::vector<Point> points;
  Point middle = Point::Zero();
  for (std::size_t i = 0; i < cell.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 a = nodes.row(cell[i]).transpose(), b = nodes.row(cell[j]).transpose();
      const double da = a[plane.axis] - plane.at, db = b[plane.axis] - plane.at;
      if ((da > 0) == (db > 0)) continue;
      points.push_back(plane.flat(a + da / (da - db) * (b - a)));
      middle += points.back();
    }
  middle /= std::max<double>(1, static_cast<double>(points.size()));
  const auto angle = [&](const Point& p) { return std::atan2(p[1] - middle[1], p[0] - middle[0]); };
  std::ranges::sort(points, [&](const Point& a, const Point& b) { return angle(a) < angle(b); });
  return points;
}

std::vector<Piece> pieces_of(const SectionPlane& plane, const Mesh& body) {
  std::vector<Piece> pieces;
  std::size_t number = 0;
  const auto add = [&](const auto& cell) {
    std::vector<Point> corners = crossing(plane, body.nodes, cell);
    if (corners.size() > 2) pieces.push_back({std::move(corners), body.materials[number]});
    ++number;
  };
  for (const Hexahedron& cell : body.hexahedra) add(cell);
  for (const Tetrahedron& cell : body.tetrahedra) add(cell);
  return pieces;
}

double area(const std::vector<Point>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
    sum += (a[0] * b[1] - a[1] * b[0]) / 2;
  }
  return std::abs(sum);
}

/// How many materials a section shows, and how much of those of regions.
std::pair<std::size_t, double> shown(const std::vector<Piece>& pieces) {
  std::set<int> materials;
  double of_regions = 0;
  for (const Piece& piece : pieces) {
    materials.insert(piece.material);
    if (piece.material > 0) of_regions += area(piece.corners);
  }
  return {materials.size(), of_regions};
}

/// Of all that is in a region.
Vec3 centroid_of_regions(const Mesh& body) {
  const Eigen::VectorXd volumes = cell_volumes(body, body.nodes);
  Vec3 sum = Vec3::Zero();
  double whole = 0;
  std::size_t number = 0;
  const auto add = [&](const auto& cell) {
    const double part = body.materials[number] > 0 ? volumes[static_cast<Eigen::Index>(number)] : 0;
    for (const int n : cell) sum += part / static_cast<double>(cell.size()) * body.nodes.row(n).transpose();
    whole += part;
    ++number;
  };
  for (const Hexahedron& cell : body.hexahedra) add(cell);
  for (const Tetrahedron& cell : body.tetrahedra) add(cell);
  return sum / whole;
}

std::string drawing(const std::vector<Piece>& pieces) {
  Point low = pieces.front().corners.front(), high = low;
  for (const Piece& piece : pieces)
    for (const Point& p : piece.corners) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  const double scale = picture_width / (high - low).maxCoeff();
  std::array<std::string, colours.size()> paths;
  for (const Piece& piece : pieces) {
    std::string& path = paths[std::ranges::find(colours, material_colour(piece.material)) - colours.begin()];
    char command = 'M';
    for (const Point& p : piece.corners) {
      path += fmt::format("{}{:.1f} {:.1f}", command, scale * (p[0] - low[0]), scale * (high[1] - p[1]));
      command = 'L';
    }
    path += 'Z';
  }
  const Point size = scale * (high - low) + Point::Constant(2 * margin);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{0:g} {0:g} {1:.0f} {2:.0f}\" width=\"{1:.0f}\" "
      "height=\"{2:.0f}\" stroke-width=\"0.6\">",
      -margin, size[0], size[1]);
  for (std::size_t c = 0; c < colours.size(); ++c)
    if (!paths[c].empty()) svg += fmt::format("<path fill=\"{0}\" stroke=\"{0}\" d=\"{1}\"/>", colours[c], paths[c]);
  return svg + "</svg>\n";
}

}  // namespace

const char* material_colour(std::size_t material) {
  return material < colours.size() ? colours[material] : colours[1 + (material - 1) % (colours.size() - 1)];
}

std::string section_svg(const Mesh& body) {
  const Vec3 through = centroid_of_regions(body);
  std::vector<Piece> best;
  for (int axis = 2; axis >= 0; --axis)
    if (std::vector<Piece> pieces = pieces_of({axis, through[axis]}, body); best.empty() || shown(pieces) > shown(best))
      best = std::move(pieces);
  return drawing(best);
}

}  // namespace springproof
