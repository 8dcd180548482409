#include "meshes/surface/surface_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/facets.h"
#include "meshes/surface/surface_repair.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

constexpr double weld_tolerance = 1e-6, coarsest_weld_tolerance = 1e-4;  // of the diagonal
constexpr double least_extent = 1e-15, most_extent = 1e15;
constexpr double most_distance = 1e9;   // of the diagonal: farther out, doubles cannot tell welded points apart
constexpr double least_volume = 1e-12;  // of the diagonal cubed
constexpr unsigned most_intersections = 10000;

std::string at(const Vec3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z()); }

/// "1 open edge", "3 open edges".
std::string count_of(std::size_t n, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}
std::string facets(std::size_t n) { return count_of(n, "facet", "facets"); }

/// The surface on its way through the checks.
struct Check {
  std::string name;
  double diagonal;
  Surface surface;
  std::vector<Side> sides;
  Neighbours neighbours;
  std::vector<std::string> notes;

  [[noreturn]] void refuse(const std::string& message) const { throw InputError(SourceLocation{name, 0, 0}, message); }
};

void check_coordinates(Check& check, const Surface& raw) {
  if (raw.triangles.empty()) check.refuse("has no facets");
  for (std::size_t f = 0; f < raw.triangles.size(); ++f)
    for (const int p : raw.triangles[f])
      if (!raw.points[p].allFinite()) check.refuse(fmt::format("facet {}: a coordinate is not a finite number", f + 1));
  const Box box = bounding_box(raw);
  check.diagonal = (box.high - box.low).stableNorm();
  if (check.diagonal == 0) check.refuse("all facets are one point");
  if (!(check.diagonal >= least_extent && check.diagonal <= most_extent))
    check.refuse(fmt::format("the diagonal of its bounding box is {:.3g} (allowed: {} to {})", check.diagonal,
                             least_extent, most_extent));
  if (const double distance = box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).maxCoeff();
      distance > most_distance * check.diagonal)
    check.refuse(
        fmt::format("lies {:.3g} times its diagonal away from the origin (allowed: {:.0e}): move it to the origin",
                    distance / check.diagonal, most_distance));
}

std::size_t edges_with(const std::vector<Side>& sides, bool (*wanted)(std::size_t), int* point = nullptr) {
  std::size_t count = 0;
  for_each_edge(sides, [&](std::span<const Side> edge) {
    if (!wanted(edge.size())) return;
    if (count++ == 0 && point) *point = edge[0].low;
  });
  return count;
}
bool is_open(std::size_t facets_at_edge) { return facets_at_edge == 1; }
bool is_crowded(std::size_t facets_at_edge) { return facets_at_edge > 2; }

/// A coarser weld that closes the surface, if there is one up to the coarsest allowed.
struct CoarserWeld {
  double tolerance = 0;  ///< 0: there is none
  Welded welded;
};
CoarserWeld closing_weld(const Surface& raw, double diagonal) {
  for (double relative = 10 * weld_tolerance; relative < 1.1 * coarsest_weld_tolerance; relative *= 10) {
    Welded welded = weld(raw, relative * diagonal);
    const auto sides = sides_by_edge(welded.surface);
    const auto is_wrong = [](std::size_t n) { return n != 2; };
    if (!sides.empty() && edges_with(sides, is_wrong) == 0) return {relative * diagonal, std::move(welded)};
  }
  return {};
}

[[noreturn]] void refuse_holes(const Check& check) {
  const std::vector<Hole> found = holes(check.surface, check.sides);
  std::size_t edges = 0;
  for (const Hole& hole : found) edges += hole.edges;
  const Hole& first = found.front();
  check.refuse(
      fmt::format("the surface is open: {} round {}; the first, of {}, is at {} and spans {} to {}: "
                  "close the {} in a mesh editor",
                  count_of(edges, "open edge", "open edges"), count_of(found.size(), "hole", "holes"),
                  count_of(first.edges, "edge", "edges"), at(first.start), at(first.box.low), at(first.box.high),
                  found.size() == 1 ? "hole" : "holes"));
}

/// Welds; more coarsely if only that closes the surface and no facet is lost by it.
void weld_points(Check& check, const Surface& raw) {
  Welded welded = weld(raw, weld_tolerance * check.diagonal);
  check.surface = std::move(welded.surface);
  check.sides = sides_by_edge(check.surface);
  if (edges_with(check.sides, is_open) > 0 && edges_with(check.sides, is_crowded) == 0) {
    CoarserWeld coarser = closing_weld(raw, check.diagonal);
    const std::size_t lost = coarser.welded.without_area.size() + coarser.welded.twice.size();
    if (coarser.tolerance > 0 && lost > welded.without_area.size() + welded.twice.size())
      check.refuse(
          fmt::format("the surface is open, {}; it would close if points up to {:.3g} apart were welded, but {} "
                      "smaller than that would be lost: weld the points in a mesh editor",
                      count_of(edges_with(check.sides, is_open), "open edge", "open edges"), coarser.tolerance,
                      facets(lost - welded.without_area.size() - welded.twice.size())));
    if (coarser.tolerance > 0) {
      check.notes.push_back(fmt::format("{} closed by welding points up to {:.3g} apart (the first at {})",
                                        count_of(edges_with(check.sides, is_open), "open edge was", "open edges were"),
                                        coarser.tolerance, at(holes(check.surface, check.sides).front().start)));
      welded = std::move(coarser.welded);
      check.surface = std::move(welded.surface);
      check.sides = sides_by_edge(check.surface);
    }
  }
  if (const auto& gone = welded.without_area; !gone.empty())
    check.notes.push_back(fmt::format("{} without area removed (the first at {})", facets(gone.size()), at(gone[0])));
  if (const auto& gone = welded.twice; !gone.empty())
    check.notes.push_back(fmt::format("{} removed that {} there twice (the first at {})", facets(gone.size()),
                                      gone.size() == 1 ? "was" : "were", at(gone[0])));
  if (check.surface.triangles.empty()) check.refuse("no facet has an area");
}

void check_edges(const Check& check) {
  int point = 0;
  if (const std::size_t crowded = edges_with(check.sides, is_crowded, &point))
    check.refuse(
        fmt::format("{} of more than two facets, the first at {}: remove inner walls, or join parts that touch along "
                    "an edge with a Boolean union",
                    count_of(crowded, "edge", "edges"), at(check.surface.points[point])));
  if (edges_with(check.sides, is_open) > 0) refuse_holes(check);
}

void orient_facets(Check& check) {
  check.neighbours = neighbours_of(check.sides, check.surface.triangles.size());
  const auto turned = orient(check.surface, check.sides, check.neighbours);
  if (!turned) check.refuse("the surface has only one side (as a Klein bottle): it bounds no body");
  if (!turned->empty())
    check.notes.push_back(fmt::format("{} turned that faced the other way than {} neighbours (the first at {})",
                                      facets(turned->size()), turned->size() == 1 ? "its" : "their",
                                      at(check.surface.points[check.surface.triangles[turned->front()][0]])));
  // orient() swaps two corners: sides and neighbours are those of the old order.
  check.sides = sides_by_edge(check.surface);
  check.neighbours = neighbours_of(check.sides, check.surface.triangles.size());
}

void check_points(const Check& check) {
  const std::vector<int> pinched = pinched_points(check.surface, check.neighbours);
  if (!pinched.empty())
    check.refuse(
        fmt::format("{} where parts of the surface only touch, the first at {}: "
                    "move the parts apart or join them in a mesh editor",
                    count_of(pinched.size(), "point", "points"), at(check.surface.points[pinched[0]])));
}

void flatten(Check& check) {
  const double height = weld_tolerance * check.diagonal;
  const Flattened flat = remove_flat_facets(check.surface, check.neighbours, height);
  if (!flat.left.empty())
    check.refuse(fmt::format("{} lower than {:.3g}, the first at {}: remove degenerate facets in a mesh editor",
                             facets(flat.left.size()), height, at(flat.left[0])));
  if (!flat.removed.empty())
    check.notes.push_back(fmt::format("{} without area removed (three corners on a line, the first at {})",
                                      facets(flat.removed.size()), at(flat.removed[0])));
}

Vec3 middle_of_the_smaller(const Surface& surface, const std::pair<int, int>& pair) {
  const auto box_around = [&](int facet) {
    const auto& [a, b, c] = surface.triangles[facet];
    return box_of(std::array{surface.points[a], surface.points[b], surface.points[c]});
  };
  const Box f = box_around(pair.first), g = box_around(pair.second);
  const Box& smaller = (f.high - f.low).norm() < (g.high - g.low).norm() ? f : g;
  return (smaller.low + smaller.high) / 2;
}

void check_intersections(const Check& check, const std::vector<int>& shell) {
  const auto pairs = intersecting_facets(check.surface, most_intersections);
  if (pairs.empty()) return;
  const auto is_between = [&](const auto& p) { return shell[p.first] != shell[p.second]; };
  const bool is_overlap = std::any_of(pairs.begin(), pairs.end(), is_between);
  const Vec3 place = middle_of_the_smaller(check.surface, pairs[0]);
  const std::string cure =
      is_overlap ? "parts overlap: join them with a Boolean union" : "remove the self-intersections in a mesh editor";
  const std::string at_least = pairs.size() >= most_intersections ? "at least " : "";
  check.refuse(fmt::format("{}{} of facets cut each other, the first at {}: {}", at_least,
                           count_of(pairs.size(), "pair", "pairs"), at(place), cure));
}

/// The facets of each shell, the one of the largest volume first.
std::vector<Surface> parts(const Surface& surface, const std::vector<int>& shell) {
  std::vector<Surface> result(*std::max_element(shell.begin(), shell.end()) + 1);
  std::vector<int> number(surface.points.size(), -1);  // no point belongs to two shells
  for (std::size_t f = 0; f < shell.size(); ++f) {
    Surface& part = result[shell[f]];
    std::array<int, 3> corners{};
    for (int i = 0; i < 3; ++i) {
      int& n = number[surface.triangles[f][i]];
      if (n < 0) {
        n = static_cast<int>(part.points.size());
        part.points.push_back(surface.points[surface.triangles[f][i]]);
      }
      corners[i] = n;
    }
    part.triangles.push_back(corners);
  }
  const auto is_larger = [](const Surface& a, const Surface& b) { return std::abs(volume(a)) > std::abs(volume(b)); };
  std::sort(result.begin(), result.end(), is_larger);
  return result;
}

/// Shells within the largest one are cavities, and point inwards.
void check_shells(Check& check, const std::vector<int>& shell) {
  if (*std::max_element(shell.begin(), shell.end()) == 0) return;
  const std::vector<Surface> all = parts(check.surface, shell);
  const auto is_inside = [](const Surface& part, const Surface& of) {
    return std::abs(winding_number(of, part.points[0])) > 0.5;
  };
  const auto outside =
      std::find_if(all.begin() + 1, all.end(), [&](const Surface& part) { return !is_inside(part, all[0]); });
  if (outside != all.end())
    check.refuse(
        fmt::format("{} shells that do not touch (allowed: one body): the largest has {} of {}, another, at {}, has "
                    "{}: keep one, or join them with a Boolean union",
                    all.size(), all[0].triangles.size(), facets(check.surface.triangles.size()), at(outside->points[0]),
                    outside->triangles.size()));
  for (auto inner = all.begin() + 1; inner != all.end(); ++inner)
    for (auto other = all.begin() + 1; other != all.end(); ++other)
      if (inner != other && is_inside(*inner, *other))
        check.refuse(fmt::format("a shell at {} is in the cavity of another one: a body of its own (allowed: one body)",
                                 at(inner->points[0])));
  Surface whole;
  for (std::size_t s = 0; s < all.size(); ++s) {
    Surface part = all[s];
    if ((volume(part) > 0) != (s == 0)) turn_inside_out(part);
    const auto first = static_cast<int>(whole.points.size());
    whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
    for (const auto& [a, b, c] : part.triangles) whole.triangles.push_back({a + first, b + first, c + first});
  }
  check.surface = std::move(whole);
  check.notes.push_back(fmt::format("{} inside of the body, of {:.3g} % of the volume within its outer surface",
                                    count_of(all.size() - 1, "cavity", "cavities"),
                                    100 * (1 - volume(check.surface) / std::abs(volume(all[0])))));
}

void check_volume(Check& check) {
  const double enclosed = volume(check.surface);
  if (!(std::abs(enclosed) > least_volume * std::pow(check.diagonal, 3)))
    check.refuse(fmt::format("the surface encloses no volume ({:.3g})", enclosed));
  if (enclosed > 0) return;
  turn_inside_out(check.surface);
  check.notes.push_back("the whole surface was inside out: turned");
}

}  // namespace

CheckedSurface check_surface(const Surface& raw, const std::string& name) {
  Check check = {name, 0, {}, {}, {}, {}};
  check_coordinates(check, raw);
  weld_points(check, raw);
  check_edges(check);
  orient_facets(check);
  check_points(check);
  flatten(check);
  const std::vector<int> shell = shells(check.neighbours);
  check_intersections(check, shell);
  check_shells(check, shell);
  check_volume(check);
  return {std::move(check.surface), std::move(check.notes)};
}

}  // namespace springproof
