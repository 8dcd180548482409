#include "meshes/halved.h"

#include <map>

namespace springproof {
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
