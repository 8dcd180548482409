#include "meshes/mesher/refined_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "meshes/quality.h"

namespace springproof {
namespace {

constexpr double near_enough = 1.12;  ///< a ratio may be off by this factor
constexpr int attempts = 6;           ///< at a mesh of the ratio asked for
constexpr double step = 1.3;          ///< by which all edges are shortened when no coarser mesh can be made
constexpr double most_growth = 12;    ///< of the number of cells by that, unless they are few
constexpr double few = 60000;

double cells(const OneMesh& m) { return static_cast<double>(m.mesh.tetrahedra.size()); }

/// Factor by which a ratio misses the one wanted.
double miss(double ratio, double wanted) { return std::max(ratio / wanted, wanted / ratio); }

/// The meshes of one request, fine to coarse.
class Chain {
 public:
  Chain(const MeshRequest& request, const MeshAt& at) : request_(request), at_(at) {}

  /// Begins anew with about this edge; false if one of the coarser meshes cannot be had.
  bool make(double edge, const std::vector<double>& times) {
    meshes.clear();
    meshes.push_back(finest(edge));
    double before = 1;
    for (const double t : times) {
      auto next = coarser(t / before);
      if (!next) return false;
      meshes.push_back(std::move(*next));
      before = t;
    }
    return true;
  }

  std::vector<OneMesh> meshes;
  std::string failure;  ///< the last, without the file's name

 private:
  /// Shorter edges where a body is too thin or too round for those asked for.
  OneMesh finest(double edge) {
    std::optional<InputError> first;
    for (const double shorter : {1.0, 0.84, 0.7, 0.6, 0.5}) try {
        OneMesh made = at_(shorter * edge, 1);
        if (first)
          made.notes.push_back(fmt::format("edges of {:.3g} m instead of {:.3g} m: {}", made.edge, edge, failure));
        return made;
      } catch (const InputError& e) {
        if (!first) first = e;
        failure = reason(*first);
      }
    throw *first;
  }

  /// Coarser than the last by about `wanted`, or as near to that as can be had; nothing: by least_ratio neither.
  std::optional<OneMesh> coarser(double wanted) {
    std::optional<OneMesh> best;
    double best_miss = std::numeric_limits<double>::infinity();
    double low = meshes.back().edge, high = std::numeric_limits<double>::infinity(), edge = wanted * low;
    for (int i = 0; i < attempts && best_miss > near_enough && high > 1.02 * low; ++i) {
      try {
        OneMesh made = at_(edge, edge / meshes.front().edge);
        const double ratio = size_ratio(made.mesh, meshes.back().mesh);
        (ratio < wanted ? low : high) = edge;
        edge *= std::clamp(wanted / ratio, 0.6, 1.6);  // the number of cells goes with the cube of the edge
        if (ratio >= least_ratio && miss(ratio, wanted) < best_miss) {
          best_miss = miss(ratio, wanted);
          best = std::move(made);
        }
      } catch (const InputError& e) {
        failure = reason(e);
        high = edge;
      }
      if (edge <= low || edge >= high) edge = std::isinf(high) ? 1.1 * low : std::sqrt(low * high);
    }
    return best;
  }

  std::string reason(const InputError& e) const {
    const std::string text = e.what(), name = request_.file.string() + ": ";
    return text.starts_with(name) ? text.substr(name.size()) : text;
  }

  const MeshRequest& request_;
  const MeshAt& at_;
};

/// `scale`: of the file's units [m].
void add_notes(std::vector<std::string>& notes, const OneMesh& m, double scale, const std::string& prefix) {
  for (const std::string& note : m.notes) notes.push_back(prefix + note);
  TetrahedraQuality quality = quality_of(m.mesh);
  quality.mean_edge *= scale;
  quality.at *= scale;
  notes.push_back(prefix + words_for(m.mesh, quality));
}

MeshedBody body_of(const MeshRequest& r, std::vector<OneMesh> chain) {
  MeshedBody body;
  body.edge = chain.front().edge;
  for (std::size_t i = 0; i < chain.size(); ++i)
    add_notes(body.notes, chain[i], r.scale,
              i == 0 ? "" : fmt::format("coarser by {:.2f}: ", size_ratio(chain[i].mesh, chain[i - 1].mesh)));
  body.mesh = std::move(chain.front().mesh);
  for (std::size_t i = chain.size() - 1; i > 0; --i) body.coarser.push_back(std::move(chain[i].mesh));
  return body;
}

}  // namespace

MeshedBody mesh_refined(const MeshRequest& r, const MeshAt& at) {
  std::vector<double> times = r.coarser;
  std::sort(times.begin(), times.end());
  Chain chain(r, at);
  double first = 0;
  for (double edge = r.edge;; edge /= step) {
    const bool complete = chain.make(edge, times);
    OneMesh& finest = chain.meshes.front();
    if (complete && edge < r.edge)
      finest.notes.push_back(fmt::format(
          "finer than asked for (edges of {:.3g} m instead of {:.3g} m), so that coarser meshes differ enough",
          finest.edge, r.edge));
    if (complete) return body_of(r, std::move(chain.meshes));
    if (first == 0) first = cells(finest);
    const double next = first * std::pow(step * r.edge / edge, 3);  // whether or not there were more this time
    if (std::max(next, cells(finest)) <= std::max(few, most_growth * first)) continue;
    const OneMesh& last = chain.meshes.back();
    throw InputError(
        {r.file.string(), 0, 0},
        fmt::format(
            "no mesh is coarser than that of {} tetrahedra, edges of {:.3g} m, by {} or more in the size of its cells, "
            "as a "
            "reference needs{}{} (take shorter edges, a surface of even triangles, or no reference: elements = [])",
            cells(last), last.edge, least_ratio, chain.failure.empty() ? "" : "; ", chain.failure));
  }
}

MeshedBody mesh_alone(const MeshRequest& r, OneMesh made) {
  std::vector<OneMesh> chain;
  chain.push_back(std::move(made));
  return body_of(r, std::move(chain));
}

namespace {

/// Middles of edges, each made once.
class Middles {
 public:
  explicit Middles(const NodalVectors& nodes) : nodes_(nodes) {}

  int of(int a, int b) {
    const auto [at, is_new] = numbers_.try_emplace(std::minmax(a, b), static_cast<int>(nodes_.rows() + added_.size()));
    if (is_new) added_.emplace_back((nodes_.row(a) + nodes_.row(b)).transpose() / 2);
    return at->second;
  }

  Vec3 point(int n) const { return n < nodes_.rows() ? Vec3(nodes_.row(n)) : added_[n - nodes_.rows()]; }

  /// The old nodes, then the middles.
  NodalVectors nodes() const {
    NodalVectors all(nodes_.rows() + static_cast<Eigen::Index>(added_.size()), 3);
    for (Eigen::Index n = 0; n < all.rows(); ++n) all.row(n) = point(static_cast<int>(n)).transpose();
    return all;
  }

 private:
  const NodalVectors& nodes_;
  std::map<std::pair<int, int>, int> numbers_;
  std::vector<Vec3> added_;
};

/// The octahedron of the middles along one of its diagonals: p and q its ends, the others around it.
void add_around(int p, int q, const std::array<int, 4>& around, std::vector<Tetrahedron>& cells) {
  for (int i = 0; i < 4; ++i) cells.push_back({p, q, around[i], around[(i + 1) % 4]});
}

void cut(const Tetrahedron& t, Middles& middles, std::vector<Tetrahedron>& cells) {
  const auto& [a, b, c, d] = t;
  const int ab = middles.of(a, b), ac = middles.of(a, c), ad = middles.of(a, d), bc = middles.of(b, c),
            bd = middles.of(b, d), cd = middles.of(c, d);
  cells.insert(cells.end(), {{a, ab, ac, ad}, {ab, b, bc, bd}, {ac, bc, c, cd}, {ad, bd, cd, d}});
  const auto length = [&](int p, int q) { return (middles.point(p) - middles.point(q)).norm(); };
  const double one = length(ab, cd), two = length(ac, bd), three = length(ad, bc);
  if (one <= two && one <= three)
    add_around(ab, cd, {ac, ad, bd, bc}, cells);
  else if (two <= three)
    add_around(ac, bd, {ab, bc, cd, ad}, cells);
  else
    add_around(ad, bc, {ab, ac, cd, bd}, cells);
}

}  // namespace

Mesh halved(const Mesh& mesh) {
  Middles middles(mesh.nodes);
  Mesh finer;
  for (const Tetrahedron& t : mesh.tetrahedra) cut(t, middles, finer.tetrahedra);
  for (const std::uint8_t material : mesh.materials) finer.materials.insert(finer.materials.end(), 8, material);
  for (const Patch& p : mesh.patches) {
    Patch& own = finer.patches.emplace_back(Patch{p.name, {}});
    for (const auto& [a, b, c, none] : p.facets) {
      const int ab = middles.of(a, b), bc = middles.of(b, c), ca = middles.of(c, a);
      own.facets.insert(own.facets.end(), {{a, ab, ca, -1}, {ab, b, bc, -1}, {ca, bc, c, -1}, {ab, bc, ca, -1}});
    }
  }
  finer.nodes = middles.nodes();
  return finer;
}

}  // namespace springproof
